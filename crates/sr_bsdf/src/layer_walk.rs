//! Light that walks between a rough coat and a white metal below it: where it leaves, and after how many bounces.
//!
//! In: two distributions of facets and an index. Out: fractions. Interfaces scatter by one bounce between facets each, so that
//! some light is lost at each of them, as in pbrt-v4's layered materials (Guo, Hašan & Zhao 2018, "Position-Free Monte Carlo
//! Simulation for Arbitrary Layered BSDFs"); here both of an interface's ways are followed, so that little noise is left.

use glam::Vec3;
use sr_sampling::{Cursor, OwenSobol, SampleId};

use crate::Microfacet;
use crate::interface::{dielectric, reflect_about, refract_about};

/// Bounces off the metal that are told apart; what is left after the last one is a few thousandths at most.
pub const BOUNCES: usize = 16;
/// Walks from one direction.
const WALKS: u32 = 1 << 11;

/// Of light from outside at cos θ = `cos`, the fraction that leaves after one, two, … bounces off the metal.
///
/// - `coat`: `None` is smooth
/// - `eta`: index of the coat over that of its surroundings, at least 1
pub(crate) fn leaves_after(
    coat: Option<&Microfacet>,
    eta: f32,
    base: &Microfacet,
    cos: f32,
) -> [f32; BOUNCES] {
    let sequence = OwenSobol::new(0x1a7e);
    let mut sums = [0.0_f64; BOUNCES];
    for i in 0..WALKS {
        let mut walk =
            Walk { cursor: Cursor::new(&sequence, SampleId { pixel: 0, index: i }), coat, base, eta };
        walk.follow(Vec3::new((1.0 - cos * cos).max(0.0).sqrt(), 0.0, cos), &mut sums);
    }
    sums.map(|sum| (sum / f64::from(WALKS)) as f32)
}

struct Walk<'a> {
    cursor: Cursor<'a, OwenSobol>,
    coat: Option<&'a Microfacet>,
    base: &'a Microfacet,
    eta: f32,
}

impl Walk<'_> {
    fn follow(&mut self, wo: Vec3, leaves: &mut [f64; BOUNCES]) {
        let [_, (mut weight, mut down)] = self.meet_coat(wo, self.eta);
        for bounce in leaves {
            if weight <= 0.0 {
                return;
            }
            let above = -down;
            let up = reflect_about(above, self.base.sample_visible(above, self.cursor.next_2d()));
            if up.z <= 0.0 {
                return;
            }
            weight *= self.base.g2_over_g1(above, up);
            // The coat from below, in a frame that is turned upside down: the way back of `up` is above it.
            let [(stays, back), (passes, _)] = self.meet_coat(Vec3::new(-up.x, -up.y, up.z), 1.0 / self.eta);
            *bounce += f64::from(weight * passes);
            weight *= stays;
            down = Vec3::new(back.x, back.y, -back.z);
        }
    }

    /// Fractions that the coat reflects and lets through in one bounce, and where to; `w` is on the side of +Z.
    fn meet_coat(&mut self, w: Vec3, eta: f32) -> [(f32, Vec3); 2] {
        let m = match self.coat {
            Some(coat) => coat.sample_visible(w, self.cursor.next_2d()),
            None => Vec3::Z,
        };
        let split = dielectric(w.dot(m), eta);
        let seen = |wi: Vec3, is_there: bool| match self.coat {
            _ if !is_there => 0.0,
            Some(coat) => coat.g2_over_g1(w, wi),
            None => 1.0,
        };
        let (mirrored, refracted) = (reflect_about(w, m), refract_about(w, m, split));
        [
            (split.reflectance * seen(mirrored, mirrored.z > 0.0), mirrored),
            (split.transmittance * seen(refracted, refracted.z < 0.0), refracted),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::MicrofacetKind;

    /// Of five bounces and less; α 0.1414 over 0.0447, η = 1.5, by 200,000 walks of another program that chose one
    /// way at each interface.
    #[test]
    fn walks_lose_what_facets_lose() {
        let kind = MicrofacetKind::GgxCorrelated;
        let [coat, base] = [0.1414, 0.0447].map(|alpha| Microfacet::isotropic(kind, alpha));
        for (cos, leaves) in [(1.0, 0.9165), (0.8, 0.8656), (0.6, 0.7625), (0.4, 0.6196), (0.2, 0.4509)] {
            let sum: f32 = leaves_after(Some(&coat), 1.5, &base, cos)[..5].iter().sum();
            assert!((sum - leaves).abs() < 4e-3, "{cos}: {sum}, not {leaves}");
        }
    }

    /// A smooth coat over a smooth metal loses nothing, and the bounces are a geometric series.
    #[test]
    fn smooth_layers_lose_nothing() {
        let base = Microfacet::isotropic(MicrofacetKind::Ggx, 1e-4);
        for cos in [1.0, 0.5, 0.2_f32] {
            let reflected = dielectric(cos, 1.5).reflectance;
            let leaves = leaves_after(None, 1.5, &base, cos);
            for (bounce, leaves) in leaves.into_iter().enumerate().take(4) {
                let expected = (1.0 - reflected).powi(2) * reflected.powi(bounce as i32);
                assert!((leaves - expected).abs() < 1e-3, "{cos}, {bounce}: {leaves}, not {expected}");
            }
        }
    }
}
