//! Distributions that are chosen at run time, in any number of dimensions: points in blocks, double
//! precision.
//!
//! In: whatever can draw a block of samples and evaluate a block of densities ([`Blocks`]). Out: a
//! [`TestReport`]. A first few samples decide on cells that hold equally many. In each cell the density is
//! integrated by independent points, and the error of that is part of the statistic; then fresh samples are
//! counted. So narrow peaks, any number of dimensions and supports without an end need no settings. Samples
//! that are nothing make up for what the cells lack to 1.
//!
//! Certainly wrong, whatever the counts: densities that are negative, infinite or NaN; samples where the
//! density is 0; samples whose `pdf` is not the density at them.

mod axes;
mod draw;
mod tree;

use super::Chi2Settings;
use super::pearson::{Cell, pearson};
use crate::report::TestReport;
use crate::tails::chi2_above;
use axes::{Axes, Domain};
use draw::{BLOCK, Random, Tally, each_block};
use tree::{Leaf, Tree};

/// A distribution that is asked for many points at once. Points lie coordinate after coordinate: all numbers
/// of the first, then all of the second.
pub trait Blocks {
    /// What may go wrong.
    type Error;

    /// The number of coordinates of a point.
    fn dim(&self) -> usize;

    /// How many uniforms in [0, 1) a sample consumes.
    fn uniforms(&self) -> usize;

    /// A box that holds the support, infinite where it has no end: there too it is looked at what the density
    /// claims. Directions and indices need none.
    fn support(&self) -> Vec<[f64; 2]>;

    /// Draws `pdf.len()` points; a `pdf` of 0 means that nothing was drawn.
    ///
    /// # Errors
    /// Whatever keeps it from doing so.
    fn sample(&mut self, u: &[f64], x: &mut [f64], pdf: &mut [f64]) -> Result<(), Self::Error>;

    /// The density at `pdf.len()` points.
    ///
    /// # Errors
    /// Whatever keeps it from being known.
    fn pdf(&mut self, x: &[f64], pdf: &mut [f64]) -> Result<(), Self::Error>;
}

/// Samples that decide on the cells.
const PILOTS: usize = 1 << 13;
/// Points in each leaf of a cell by which the density is integrated.
const REFERENCES: usize = 1 << 5;
/// A leaf may be halved this often …
const MAX_HALVINGS: usize = 24;
/// … while the density was not asked for more points than these …
const MAX_EVALUATIONS: usize = 1 << 20;
/// … nor more coordinates: of many axes halving one settles little.
const MAX_COORDINATES: usize = 1 << 24;

/// Tests a distribution over real coordinates. `settings.bins` multiply to the number of cells.
///
/// # Errors
/// Those of the distribution.
pub fn real<B: Blocks>(of: &mut B, settings: Chi2Settings) -> Result<TestReport, B::Error> {
    run(of, Domain::Real, settings)
}

/// Tests a distribution over directions, unit vectors of three coordinates.
///
/// # Errors
/// Those of the distribution.
pub fn directions<B: Blocks>(of: &mut B, settings: Chi2Settings) -> Result<TestReport, B::Error> {
    run(of, Domain::Sphere, settings)
}

/// Tests a distribution over the indices 0 to `len` − 1, each of which is a cell.
///
/// # Errors
/// Those of the distribution.
pub fn indices<B: Blocks>(of: &mut B, len: usize, settings: Chi2Settings) -> Result<TestReport, B::Error> {
    let n = settings.samples as usize;
    let points: Vec<f64> = (0..len).map(|i| i as f64).collect();
    let mut pmf = vec![0.0; len];
    of.pdf(&points, &mut pmf)?;
    let mut cells: Vec<Cell> = pmf.iter().map(|p| Cell { expected: n as f64 * p, observed: 0 }).collect();
    let mut tally = Tally::default();
    let (mut none, mut outside) = (0, 0);
    each_block(of, settings.seed, n, &mut tally, |x, pdf| {
        for (&x, &pdf) in x.iter().zip(pdf) {
            match cells.get_mut(x as usize) {
                _ if pdf == 0.0 => none += 1,
                Some(cell) if (x as usize) as f64 == x => cell.observed += 1,
                _ => outside += 1,
            }
        }
    })?;
    if let Some(report) = tally.verdict() {
        return Ok(report);
    }
    if outside > 0 {
        return Ok(TestReport::impossible(format!("{outside} of {n} samples are no index below {len}")));
    }
    let missing = n as f64 - cells.iter().map(|cell| cell.expected).sum::<f64>();
    if missing < -1e-6 * n as f64 {
        return Ok(TestReport::impossible(format!("the probabilities sum to {}", 1.0 - missing / n as f64)));
    }
    let rounding = 1e-6 * n as f64;
    let expected = (none as f64).clamp((missing - rounding).max(0.0), missing.max(0.0) + rounding);
    cells.push(Cell { expected, observed: none });
    Ok(pearson(&cells, |i| if i < len { format!("index {i}") } else { "nothing".into() }))
}

/// A cell, and the error of what is expected in it.
#[derive(Clone, Copy)]
struct Uncertain {
    expected: f64,
    variance: f64,
    observed: u64,
}

fn run<B: Blocks>(of: &mut B, domain: Domain, settings: Chi2Settings) -> Result<TestReport, B::Error> {
    let mut tally = Tally::default();
    let mut pilots: Vec<Vec<f64>> = Vec::new();
    let dim = of.dim();
    let first = Axes::samples(dim, PILOTS);
    each_block(of, settings.seed ^ 0x5eed, first, &mut tally, |x, pdf| {
        let len = pdf.len();
        for i in (0..len).filter(|&i| pdf[i] != 0.0) {
            pilots.push(domain.coordinates(&(0..dim).map(|j| x[j * len + i]).collect::<Vec<_>>()));
        }
    })?;
    if let Some(report) = tally.verdict() {
        return Ok(report);
    }
    if pilots.is_empty() {
        return Ok(TestReport::impossible(format!("all of {first} samples are nothing")));
    }
    let Some(axes) = Axes::of(&pilots, &domain.sides(&of.support())) else {
        let remark = "the samples have too few values: no evidence".into();
        return Ok(TestReport { statistic: f64::NAN, dof: 0.0, p_value: f64::NAN, remark });
    };
    // More samples are for the axes alone.
    pilots.truncate(pilots.len() * PILOTS / first);
    let mapped: Vec<Vec<f64>> = pilots.iter().filter_map(|at| axes.to_unit(at)).collect();
    let wanted = settings.bins.0.max(1) * settings.bins.1.max(1);
    let tree = Tree::new(mapped, wanted.min(PILOTS / 32));

    let n = settings.samples as usize;
    let mut cells = expected(of, domain, &axes, &tree, settings.seed, n as f64)?;
    let mut outside = 0;
    each_block(of, settings.seed, n, &mut tally, |x, pdf| {
        let len = pdf.len();
        for i in 0..len {
            let point: Vec<f64> = (0..dim).map(|j| x[j * len + i]).collect();
            let inside = if pdf[i] == 0.0 { None } else { axes.to_unit(&domain.coordinates(&point)) };
            match inside {
                Some(at) => cells[tree.find(&at)].observed += 1,
                None => outside += 1,
            }
        }
    })?;
    if let Some(report) = tally.verdict() {
        return Ok(report);
    }
    Ok(judge(&cells, outside, n as f64, |i| domain.describe(&axes, &tree.sides(i))))
}

/// What is expected in each cell of `n` samples, by points that are uniform in its leaves.
///
/// A leaf is halved while its integral is uncertain by more than a few samples, or much less than the first
/// samples in it let expect: a peak may lie between the points. What is uncertain all the same is in the
/// variance.
fn expected<B: Blocks>(
    of: &mut B,
    domain: Domain,
    axes: &Axes,
    tree: &Tree,
    seed: u64,
    n: f64,
) -> Result<Vec<Uncertain>, B::Error> {
    let mut random = Random::new(seed ^ 0x0dd_ba11);
    let mut unsettled = tree.leaves().to_vec();
    let (mut settled, mut evaluations) = (Vec::new(), 0);
    for _ in 0..MAX_HALVINGS {
        evaluations += unsettled.len() * REFERENCES;
        if unsettled.is_empty() || evaluations > MAX_EVALUATIONS.min(MAX_COORDINATES / of.dim()) {
            break;
        }
        let integrals = integrate(of, domain, axes, &unsettled, &mut random)?;
        for (leaf, (mean, variance)) in std::mem::take(&mut unsettled).into_iter().zip(integrals) {
            let (expected, error) = (n * mean, n * variance.sqrt());
            let held = n * leaf.points.len() as f64 / PILOTS as f64;
            if error > (0.1 * expected).max(2.0) || expected < 0.25 * held {
                unsettled.extend(leaf.halves());
            } else {
                settled.push(leaf);
            }
        }
    }
    settled.append(&mut unsettled);
    // Fresh points: those before decided where to stop, so that too small an integral was kept more often.
    let mut cells = vec![Uncertain { expected: 0.0, variance: 0.0, observed: 0 }; tree.cells()];
    for (leaf, (mean, variance)) in settled.iter().zip(integrate(of, domain, axes, &settled, &mut random)?) {
        cells[leaf.cell].expected += n * mean;
        cells[leaf.cell].variance += n * n * variance;
    }
    // Of a density that hangs together in many dimensions few points of many count, and cells that have none of them have
    // too small a mean and too small a variance. What all cells say together is the better measure.
    let variance: f64 = cells.iter().map(|cell| cell.variance).sum();
    let squares: f64 = cells.iter().map(|cell| cell.expected.powi(2)).sum();
    let typical = if squares > 0.0 && variance.is_finite() { variance / squares } else { 0.0 };
    let size = n / cells.len() as f64;
    cells.iter_mut().for_each(|cell| cell.variance = cell.variance.max(typical * size * size));
    Ok(cells)
}

/// The integral of the density over each leaf, and its variance.
fn integrate<B: Blocks>(
    of: &mut B,
    domain: Domain,
    axes: &Axes,
    leaves: &[Leaf],
    random: &mut Random,
) -> Result<Vec<(f64, f64)>, B::Error> {
    let (dim, count) = (of.dim(), REFERENCES as f64);
    let mut integrals = Vec::with_capacity(leaves.len());
    for leaves in leaves.chunks(BLOCK / REFERENCES) {
        let len = leaves.len() * REFERENCES;
        let (mut x, mut pdf, mut stretch) = (vec![0.0; dim * len], vec![0.0; len], vec![0.0; len]);
        for i in 0..len {
            let sides = &leaves[i / REFERENCES].sides;
            let at: Vec<f64> = sides.iter().map(|[low, high]| low + random.next() * (high - low)).collect();
            let (coordinates, jacobian) = axes.at_unit(&at);
            stretch[i] =
                jacobian * domain.measure() * sides.iter().map(|[low, high]| high - low).product::<f64>();
            for (j, c) in domain.point(&coordinates).into_iter().enumerate() {
                x[j * len + i] = c;
            }
        }
        of.pdf(&x, &mut pdf)?;
        for (pdf, stretch) in pdf.chunks_exact(REFERENCES).zip(stretch.chunks_exact(REFERENCES)) {
            let shares = || pdf.iter().zip(stretch).map(|(p, s)| if *p == 0.0 { 0.0 } else { p * s });
            let mean = shares().sum::<f64>() / count;
            let square = shares().map(|share| (share - mean) * (share - mean)).sum::<f64>() / (count - 1.0);
            integrals.push((mean, square / count));
        }
    }
    Ok(integrals)
}

/// Pearson's statistic, in which what is expected is uncertain too.
fn judge(cells: &[Uncertain], outside: u64, n: f64, describe: impl Fn(usize) -> String) -> TestReport {
    if let Some(i) = cells.iter().position(|c| !(c.expected >= 0.0 && c.expected.is_finite())) {
        return TestReport::impossible(format!("{} expects {} samples", describe(i), cells[i].expected));
    }
    let term = |c: &Uncertain| {
        let difference = c.observed as f64 - c.expected;
        difference * difference / (c.expected.max(1.0) + c.variance)
    };
    let total: f64 = cells.iter().map(|c| c.expected).sum();
    let variance: f64 = cells.iter().map(|c| c.variance).sum();
    let rest = Uncertain { expected: n - total, variance, observed: outside };
    // The rest may be less than nothing, by as much as the total is uncertain.
    let rest_term = {
        let difference = outside as f64 - rest.expected;
        difference * difference / (rest.expected.max(0.0) + 1.0 + rest.variance)
    };
    let statistic = cells.iter().map(term).sum::<f64>() + rest_term;
    let dof = cells.len() as f64;
    let worst = (0..cells.len()).max_by(|&i, &j| term(&cells[i]).total_cmp(&term(&cells[j])));
    let integral = format!("the density integrates to {:.5} ± {:.5}", total / n, variance.sqrt() / n);
    let remark = match worst {
        Some(i) if term(&cells[i]) > rest_term => {
            let Uncertain { expected, observed, .. } = cells[i];
            format!("worst at {}: {observed} samples for {expected:.1} expected; {integral}", describe(i))
        }
        _ => format!("{outside} samples outside of the cells; {integral} in them"),
    };
    TestReport { statistic, dof, p_value: chi2_above(statistic, dof), remark }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// u², of each coordinate, said to have the density that `pdf` gives.
    struct Squares<S, P> {
        dim: usize,
        /// What the samples say.
        said: S,
        pdf: P,
    }

    fn product(f: impl Fn(f64) -> f64, x: &[f64], pdf: &mut [f64]) {
        let n = pdf.len();
        for i in 0..n {
            pdf[i] = x[i..].iter().step_by(n).map(|&x| f(x)).product();
        }
    }

    impl<S: Fn(f64) -> f64, P: Fn(f64) -> f64> Blocks for Squares<S, P> {
        type Error = std::convert::Infallible;

        fn dim(&self) -> usize {
            self.dim
        }

        fn uniforms(&self) -> usize {
            self.dim
        }

        fn support(&self) -> Vec<[f64; 2]> {
            vec![[0.0, 1.2]; self.dim]
        }

        fn sample(&mut self, u: &[f64], x: &mut [f64], pdf: &mut [f64]) -> Result<(), Self::Error> {
            for (x, u) in x.iter_mut().zip(u) {
                *x = u * u;
            }
            product(&self.said, x, pdf);
            Ok(())
        }

        fn pdf(&mut self, x: &[f64], pdf: &mut [f64]) -> Result<(), Self::Error> {
            product(&self.pdf, x, pdf);
            Ok(())
        }
    }

    fn test(dim: usize, said: impl Fn(f64) -> f64, pdf: impl Fn(f64) -> f64) -> TestReport {
        let settings = Chi2Settings { samples: 1 << 17, bins: (16, 16), seed: 3 };
        match real(&mut Squares { dim, said, pdf }, settings) {
            Ok(report) => report,
            Err(never) => match never {},
        }
    }

    /// `scale` / 2√x up to an end.
    fn root(scale: f64, end: f64) -> impl Fn(f64) -> f64 {
        move |x| if x > 0.0 && x < end { scale * 0.5 / x.sqrt() } else { 0.0 }
    }

    #[test]
    fn what_is_right_passes_in_any_number_of_dimensions() {
        for dim in [1, 2, 3, 6] {
            let report = test(dim, root(1.0, 1.0), root(1.0, 1.0));
            assert!(report.passes(1e-3), "{dim}: {report}");
            let nothing_above = test(dim, root(1.0, 0.9), root(1.0, 0.9));
            assert!(nothing_above.passes(1e-3), "{dim}: {nothing_above}");
        }
    }

    #[test]
    fn what_is_wrong_does_not() {
        for dim in [1, 2, 3, 6] {
            let flat = |x: f64| if x > 0.0 && x < 1.0 { 1.0 } else { 0.0 };
            for (name, report) in [
                ("scaled", test(dim, root(1.02, 1.0), root(1.02, 1.0))),
                ("without the Jacobian", test(dim, flat, flat)),
                ("a hole in the density", test(dim, root(1.0, 1.0), root(1.0, 0.98))),
                ("a hole in the samples", test(dim, root(1.0, 1.1), root(1.0, 1.1))),
                ("contradicted by the samples", test(dim, root(1.001, 1.0), root(1.0, 1.0))),
                ("not a number", test(dim, |_| f64::NAN, |_| f64::NAN)),
                ("nothing", test(dim, |_| 0.0, root(1.0, 1.0))),
            ] {
                assert!(!report.passes(1e-9), "{name}, {dim}: {report}");
            }
        }
    }

    /// Exponential with rate 1 in each coordinate, said to have another rate in the first.
    struct Exponentials {
        dim: usize,
        rate: f64,
    }

    impl Blocks for Exponentials {
        type Error = std::convert::Infallible;

        fn dim(&self) -> usize {
            self.dim
        }

        fn uniforms(&self) -> usize {
            self.dim
        }

        fn support(&self) -> Vec<[f64; 2]> {
            vec![[0.0, f64::INFINITY]; self.dim]
        }

        fn sample(&mut self, u: &[f64], x: &mut [f64], pdf: &mut [f64]) -> Result<(), Self::Error> {
            x.iter_mut().zip(u).for_each(|(x, u)| *x = -(-u).ln_1p());
            self.pdf(x, pdf)
        }

        fn pdf(&mut self, x: &[f64], pdf: &mut [f64]) -> Result<(), Self::Error> {
            let n = pdf.len();
            for i in 0..n {
                let sum: f64 = x[i..].iter().step_by(n).sum();
                pdf[i] = if x[i..].iter().step_by(n).all(|x| *x >= 0.0) {
                    self.rate * (-sum - (self.rate - 1.0) * x[i]).exp()
                } else {
                    0.0
                };
            }
            Ok(())
        }
    }

    /// Pieces beyond the samples once took all reference points of many axes, and false alarms were certain.
    #[test]
    fn many_dimensions_raise_no_alarm() {
        let run = |dim: usize, rate: f64, seed: u64| {
            let settings = Chi2Settings { samples: 1 << 14, bins: (16, 16), seed };
            match real(&mut Exponentials { dim, rate }, settings) {
                Ok(report) => report,
                Err(never) => match never {},
            }
        };
        let right = run(80, 1.0, 0);
        assert!(right.passes(1e-3), "{right}");
        let wrong = run(80, 1.3, 0);
        assert!(!wrong.passes(1e-4), "{wrong}");
    }
}
