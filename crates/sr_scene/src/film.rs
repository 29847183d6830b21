//! Films and pixel filters.

/// The grid of pixels.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmDesc {
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
    /// The part that is rendered; all of it if `None`.
    pub crop: Option<Crop>,
    /// The pixel filter.
    pub filter: FilterDesc,
    /// May a border pixel's filter gather light from outside the film? If not, the filter is cut at
    /// the border and renormalised.
    pub sample_border: bool,
}

/// A rectangle of a film's pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Crop {
    /// Its first column.
    pub x: u32,
    /// Its first row.
    pub y: u32,
    /// Pixels across.
    pub width: u32,
    /// Pixels down.
    pub height: u32,
}

/// An image as a part of a film.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FilmWindow {
    /// Pixels across and down the whole film.
    pub film: (u32, u32),
    /// The film's column and row of the image's first pixel.
    pub origin: (u32, u32),
}

impl FilmDesc {
    /// Pixels across and down the image: those of the crop, if there is one.
    pub fn image_size(&self) -> (u32, u32) {
        self.crop.map_or((self.width, self.height), |crop| (crop.width, crop.height))
    }

    /// Where an image of `width` × `height` pixels lies in the film, which grows or shrinks with the image: it shows
    /// the same, but for roundings to whole pixels, at any size.
    pub fn window(&self, width: u32, height: u32) -> FilmWindow {
        let Some(crop) = self.crop else { return FilmWindow { film: (width, height), origin: (0, 0) } };
        let along = |film: u32, first: u32, crop: u32, image: u32| {
            let scaled =
                |n: u32| (u64::from(n) * u64::from(image) + u64::from(crop) / 2) / u64::from(crop).max(1);
            let clamped = |n: u64| u32::try_from(n).unwrap_or(u32::MAX);
            let film = clamped(scaled(film)).max(image);
            (film, clamped(scaled(first)).min(film - image))
        };
        let (across, x) = along(self.width, crop.x, crop.width, width);
        let (down, y) = along(self.height, crop.y, crop.height, height);
        FilmWindow { film: (across, down), origin: (x, y) }
    }
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
    /// The cubic splines of Mitchell & Netravali 1988, of radius 2.
    Mitchell {
        /// How blurred.
        b: f32,
        /// How much it rings; B + 2 C = 1 is recommended.
        c: f32,
    },
    /// The interpolating spline of Catmull & Rom 1974: Mitchell & Netravali's with B = 0 and C = ½.
    CatmullRom,
    /// sinc(x) sinc(x / `lobes`), of radius `lobes`.
    Lanczos {
        /// How many zeros it has on each side.
        lobes: u32,
    },
    /// The four-term window of Blackman and Harris (Harris 1978).
    BlackmanHarris {
        /// Half the width.
        radius: f32,
    },
}

impl FilterDesc {
    /// What scene files call it.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Box { .. } => "box",
            Self::Tent { .. } => "tent",
            Self::Gaussian { .. } => "gaussian",
            Self::Mitchell { .. } => "mitchell",
            Self::CatmullRom => "catmullrom",
            Self::Lanczos { .. } => "lanczos",
            Self::BlackmanHarris { .. } => "blackmanharris",
        }
    }

    /// Half the width, in pixels.
    pub fn radius(&self) -> f32 {
        match *self {
            Self::Box { radius }
            | Self::Tent { radius }
            | Self::Gaussian { radius, .. }
            | Self::BlackmanHarris { radius } => radius,
            Self::Mitchell { .. } | Self::CatmullRom => 2.0,
            Self::Lanczos { lobes } => lobes as f32,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn film(crop: Option<Crop>) -> FilmDesc {
        FilmDesc {
            width: 100,
            height: 50,
            crop,
            filter: FilterDesc::Box { radius: 0.5 },
            sample_border: false,
        }
    }

    #[test]
    fn a_crop_shows_the_same_at_any_size() {
        let film = film(Some(Crop { x: 60, y: 10, width: 40, height: 20 }));
        assert_eq!(film.image_size(), (40, 20));
        assert_eq!(film.window(40, 20), FilmWindow { film: (100, 50), origin: (60, 10) });
        assert_eq!(film.window(80, 40), FilmWindow { film: (200, 100), origin: (120, 20) });
        // to whole pixels, and never beyond the film
        assert_eq!(film.window(1, 1), FilmWindow { film: (3, 3), origin: (2, 1) });
        let window = film.window(u32::MAX, 1);
        assert_eq!(window.film.0 - window.origin.0, u32::MAX);
    }

    #[test]
    fn without_a_crop_the_image_is_the_film() {
        assert_eq!(film(None).image_size(), (100, 50));
        assert_eq!(film(None).window(7, 9), FilmWindow { film: (7, 9), origin: (0, 0) });
    }
}
