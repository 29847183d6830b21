//! Spheres, as a packet meets them.
//!
//! With s = o − c, the ray o + t d passes the centre c at the distance l = |s − (s·d / d·d) d|, which does not cancel
//! (Haines, Günther & Akenine-Möller 2019, "Precision improvements for ray/sphere intersection"). It meets the sphere
//! where l < r. With C = s·s − r², B = s·d, A = d·d, Q = √(A (r² − l²)) and W = |B| + Q it does so at
//!
//! > t = C / W from outside, where B < 0; t = −C / W from inside, where B > 0; and t = W / A, where B ≤ 0.
//!
//! # How wrong it may be
//!
//! ε, R as in `packet`; S is |s|₁. Products of ε are left out, but for those that S may make large.
//!
//! - B: ε S R from s, another from products, 2 from sums: less than 5 ε S R.
//! - C: 2 ε s·s from s, ε from squares, 2 ε from sums, ε r², and ε (s·s + r²): less than 8 ε s·s + 3 ε r².
//! - The foot s − (B/A) d: ε S from s, ε S from the product, ε l from the difference; B/A is wrong by 9 ε S / |d|, but that
//!   moves the foot along d only, so l² by squares: less than 200 ε² S² with all the others. So l² is wrong by 4 ε S l +
//!   2 ε l², and by 3 ε l² from squares and sums, r² − l² where l < r by E = 5 ε S r + 8 ε r² + 200 ε² S² at most.
//!   Where r² − l² is larger than E, l is surely less than r; where it is less than −E, l is surely larger.
//! - W: the error of B, and A E / Q where E < r² − l².
//!
//! A hit is certain if the signs that choose its formula are, and C and W within [`KAPPA`]: t is then within some 6e-5 of
//! its value, which is less than by how much a shadow ray ends before its target. The point on the sphere is found again
//! from t, so it is no worse for that. What is not certain, mostly the rim, is for [`Sphere::intersect`]: one of a hundred
//! rays where half are aimed at small spheres. Rays that leave the sphere outwards are certain, as they start outside by
//! more than the error of C.

use super::super::simd::Lanes;
use super::Packet;
use crate::Sphere;
use crate::offset::ROUNDING;

/// How wrong numerator and denominator of t may be, in parts of their own.
const KAPPA: f32 = 1.0 / 32768.0;

/// Radii between these, and coordinates below the second, leave room for squares of squares.
const RADII: [f32; 2] = [1e-6, 1e8];

/// A sphere.
#[derive(Clone, Copy, Debug)]
pub(in crate::bvh) struct Ball {
    center: [f32; 3],
    /// r².
    square: f32,
    /// 5 ε r and 8 ε r²: parts of E.
    rim: [f32; 2],
    /// 3 ε r²: a part of the error of C.
    skin: f32,
    /// As of a piece.
    halves: f32,
}

/// What the directions of a packet are for all spheres.
pub(super) struct Speed<L: Lanes> {
    /// A.
    square: L::F,
    /// 1 / A.
    inverse: L::F,
}

impl<L: Lanes> Speed<L> {
    #[inline(always)]
    pub fn new(lanes: L, packet: &Packet<L>) -> Self {
        let square = dot(lanes, &packet.back, &packet.back);
        Self { square, inverse: lanes.div(lanes.splat(1.0), square) }
    }
}

/// What a packet sees of a sphere: numerators and denominators of t.
pub(super) struct SeenBall<L: Lanes> {
    pub t: L::F,
    pub denominator: L::F,
    /// As of the sphere.
    pub halves: f32,
    /// Which lines surely meet the sphere ahead, at this t.
    pub hit: L::Mask,
    /// Which may, surely or not.
    maybe: L::Mask,
}

impl<L: Lanes> SeenBall<L> {
    /// 1 where the sphere may be hit, but not surely, else as it was.
    #[inline(always)]
    pub fn mark_doubtful(&self, lanes: L, doubtful: L::F) -> L::F {
        let marked = lanes.select(self.maybe, lanes.splat(1.0), doubtful);
        lanes.select(self.hit, doubtful, marked)
    }
}

impl Ball {
    /// `None`: it is too small or too large, or too far away.
    pub fn new(sphere: &Sphere, halves: f32) -> Option<Self> {
        let (radius, unit) = (f64::from(sphere.radius), f64::from(ROUNDING));
        let square = radius * radius;
        let [small, large] = RADII;
        let fits = (small..=large).contains(&sphere.radius) && sphere.center.abs().max_element() <= large;
        fits.then_some(Self {
            center: sphere.center.to_array(),
            square: square as f32,
            rim: [(5.0 * unit * radius) as f32, (8.0 * unit * square) as f32],
            skin: (3.0 * unit * square) as f32,
            halves,
        })
    }

    /// `None`: surely no ray meets the sphere.
    #[inline(always)]
    pub(super) fn see<L: Lanes>(
        &self,
        lanes: L,
        packet: &Packet<L>,
        speed: &Speed<L>,
    ) -> Option<SeenBall<L>> {
        let [zero, kappa] = [lanes.splat(0.0), lanes.splat(KAPPA)];
        let square = lanes.splat(self.square);
        let s = [
            lanes.sub(packet.origin[0], lanes.splat(self.center[0])),
            lanes.sub(packet.origin[1], lanes.splat(self.center[1])),
            lanes.sub(packet.origin[2], lanes.splat(self.center[2])),
        ];
        let distance = lanes.add(lanes.add(lanes.abs(s[0]), lanes.abs(s[1])), lanes.abs(s[2]));
        // −B
        let approach = dot(lanes, &s, &packet.back);
        let along = lanes.mul(approach, speed.inverse);
        let foot = [
            lanes.sub(s[0], lanes.mul(along, packet.back[0])),
            lanes.sub(s[1], lanes.mul(along, packet.back[1])),
            lanes.sub(s[2], lanes.mul(along, packet.back[2])),
        ];
        // r² − l², and E.
        let inside_by = lanes.sub(square, dot(lanes, &foot, &foot));
        let far = lanes
            .add(lanes.splat(self.rim[0]), lanes.mul(distance, lanes.splat(200.0 * ROUNDING * ROUNDING)));
        let slack = lanes.add(lanes.mul(distance, far), lanes.splat(self.rim[1]));
        // C, and the errors of C and B.
        let distance_2 = dot(lanes, &s, &s);
        let outside_by = lanes.sub(distance_2, square);
        let skin = lanes.add(lanes.mul(distance_2, lanes.splat(8.0 * ROUNDING)), lanes.splat(self.skin));
        let hesitation = lanes.mul(lanes.mul(distance, packet.longest), lanes.splat(5.0 * ROUNDING));
        let ahead = lanes.or(lanes.le(outside_by, skin), lanes.lt(zero, lanes.add(approach, hesitation)));
        let maybe = lanes.and(lanes.lt(zero, lanes.add(inside_by, slack)), ahead);
        if lanes.bits(maybe) == 0 {
            return None;
        }
        // Q and W.
        let half_chord = lanes.sqrt(lanes.mul(speed.square, lanes.max(inside_by, zero)));
        let sum = lanes.add(lanes.abs(approach), half_chord);
        let inside = lanes.lt(outside_by, zero);
        let through = lanes.and(inside, lanes.le(zero, approach));
        let depth = lanes.abs(outside_by);
        // What must be certain: l < r, the side, the direction, C and W.
        let mut hit = lanes.lt(slack, inside_by);
        hit = lanes.and(hit, lanes.lt(skin, lanes.select(through, depth, lanes.mul(kappa, depth))));
        hit = lanes.and(hit, lanes.or(inside, lanes.lt(hesitation, approach)));
        let error = lanes.add(lanes.mul(hesitation, half_chord), lanes.mul(speed.square, slack));
        hit = lanes.and(hit, lanes.le(error, lanes.mul(lanes.mul(kappa, half_chord), sum)));
        Some(SeenBall {
            t: lanes.select(through, sum, depth),
            denominator: lanes.select(through, speed.square, sum),
            halves: self.halves,
            hit,
            maybe,
        })
    }
}

#[inline(always)]
fn dot<L: Lanes>(lanes: L, a: &[L::F; 3], b: &[L::F; 3]) -> L::F {
    lanes.add(lanes.add(lanes.mul(a[0], b[0]), lanes.mul(a[1], b[1])), lanes.mul(a[2], b[2]))
}
