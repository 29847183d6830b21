//! One coordinate of a map: a smooth, monotone function from [0, 1] onto an interval.
//!
//! Knots cut the interval into bins of equal probability, as the grids of vegas do (G. P. Lepage, "A new algorithm for
//! adaptive multidimensional integration", J. Comput. Phys. 27, 1978). Between them runs a rational quadratic spline
//! (J. Gregory & R. Delbourgo, IMA J. Numer. Anal. 2, 1982; as a density: C. Durkan et al., "Neural spline flows",
//! 2019): the density is continuous, low-discrepancy points keep their advantage, and the inverse is a closed form.

/// A bin of a spline, in the form in which it is evaluated.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Bin {
    /// Where it begins, and how wide it is.
    start: f64,
    width: f64,
    /// Slopes of the map at both ends, over its mean slope.
    at_start: f64,
    at_end: f64,
}

/// A map of [0, 1] onto an interval, and with it a density there: that of the map's image of a uniform number.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    knots: Vec<f64>,
    bins: Vec<Bin>,
}

impl Axis {
    /// The most bins.
    pub const MAX_BINS: usize = 256;

    /// The constant density on an interval.
    pub fn uniform([low, high]: [f64; 2]) -> Self {
        Self::new(vec![low, high])
    }

    /// A density of which each bin between two knots has the same share.
    ///
    /// # Panics
    /// If the bins are not a power of two in number.
    pub fn new(mut knots: Vec<f64>) -> Self {
        let n = knots.len() - 1;
        assert!(n.is_power_of_two(), "{n} bins");
        separate(&mut knots);
        let density = |i: usize| 1.0 / (knots[i + 1] - knots[i]);
        // At a knot the density is the mean of its neighbours'; at the ends it goes on as it did, within bounds.
        let at = |i: usize| match i {
            _ if n == 1 => density(0),
            0 => beyond(density(0), density(1)),
            i if i == n => beyond(density(n - 1), density(n - 2)),
            i => 0.5 * (density(i - 1) + density(i)),
        };
        let bins = (0..n).map(|i| Bin {
            start: knots[i],
            width: knots[i + 1] - knots[i],
            at_start: density(i) / at(i),
            at_end: density(i) / at(i + 1),
        });
        Self { bins: bins.collect(), knots }
    }

    /// About a normal density, with exponential tails, cut to an interval, of which `floor` is spread evenly.
    pub fn bell(mean: f64, sd: f64, [low, high]: [f64; 2], bins: usize, floor: f64) -> Self {
        // The logistic density of that standard deviation, or a little more.
        let (mean, scale) = (mean.clamp(low, high), 0.6 * sd);
        let logistic = |x: f64| 1.0 / (1.0 + (-(x - mean) / scale).exp());
        let (at_low, at_high) = (logistic(low), logistic(high));
        let knot = |i: usize| {
            let u = at_low + (at_high - at_low) * (i as f64 / bins as f64);
            (mean + scale * (u / (1.0 - u)).ln()).clamp(low, high)
        };
        let mut knots: Vec<f64> = (0..=bins).map(knot).collect();
        (knots[0], knots[bins]) = (low, high);
        Self::new(knots).refined(&vec![1.0; bins], bins, floor)
    }

    /// Where the bins meet, from end to end.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// The interval.
    pub fn range(&self) -> [f64; 2] {
        [self.knots[0], self.knots[self.bins.len()]]
    }

    /// Maps numbers in [0, 1), and multiplies `stretch` by the slope of the map.
    pub fn map(&self, u: &[f64], x: &mut [f64], stretch: &mut [f64]) {
        let n = self.bins.len();
        let count = n as f64;
        for ((&u, x), stretch) in u.iter().zip(x).zip(stretch) {
            let place = u * count;
            let i = (place as usize).min(n - 1);
            let t = place - i as f64;
            let Bin { start, width, at_start, at_end } = self.bins[i];
            let (s, between) = (1.0 - t, t * (1.0 - t));
            let rest = 1.0 / (1.0 + (at_start + at_end - 2.0) * between);
            *x = start + width * (t * t + at_start * between) * rest;
            *stretch *= count * width * (at_end * t * t + 2.0 * between + at_start * s * s) * (rest * rest);
        }
    }

    /// [`Axis::map`] backwards: the numbers, and `stretch` times the slope there; a slope of infinity outside the
    /// interval, so that the density is 0.
    pub fn unmap(&self, x: &[f64], u: &mut [f64], stretch: &mut [f64]) {
        let n = self.bins.len();
        let [low, high] = self.range();
        for ((&x, u), stretch) in x.iter().zip(u).zip(stretch) {
            let i = self.bin(x);
            let Bin { start, width, at_start, at_end } = self.bins[i];
            let y = ((x - start) / width).clamp(0.0, 1.0);
            let bend = at_start + at_end - 2.0;
            let a = (1.0 - at_start) + y * bend;
            let b = at_start - y * bend;
            let root = (b * b + 4.0 * a * y).max(0.0).sqrt();
            let t = (2.0 * y / (b + root)).min(1.0);
            let (s, between) = (1.0 - t, t * (1.0 - t));
            let rest = 1.0 / (1.0 + bend * between);
            *u = (i as f64 + t) / n as f64;
            let slope =
                n as f64 * width * (at_end * t * t + 2.0 * between + at_start * s * s) * (rest * rest);
            *stretch *= if x >= low && x <= high { slope } else { f64::INFINITY };
        }
    }

    /// The bin of a number: halved without a branch, for which bin is never foreseen.
    #[inline(always)]
    fn bin(&self, x: f64) -> usize {
        let mut knots = &self.knots[..self.bins.len()];
        let mut i = 0;
        while knots.len() > 1 {
            let half = knots.len() / 2;
            let above = usize::from(x >= knots[half]);
            i += above * half;
            knots = &self.knots[i..i + half];
        }
        i
    }

    /// The map whose density is this one times a factor, constant in each of many equal steps of u, of which `floor`
    /// is spread evenly over the interval.
    pub fn refined(&self, factors: &[f64], bins: usize, floor: f64) -> Self {
        let steps = factors.len();
        let [low, high] = self.range();
        let edges: Vec<f64> = (0..=steps).map(|m| m as f64 / steps as f64).collect();
        let mut at = vec![0.0; steps + 1];
        self.map(&edges, &mut at, &mut vec![1.0; steps + 1]);
        let total: f64 = factors.iter().sum();
        if !(total > 0.0 && total.is_finite()) {
            return self.clone();
        }
        let mut cumulative = vec![0.0; steps + 1];
        for m in 0..steps {
            let even = (at[m + 1] - at[m]) / (high - low);
            cumulative[m + 1] = cumulative[m] + (1.0 - floor) * factors[m] / total + floor * even;
        }
        let whole = cumulative[steps];
        let mut places = vec![0.0; bins + 1];
        let mut m = 0;
        for (i, place) in places.iter_mut().enumerate().take(bins).skip(1) {
            let goal = whole * i as f64 / bins as f64;
            while m + 1 < steps && cumulative[m + 1] <= goal {
                m += 1;
            }
            let share = (goal - cumulative[m]) / (cumulative[m + 1] - cumulative[m]);
            *place = (m as f64 + share.clamp(0.0, 1.0)) / steps as f64;
        }
        let mut knots = vec![0.0; bins + 1];
        self.map(&places, &mut knots, &mut vec![1.0; bins + 1]);
        (knots[0], knots[bins]) = (low, high);
        Self::new(knots)
    }
}

/// A density at the end of an interval, from those of its last two bins. Where they rise steeply towards it, it may be
/// infinite there, and is made large: maps then reach into singularities like 1 / √x and beyond.
fn beyond(last: f64, before: f64) -> f64 {
    let ratio = last / before;
    let rise = match ratio {
        r if r > 2.0 => r.powi(8),
        r if r > 1.0 => r * r,
        r => r,
    };
    last * rise.clamp(0.1, 1e6)
}

/// Pushes knots apart that rounding has made equal.
fn separate(knots: &mut [f64]) {
    let n = knots.len() - 1;
    let high = knots[n];
    for i in 1..n {
        knots[i] = knots[i].max(knots[i - 1].next_up());
    }
    let mut most = high;
    for i in (1..n).rev() {
        most = most.next_down();
        knots[i] = knots[i].min(most);
        most = knots[i];
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn axes() -> Vec<Axis> {
        vec![
            Axis::uniform([0.0, 1.0]),
            Axis::uniform([-3.0, 2.5]),
            Axis::new(vec![0.0, 1e-12, 1e-6, 0.1, 1.0]),
            Axis::new(vec![0.0, 0.4, 0.4, 0.4, 1.0]),
            Axis::bell(0.3, 0.01, [0.0, 1.0], 64, 0.005),
            Axis::bell(-2.0, 0.1, [0.0, 1.0], 16, 0.0),
            Axis::bell(0.5, 0.2, [0.0, 1.0], 128, 0.0).refined(&[1.0, 0.0, 3.0, 0.5], 32, 0.01),
        ]
    }

    #[test]
    fn a_map_runs_backwards() {
        for axis in axes() {
            let u: Vec<f64> = (0..1000).map(|i| f64::from(i) / 1000.0).collect();
            let (mut x, mut forth) = (vec![0.0; 1000], vec![1.0; 1000]);
            axis.map(&u, &mut x, &mut forth);
            let (mut back, mut slope) = (vec![0.0; 1000], vec![1.0; 1000]);
            axis.unmap(&x, &mut back, &mut slope);
            let [low, high] = axis.range();
            for i in 0..1000 {
                assert!((low..=high).contains(&x[i]), "{axis:?}");
                // Where bins are narrow, x has few digits within them.
                let coarse = 4.0 * f64::EPSILON * x[i].abs().max(low.abs()) / forth[i].min(slope[i]);
                assert!((back[i] - u[i]).abs() < 1e-9 + coarse, "{} {} {axis:?}", back[i], u[i]);
                if coarse < 1e-9 {
                    assert!(
                        (slope[i] / forth[i] - 1.0).abs() < 1e-5,
                        "{} {} at {}",
                        slope[i],
                        forth[i],
                        x[i]
                    );
                }
            }
        }
    }

    #[test]
    fn slopes_are_derivatives() {
        let axis = Axis::bell(0.4, 0.05, [0.0, 1.0], 32, 0.01);
        let u: Vec<f64> = (0..200).map(|i| (f64::from(i) + 0.37) / 200.0).collect();
        let near: Vec<f64> = u.iter().map(|u| u + 1e-7).collect();
        let (mut x, mut slope) = (vec![0.0; 200], vec![1.0; 200]);
        axis.map(&u, &mut x, &mut slope);
        let mut y = vec![0.0; 200];
        axis.map(&near, &mut y, &mut [1.0; 200]);
        for i in 0..200 {
            assert!(((y[i] - x[i]) / 1e-7 / slope[i] - 1.0).abs() < 1e-3, "at {}", u[i]);
        }
    }

    #[test]
    fn factors_move_probability() {
        let axis = Axis::uniform([0.0, 1.0]).refined(&[3.0, 1.0], 64, 0.0);
        let mut x = [0.0];
        axis.map(&[0.75], &mut x, &mut [1.0]);
        assert!((x[0] - 0.5).abs() < 1e-3, "{x:?}");
        let same = axis.refined(&[0.0, 0.0], 64, 0.0);
        assert_eq!(same, axis);
    }

    #[test]
    fn outside_there_is_no_density() {
        let mut stretch = [1.0; 3];
        Axis::uniform([0.0, 1.0]).unmap(&[-0.1, 1.1, f64::NAN], &mut [0.0; 3], &mut stretch);
        assert_eq!(stretch, [f64::INFINITY; 3]);
    }
}
