//! Russian roulette: paths that carry little end early, the others carry their share.

use sr_scene::Rgb;

/// No path survives with a higher probability: an absorbing-free scene must end as well.
const MAX_SURVIVAL: f32 = 0.95;

/// Plays for a path of throughput `beta`. Returns what to multiply it by, or `None` if it ends.
///
/// `eta` is the index of refraction where the path is over that at the camera: radiance is squeezed by
/// 1 / η² on entering a medium and released on leaving it, so β η² is what will come home.
#[inline]
pub(super) fn survive(beta: Rgb, eta: f32, u: f32) -> Option<f32> {
    let survival = (beta.max_element() * eta * eta).min(MAX_SURVIVAL);
    (u < survival).then(|| 1.0 / survival)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keeps_the_expectation() {
        let beta = Rgb::new(0.1, 0.3, 0.2);
        let n = 10_000;
        let kept: f32 = (0..n).filter_map(|i| survive(beta, 1.0, (i as f32 + 0.5) / n as f32)).sum();
        assert!((kept / n as f32 - 1.0).abs() < 1e-3);
    }

    #[test]
    fn always_can_end() {
        assert_eq!(survive(Rgb::splat(7.0), 1.5, 0.96), None);
        assert_eq!(survive(Rgb::ZERO, 1.0, 0.0), None);
        assert_eq!(survive(Rgb::ZERO, f32::NAN, 0.99), None);
    }
}
