//! Cameras, films and pixel filters.

use glam::{Mat4, Vec2};

use crate::diagnostic::Span;

/// A pinhole or thin-lens camera.
///
/// In camera space the view is along +Z, +Y is up and +X is to the *left* of the image
/// (Mitsuba's convention).
#[derive(Clone, Debug)]
pub struct CameraDesc {
    /// Rigid placement; a scale is removed when the scene is compiled.
    pub world_from_camera: Mat4,
    /// The direction of the film along which `fov` is measured.
    pub fov_axis: FovAxis,
    /// The full angle of view along `fov_axis`, in radians.
    pub fov: f32,
    /// Rays start at this distance along +Z.
    pub near_clip: f32,
    /// Nothing farther than this along +Z is seen.
    pub far_clip: f32,
    /// Offset of the principal point, in fractions of the film's width and height.
    pub principal_point_offset: Vec2,
    /// Radius of the lens; 0 is a pinhole.
    pub aperture_radius: f32,
    /// Distance along +Z that is in focus; used if `aperture_radius > 0`.
    pub focus_distance: f32,
    /// The film.
    pub film: FilmDesc,
    /// Where the camera was described.
    pub span: Span,
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

/// The grid of pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmDesc {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// The pixel filter.
    pub filter: FilterDesc,
    /// May a border pixel's filter gather light from outside the film? If not, the filter is cut at
    /// the border and renormalised.
    pub sample_border: bool,
}

/// A separable pixel reconstruction filter; lengths in pixels.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum FilterDesc {
    /// Constant within `radius`.
    Box {
        /// Half the width.
        radius: f32,
    },
    /// Falls linearly to 0 at `radius`.
    Tent {
        /// Half the width.
        radius: f32,
    },
    /// A Gaussian, lowered to be 0 at `radius`.
    Gaussian {
        /// Standard deviation.
        stddev: f32,
        /// Where it is cut.
        radius: f32,
    },
}
