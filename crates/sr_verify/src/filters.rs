//! Pixel filters: offsets follow the filter, and its distribution function; weights are 1 on average.

use std::sync::Arc;

use sr_render::filter::PixelFilter;
use sr_sampling::{Independent, SampleId, Sequence};
use sr_scene::FilterDesc;
use sr_stats::ks;
use sr_testing::filters;

use crate::subject::{Group, Subject, Verdict};

pub fn subjects() -> Vec<Subject> {
    filters().into_iter().map(subject).collect()
}

fn subject(desc: FilterDesc) -> Subject {
    let filter = Arc::new(PixelFilter::new(desc));
    let (forth, same, edge) = (Arc::clone(&filter), Arc::clone(&filter), Arc::clone(&filter));
    Subject::new(Group::Filter, case(desc))
        .check("cdf", move |seed| {
            let sequence = Independent::new(seed);
            let offset = |index| {
                let u = sequence.get_1d(SampleId { pixel: 0, index }, 0);
                f64::from(filter.icdf(u))
            };
            let offsets: Vec<f64> = (0..1 << 16).map(offset).collect();
            Verdict::Chance(ks(&offsets, |x| f64::from(filter.cdf(x as f32))))
        })
        .check("icdf", move |_| {
            Verdict::of((1..1000).find_map(|i| {
                let u = i as f32 / 1000.0;
                let back = forth.cdf(forth.icdf(u));
                let off = !((back - u).abs() < 1e-4);
                off.then(|| format!("cdf(icdf({u})) = {back}"))
            }))
        })
        .check("weights", move |_| weights(&same))
        .check("finite", move |_| {
            let corners = [0.0, f32::MIN_POSITIVE, 1.0 - f32::EPSILON / 2.0];
            Verdict::of(corners.into_iter().map(|u| (u, edge.icdf(u))).find_map(|(u, offset)| {
                let off = !(offset.abs() <= edge.radius());
                off.then(|| format!("icdf({u}) = {offset} is beyond the radius {}", edge.radius()))
            }))
        })
}

/// The kind, and its parameters.
fn case(desc: FilterDesc) -> String {
    let parameters = match desc {
        FilterDesc::Mitchell { b, c } => format!(", B = {b:.3}, C = {c:.3}"),
        FilterDesc::Gaussian { stddev, radius } => format!(", σ = {stddev}, radius {radius}"),
        FilterDesc::CatmullRom => String::new(),
        _ => format!(", radius {}", desc.radius()),
    };
    desc.name().to_owned() + &parameters
}

/// Weights of samples have the mean 1 in pixels amid the film and at its border.
fn weights(filter: &PixelFilter) -> Verdict {
    const SAMPLES: u32 = 4096;
    let pixels = [1, 2, 3, 5, 9, 100]
        .into_iter()
        .flat_map(|count| [0, count / 3, count / 2, count - 1].into_iter().map(move |index| (index, count)));
    Verdict::of(pixels.into_iter().find_map(|(index, count)| {
        let (low, high) = filter.inside(index, count);
        let sign = |i| filter.sign(low + (high - low) * (i as f32 + 0.5) / SAMPLES as f32);
        let gain = filter.gain((low, high));
        let mean = (0..SAMPLES).map(sign).sum::<f32>() / SAMPLES as f32 * gain;
        let off = !(gain > 0.0 && gain < 20.0 && (mean - 1.0).abs() < 0.01);
        off.then(|| format!("the weights' mean is {mean}, of ±{gain}, in pixel {index} of {count}"))
    }))
}
