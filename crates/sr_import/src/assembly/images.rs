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
        let slots = std::mem::take(&mut self.images);
        let loaded: Vec<Result<Arc<Image>, String>> = slots
            .par_iter()
            .map(|slot| match slot {
                ImageSlot::Ready(image) => check_image(image).map(|()| image.clone()),
                ImageSlot::File { path, decode, .. } => images::load(path, *decode).map(Arc::new),
            })
            .collect();
        let mut out = Vec::with_capacity(loaded.len());
        for (slot, result) in slots.iter().zip(loaded) {
            match (result, slot) {
                (Ok(image), _) => out.push(image),
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
