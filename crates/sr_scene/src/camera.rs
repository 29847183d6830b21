//! Cameras.

use glam::{Mat4, Vec2};

use crate::FilmDesc;
use crate::diagnostic::Span;

/// Where an image is taken from, and how.
///
/// In camera space the view is along +Z, +Y is up and +X is to the *left* of the image
/// (Mitsuba's convention).
#[derive(Clone, Debug)]
pub struct CameraDesc {
    /// Placement. A scale means something to orthographic cameras alone, and is removed for others.
    pub world_from_camera: Mat4,
    /// Which way the rays go.
    pub projection: Projection,
    /// Rays start at this distance: along +Z, or along the ray for [`Projection::Spherical`].
    pub near_clip: f32,
    /// Nothing farther than this is seen.
    pub far_clip: f32,
    /// The film.
    pub film: FilmDesc,
    /// Where the camera was described.
    pub span: Span,
}

/// Which way a camera's rays go.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Through a point, or through a thin lens.
    Perspective {
        /// The direction of the film along which `fov` is measured.
        fov_axis: FovAxis,
        /// The full angle of view along `fov_axis`, in radians.
        fov: f32,
        /// Offset of the principal point, in fractions of the film's width and height.
        principal_point_offset: Vec2,
        /// A pinhole if `None`.
        lens: Option<Lens>,
    },
    /// Along +Z. The film's width shows x from 1 to −1 of camera space.
    Orthographic,
    /// All around, as an environment map shows it: the width is the longitude, from −Z by way of +X, the height the
    /// angle from +Y.
    Spherical,
}

/// A thin lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lens {
    /// Radius of the aperture, or of the circle around its corners; 0 is a pinhole.
    pub aperture_radius: f32,
    /// Distance along +Z that is in focus.
    pub focus_distance: f32,
    /// Corners of the aperture; 0 is a disk.
    pub blades: u32,
    /// The angle of a corner from camera-space +X, in radians.
    pub blade_rotation: f32,
}

/// The direction of the film that an angle of view is measured along.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FovAxis {
    /// The width.
    X,
    /// The height.
    Y,
    /// The diagonal.
    Diagonal,
    /// The smaller of width and height.
    Smaller,
    /// The larger of width and height.
    Larger,
}

impl FovAxis {
    /// The full horizontal angle, in radians, of a film `aspect` = width / height whose angle along
    /// this axis is `fov`.
    pub fn horizontal(self, fov: f32, aspect: f32) -> f32 {
        let along_x = |tan_half: f32| 2.0 * tan_half.atan();
        let t = (0.5 * fov).tan();
        match self {
            FovAxis::X => fov,
            FovAxis::Y => along_x(t * aspect),
            FovAxis::Diagonal => along_x(t * aspect / (1.0 + aspect * aspect).sqrt()),
            FovAxis::Smaller if aspect >= 1.0 => along_x(t * aspect),
            FovAxis::Larger if aspect < 1.0 => along_x(t * aspect),
            FovAxis::Smaller | FovAxis::Larger => fov,
        }
    }
}
