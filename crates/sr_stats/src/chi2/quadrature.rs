//! Integrals over boxes of coordinates.

use super::chart::Coordinates;

/// Nodes and weights of the four-point Gauss-Legendre rule on [0, 1].
const NODES: [f64; 4] =
    [0.069_431_844_202_973_71, 0.330_009_478_207_571_9, 0.669_990_521_792_428_1, 0.930_568_155_797_026_3];
const WEIGHTS: [f64; 4] =
    [0.173_927_422_568_726_93, 0.326_072_577_431_273_07, 0.326_072_577_431_273_07, 0.173_927_422_568_726_93];

/// Where jumps are looked for: also just inside the rim, where the rule has no nodes.
const PROBES: [f64; 5] = [1e-4, 0.2, 0.5, 0.8, 1.0 - 1e-4];
/// A step between probes of more than this share of the largest value may be a jump.
const JUMP: f64 = 0.3;
/// What a jump of 1 in a box of area 1 may add to the error.
const JUMP_ERROR: f64 = 0.1;

/// An integral over a box, with what it takes to improve it.
#[derive(Clone, Copy, Debug)]
pub struct Integral {
    pub value: f64,
    pub error: f64,
    /// Along which to halve the box for the most gain.
    pub axis: usize,
}

/// A box of coordinates, and how often it was halved along each axis to get there.
#[derive(Clone, Copy, Debug)]
pub struct Patch {
    pub low: Coordinates,
    pub high: Coordinates,
    pub halvings: [u32; 2],
}

impl Patch {
    pub fn middle(&self, axis: usize) -> f64 {
        0.5 * (self.low[axis] + self.high[axis])
    }

    /// The two halves along an axis.
    pub fn halves(&self, axis: usize) -> [Self; 2] {
        let (mut below, mut above) = (*self, *self);
        below.high[axis] = self.middle(axis);
        above.low[axis] = self.middle(axis);
        below.halvings[axis] += 1;
        above.halvings[axis] += 1;
        [below, above]
    }

    /// The axis that was halved least.
    pub fn coarsest_axis(&self, axes: usize) -> usize {
        (0..axes).min_by_key(|&axis| self.halvings[axis]).unwrap_or(0)
    }

    /// ∫ f over the box by one application of the rule.
    fn integrate(&self, f: &impl Fn(Coordinates) -> f64) -> f64 {
        let [x, y] = [0, 1].map(|axis| NODES.map(|node| self.at(axis, node)));
        let row = |x: f64| y.iter().zip(WEIGHTS).map(|(&y, w)| w * f([x, y])).sum::<f64>();
        x.iter().zip(WEIGHTS).map(|(&x, w)| w * row(x)).sum::<f64>() * self.area()
    }

    fn at(&self, axis: usize, node: f64) -> f64 {
        self.low[axis] + node * (self.high[axis] - self.low[axis])
    }

    fn area(&self) -> f64 {
        (self.high[0] - self.low[0]) * (self.high[1] - self.low[1])
    }

    /// ∫ f over the box, its error, and the axis along which to halve the box for the most gain.
    ///
    /// The error is how much halving changes the value. Where f seems to jump, halving may change
    /// nothing although the jump lies anywhere between two nodes; so a share of the jump counts too.
    pub fn estimate(&self, f: &impl Fn(Coordinates) -> f64, axes: usize) -> Integral {
        let whole = self.integrate(f);
        let values = PROBES.map(|x| PROBES.map(|y| f([self.at(0, x), self.at(1, y)])));
        let steps = largest_steps(&values);
        let top = values.iter().flatten().fold(0.0, |a: f64, &b| a.max(b));
        let mut best = Integral { value: whole, error: -1.0, axis: 0 };
        for (axis, step) in steps.into_iter().enumerate().take(axes) {
            let value = self.halves(axis).iter().map(|half| half.integrate(f)).sum::<f64>();
            let jump = if step > JUMP * top { JUMP_ERROR * step * self.area() } else { 0.0 };
            let error = (value - whole).abs().max(jump);
            if error > best.error || error.is_nan() {
                best = Integral { value, error, axis };
            }
        }
        best
    }
}

/// The largest difference between neighbours, along each axis.
fn largest_steps(values: &[[f64; 5]; 5]) -> [f64; 2] {
    let along_0 = values.windows(2).flat_map(|pair| (0..5).map(|j| (pair[1][j] - pair[0][j]).abs()));
    let along_1 = values.iter().flat_map(|row| row.windows(2).map(|pair| (pair[1] - pair[0]).abs()));
    [along_0.fold(0.0, f64::max), along_1.fold(0.0, f64::max)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_degree_seven_are_exact() {
        let patch = Patch { low: [1.0, -1.0], high: [2.0, 3.0], halvings: [0; 2] };
        let value = patch.integrate(&|[x, y]| x.powi(7) * y.powi(6));
        let exact = (256.0 - 1.0) / 8.0 * (2187.0 + 1.0) / 7.0;
        assert!((value / exact - 1.0).abs() < 1e-13, "{value}, not {exact}");
    }

    #[test]
    fn the_error_of_a_jump_is_not_overlooked() {
        let patch = Patch { low: [0.0; 2], high: [1.0; 2], halvings: [0; 2] };
        for place in [0.001, 0.1, 0.4, 0.5, 0.8, 0.999] {
            let integral = patch.estimate(&|[x, _]| f64::from(u8::from(x < place)), 2);
            assert!((integral.value - place).abs() <= 2.0 * integral.error, "{place}: {integral:?}");
            assert_eq!(integral.axis, 0);
        }
        assert!(patch.estimate(&|[x, y]| 1.0 + 0.1 * x * y, 2).error < 1e-12);
    }

    #[test]
    fn halves_make_up_the_whole() {
        let patch = Patch { low: [0.0, 0.0], high: [1.0, 0.5], halvings: [0; 2] };
        let sum: f64 = patch.halves(1).iter().map(|half| half.integrate(&|[x, y]| x + y)).sum();
        assert!((sum - patch.integrate(&|[x, y]| x + y)).abs() < 1e-15);
        assert_eq!(patch.halves(0)[0].coarsest_axis(2), 1);
        assert_eq!(patch.halves(0)[0].coarsest_axis(1), 0);
    }
}
