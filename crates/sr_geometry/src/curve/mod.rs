//! Curves with thickness, as of hair and fur: chains of round cones with spheres where they meet, or discs swept along
//! cubics. Both are met in `f64`, from outside alone: their insides are never seen.
//!
//! In: [`Curves`], borrowed control points. Out: [`CurveSet`], flat arrays of control points and segments, which makes
//! the tree's primitives, meets rays, and tells surfaces. A segment is one cone or one cubic; where that makes boxes
//! tighter, several [`Piece`]s of it are primitives.
//!
//! - `cone`: a segment of a linear curve. `cubic`: a segment of the others, and `sweep`, how a ray meets it.

mod cone;
mod cubic;
mod sweep;

use std::f32::consts::TAU;

use glam::{DVec3, Vec2, Vec3, Vec4};
use rayon::prelude::*;

use crate::bvh::MAX_INDEX;
use crate::offset::ROUNDING;
use crate::surface::Located;
use crate::{Bounds3, Ray, Tangents};
use cone::RoundCone;
use cubic::Cubic;

/// What control points mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveBasis {
    /// They are joined by cones. There are spheres at all points, also at the ends. At least two to a curve.
    Linear,
    /// Those of uniform cubic B-splines, open at their ends. At least four to a curve.
    BSpline,
    /// Those of cubic Bézier splines, open at their ends: three for each segment, and one more.
    Bezier,
}

impl CurveBasis {
    /// Control points of a segment.
    pub fn order(self) -> usize {
        match self {
            CurveBasis::Linear => 2,
            CurveBasis::BSpline | CurveBasis::Bezier => 4,
        }
    }

    /// How many control points a segment begins after the one before.
    pub fn stride(self) -> usize {
        match self {
            CurveBasis::Linear | CurveBasis::BSpline => 1,
            CurveBasis::Bezier => 3,
        }
    }

    /// Segments of a curve of so many control points; `None` if it cannot have so many.
    pub fn segments(self, points: usize) -> Option<usize> {
        let after_first = points.checked_sub(self.order())?;
        after_first.is_multiple_of(self.stride()).then_some(after_first / self.stride() + 1)
    }
}

/// What (u, v) are on curves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CurveUv {
    /// u: the angle around; v: the place along all segments of the shape, one after another. Mitsuba's.
    AroundAlong,
    /// u: the place along each segment; v: the angle around. pbrt's.
    AlongAround,
}

/// Curves, borrowed.
#[derive(Clone, Copy, Debug)]
pub struct Curves<'a> {
    /// What the control points mean.
    pub basis: CurveBasis,
    /// What (u, v) are.
    pub uv: CurveUv,
    /// Control points: position, and radius, not below 0. Those of B-splines may be; where the curve's is, it is not met.
    pub points: &'a [Vec4],
    /// At which control point each curve begins: from 0, and growing.
    pub firsts: &'a [u32],
}

/// What is wrong with [`Curves`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum CurvesError {
    /// A NaN, an infinity, or a radius below 0.
    #[error("control point {point} is {value}; expected finite numbers and a radius that is not below 0")]
    Point {
        /// Which.
        point: usize,
        /// Position and radius.
        value: Vec4,
    },
    /// A curve that does not begin after the one before.
    #[error(
        "curve {curve} begins at control point {first}; expected one after the curve before, of {points}"
    )]
    First {
        /// Which curve.
        curve: usize,
        /// Where it begins.
        first: u32,
        /// Number of control points.
        points: usize,
    },
    /// A curve of a number of control points that its basis does not allow.
    #[error("curve {curve} has {points} control points, which is no number for its basis")]
    Count {
        /// Which curve.
        curve: usize,
        /// How many control points it has.
        points: usize,
    },
}

impl Curves<'_> {
    /// The control points of each curve, as ranges.
    fn ranges(&self) -> impl Iterator<Item = std::ops::Range<usize>> {
        let ends = self.firsts.iter().skip(1).map(|&next| next as usize).chain([self.points.len()]);
        self.firsts.iter().zip(ends).map(|(&first, end)| first as usize..end)
    }

    /// At most so many primitives are made of them.
    pub(crate) fn most_pieces(&self) -> usize {
        let count = self.points.len();
        count.saturating_mul(MOST_PIECES as usize).min(count.max(MANY_PIECES))
    }

    pub(crate) fn validate(&self) -> Result<(), CurvesError> {
        let is_spline = self.basis == CurveBasis::BSpline;
        let is_bad = |p: &Vec4| !(p.is_finite() && (p.w >= 0.0 || is_spline));
        if let Some(point) = self.points.par_iter().position_first(is_bad) {
            return Err(CurvesError::Point { point, value: self.points[point] });
        }
        for (curve, range) in self.ranges().enumerate() {
            if range.start >= range.end || (curve == 0 && range.start != 0) {
                let (first, points) = (range.start as u32, self.points.len());
                return Err(CurvesError::First { curve, first, points });
            }
            if self.basis.segments(range.len()).is_none() {
                return Err(CurvesError::Count { curve, points: range.len() });
            }
        }
        Ok(())
    }
}

/// A part of a segment that is one primitive: from k / n to (k + 1) / n of it, n being 1, 2, 4 or 8.
///
/// The segment in the lower 28 bits, n + k above.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Piece(u32);

/// The most pieces of a segment.
const MOST_PIECES: u32 = 8;

/// Up to this many primitives, segments are cut as often as is useful.
const MANY_PIECES: usize = 1 << 23;

impl Piece {
    fn new(segment: u32, parts: u32, part: u32) -> Self {
        Self(segment | (parts + part) << MAX_INDEX.count_ones())
    }

    pub fn segment(self) -> u32 {
        self.0 & MAX_INDEX as u32
    }

    /// Where it begins and ends, of the segment.
    fn span(self) -> [f64; 2] {
        let code = self.0 >> MAX_INDEX.count_ones();
        let parts = 1 << code.ilog2();
        let part = code - parts;
        [part, part + 1].map(|at| f64::from(at) / f64::from(parts))
    }
}

/// All curves.
#[derive(Debug, Default)]
pub(crate) struct CurveSet {
    points: Vec<Vec4>,
    segments: Vec<Segment>,
    records: Vec<Record>,
}

/// Where a segment's control points begin, and, above, whether it is joined to the one before and to the one after.
#[derive(Clone, Copy, Debug)]
struct Segment(u32);

impl Segment {
    const AFTER: u32 = 1 << 30;
    const BEFORE: u32 = 1 << 31;

    fn first(self) -> usize {
        (self.0 & !(Self::AFTER | Self::BEFORE)) as usize
    }
}

/// Where a shape's segments are.
#[derive(Clone, Copy, Debug)]
struct Record {
    basis: CurveBasis,
    uv: CurveUv,
    first: u32,
    count: u32,
}

impl CurveSet {
    /// Copies valid curves; the index to ask for them.
    pub fn store(&mut self, curves: &Curves<'_>) -> u32 {
        let (basis, first) = (curves.basis, self.segments.len());
        let base = self.points.len();
        self.points.extend_from_slice(curves.points);
        for range in curves.ranges() {
            let count = basis.segments(range.len()).unwrap_or(0);
            self.segments.extend((0..count).map(|i| {
                let before = if i > 0 { Segment::BEFORE } else { 0 };
                let after = if i + 1 < count { Segment::AFTER } else { 0 };
                Segment((base + range.start + i * basis.stride()) as u32 | before | after)
            }));
        }
        let count = (self.segments.len() - first) as u32;
        self.records.push(Record { basis, uv: curves.uv, first: first as u32, count });
        self.records.len() as u32 - 1
    }

    /// Segments of a shape.
    pub fn segment_count(&self, index: u32) -> u32 {
        self.records[index as usize].count
    }

    /// What the tree is built from: pieces and their boxes. Segments without a surface are left out.
    pub fn pieces(&self, index: u32) -> Vec<(Bounds3, Piece)> {
        let Record { basis, first, count, .. } = self.records[index as usize];
        let most = (MANY_PIECES / count.max(1) as usize).clamp(1, MOST_PIECES as usize) as u32;
        let of = |segment: u32| {
            let at = self.segments[(first + segment) as usize];
            let bounds = |parts: u32| {
                let pieces = (0..parts).map(move |part| Piece::new(segment, parts, part));
                pieces.map(|piece| (self.piece_bounds(basis, at, piece), piece)).collect::<Vec<_>>()
            };
            if !self.has_surface(basis, at) {
                return Vec::new();
            }
            let area = |pieces: &[(Bounds3, Piece)]| pieces.iter().map(|(b, _)| half_area(b)).sum::<f32>();
            let mut best = bounds(1);
            while best.len() as u32 * 2 <= most {
                let finer = bounds(best.len() as u32 * 2);
                if !(area(&finer) < WORTH_CUTTING * area(&best)) {
                    break;
                }
                best = finer;
            }
            best
        };
        (0..count).into_par_iter().flat_map_iter(of).collect()
    }

    fn has_surface(&self, basis: CurveBasis, at: Segment) -> bool {
        let points = &self.points[at.first()..][..basis.order()];
        let has_length = points.iter().any(|p| p.truncate() != points[0].truncate());
        points.iter().any(|p| p.w > 0.0) && (has_length || basis == CurveBasis::Linear)
    }

    fn piece_bounds(&self, basis: CurveBasis, at: Segment, piece: Piece) -> Bounds3 {
        let span = piece.span();
        let around = |bounds: Bounds3, p: glam::DVec4| {
            let (center, radius) = (p.truncate(), p.w);
            bounds.with((center - radius).as_vec3()).with((center + radius).as_vec3())
        };
        let bounds = match basis {
            CurveBasis::Linear => {
                span.map(|at_span| self.cone(at).at(at_span)).into_iter().fold(Bounds3::EMPTY, around)
            }
            _ => {
                let Cubic(points) = self.cubic(basis, at).between(span);
                // The surface is nowhere farther from a convex combination of these points than that of their radii.
                let radius = points.iter().fold(0.0_f64, |r, p| r.max(p.w));
                points.into_iter().map(|p| p.truncate().extend(radius)).fold(Bounds3::EMPTY, around)
            }
        };
        bounds.padded()
    }

    fn cone(&self, at: Segment) -> RoundCone {
        let first = at.first();
        RoundCone::new(self.points[first], self.points[first + 1])
    }

    fn cubic(&self, basis: CurveBasis, at: Segment) -> Cubic {
        let first = at.first();
        let points = [0, 1, 2, 3].map(|i| self.points[first + i].as_dvec4());
        if basis == CurveBasis::BSpline { Cubic::from_b_spline(points) } else { Cubic(points) }
    }

    fn segment(&self, index: u32, segment: u32) -> (Record, Segment) {
        let record = self.records[index as usize];
        (record, self.segments[(record.first + segment) as usize])
    }

    /// The smallest t in (0, `t_max`) at which the ray meets a piece from outside, and where that is along its segment.
    pub fn intersect(&self, index: u32, piece: Piece, ray: &Ray) -> Option<(f32, f32)> {
        let (record, at) = self.segment(index, piece.segment());
        let (t, u) = match record.basis {
            // The whole of it: what another piece shows is met no later there.
            CurveBasis::Linear => self.meet_chain(at, ray)?,
            basis => sweep::meet(&self.cubic(basis, at), piece.span(), ray)?,
        };
        Some((t as f32, u as f32))
    }

    /// A cone of a chain, without what is inside its neighbours.
    fn meet_chain(&self, at: Segment, ray: &Ray) -> Option<(f64, f64)> {
        let shifted = |by: isize| {
            RoundCone::new(
                self.points[at.first().wrapping_add_signed(by)],
                self.points[at.first().wrapping_add_signed(by + 1)],
            )
        };
        let before = (at.0 & Segment::BEFORE != 0).then(|| shifted(-1));
        let after = (at.0 & Segment::AFTER != 0).then(|| shifted(1));
        self.cone(at).meet(ray, |p| [&before, &after].into_iter().flatten().any(|other| other.holds(p)))
    }

    /// The surface at a place along a segment, at the point closest to `near`, which lies close to it.
    pub fn located(&self, index: u32, segment: u32, u: f32, near: Vec3) -> Located {
        let (record, at) = self.segment(index, segment);
        let point = self.point(record.basis, at, u.into(), near);
        let p = point.p.as_vec3();
        let angle = point.angle();
        let along = (segment as f32 + u) / record.count as f32;
        let ng = point.normal.as_vec3();
        Located {
            p,
            p_error: 2.0 * ROUNDING * p.abs() + Vec3::splat(8.0 * ROUNDING * point.radius as f32),
            ng,
            ns: ng,
            uv: match record.uv {
                CurveUv::AroundAlong => Vec2::new(angle, along),
                CurveUv::AlongAround => Vec2::new(u, angle),
            },
        }
    }

    pub fn tangents(&self, index: u32, segment: u32, u: f32, near: Vec3) -> Tangents {
        let (record, at) = self.segment(index, segment);
        let point = self.point(record.basis, at, u.into(), near);
        let (around, along) = (point.around().as_vec3(), point.along.as_vec3());
        match record.uv {
            CurveUv::AroundAlong => Tangents { dpdu: around, dpdv: record.count as f32 * along },
            CurveUv::AlongAround => Tangents { dpdu: along, dpdv: around },
        }
    }

    fn point(&self, basis: CurveBasis, at: Segment, u: f64, near: Vec3) -> CurvePoint {
        match basis {
            CurveBasis::Linear => self.cone(at).point(u, near.as_dvec3()),
            _ => self.cubic(basis, at).point(u, near.as_dvec3()),
        }
    }

    /// Bytes of all arrays.
    pub fn memory_bytes(&self) -> usize {
        size_of_val(&self.points[..]) + size_of_val(&self.segments[..]) + size_of_val(&self.records[..])
    }
}

/// What is cut in two must have less than this of its area.
const WORTH_CUTTING: f32 = 0.75;

fn half_area(bounds: &Bounds3) -> f32 {
    let e = bounds.extent();
    e.x * e.y + e.y * e.z + e.z * e.x
}

/// A point of a surface around a curve.
struct CurvePoint {
    p: DVec3,
    radius: f64,
    /// From the curve to `p`, of length 1.
    out: DVec3,
    /// Where the curve goes, of length 1.
    axis: DVec3,
    /// On the outside, of length 1.
    normal: DVec3,
    /// Derivative of `p` along the curve.
    along: DVec3,
}

impl CurvePoint {
    /// Derivative of `p` by the angle around, of which 1 is a whole turn.
    fn around(&self) -> DVec3 {
        f64::from(TAU) * self.radius * self.axis.cross(self.out)
    }

    /// Around the curve from the direction that is perpendicular to +Z, as Mitsuba counts; a whole turn is 1.
    fn angle(&self) -> f32 {
        let up = (DVec3::Z - self.axis * self.axis.z).try_normalize().unwrap_or(DVec3::Y);
        let across = up.cross(self.axis);
        let angle = up.dot(self.out).atan2(across.dot(self.out)) as f32;
        (if angle < 0.0 { angle + TAU } else { angle }) / TAU
    }
}
