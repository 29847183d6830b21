//! What a flat interface does to a ray: which way it goes on, and how much of it.
//!
//! In: cosines and indices of refraction. Out: exact, unpolarised Fresnel coefficients and directions.

use glam::Vec3;

use crate::Rgb;

/// What becomes of light that meets the interface between two dielectrics.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DielectricSplit {
    /// The fraction reflected, in [0, 1]; 1 under total internal reflection.
    pub reflectance: f32,
    /// The fraction refracted, 1 − `reflectance`, to full relative precision where it is small.
    pub transmittance: f32,
    /// |cos θ| of the refracted direction; 0 under total internal reflection.
    pub cos_t: f32,
    /// Index of the far side over that of the near side.
    pub eta: f32,
}

/// Splits light between reflection and refraction (Fresnel's equations, unpolarised).
///
/// - `cos_i`: cosine between the normal and the direction towards the near side; negative: from inside
/// - `eta`: interior over exterior index, positive
#[inline(always)]
pub fn dielectric(cos_i: f32, eta: f32) -> DielectricSplit {
    let eta = if cos_i >= 0.0 { eta } else { 1.0 / eta };
    let c = cos_i.abs();
    if eta == 1.0 {
        return DielectricSplit { reflectance: 0.0, transmittance: 1.0, cos_t: c, eta };
    }
    let cos_t_squared = 1.0 - (1.0 - c * c) * (1.0 / (eta * eta));
    if cos_t_squared <= 0.0 {
        return DielectricSplit { reflectance: 1.0, transmittance: 0.0, cos_t: 0.0, eta };
    }
    let cos_t = cos_t_squared.sqrt();
    let transmittance = transmittance(c, cos_t, eta);
    DielectricSplit { reflectance: 1.0 - transmittance, transmittance, cos_t, eta }
}

/// The fraction of unpolarised light that passes between two directions that refraction joins, the same in either direction.
///
/// - `c`, `cos_t`: cosines between the normal and the directions, not negative, not both 0
/// - `eta`: index of the far side (of `cos_t`) over that of the near side
#[inline(always)]
pub(crate) fn transmittance(c: f32, cos_t: f32, eta: f32) -> f32 {
    // Of the squared field, light polarised across (s) and in (p) the plane of incidence loses 4 c η cₜ over
    // (c + η cₜ)² and (η c + cₜ)² to the far side.
    let (s, p) = (c + eta * cos_t, eta * c + cos_t);
    let both = s * p;
    (2.0 * c * eta * cos_t * ((s * s + p * p) / (both * both))).min(1.0)
}

/// The fraction of light that a conductor reflects (Fresnel's equations, unpolarised).
///
/// - `cos_i`: cosine between the normal and either direction, in [0, 1]
/// - `eta`, `k`: real and imaginary part of the index over the exterior's, per channel
/// - returns: per channel, in [0, 1]
#[inline(always)]
pub fn conductor(cos_i: f32, eta: Rgb, k: Rgb) -> Rgb {
    let cos_squared = Rgb::splat(cos_i * cos_i);
    let sin_squared = Rgb::ONE - cos_squared;
    // The complex square root of (η + ik)² − sin²θ is a + ib.
    let real_part = eta * eta - k * k - sin_squared;
    let a_b_squared = sqrt(real_part * real_part + 4.0 * eta * eta * k * k);
    let a = sqrt((0.5 * (a_b_squared + real_part)).max(Rgb::ZERO));
    let two_a_cos = 2.0 * cos_i * a;
    // s = (x − y) / (x + y) for s-polarised light, and p = s (v − w) / (v + w); their mean by one division.
    let (x, y) = (a_b_squared + cos_squared, two_a_cos);
    let (v, w) = (a_b_squared * cos_squared + sin_squared * sin_squared, two_a_cos * sin_squared);
    let below = (x + y) * (v + w);
    let mean = (x - y).max(Rgb::ZERO) * v.max(w) / below;
    // The limit where nothing is left to divide: all is reflected.
    Rgb::select(below.cmpgt(Rgb::ZERO), mean, Rgb::ONE)
}

#[inline(always)]
fn sqrt(x: Rgb) -> Rgb {
    Rgb::new(x.x.sqrt(), x.y.sqrt(), x.z.sqrt())
}

/// The fraction of diffuse light that the interface between two dielectrics reflects: 2 ∫ F(μ) μ dμ.
///
/// - `eta`: index of the far side over that of the near side, positive
///
/// Closed form for η > 1 (Duntley 1942, "The optical properties of diffusing materials"); below 1
/// by conservation of étendue, 1 − R(1/η) = (1 − R(η)) η².
pub fn diffuse_reflectance(eta: f32) -> f32 {
    let n = f64::from(eta);
    if n < 1.0 {
        return (1.0 - (1.0 - diffuse_reflectance_above_1(1.0 / n)) * n * n) as f32;
    }
    diffuse_reflectance_above_1(n) as f32
}

fn diffuse_reflectance_above_1(n: f64) -> f64 {
    // Where the closed form's terms, of order 1 / (n − 1), cancel; R is below 10⁻⁶ there.
    if n - 1.0 < 1e-6 {
        return 0.0;
    }
    let n2 = n * n;
    let n4 = n2 * n2;
    0.5 + (n - 1.0) * (3.0 * n + 1.0) / (6.0 * (n + 1.0) * (n + 1.0))
        + n2 * (n2 - 1.0).powi(2) / (n2 + 1.0).powi(3) * ((n - 1.0) / (n + 1.0)).ln()
        - 2.0 * n * n2 * (n2 + 2.0 * n - 1.0) / ((n2 + 1.0) * (n4 - 1.0))
        + 8.0 * n4 * (n4 + 1.0) / ((n2 + 1.0) * (n4 - 1.0).powi(2)) * n.ln()
}

/// `w` mirrored about the normal +Z.
#[inline(always)]
pub fn reflect(w: Vec3) -> Vec3 {
    Vec3::new(-w.x, -w.y, w.z)
}

/// `w` mirrored about the unit vector `m`.
#[inline(always)]
pub fn reflect_about(w: Vec3, m: Vec3) -> Vec3 {
    2.0 * w.dot(m) * m - w
}

/// `w` refracted at an interface whose unit normal `m` is on the side of `w`.
///
/// `split` is what [`dielectric`] says of w · m; not under total internal reflection.
#[inline(always)]
pub fn refract_about(w: Vec3, m: Vec3, split: DielectricSplit) -> Vec3 {
    (w.dot(m) / split.eta - split.cos_t) * m - w / split.eta
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fresnel_at_normal_incidence_is_the_squared_contrast() {
        for eta in [1.1_f32, 1.5, 2.4, 0.7] {
            let expected = ((eta - 1.0) / (eta + 1.0)).powi(2);
            assert!((dielectric(1.0, eta).reflectance - expected).abs() < 2e-7);
            assert!((dielectric(-1.0, eta).reflectance - expected).abs() < 2e-7);
        }
    }

    /// At Brewster's angle, tan θ = η, parallel light is not reflected, and reflection and refraction
    /// are at right angles.
    #[test]
    fn brewsters_angle() {
        let eta = 1.5_f32;
        let cos = 1.0 / (1.0 + eta * eta).sqrt();
        let split = dielectric(cos, eta);
        let s = (cos - eta * split.cos_t) / (cos + eta * split.cos_t);
        assert!((split.reflectance - 0.5 * s * s).abs() < 2e-7);
        assert!((split.cos_t - (1.0 - cos * cos).sqrt()).abs() < 1e-6);
    }

    #[test]
    fn reflection_is_total_beyond_the_critical_angle() {
        let critical = (1.0 - 1.0 / 1.5_f32.powi(2)).sqrt();
        assert_eq!(dielectric(-critical * 0.999, 1.5).reflectance, 1.0);
        assert!(dielectric(-critical * 1.001, 1.5).reflectance < 0.9);
    }

    #[test]
    fn an_interface_between_equal_media_is_not_there() {
        for cos in [1.0, 0.3, 1e-20, 0.0] {
            assert_eq!(
                dielectric(cos, 1.0),
                DielectricSplit { reflectance: 0.0, transmittance: 1.0, cos_t: cos, eta: 1.0 }
            );
            assert!(dielectric(cos, 1.0 + f32::EPSILON).reflectance.is_finite());
        }
    }

    /// Light takes the same split in either direction.
    #[test]
    fn fresnel_is_symmetric() {
        for i in 10..100 {
            let cos = i as f32 / 100.0;
            let there = dielectric(cos, 1.5);
            let back = dielectric(-there.cos_t, 1.5);
            assert!((there.reflectance - back.reflectance).abs() < 1e-5, "{cos}: {there:?} {back:?}");
            assert!((back.cos_t - cos).abs() < 1e-5);
        }
    }

    #[test]
    fn refraction_obeys_snell() {
        let m = Vec3::new(0.36, 0.48, 0.8);
        let w = Vec3::new(-0.48, 0.6, 0.64);
        let split = dielectric(w.dot(m), 1.5);
        let t = refract_about(w, m, split);
        assert!((t.length() - 1.0).abs() < 1e-6);
        assert!((t.cross(m) * 1.5 + w.cross(m)).length() < 1e-6); // in the plane of incidence, on the other side
        assert!((t.dot(m) + split.cos_t).abs() < 1e-6);
    }

    #[test]
    fn a_conductor_that_absorbs_nothing_is_a_dielectric() {
        let eta = Rgb::new(1.2, 1.5, 2.4);
        for i in 0..=100 {
            let cos = i as f32 / 100.0;
            let got = conductor(cos, eta, Rgb::ZERO);
            let expected = Rgb::from_array(eta.to_array().map(|eta| dielectric(cos, eta).reflectance));
            assert!((got - expected).abs().max_element() < 2e-6, "{cos}: {got} {expected}");
        }
    }

    /// |(η + ik − 1) / (η + ik + 1)|² at normal incidence; everything at grazing.
    #[test]
    fn conductor_at_its_ends() {
        let (eta, k) = (Rgb::new(0.2, 1.1, 3.0), Rgb::new(3.9, 2.5, 5.0));
        let one = Rgb::ONE;
        let expected = ((eta - one) * (eta - one) + k * k) / ((eta + one) * (eta + one) + k * k);
        assert!((conductor(1.0, eta, k) - expected).abs().max_element() < 1e-6);
        assert_eq!(conductor(0.0, eta, k), one);
    }

    #[test]
    fn conductor_is_finite_for_any_index() {
        for cos in [0.0, 1e-20, 0.5, 1.0] {
            for (eta, k) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (4096.0, 4096.0), (1e-20, 1e-20)] {
                let r = conductor(cos, Rgb::splat(eta), Rgb::splat(k));
                assert!(r.min_element() >= 0.0 && r.max_element() <= 1.0 + 1e-6, "{cos} {eta} {k}: {r}");
            }
        }
    }

    #[test]
    fn diffuse_reflectance_is_the_integral() {
        for eta in [1.0005_f32, 1.01, 1.3, 1.5, 2.0, 4.0, 0.99, 0.75, 0.5] {
            let n = 100_000;
            let integral: f64 = (0..n)
                .map(|i| (f64::from(i) + 0.5) / f64::from(n))
                .map(|mu| 2.0 * mu * f64::from(dielectric(mu as f32, eta).reflectance))
                .sum::<f64>()
                / f64::from(n);
            let got = f64::from(diffuse_reflectance(eta));
            assert!((got - integral).abs() < 2e-6, "{eta}: {got}, not {integral}");
        }
        assert_eq!(diffuse_reflectance(1.0), 0.0);
    }
}
