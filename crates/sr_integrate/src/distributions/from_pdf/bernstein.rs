//! Polynomials of degree five that are nowhere negative: in Bernstein's form, with coefficients that are not.

use crate::distributions::affine::invert_matrix;

/// The number of coefficients.
pub const LEN: usize = 6;

/// Coefficients c of Σⱼ cⱼ (5 over j) tʲ (1 − t)⁵⁻ʲ on [0, 1].
pub type Coefficients = [f64; LEN];

/// Nodes of Gauss and Legendre's rule of six points on [0, 1]: never an end or the middle, where poles tend
/// to be.
pub const NODES: [f64; LEN] = [
    0.033_765_242_898_423_99,
    0.169_395_306_766_867_74,
    0.380_690_406_958_401_54,
    0.619_309_593_041_598_5,
    0.830_604_693_233_132_3,
    0.966_234_757_101_576,
];

/// Its weights.
pub const WEIGHTS: [f64; LEN] = [
    0.085_662_246_189_585_18,
    0.180_380_786_524_069_3,
    0.233_956_967_286_345_52,
    0.233_956_967_286_345_52,
    0.180_380_786_524_069_3,
    0.085_662_246_189_585_18,
];

const CHOOSE_5: [f64; LEN] = [1.0, 5.0, 10.0, 10.0, 5.0, 1.0];
const CHOOSE_6: [f64; LEN + 1] = [1.0, 6.0, 15.0, 20.0, 15.0, 6.0, 1.0];

/// Σⱼ cⱼ (n over j) tʲ (1 − t)ⁿ⁻ʲ: sums of positive terms only, if the coefficients are positive.
#[inline]
fn evaluate<const N: usize>(c: &[f64; N], choose: &[f64; N], t: f64) -> f64 {
    let s = 1.0 - t;
    let (mut sum, mut power) = (c[0], 1.0);
    for j in 1..N {
        power *= t;
        sum = sum * s + c[j] * choose[j] * power;
    }
    sum
}

/// The polynomial at `t`.
#[inline]
pub fn value(c: &Coefficients, t: f64) -> f64 {
    evaluate(c, &CHOOSE_5, t)
}

/// Its integral from 0 to `t`; that to 1 is the mean of the coefficients.
#[inline]
pub fn integral(c: &Coefficients, t: f64) -> f64 {
    let mut sums = [0.0; LEN + 1];
    for j in 0..LEN {
        sums[j + 1] = sums[j] + c[j] * (1.0 / LEN as f64);
    }
    evaluate(&sums, &CHOOSE_6, t)
}

/// ∫ t p(t) dt over [0, 1].
pub fn first_moment(c: &Coefficients) -> f64 {
    c.iter().zip(1..).map(|(c, j)| c * f64::from(j)).sum::<f64>() / 42.0
}

/// From values at the [`NODES`] to the polynomial through them, made non-negative.
pub struct Fit {
    /// Row after row.
    coefficients_from_values: Vec<f64>,
}

impl Fit {
    pub fn new() -> Self {
        let mut values = vec![0.0; LEN * LEN];
        for (i, &t) in NODES.iter().enumerate() {
            for j in 0..LEN {
                let mut unit = [0.0; LEN];
                unit[j] = 1.0;
                values[i * LEN + j] = value(&unit, t);
            }
        }
        let (inverse, _) = invert_matrix(&values, LEN).expect("six nodes make a polynomial");
        Self { coefficients_from_values: inverse }
    }

    /// The polynomial through six values. Where it has a negative coefficient it is drawn towards its mean,
    /// just as far as it takes: the integral stays (Zhang & Shu 2010).
    pub fn fit(&self, values: &[f64; LEN]) -> Coefficients {
        let mut c: Coefficients = std::array::from_fn(|j| {
            let row = &self.coefficients_from_values[j * LEN..(j + 1) * LEN];
            row.iter().zip(values).map(|(a, y)| a * y).sum()
        });
        let mean = values.iter().zip(WEIGHTS).map(|(y, w)| w * y).sum::<f64>();
        let least = c.iter().copied().fold(f64::INFINITY, f64::min);
        if least < 0.0 {
            let share = mean / (mean - least);
            c = c.map(|c| (mean + share * (c - mean)).max(0.0));
        }
        c
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_degree_five_are_themselves() {
        let f = |t: f64| 3.0 - t + 2.0 * t.powi(3) + t.powi(5);
        let c = Fit::new().fit(&NODES.map(f));
        for t in [0.0, 0.2, 0.7, 1.0] {
            assert!((value(&c, t) - f(t)).abs() < 1e-13);
            let exact = 3.0 * t - t * t / 2.0 + t.powi(4) / 2.0 + t.powi(6) / 6.0;
            assert!((integral(&c, t) - exact).abs() < 1e-13, "{t}");
        }
        assert!((first_moment(&c) - (1.5 - 1.0 / 3.0 + 0.4 + 1.0 / 7.0)).abs() < 1e-13);
    }

    #[test]
    fn never_negative_and_of_the_same_integral() {
        let fit = Fit::new();
        for f in
            [|t: f64| f64::from(u8::from(t > 0.5)), |t: f64| (t - 0.4).max(0.0), |t: f64| (t - 0.6).powi(2)]
        {
            let values = NODES.map(f);
            let c = fit.fit(&values);
            let mean = values.iter().zip(WEIGHTS).map(|(y, w)| w * y).sum::<f64>();
            assert!((integral(&c, 1.0) - mean).abs() < 1e-14);
            assert!((0..=100).all(|i| value(&c, f64::from(i) / 100.0) >= 0.0));
        }
    }
}
