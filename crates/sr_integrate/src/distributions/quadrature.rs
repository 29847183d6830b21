//! Integrals of one variable, for means that have no formula.

/// Nodes and weights of Gauss and Legendre's rule of eight points on [0, 1].
pub(crate) const GAUSS: [(f64, f64); 8] = [
    (0.019_855_071_751_231_856, 0.050_614_268_145_188_13),
    (0.101_666_761_293_186_64, 0.111_190_517_226_687_24),
    (0.237_233_795_041_835_5, 0.156_853_322_938_943_64),
    (0.408_282_678_752_175_1, 0.181_341_891_689_181),
    (0.591_717_321_247_825, 0.181_341_891_689_181),
    (0.762_766_204_958_164_5, 0.156_853_322_938_943_64),
    (0.898_333_238_706_813_4, 0.111_190_517_226_687_24),
    (0.980_144_928_248_768_1, 0.050_614_268_145_188_13),
];

/// The rule over [low, high].
pub(crate) fn gauss(f: impl Fn(f64) -> f64, low: f64, high: f64) -> f64 {
    let width = high - low;
    GAUSS.iter().map(|&(node, weight)| weight * f(low + node * width)).sum::<f64>() * width
}

/// ∫ f over [low, high], halving where halving matters; `None` if that does not settle it to `tolerance`.
pub(crate) fn integrate(f: impl Fn(f64) -> f64, low: f64, high: f64, tolerance: f64) -> Option<f64> {
    let mut parts = vec![(low, high, gauss(&f, low, high))];
    let mut sum = 0.0;
    let mut left = 20_000;
    while let Some((low, high, whole)) = parts.pop() {
        let middle = 0.5 * (low + high);
        let (below, above) = (gauss(&f, low, middle), gauss(&f, middle, high));
        let halves = below + above;
        if (halves - whole).abs() <= tolerance * (high - low).max(1e-3) || middle <= low || middle >= high {
            sum += halves;
        } else {
            left -= 1;
            if left == 0 || !halves.is_finite() {
                return None;
            }
            parts.extend([(low, middle, below), (middle, high, above)]);
        }
    }
    Some(sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn smooth_steep_and_jumping() {
        assert!((gauss(|x| x.powi(15), 0.0, 2.0) - 4096.0).abs() < 1e-9);
        assert!((integrate(|x| x.sqrt(), 0.0, 1.0, 1e-12).unwrap() - 2.0 / 3.0).abs() < 1e-11);
        let jump = |x: f64| if x < 0.3 { 0.0 } else { 1.0 };
        assert!((integrate(jump, 0.0, 1.0, 1e-12).unwrap() - 0.7).abs() < 1e-11);
        assert_eq!(integrate(|_| f64::NAN, 0.0, 1.0, 1e-12), None);
    }
}
