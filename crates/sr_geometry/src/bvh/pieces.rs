//! Few triangles, disks and spheres, made ready for packets of rays.
//!
//! In: primitives. Out: [`Pieces`], a parallelogram wherever two triangles make one, and what is left.
//! Most walls and blocks are parallelograms, which cost a ray no more than a triangle each, and less where they are
//! perpendicular to an axis. `packet` meets them.

use glam::{DVec3, Vec3};

use super::packet::Ball;
use super::{PrimRef, Round};
use crate::offset::ROUNDING;
use crate::{Bounds3, Disk, ShapeId};

/// How far the fourth corner of a parallelogram may be from where the others put it, in parts of the edges: rounding.
const CROOKED: f64 = 4.0 * ROUNDING as f64;

/// What a flat piece is: [`DISK`], [`TRIANGLE`], [`PARALLELOGRAM`], or a parallelogram that is perpendicular to axis 0, 1,
/// 2.
pub(super) type Kind = usize;
pub(super) const PARALLELOGRAM: Kind = 3;
pub(super) const TRIANGLE: Kind = 4;
pub(super) const DISK: Kind = 5;
const KINDS: usize = 6;

/// Words of a half.
pub(super) const HALF: usize = 4;

/// The triangle p0, p1, p2 or the parallelogram p0, p1, p3, p2, with edges e1 = p1 − p0 and e2 = p2 − p0; or the disk
/// around p0 with half-axes e1 and e2.
///
/// Edges and normal are multiplied by the power of two that brings the normal's largest component into [1, 2), which
/// is exact and changes no ratio: products of products neither overflow nor vanish. Those that are perpendicular to an
/// axis are divided by the normal's only component, which is then 1.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// p0.
    pub corner: [f32; 3],
    /// e1 × e2.
    pub normal: [f32; 3],
    /// −e2 and e1: a quarter turn from where coordinates along e1 and along e2 grow.
    pub across: [[f32; 3]; 2],
    /// How wrong areas may be, see `packet`.
    pub slack: f32,
    /// Where its halves begin in [`Pieces::halves`], a whole number.
    pub halves: f32,
}

/// The pieces of a tree.
#[derive(Debug)]
pub(super) struct Pieces {
    /// By [`Kind`].
    pub kinds: [Vec<Piece>; KINDS],
    pub balls: Vec<Ball>,
    /// Two of [`HALF`] words for each piece: the triangle with corner p0 and that with p3, or a triangle, disk or sphere
    /// twice. Words: shape, primitive, and which weights barycentric coordinates 1 and 2 are, as bits of the numbers 0,
    /// 1, 2: the weight of p0 (p3), of p1 (p2), of p2 (p1).
    pub halves: Vec<u32>,
    /// Where the halves of disks begin, and where those of spheres do.
    pub first_disk: f32,
    pub first_ball: f32,
    /// The box around all that is flat, or around the spheres if nothing is.
    pub bounds: Bounds3,
    /// How wrong heights over planes may be, see `packet`.
    pub near: f32,
    /// The largest slack, at least 1.
    pub slack: f32,
    /// The largest component of a ray's direction is at least the first and at most the second, as are distances.
    pub lengths: [f32; 2],
}

/// Between these, sizes of rays leave room for products: neither overflows, and what vanishes is less than any slack.
const LENGTHS: [f32; 2] = [1e-30, 1e30];
/// [`LENGTHS`] where squares are multiplied, for disks and spheres.
const ROUND_LENGTHS: [f32; 2] = [1e-8, 1e8];

/// A triangle, and the order in which its vertices are corners of a piece.
#[derive(Clone, Copy)]
struct Half<'a> {
    prim: &'a PrimRef,
    vertices: &'a [Vec3; 3],
    order: [usize; 3],
}

/// A flat piece in `f64`: p0, e1, e2, how far p3 is from p0 + e1 + e2, and e1 × e2.
struct Flat {
    corner: DVec3,
    edges: [DVec3; 2],
    off: DVec3,
    normal: DVec3,
}

impl Pieces {
    /// `round_of` tells what those are that are no triangles. `None`: some are too long, thin, small or large for `f32`.
    pub fn new<'a>(
        prims: &[PrimRef],
        vertices_of: impl Fn(ShapeId, u32) -> [Vec3; 3],
        round_of: impl Fn(u32) -> Option<Round<'a>>,
    ) -> Option<Self> {
        let (triangles, others): (Vec<&PrimRef>, Vec<&PrimRef>) = prims.iter().partition(|p| p.is_triangle());
        let (mut disks, mut spheres) = (Vec::new(), Vec::new());
        let mut flat = triangles.iter().fold(Bounds3::EMPTY, |bounds, p| bounds.union(p.bounds()));
        for other in others {
            match round_of(other.primitive())? {
                Round::Sphere(shape, sphere) => spheres.push((shape, sphere)),
                Round::Disk(shape, disk) => {
                    disks.push((shape, disk));
                    flat = flat.union(other.bounds());
                }
            }
        }
        let all = || prims.iter().fold(Bounds3::EMPTY, |bounds, p| bounds.union(p.bounds()));
        let mut pieces = Self {
            kinds: [const { Vec::new() }; KINDS],
            balls: Vec::new(),
            halves: Vec::new(),
            first_disk: 0.0,
            first_ball: 0.0,
            bounds: if flat.is_empty() { all() } else { flat },
            near: 0.0,
            slack: 1.0,
            lengths: if disks.is_empty() && spheres.is_empty() { LENGTHS } else { ROUND_LENGTHS },
        };
        pieces.push_triangles(&triangles, vertices_of)?;
        pieces.first_disk = pieces.halves.len() as f32;
        for (shape, disk) in disks {
            let halves = pieces.push_round(shape);
            pieces.push(DISK, &Flat::of_disk(disk), halves)?;
        }
        pieces.first_ball = pieces.halves.len() as f32;
        for (shape, sphere) in spheres {
            let halves = pieces.push_round(shape);
            pieces.balls.push(Ball::new(sphere, halves)?);
        }
        Some(pieces)
    }

    /// Adds triangles. `None`: some do not fit.
    fn push_triangles(
        &mut self,
        prims: &[&PrimRef],
        vertices_of: impl Fn(ShapeId, u32) -> [Vec3; 3],
    ) -> Option<()> {
        let vertices: Vec<_> = prims.iter().map(|p| vertices_of(ShapeId(p.shape()), p.primitive())).collect();
        let half = |i: usize, order: [usize; 3]| Half { prim: prims[i], vertices: &vertices[i], order };
        let mut taken = vec![false; prims.len()];
        for i in 0..prims.len() {
            if taken[i] {
                continue;
            }
            let other = (i + 1..prims.len())
                .filter(|&j| !taken[j])
                .find_map(|j| parallelogram(&vertices[i], &vertices[j]).map(|(of_i, of_j)| (j, of_i, of_j)));
            let (first, second) = match other {
                Some((j, of_i, of_j)) => (half(i, of_i), Some(half(j, of_j))),
                None => (half(i, [0, 1, 2]), None),
            };
            if let Some((j, ..)) = other {
                taken[j] = true;
            }
            let flat = Flat::of_triangles(first, second);
            let kind = match flat.axis() {
                _ if second.is_none() => TRIANGLE,
                Some(axis) => axis,
                None => PARALLELOGRAM,
            };
            let halves = self.push_halves([first.words(), second.unwrap_or(first).words()]);
            self.push(kind, &flat, halves)?;
        }
        Some(())
    }

    /// Adds what a disk or a sphere has instead of halves.
    fn push_round(&mut self, shape: ShapeId) -> f32 {
        self.push_halves([[shape.0, 0, 0, 0]; 2])
    }

    fn push_halves(&mut self, halves: [[u32; HALF]; 2]) -> f32 {
        let first = self.halves.len() as f32;
        self.halves.extend(halves.as_flattened());
        first
    }

    /// Adds a piece. `None`: it does not fit.
    fn push(&mut self, kind: Kind, &Flat { corner, edges, off, normal }: &Flat, halves: f32) -> Option<()> {
        let scale = if kind < PARALLELOGRAM {
            1.0 / normal[kind]
        } else {
            // From the exponent: a logarithm may round differently elsewhere.
            let exponent = (normal.abs().max_element().to_bits() >> 52) as i32 - 1023;
            2f64.powi(-exponent)
        };
        let [e1, e2, off, normal] = [edges[0], edges[1], off, normal].map(|v| scale * v);
        let (extent, unit) = (f64::from(self.bounds.extent().max_element()), f64::from(ROUNDING));
        let edges = 24.0 * unit * (length_1(e1) + length_1(e2));
        let slack = (edges + 24.0 * unit * length_1(normal) / extent + 8.0 * length_1(off)) as f32;
        let near = (8.0 * unit * length_1(normal) + 2.0 * normal.dot(off).abs() / extent) as f32;
        self.near = self.near.max(near);
        self.slack = self.slack.max(slack);
        let [corner, normal, back, along] = [corner, normal, -e2, e1].map(|v| v.as_vec3().to_array());
        let fits = [normal, back, along].iter().flatten().all(|x| x.is_finite()) && slack.is_finite();
        self.kinds[kind].push(Piece { corner, normal, across: [back, along], slack, halves });
        fits.then_some(())
    }

    /// Bytes.
    pub fn memory_bytes(&self) -> usize {
        self.kinds.iter().map(|pieces| size_of_val(&pieces[..])).sum::<usize>()
            + size_of_val(&self.balls[..])
            + size_of_val(&self.halves[..])
    }
}

impl Flat {
    fn of_triangles(first: Half<'_>, second: Option<Half<'_>>) -> Self {
        let [corner, e1, e2] = first.edges();
        let off = second.map_or(DVec3::ZERO, |second| second.corner(0) - (corner + e1 + e2));
        Self { corner, edges: [e1, e2], off, normal: e1.cross(e2) }
    }

    /// The half-axes need not be quite perpendicular: these edges give the coordinates that [`Disk::intersect`] does.
    fn of_disk(disk: &Disk) -> Self {
        let [corner, u, v] = [disk.center, disk.u_axis, disk.v_axis].map(|v| v.as_dvec3());
        let normal = u.cross(v);
        let edges = [v.cross(normal) / v.length_squared(), normal.cross(u) / u.length_squared()];
        Self { corner, edges, off: DVec3::ZERO, normal }
    }

    /// The axis that is perpendicular to the piece, if one is.
    fn axis(&self) -> Option<usize> {
        (0..3).find(|&axis| self.edges[0][axis] == 0.0 && self.edges[1][axis] == 0.0)
    }
}

impl Half<'_> {
    fn corner(&self, i: usize) -> DVec3 {
        self.vertices[self.order[i]].as_dvec3()
    }

    /// The first corner, and the edges from there.
    fn edges(&self) -> [DVec3; 3] {
        let corner = self.corner(0);
        [corner, self.corner(1) - corner, self.corner(2) - corner]
    }

    fn words(&self) -> [u32; HALF] {
        let weight = |vertex: usize| {
            let [_, second, third] = self.order.map(|v| f32::from(u8::from(v == vertex)));
            (second + 2.0 * third).to_bits()
        };
        [self.prim.shape(), self.prim.primitive(), weight(1), weight(2)]
    }
}

/// Sum of the components' sizes.
fn length_1(v: DVec3) -> f64 {
    v.abs().element_sum()
}

/// Whether two triangles make a parallelogram: the orders in which their vertices are p0, p1, p2 and p3, p2, p1.
fn parallelogram(a: &[Vec3; 3], b: &[Vec3; 3]) -> Option<([usize; 3], [usize; 3])> {
    [[0, 1, 2], [1, 2, 0], [2, 0, 1]].into_iter().find_map(|order| {
        let [p0, p1, p2] = order.map(|i| a[i]);
        let of_b = |p: Vec3| b.iter().position(|&q| q == p);
        let (i1, i2) = (of_b(p1)?, of_b(p2)?);
        // Neither has two equal vertices: they have areas.
        let i3 = 3 - i1 - i2;
        let [p0, p1, p2, p3] = [p0, p1, p2, b[i3]].map(|p| p.as_dvec3());
        let (e1, e2) = (p1 - p0, p2 - p0);
        let off = length_1(p3 - (p0 + e1 + e2));
        (off <= CROOKED * (length_1(e1) + length_1(e2))).then_some((order, [i3, i2, i1]))
    })
}
