//! Openings through which the light around a scene comes in.
//!
//! Seen from any point, a rectangle's edges are straight lines along the axes if directions (x, y, z) in the rectangle's
//! own frame, z through it, are held as the angles atan(x / z) and atan(y / z): so what is seen of the sky through it is a
//! window of one table, whatever the point (Bitterli, Novák & Jarosz 2015, "Portal-Masked Environment Map Sampling").

use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Mat3, Vec2, Vec3};
use sr_sampling::{Distribution, SummedArea, Window};
use sr_scene::{MAX_PORTALS, Portal, Rgb};

use crate::texture::luminance;

/// Bounds of the side of a portal's table.
const SIDES: (usize, usize) = (64, 512);
/// Directions looked at along each side of a cell.
const POINTS_PER_CELL: usize = 2;

/// Openings, each with its table.
#[derive(Clone, Debug)]
pub(super) struct Portals(Vec<Rectified>);

/// The sky as a portal holds it.
#[derive(Clone, Debug)]
struct Rectified {
    /// Columns: along the edges, and outwards.
    world_from_portal: Mat3,
    corners: [Vec3; 2],
    /// Luminance times solid angle, over the two angles scaled to [0, 1]².
    table: SummedArea,
}

impl Portals {
    /// Tables of the radiance along directions in world space, for an image `side` texels wide. `None` if there is no
    /// portal, or no light.
    pub fn new(portals: &[Portal], side: usize, radiance: impl Fn(Vec3) -> Rgb) -> Option<Self> {
        let side = side.clamp(SIDES.0, SIDES.1);
        let all: Vec<Rectified> =
            portals.iter().take(MAX_PORTALS).filter_map(|p| Rectified::new(p, side, &radiance)).collect();
        (!all.is_empty()).then_some(Self(all))
    }

    /// What is seen through the portals from a point; `None` if no light is.
    pub fn seen_from(&self, from: Vec3) -> Option<SeenThrough<'_>> {
        let mut windows = [const { None }; MAX_PORTALS];
        let mut total = 0.0;
        for (portal, window) in self.0.iter().zip(&mut windows) {
            *window = portal.window(from);
            total += window.as_ref().map_or(0.0, Window::integral);
        }
        (total > 0.0).then_some(SeenThrough { portals: &self.0, windows, total })
    }
}

impl Rectified {
    fn new(portal: &Portal, side: usize, radiance: impl Fn(Vec3) -> Rgb) -> Option<Self> {
        let [x, y] = portal.edges.map(Vec3::normalize_or_zero);
        // the edges' product points inside
        let outwards = y.cross(x).try_normalize()?;
        let world_from_portal = Mat3::from_cols(x, outwards.cross(x), outwards);
        let fine = side * POINTS_PER_CELL;
        let mut values = vec![0.0; side * side];
        for row in 0..fine {
            for column in 0..fine {
                let uv = (Vec2::new(column as f32, row as f32) + 0.5) / fine as f32;
                let (local, jacobian) = direction(uv);
                values[row / POINTS_PER_CELL * side + column / POINTS_PER_CELL] +=
                    luminance(radiance(world_from_portal * local)) * jacobian;
            }
        }
        let corners = [portal.corner, portal.corner + portal.edges[0] + portal.edges[1]];
        Some(Self { world_from_portal, corners, table: SummedArea::new(&values, side).ok()? })
    }

    /// The directions from a point through the portal, if it is on the inside.
    fn window(&self, from: Vec3) -> Option<Window<'_>> {
        let [a, b] = self.corners.map(|corner| uv_of(self.world_from_portal.transpose() * (corner - from)));
        let (a, b) = (a?, b?);
        self.table.window(a.min(b), a.max(b))
    }
}

/// What a point sees through portals, as a density over directions: a mixture of their windows in proportion to the
/// light through each.
pub(super) struct SeenThrough<'a> {
    portals: &'a [Rectified],
    windows: [Option<Window<'a>>; MAX_PORTALS],
    total: f64,
}

impl SeenThrough<'_> {
    /// A direction in world space.
    pub fn sample(&self, u: Vec2) -> Option<Vec3> {
        let mut left = f64::from(u.x) * self.total;
        let seen = self.portals.iter().zip(&self.windows).filter_map(|(p, w)| Some((p, w.as_ref()?)));
        let mut chosen = None;
        for (portal, window) in seen {
            if left < 0.0 {
                break;
            }
            chosen = Some((portal, window, (left / window.integral()).min(1.0 - 1e-7)));
            left -= window.integral();
        }
        let (portal, window, rest) = chosen?;
        let uv = window.sample(Vec2::new(rest as f32, u.y))?.value;
        Some((portal.world_from_portal * direction(uv).0).normalize())
    }

    /// The density of `sample`, in sr⁻¹.
    pub fn pdf(&self, wi: Vec3) -> f32 {
        let seen = self.portals.iter().zip(&self.windows).filter_map(|(p, w)| Some((p, w.as_ref()?)));
        let through = seen.filter_map(|(portal, window)| {
            let local = portal.world_from_portal.transpose() * wi;
            let uv = uv_of(local)?;
            let pdf_uv = window.value(uv) / self.total;
            Some(pdf_uv / f64::from(direction(uv).1))
        });
        let pdf = through.sum::<f64>() as f32;
        if pdf.is_finite() { pdf } else { 0.0 }
    }
}

/// The two angles of a vector in a portal's frame, scaled to [0, 1]; `None` unless it points outwards.
fn uv_of(local: Vec3) -> Option<Vec2> {
    let angles = || Vec2::new((local.x / local.z).atan(), (local.y / local.z).atan());
    (local.z > 0.0).then(|| angles() / PI + 0.5)
}

/// The direction at two scaled angles, and the solid angle per unit of their area:
/// π² (1 − x²) (1 − y²) / z.
fn direction(uv: Vec2) -> (Vec3, f32) {
    // kept from the horizon, where the angles are no coordinates
    let angles = ((uv - 0.5) * PI).clamp(Vec2::splat(1e-6 - FRAC_PI_2), Vec2::splat(FRAC_PI_2 - 1e-6));
    let local = Vec3::new(angles.x.tan(), angles.y.tan(), 1.0).normalize();
    let (x2, y2, z2) = (local.x * local.x, local.y * local.y, local.z * local.z);
    (local, PI * PI * (y2 + z2) * (x2 + z2) / local.z)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ∫ over the unit square of the Jacobian is the half-sphere.
    #[test]
    fn all_windows_together_are_a_half_sphere() {
        let n = 2000;
        let sum: f64 = (0..n * n)
            .map(|i| (Vec2::new((i % n) as f32, (i / n) as f32) + 0.5) / n as f32)
            .map(|uv| f64::from(direction(uv).1))
            .sum();
        let sphere = sum / f64::from(n * n);
        assert!((sphere - 2.0 * std::f64::consts::PI).abs() < 0.01, "{sphere}");
    }

    #[test]
    fn a_portal_is_seen_from_inside_only() {
        let portal = Portal { corner: Vec3::new(-1.0, -1.0, 0.0), edges: [2.0 * Vec3::X, 2.0 * Vec3::Y] };
        let portals = Portals::new(&[portal], 64, |_| Rgb::ONE).unwrap();
        assert!(portals.seen_from(-Vec3::Z).is_none(), "outside");
        assert!(portals.seen_from(Vec3::X).is_none(), "in its plane");
        let seen = portals.seen_from(Vec3::Z).unwrap();
        // a face of a cube is a sixth of the sphere
        assert!((seen.pdf(-Vec3::Z) - 1.5 / PI).abs() < 2e-3, "{}", seen.pdf(-Vec3::Z));
        assert_eq!(seen.pdf(Vec3::X), 0.0);
        for i in 0..100 {
            let u = Vec2::new(i as f32 / 100.0, (i * 37 % 100) as f32 / 100.0);
            let wi = seen.sample(u).unwrap();
            assert!(wi.x.abs() <= -wi.z * 1.00001 && wi.y.abs() <= -wi.z * 1.00001, "{wi}");
        }
        assert!(Portals::new(&[portal], 64, |_| Rgb::ZERO).is_none());
    }
}
