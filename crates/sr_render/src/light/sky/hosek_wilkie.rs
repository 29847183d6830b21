//! The radiance of a clear sky, and of the sun in it.
//!
//! Lukáš Hošek & Alexander Wilkie, "An Analytic Model for Full Spectral Sky-Dome Radiance", SIGGRAPH 2012, and "Adding a
//! Solar-Radiance Function to the Hošek–Wilkie Skylight Model", 2013. The coefficients, in linear RGB, are in
//! `data/hosek_wilkie.txt`, under the licence that stands there.

use std::f32::consts::{FRAC_PI_2, PI};
use std::sync::OnceLock;

use glam::Vec3;
use sr_scene::Rgb;

/// Turbidities in the tables, from 1.
const TURBIDITIES: usize = 10;
/// Albedos in the tables: 0 and 1.
const ALBEDOS: usize = 2;
/// Control points along the sun's elevation, of a Bézier curve.
const CONTROLS: usize = 6;
const CHANNELS: usize = 3;
/// Parameters of the distribution.
const PARAMETERS: usize = 9;
/// Zenith angles of the sun in the tables.
const SUN_ANGLES: usize = 30;
/// The first and the last of them, in degrees.
const SUN_ANGLE_RANGE: [f32; 2] = [1.0, 88.0];
/// What a unit of the tables is: 1 over the integral of the CIE's ȳ, in nm, which is how Mitsuba normalises spectra.
const UNIT: f32 = 1.0 / 106.750_26;

/// The file's numbers, in its order.
struct Coefficients {
    /// `[turbidity][albedo][control][channel][parameters, then radiance]`
    sky: Vec<f32>,
    /// `[turbidity][angle][channel]`
    sun: Vec<f32>,
}

fn coefficients() -> &'static Coefficients {
    static COEFFICIENTS: OnceLock<Coefficients> = OnceLock::new();
    COEFFICIENTS.get_or_init(|| {
        let text = include_str!("../../../data/hosek_wilkie.txt");
        let mut lists = [Vec::new(), Vec::new()];
        let mut which = 0;
        for line in text.lines().filter(|line| !line.starts_with('#')) {
            match line {
                "sky" => which = 0,
                "sun" => which = 1,
                numbers => lists[which].extend(numbers.split(' ').filter_map(|n| n.parse::<f32>().ok())),
            }
        }
        let [sky, sun] = lists;
        assert_eq!(
            sky.len(),
            TURBIDITIES * ALBEDOS * CONTROLS * CHANNELS * (PARAMETERS + 1),
            "the file is ours"
        );
        assert_eq!(sun.len(), TURBIDITIES * SUN_ANGLES * CHANNELS, "the file is ours");
        Coefficients { sky, sun }
    })
}

/// An index, and how far it is on to the next one.
fn between(x: f32, count: usize) -> (usize, f32) {
    let x = x.clamp(0.0, (count - 1) as f32);
    let index = (x as usize).min(count - 2);
    (index, x - index as f32)
}

/// The distribution of radiance for one place of the sun.
#[derive(Clone, Debug)]
pub(super) struct SkyModel {
    /// Parameters A to I of the paper's equation 8.
    parameters: [Rgb; PARAMETERS],
    /// What the distribution is multiplied by; zero if the sun is below the horizon.
    radiance: Rgb,
    sun_direction: Vec3,
}

impl SkyModel {
    /// `sun_direction` has +Z to the zenith.
    pub fn new(turbidity: f32, albedo: Rgb, sun_direction: Vec3) -> Self {
        let mut of = [Rgb::ZERO; PARAMETERS + 1];
        if sun_direction.z >= 0.0 {
            let elevation = sun_direction.z.min(1.0).asin();
            let basis = bernstein((elevation / FRAC_PI_2).cbrt());
            let (t, s) = between(turbidity - 1.0, TURBIDITIES);
            let stride = PARAMETERS + 1;
            for (k, value) in of.iter_mut().enumerate() {
                for c in 0..CHANNELS {
                    let a = albedo[c].clamp(0.0, 1.0);
                    let weights = [
                        (t, 0, (1.0 - s) * (1.0 - a)),
                        (t, 1, (1.0 - s) * a),
                        (t + 1, 0, s * (1.0 - a)),
                        (t + 1, 1, s * a),
                    ];
                    for (turbidity, albedo, weight) in weights {
                        for (control, b) in basis.into_iter().enumerate() {
                            let at = ((turbidity * ALBEDOS + albedo) * CONTROLS + control) * CHANNELS + c;
                            value[c] += weight * b * coefficients().sky[at * stride + k];
                        }
                    }
                }
            }
        }
        let [parameters @ .., radiance] = of;
        Self { parameters, radiance: radiance * UNIT, sun_direction }
    }

    /// Radiance from a direction, with +Z to the zenith; 0 below the horizon.
    pub fn radiance(&self, w: Vec3) -> Rgb {
        if self.radiance == Rgb::ZERO || !(w.z >= 0.0) {
            return Rgb::ZERO;
        }
        let [a, b, c, d, e, f, g, h, i] = self.parameters;
        let cos_gamma = self.sun_direction.dot(w).clamp(-1.0, 1.0);
        // the angle to the sun, precise near it
        let gamma = 2.0 * (0.5 * self.sun_direction.distance(w)).min(1.0).asin();
        let cos2 = cos_gamma * cos_gamma;
        let base = (Rgb::ONE + i * i - 2.0 * i * cos_gamma).max(Rgb::splat(1e-9));
        let chi = (1.0 + cos2) / (base * base.map(f32::sqrt));
        let around_zenith = Rgb::ONE + a * (b / (w.z + 0.01)).exp();
        let around_sun = c + d * (e * gamma).exp() + f * cos2 + g * chi + h * w.z.sqrt();
        (around_zenith * around_sun * self.radiance).max(Rgb::ZERO)
    }
}

/// The quintic Bernstein polynomials.
fn bernstein(x: f32) -> [f32; CONTROLS] {
    let y = 1.0 - x;
    let (x2, y2) = (x * x, y * y);
    [y2 * y2 * y, 5.0 * x * y2 * y2, 10.0 * x2 * y2 * y, 10.0 * x2 * x * y2, 5.0 * x2 * x2 * y, x2 * x2 * x]
}

/// The mean radiance of the sun's disk at its true size; `cos_zenith` tells how high it stands.
pub(super) fn sun_radiance(turbidity: f32, cos_zenith: f32) -> Rgb {
    let [first, last] = SUN_ANGLE_RANGE;
    let zenith = cos_zenith.clamp(0.0, 1.0).acos() * 180.0 / PI;
    let (k, r) = between((zenith - first) / (last - first) * (SUN_ANGLES - 1) as f32, SUN_ANGLES);
    let (t, s) = between(turbidity - 1.0, TURBIDITIES);
    let at = |t: usize, k: usize| Rgb::from_slice(&coefficients().sun[(t * SUN_ANGLES + k) * CHANNELS..]);
    at(t, k).lerp(at(t, k + 1), r).lerp(at(t + 1, k).lerp(at(t + 1, k + 1), r), s)
}
