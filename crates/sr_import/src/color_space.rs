//! RGB colors of other spaces to linear sRGB.

use glam::{DMat3, DVec2, DVec3};

/// A space of linear RGB colors.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ColorSpace {
    /// IEC 61966-2-1, with the primaries of ITU-R BT.709.
    Srgb,
    /// SMPTE EG 432-1, at D65.
    DciP3,
    /// ITU-R BT.2020.
    Rec2020,
    /// SMPTE ST 2065-1.
    Aces2065,
}

impl ColorSpace {
    /// By the names that pbrt has for them.
    pub const NAMES: [(&str, ColorSpace); 4] = [
        ("srgb", ColorSpace::Srgb),
        ("dci-p3", ColorSpace::DciP3),
        ("rec2020", ColorSpace::Rec2020),
        ("aces2065-1", ColorSpace::Aces2065),
    ];

    /// The chromaticities of red, green, blue and white.
    fn primaries(self) -> [DVec2; 4] {
        let d65 = DVec2::new(0.3127, 0.3290);
        let primaries = |r: [f64; 2], g: [f64; 2], b: [f64; 2], white| [r.into(), g.into(), b.into(), white];
        match self {
            Self::Srgb => primaries([0.64, 0.33], [0.3, 0.6], [0.15, 0.06], d65),
            Self::DciP3 => primaries([0.68, 0.32], [0.265, 0.69], [0.15, 0.06], d65),
            Self::Rec2020 => primaries([0.708, 0.292], [0.17, 0.797], [0.131, 0.046], d65),
            Self::Aces2065 => {
                let d60 = DVec2::new(0.32168, 0.33767);
                primaries([0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.077], d60)
            }
        }
    }

    /// CIE XYZ from this space's colors; white has the luminance 1.
    fn xyz_from_rgb(self) -> DMat3 {
        let [r, g, b, white] = self.primaries().map(xyz_of);
        let columns = DMat3::from_cols(r, g, b);
        let scale = columns.inverse() * white;
        DMat3::from_cols(r * scale.x, g * scale.y, b * scale.z)
    }

    /// The color of a light.
    pub fn light_to_srgb(self, color: DVec3) -> DVec3 {
        match self {
            Self::Srgb => color,
            _ => Self::Srgb.xyz_from_rgb().inverse() * (self.xyz_from_rgb() * color),
        }
    }

    /// The color of a surface: white stays white, whatever light this space means by it (von Kries, with Bradford's cones).
    pub fn surface_to_srgb(self, color: DVec3) -> DVec3 {
        let cones = DMat3::from_cols(
            DVec3::new(0.8951, -0.7502, 0.0389),
            DVec3::new(0.2664, 1.7135, -0.0685),
            DVec3::new(-0.1614, 0.0367, 1.0296),
        );
        match self {
            Self::Srgb => color,
            _ => {
                let white = |space: Self| cones * xyz_of(space.primaries()[3]);
                let seen = cones * (self.xyz_from_rgb() * color);
                let adapted = cones.inverse() * (seen * white(Self::Srgb) / white(self));
                Self::Srgb.xyz_from_rgb().inverse() * adapted
            }
        }
    }
}

/// CIE XYZ of a chromaticity, at luminance 1.
pub fn xyz_of(xy: DVec2) -> DVec3 {
    DVec3::new(xy.x / xy.y, 1.0, (1.0 - xy.x - xy.y) / xy.y)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_surfaces_stay_white() {
        for (name, space) in ColorSpace::NAMES {
            let white = space.surface_to_srgb(DVec3::ONE);
            assert!((white - 1.0).abs().max_element() < 1e-9, "{name}: {white}");
        }
        let warm = ColorSpace::Aces2065.light_to_srgb(DVec3::ONE);
        assert!(warm.x > 1.0 && warm.z < 1.0, "{warm}");
    }

    /// ITU-R BT.2087, table 1, the other way round.
    #[test]
    fn rec2020_to_srgb() {
        let red = ColorSpace::Rec2020.light_to_srgb(DVec3::X);
        assert!((red - DVec3::new(1.6605, -0.1246, -0.0182)).abs().max_element() < 1e-3, "{red}");
    }
}
