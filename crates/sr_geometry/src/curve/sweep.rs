//! Rays and discs swept along cubics, perpendicular to them.
//!
//! The curve is cut in halves until it is nearly straight next to the ray, as Nakamaru & Ohno 2002 ("Ray tracing for
//! curves primitive") do in the ray's own frame; what passes the ray too far away is dropped. A cone is where the search begins
//! in each part that is left: for the point that is on the ray and on the rim of a disc, by Newton's method, with
//! curve and radius as they are.

use glam::{DMat3, DVec3};

use super::cubic::Cubic;
use crate::Ray;

/// Halves of halves end at this depth.
const MOST_HALVINGS: u32 = 12;

/// How often a part is halved again in which no point was found.
const RETRIES: u32 = 2;

/// A part is straight if it is off its chord by at most this part of its radius,
const BEND: f64 = 0.05;
/// and if it turns by an angle of at least this cosine.
const TURN: f64 = 0.9;

/// Steps of Newton's method.
const STEPS: usize = 12;

/// How far beyond its ends a part may be met: neighbours then have no gap. Of the segment.
const OVERLAP: f64 = 1e-9;

/// The ray in its own frame: from the origin along +Z, in units of its direction.
struct Search {
    /// Where it ends.
    end: f64,
    best: Option<(f64, f64)>,
}

/// The smallest t in (0, `t_max`) at which the ray meets a part of the surface from outside, and where on the cubic.
pub(super) fn meet(cubic: &Cubic, span: [f64; 2], ray: &Ray) -> Option<(f64, f64)> {
    let direction = ray.direction.as_dvec3();
    if passes(cubic, span, ray.origin.as_dvec3(), direction) {
        return None;
    }
    let speed = direction.length();
    let z = direction / speed;
    let (x, y) = z.any_orthonormal_pair();
    let to_ray = DMat3::from_cols(x, y, z).transpose();
    let origin = ray.origin.as_dvec3();
    let Cubic(points) = cubic.between(span);
    let local = points.map(|p| (to_ray * (p.truncate() - origin)).extend(p.w));
    let mut search = Search { end: f64::from(ray.t_max) * speed, best: None };
    search.part(&Cubic(local), span, MOST_HALVINGS);
    let (t, u) = search.best?;
    let t = t / speed;
    (t as f32 > 0.0 && (t as f32) < ray.t_max).then_some((t, u.clamp(span[0], span[1])))
}

/// Does the ray's line surely pass a part, by its distance to the line through the part's ends? Most rays do.
fn passes(cubic: &Cubic, span: [f64; 2], origin: DVec3, direction: DVec3) -> bool {
    let Cubic([a, b, c, d]) = cubic;
    let [from, to] = span.map(|u| cubic.at(u).truncate());
    let radius = a.w.max(b.w).max(c.w).max(d.w);
    // A curve is off its chord by at most an eighth of its second derivative and its span squared.
    let second =
        (a - 2.0 * b + c).truncate().length_squared().max((b - 2.0 * c + d).truncate().length_squared());
    let part = span[1] - span[0];
    let reach = radius + 0.75 * part * part * second.sqrt();
    let across = (to - from).cross(direction);
    let distance = across.dot(from - origin);
    distance * distance > reach * reach * across.length_squared()
}

impl Search {
    /// Meets a part of the curve, which has the given parameters.
    fn part(&mut self, part: &Cubic, span: [f64; 2], halvings: u32) {
        let Cubic(points) = part;
        let [a, b, c, d] = points.map(|p| p.truncate());
        let radius = points.iter().fold(0.0_f64, |r, p| r.max(p.w));
        let (low, high) = (a.min(b).min(c.min(d)) - radius, a.max(b).max(c.max(d)) + radius);
        let passes_box = low.x > 0.0 || low.y > 0.0 || high.x < 0.0 || high.y < 0.0;
        if passes_box || high.z < 0.0 || low.z > self.end {
            return;
        }
        let chord = d - a;
        let length = chord.length();
        let off =
            |p: DVec3| if length > 0.0 { (p - a).cross(chord).length() / length } else { (p - a).length() };
        let bend = off(b).max(off(c));
        // The ray's distance to the chord's line, seen along the ray.
        let seen = chord.truncate();
        if a.truncate().perp_dot(seen).abs() > (radius + bend) * seen.length() {
            return;
        }
        let thinnest = points.iter().fold(f64::INFINITY, |r, p| r.min(p.w)).max(0.1 * radius);
        let turns = |from: DVec3, to: DVec3| from.dot(to) < TURN * from.length() * to.length();
        let is_straight =
            bend <= BEND * thinnest && !turns(b - a, chord) && !turns(d - c, chord) && !turns(b - a, d - c);
        let is_met = (is_straight || halvings <= RETRIES) && self.leaf(part, span);
        if is_met || halvings == 0 {
            return;
        }
        // Where the search went astray, it is begun closer.
        let halvings = if is_straight { halvings.min(RETRIES) } else { halvings } - 1;
        let middle = 0.5 * (span[0] + span[1]);
        let [first, second] = part.halves();
        let mut halves = [(first, [span[0], middle]), (second, [middle, span[1]])];
        // The nearer half first: what it shows may hide the other.
        if a.z > d.z {
            halves.reverse();
        }
        halves.iter().for_each(|(half, span)| self.part(half, *span, halvings));
    }

    /// Meets a part that is nearly straight; was it met?
    fn leaf(&mut self, part: &Cubic, span: [f64; 2]) -> bool {
        let mut is_met = false;
        for (u, t) in guesses(part).into_iter().flatten() {
            let Some((u, t)) = refine(part, u, t) else { continue };
            let whole = span[0] + u * (span[1] - span[0]);
            if whole >= span[0] - OVERLAP && whole <= span[1] + OVERLAP {
                is_met = true;
                if t > 0.0 && t < self.end {
                    (self.end, self.best) = (t, Some((t, whole)));
                }
            }
        }
        is_met
    }
}

/// Where the ray meets the cone around the chord, or comes closest to it: on the curve and on the ray.
fn guesses(part: &Cubic) -> [Option<(f64, f64)>; 2] {
    let [a, _, _, d] = part.0;
    let chord = (d - a).truncate();
    let length = chord.length();
    let axis = chord.normalize_or(DVec3::Z);
    let widening = if length > 0.0 { (d.w - a.w) / length } else { 0.0 };
    let from = -a.truncate();
    let along = from.dot(axis);
    let radius = a.w + widening * along;
    let qa = 1.0 - axis.z * axis.z * (1.0 + widening * widening);
    let qb = from.z - along * axis.z - radius * widening * axis.z;
    let qc = from.length_squared() - along * along - radius * radius;
    let root = (qb * qb - qa * qc).max(0.0).sqrt();
    let place = |t: f64| {
        let u = if length > 0.0 { (along + t * axis.z) / length } else { 0.5 };
        (t.is_finite() && u.is_finite()).then_some((u.clamp(0.0, 1.0), t))
    };
    // Only one of them is on the outside, unless the cone opens towards the ray.
    match qa > 0.0 {
        true => [place((-qb - root) / qa), None],
        false => [place((-qb - root) / qa), place((-qb + root) / qa)],
    }
}

/// From a guess to a point on the ray and on the rim of a disc, seen from outside.
fn refine(part: &Cubic, mut u: f64, mut t: f64) -> Option<(f64, f64)> {
    for _ in 0..STEPS {
        let [at, first, second] = part.derivatives(u);
        let (tangent, bending) = (first.truncate(), second.truncate());
        let off = DVec3::Z * t - at.truncate();
        // In the plane of the disc, and as far from its centre as its rim.
        let (height, beyond) = (off.dot(tangent), 0.5 * (off.length_squared() - at.w * at.w));
        let (height_u, height_t) = (off.dot(bending) - tangent.length_squared(), tangent.z);
        let (beyond_u, beyond_t) = (-height - at.w * first.w, off.z);
        let determinant = height_u * beyond_t - height_t * beyond_u;
        let du = (height * beyond_t - height_t * beyond) / determinant;
        let dt = (height_u * beyond - height * beyond_u) / determinant;
        if !(du.is_finite() && dt.is_finite()) {
            return None;
        }
        u -= du.clamp(-0.5, 0.5);
        t -= dt;
        // Far outside of the part, another one is responsible.
        if !(-1.0..=2.0).contains(&u) {
            return None;
        }
        if du.abs() < 1e-12 && dt.abs() <= 1e-12 * t.abs() + 1e-9 * at.w {
            let [at, first, second] = part.derivatives(u);
            let off = DVec3::Z * t - at.truncate();
            let tangent = first.truncate();
            let stretch = tangent.length_squared() - off.dot(second.truncate());
            let facing = stretch * off.z - at.w * first.w * tangent.z;
            return (at.w >= 0.0 && facing < 0.0).then_some((u, t));
        }
    }
    None
}
