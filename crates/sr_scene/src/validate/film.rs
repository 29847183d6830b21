//! Films and pixel filters.

use super::Check;
use crate::diagnostic::{Diagnostic, Span};
use crate::{FilmDesc, FilterDesc};

/// An image of more pixels than this is an error: its accumulators alone would not fit in memory.
pub const MAX_FILM_PIXELS: u64 = 1 << 27;

/// Filters reach no farther than this.
const MAX_RADIUS: f32 = 32.0;

impl Check<'_> {
    pub(super) fn film(&mut self, film: &FilmDesc, span: &Span) {
        let (width, height) = film.image_size();
        let pixels = u64::from(width) * u64::from(height);
        if pixels == 0 || pixels > MAX_FILM_PIXELS {
            let size = format!("a film of {width} × {height} pixels");
            let limit = format!("at least 1 and at most {MAX_FILM_PIXELS} pixels are possible");
            self.found.push(Diagnostic::error("scene::film-size", span, size).hint(limit));
        }
        if let Some(crop) = film.crop {
            let fits = |first: u32, count: u32, all: u32| u64::from(first) + u64::from(count) <= all.into();
            if !(fits(crop.x, crop.width, film.width) && fits(crop.y, crop.height, film.height)) {
                let message = format!(
                    "a crop of {} × {} pixels from column {} and row {} leaves the film of {} × {}",
                    crop.width, crop.height, crop.x, crop.y, film.width, film.height
                );
                self.error("scene::crop", span, message);
            }
        }
        self.filter(&film.filter, span);
    }

    fn filter(&mut self, filter: &FilterDesc, span: &Span) {
        let radius = filter.radius();
        if !(radius > 0.0 && radius <= MAX_RADIUS) {
            let message = format!("a pixel filter of radius {radius}: (0, {MAX_RADIUS}] is possible");
            self.error("scene::filter", span, message);
        }
        match *filter {
            FilterDesc::Gaussian { stddev, .. } if !(stddev > 0.0 && stddev.is_finite()) => {
                let message = format!("a Gaussian pixel filter of standard deviation {stddev}");
                self.error("scene::filter", span, message);
            }
            // Beyond these the lobes below zero outweigh what is above.
            FilterDesc::Mitchell { b, c } if !(b.abs() <= 2.0 && c.abs() <= 2.0) => {
                let message = format!("a Mitchell filter of B = {b} and C = {c}: [-2, 2] is possible");
                self.error("scene::filter", span, message);
            }
            _ => {}
        }
    }
}
