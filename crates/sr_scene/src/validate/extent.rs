//! How large things are, and how far away: within what single precision can square.

use glam::{Mat3, Vec3};

use super::Check;
use crate::diagnostic::Span;
use crate::{Geometry, InstanceDesc, ShapeDesc};

/// Nothing is farther from the origin than this, or larger: its square, and sums of many, are still numbers.
pub(super) const FARTHEST: f64 = 1e15;
/// Nothing is smaller than this: an area is still above zero.
const SMALLEST: f64 = 1e-15;

/// How far something reaches.
#[derive(Clone, Copy)]
struct Extent {
    /// The largest coordinate, without its sign.
    reach: f64,
    /// How large it is, up to a factor: the longest side of the box around it, a radius.
    size: f64,
}

impl Extent {
    const NOTHING: Extent = Extent { reach: 0.0, size: 0.0 };

    fn of_points(points: impl IntoIterator<Item = Vec3>) -> Self {
        let mut points = points.into_iter();
        let Some(first) = points.next() else { return Self::NOTHING };
        let (low, high) = points.fold((first, first), |(low, high), p| (low.min(p), high.max(p)));
        let reach = low.abs().max(high.abs()).max_element();
        Self { reach: reach.into(), size: (high.as_dvec3() - low.as_dvec3()).max_element() }
    }

    fn of(geometry: &Geometry) -> Self {
        let around =
            |center: Vec3, size: f64| Self { reach: f64::from(center.abs().max_element()) + size, size };
        match geometry {
            Geometry::Mesh(mesh) => Self::of_points(mesh.positions.iter().copied()),
            Geometry::Sphere { center, radius, .. } => around(*center, (*radius).into()),
            Geometry::Disk { center, u_axis, v_axis, .. } => {
                around(*center, u_axis.as_dvec3().length().max(v_axis.as_dvec3().length()))
            }
            Geometry::Cylinder { base, radius, length, .. } => around(*base, (radius + length).into()),
            Geometry::Patch { corners, .. } => Self::of_points(*corners),
            Geometry::Curves(curves) => {
                Self::of_points(curves.points.iter().flat_map(|p| [p.truncate() - p.w, p.truncate() + p.w]))
            }
        }
    }

    fn and(self, other: Self) -> Self {
        Self { reach: self.reach.max(other.reach), size: self.size.max(other.size) }
    }
}

impl Check<'_> {
    /// How far a shape reaches, which is finite.
    pub(super) fn extent(&mut self, shape: &ShapeDesc) {
        let extent = Extent::of(&shape.geometry);
        if extent.size > 0.0 {
            self.extent_fits(extent, "the shape", &shape.span);
        }
    }

    fn extent_fits(&mut self, Extent { reach, size }: Extent, what: &str, span: &Span) {
        if reach > FARTHEST {
            let message =
                format!("{what} reaches to {reach:.2e}; coordinates up to {FARTHEST:e} are possible");
            self.error("scene::extent", span, message);
        } else if size < SMALLEST {
            let message = format!("{what} is {size:.2e} across; {SMALLEST:e} and more can be seen");
            self.error("scene::extent", span, message);
        }
    }

    /// Placements of groups: ids, transforms, and how far what is placed reaches.
    pub(super) fn instances(&mut self) {
        let groups = &self.scene.groups;
        let extents: Vec<Extent> = groups
            .iter()
            .map(|group| {
                let shapes = group.shapes.iter().map(|shape| Extent::of(&shape.geometry));
                shapes.fold(Extent::NOTHING, Extent::and)
            })
            .collect();
        for InstanceDesc { group, world_from_group: m, span } in &self.scene.instances {
            let Some(extent) = extents.get(*group as usize) else {
                self.error("scene::bad-id", span, format!("there is no group {group}"));
                continue;
            };
            let linear = Mat3::from(m.matrix3).as_dmat3();
            let determinant = linear.determinant();
            if !(m.is_finite() && determinant.is_finite() && determinant != 0.0) {
                self.error("scene::bad-transform", span, "the placement of an instance is not invertible");
                continue;
            }
            let lengths = [linear.x_axis, linear.y_axis, linear.z_axis].map(glam::DVec3::length);
            let longest = lengths.into_iter().fold(0.0, f64::max);
            let shift = f64::from(m.translation.abs().max_element());
            let placed = Extent { reach: shift + longest * extent.reach, size: longest * extent.size };
            if extent.size > 0.0 {
                self.extent_fits(placed, "the instance", span);
            }
            let shortest = lengths.into_iter().fold(f64::INFINITY, f64::min);
            if longest > FARTHEST || shortest < SMALLEST {
                let message = format!(
                    "an instance scaled by {shortest:.2e} to {longest:.2e}: {SMALLEST:e} to {FARTHEST:e} is possible"
                );
                self.error("scene::extent", span, message);
            }
        }
    }
}
