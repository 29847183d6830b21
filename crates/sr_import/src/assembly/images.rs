//! Images: read in parallel once all are known, each file once.

use std::path::PathBuf;
use std::sync::Arc;

use rayon::prelude::*;
use sr_scene::{Diagnostic, Image, Pixels, Span};

use super::Assembly;
use crate::files;
use crate::images::{self, Decode};

/// An image of the scene, read or to be read.
pub(super) enum ImageSlot {
    Ready(Arc<Image>),
    File { path: PathBuf, decode: Decode, span: Span },
}

impl Assembly<'_> {
    pub(super) fn load_images(&mut self) -> Vec<Arc<Image>> {
        let limits = self.limits;
        let slots = std::mem::take(&mut self.images);
        let loaded: Vec<Result<Arc<Image>, String>> = slots
            .par_iter()
            .map(|slot| match slot {
                ImageSlot::Ready(image) => check_image(image).map(|()| image.clone()),
                ImageSlot::File { path, decode, .. } => images::load(path, *decode, &limits).map(Arc::new),
            })
            .collect();
        let mut out = Vec::with_capacity(loaded.len());
        for (slot, result) in slots.iter().zip(loaded) {
            match (result, slot) {
                (Ok(mut image), slot) => {
                    self.tame(&mut image, slot);
                    out.push(image);
                }
                (Err(reason), ImageSlot::File { path, span, .. }) => {
                    let error = files::error("file::bad-image", span, "image", path, &reason);
                    self.d.push(error);
                }
                (Err(reason), ImageSlot::Ready(image)) => {
                    let message = format!("the image \"{}\" cannot be used: {reason}", image.name);
                    self.d.push(Diagnostic::error("file::bad-image", &Span::default(), message));
                }
            }
        }
        out
    }
}

/// The largest number in an image, as in a constant color.
const BRIGHTEST: f32 = 1e18;

impl Assembly<'_> {
    /// Takes what no picture can show out of an image, and says so.
    fn tame(&mut self, image: &mut Arc<Image>, slot: &ImageSlot) {
        let Pixels::F32 { data, .. } = &image.pixels else { return };
        // NaN is in no range.
        let is_wild = |v: &f32| !(-BRIGHTEST..=BRIGHTEST).contains(v);
        let count = data.iter().filter(|v| is_wild(v)).count();
        if count == 0 {
            return;
        }
        let span = match slot {
            ImageSlot::File { span, .. } => span.clone(),
            ImageSlot::Ready(_) => Span::default(),
        };
        let message = format!("{count} values of {} are infinite, not numbers, or beyond 10¹⁸", image.name);
        self.d.push(
            Diagnostic::warning("file::bad-texels", &span, message)
                .consequence("those that are not numbers are 0, the others ±10¹⁸"),
        );
        if let Pixels::F32 { data, .. } = &mut Arc::make_mut(image).pixels {
            for v in data {
                *v = if v.is_nan() { 0.0 } else { v.clamp(-BRIGHTEST, BRIGHTEST) };
            }
        }
    }
}

/// An image that was not made here may be anything.
fn check_image(image: &Image) -> Result<(), String> {
    let (channels, len) = match &image.pixels {
        Pixels::U8 { channels, data } => (*channels, data.len()),
        Pixels::F32 { channels, data } => (*channels, data.len()),
    };
    let texels = u64::from(image.width) * u64::from(image.height);
    if ![1, 3, 4].contains(&channels) || texels == 0 || texels * u64::from(channels) != len as u64 {
        return Err(format!(
            "{len} values are not {} × {} texels of {channels} channels",
            image.width, image.height
        ));
    }
    Ok(())
}
