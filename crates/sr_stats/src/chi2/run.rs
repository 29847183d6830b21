//! The test itself: cut, integrate, count, compare.

use sr_sampling::{Cursor, Distribution, Estimate, Independent, Measure, Real, Sample, SampleId, Uniforms};

use super::chart::{Chart, Coordinates};
use super::pearson::{Cell, pearson, too_many_strays};
use super::quadrature::{Integral, Patch};
use super::{Chi2Settings, Mass};
use crate::report::TestReport;

/// A box may be halved this often along each axis.
const MAX_HALVINGS: u32 = 60;

/// No cell needs more halvings than this in all; more are spent on a sampler that is plainly wrong.
const MAX_PATCHES_PER_CELL: u32 = 4_000;

/// A cell that holds more than this many times the mean share of a cell is cut into several.
const MAX_SHARE: f64 = 4.0;

/// A density that integrates to so much is wrong beyond doubt: no use in learning where else it is too large, cell by cell.
const TOO_MUCH: f64 = 2.0;

/// A sample's `pdf` may differ from the density at it by this factor, since the point is rounded …
const PDF_TOLERANCE: f64 = 0.01;
/// … and by more in this share of the samples: at rims, where the density jumps.
const PDF_OUTLIERS: f64 = 1e-3;

/// The samples that settings ask for.
pub fn draw<D: Distribution>(
    distribution: &D,
    settings: Chi2Settings,
) -> impl Iterator<Item = Option<Sample<D::Measure>>> {
    let sequence = Independent::new(settings.seed);
    (0..settings.samples).map(move |index| {
        let mut cursor = Cursor::new(&sequence, SampleId { pixel: 0, index });
        distribution.sample(D::Uniform::draw(&mut cursor))
    })
}

/// What is noticed while samples are drawn.
#[derive(Default)]
pub struct Tally {
    samples: u64,
    none: u64,
    /// Samples whose `pdf` is not a positive number.
    broken: u64,
    /// Samples where the density is 0.
    stray: u64,
    /// Samples whose `pdf` is not the density at them.
    wrong_pdf: u64,
    /// The first sample of any of these kinds.
    example: String,
}

impl Tally {
    /// Compares a sample's `pdf` with the density at it, and passes the sample on.
    pub fn check<D: Distribution>(
        &mut self,
        distribution: &D,
        sample: Option<Sample<D::Measure>>,
    ) -> Option<Sample<D::Measure>> {
        self.samples += 1;
        let Some(sample) = sample else {
            self.none += 1;
            return None;
        };
        let (said, is) = (sample.pdf.to_f64(), distribution.pdf(sample.value).to_f64());
        let broken = !(said > 0.0 && said.is_finite());
        let stray = is == 0.0;
        let wrong = is.is_nan() || (said - is).abs() > PDF_TOLERANCE * said.max(is);
        self.broken += u64::from(broken);
        self.stray += u64::from(stray);
        self.wrong_pdf += u64::from(wrong);
        if (broken || stray || wrong) && self.example.is_empty() {
            self.example = format!("{:?} was drawn with pdf {said}, the density there is {is}", sample.value);
        }
        Some(sample)
    }

    /// What is certainly wrong, if anything. `outside`: how many samples the chart does not cover.
    pub fn verdict(&self, outside: u64) -> Option<TestReport> {
        let Self { samples, broken, stray, wrong_pdf, example, .. } = self;
        let n = *samples as f64;
        let (count, what) = if *broken > 0 {
            (*broken, "carry a pdf that is not a positive number")
        } else if too_many_strays(*stray, *samples) {
            (*stray, "lie where the density is 0")
        } else if *wrong_pdf as f64 > PDF_OUTLIERS * n {
            (*wrong_pdf, "carry a pdf that is not the density there")
        } else if outside > 0 {
            return Some(TestReport::impossible(format!(
                "{outside} of {samples} samples lie outside the domain"
            )));
        } else {
            return None;
        };
        Some(TestReport::impossible(format!("{count} of {samples} samples {what}: {example}")))
    }

    /// Adds the cell of samples that are `None`. The rest of the integral is known up to `error`:
    /// within that, the count is believed.
    pub fn push_none(&self, cells: &mut Vec<Cell>, expected: f64, error: f64) {
        let expected = (self.none as f64).clamp((expected - error).max(0.0), (expected + error).max(0.0));
        cells.push(Cell { expected, observed: self.none });
    }
}

/// Samples counted, and the density integrated, cell by cell.
pub struct Counted {
    tally: Tally,
    cells: Vec<Cell>,
    places: Vec<Patch>,
    /// Estimated error of the sum of all integrals.
    error: f64,
}

impl Counted {
    /// ∫ density, its estimated error, and the share of samples that are not `None`.
    pub fn mass(&self) -> Mass {
        let n = self.tally.samples as f64;
        let drawn = 1.0 - self.tally.none as f64 / n;
        Mass {
            integral: self.cells.iter().map(|c| c.expected).sum::<f64>() / n,
            error: self.error,
            drawn: Estimate {
                mean: drawn,
                stderr: (drawn * (1.0 - drawn) / n).sqrt(),
                n: self.tally.samples,
            },
        }
    }
}

/// Counts samples in cells, and integrates the density over each.
///
/// # Errors
/// The report, if something is certainly wrong.
pub fn count<D, C>(distribution: &D, chart: &C, settings: Chi2Settings) -> Result<Counted, TestReport>
where
    D: Distribution,
    C: Chart<D::Measure>,
{
    let (nx, ny) = (settings.bins.0.max(1), if C::AXES == 1 { 1 } else { settings.bins.1.max(1) });
    let mut tally = Tally::default();
    let mut outside = 0;
    let mut samples: Vec<Vec<Coordinates>> = vec![Vec::new(); nx * ny];
    for sample in draw(distribution, settings) {
        let Some(sample) = tally.check(distribution, sample) else { continue };
        let Some(at) = chart.coordinates(sample.value) else {
            outside += 1;
            continue;
        };
        let bin = |x: f64, n: usize| ((x * n as f64) as usize).min(n - 1);
        samples[bin(at[0], nx) * ny + bin(at[1], ny)].push(at);
    }
    if let Some(report) = tally.verdict(outside) {
        return Err(report);
    }

    let density = |at| distribution.pdf(chart.point(at)).to_f64() * chart.measure();
    let mut cutter = Cutter {
        density,
        axes: C::AXES,
        samples: f64::from(settings.samples),
        max_share: MAX_SHARE / (nx * ny) as f64,
        patches_left: 0,
        cells: Vec::new(),
        places: Vec::new(),
        integral: 0.0,
        error: 0.0,
    };
    for (i, inside) in samples.iter_mut().enumerate() {
        let (x, y) = ((i / ny) as f64, (i % ny) as f64);
        let (sx, sy) = (1.0 / nx as f64, 1.0 / ny as f64);
        let patch = Patch { low: [x * sx, y * sy], high: [(x + 1.0) * sx, (y + 1.0) * sy], halvings: [0; 2] };
        cutter.cut(patch, inside);
        if cutter.integral > TOO_MUCH {
            let report = format!("the density integrates to more than {:.5}", cutter.integral);
            return Err(TestReport::impossible(report));
        }
    }
    Ok(Counted { tally, cells: cutter.cells, places: cutter.places, error: cutter.error })
}

/// The test on any space with coordinates.
pub fn run<D, C>(distribution: &D, chart: &C, settings: Chi2Settings) -> TestReport
where
    D: Distribution,
    C: Chart<D::Measure>,
{
    match count(distribution, chart, settings) {
        Ok(Counted { tally, cells, places, error }) => {
            judge::<D::Measure, C>(cells, &places, error, &tally, chart)
        }
        Err(report) => report,
    }
}

/// Compares expected and observed counts.
fn judge<M: Measure, C: Chart<M>>(
    mut cells: Vec<Cell>,
    places: &[Patch],
    error: f64,
    tally: &Tally,
    chart: &C,
) -> TestReport {
    let n = tally.samples as f64;
    let integral = cells.iter().map(|c| c.expected).sum::<f64>() / n;
    // Estimates of errors are rough, and densities are computed in single precision.
    let error = 3.0 * error + 1e-4;
    if integral > 1.0 + error {
        return TestReport::impossible(format!("the density integrates to {integral:.5} ± {error:.5}"));
    }
    tally.push_none(&mut cells, n * (1.0 - integral), n * error);
    pearson(&cells, |i| match places.get(i) {
        Some(patch) => format!("{:.4?} to {:.4?}", chart.point(patch.low), chart.point(patch.high)),
        None => format!("None (the density integrates to {integral:.5})"),
    })
}

/// Cuts cells until their integrals are known and none holds too much.
struct Cutter<F> {
    density: F,
    axes: usize,
    /// The number of samples in all.
    samples: f64,
    /// The largest probability of a cell.
    max_share: f64,
    patches_left: u32,
    cells: Vec<Cell>,
    places: Vec<Patch>,
    /// The sum of all integrals, and its estimated error.
    integral: f64,
    error: f64,
}

impl<F: Fn(Coordinates) -> f64> Cutter<F> {
    /// Turns a box and the samples in it into one cell, or several.
    fn cut(&mut self, patch: Patch, inside: &mut [Coordinates]) {
        if self.integral > TOO_MUCH {
            return;
        }
        self.patches_left = MAX_PATCHES_PER_CELL;
        let (share, _) = self.integrate(patch, inside, 0.1 * self.max_share);
        let axis = patch.coarsest_axis(self.axes);
        if share > self.max_share && patch.halvings[axis] < MAX_HALVINGS {
            let (below, above) = split(inside, axis, patch.middle(axis));
            let [low, high] = patch.halves(axis);
            self.cut(low, below);
            self.cut(high, above);
        } else {
            self.patches_left = MAX_PATCHES_PER_CELL;
            let (share, error) = self.integrate(patch, inside, self.tolerance(inside.len()));
            self.integral += share;
            self.error += error;
            self.cells.push(Cell { expected: share * self.samples, observed: inside.len() as u64 });
            self.places.push(patch);
        }
    }

    /// The error of a part of an integral that does not matter: a hundredth of the standard deviation
    /// of the cell's count. The edge of a support may pass through a hundred parts.
    fn tolerance(&self, inside: usize) -> f64 {
        0.01 * (inside as f64).max(5.0).sqrt() / self.samples
    }

    /// ∫ density over a box, adaptively, with an estimate of its error.
    ///
    /// A peak that falls between the nodes of the rule is found by the samples: where these disagree
    /// with the integral, the box is halved as well. That never changes what the integral converges to.
    fn integrate(&mut self, patch: Patch, inside: &mut [Coordinates], tolerance: f64) -> (f64, f64) {
        let Integral { value, error, axis } = patch.estimate(&self.density, self.axes);
        if !value.is_finite() {
            return (value, 0.0); // nothing more to learn: the test fails on it
        }
        let share = inside.len() as f64 / self.samples;
        let noise = (share.max(value).max(1.0 / self.samples) / self.samples).sqrt();
        let overlooked = value == 0.0 && !inside.is_empty();
        let settled = error <= tolerance && (share - value).abs() <= 4.0 * noise && !overlooked;
        let axis = if error <= tolerance { self.most_uneven_axis(&patch, inside) } else { axis };
        if settled || self.patches_left == 0 || patch.halvings[axis] >= MAX_HALVINGS {
            return (value, error);
        }
        self.patches_left -= 1;
        let (below, above) = split(inside, axis, patch.middle(axis));
        let [low, high] = patch.halves(axis);
        // Errors of parts add up as if they were independent.
        let (low, high) = (self.integrate(low, below, tolerance), self.integrate(high, above, tolerance));
        (low.0 + high.0, low.1.hypot(high.1))
    }

    /// The axis along which the samples differ most between the halves of a box: towards a narrow peak.
    fn most_uneven_axis(&self, patch: &Patch, inside: &[Coordinates]) -> usize {
        let unevenness = |axis: usize| {
            let below = inside.iter().filter(|at| at[axis] < patch.middle(axis)).count();
            below.abs_diff(inside.len() - below)
        };
        let coarsest = patch.coarsest_axis(self.axes);
        let other = (coarsest + 1) % self.axes;
        // Only a clear difference outweighs square boxes.
        if unevenness(other) > unevenness(coarsest) + inside.len() / 4 { other } else { coarsest }
    }
}

/// Reorders samples into those below a coordinate and the others.
fn split(inside: &mut [Coordinates], axis: usize, middle: f64) -> (&mut [Coordinates], &mut [Coordinates]) {
    let mut below = 0;
    for i in 0..inside.len() {
        if inside[i][axis] < middle {
            inside.swap(i, below);
            below += 1;
        }
    }
    inside.split_at_mut(below)
}
