//! Pixel filters: offsets follow the filter, and its distribution function.

use std::sync::Arc;

use sr_render::filter::PixelFilter;
use sr_sampling::{Independent, SampleId, Sequence};
use sr_scene::FilterDesc;
use sr_stats::ks;

use crate::subject::{Group, Subject, Verdict};

pub fn subjects() -> Vec<Subject> {
    let each = |(name, desc): (&str, FilterDesc)| {
        let filter = Arc::new(PixelFilter::new(desc));
        let same = Arc::clone(&filter);
        Subject::new(Group::Filter, name)
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
                    let back = same.cdf(same.icdf(u));
                    let off = !((back - u).abs() < 1e-4);
                    off.then(|| format!("cdf(icdf({u})) = {back}"))
                }))
            })
    };
    [
        ("box", FilterDesc::Box { radius: 0.5 }),
        ("box, wide", FilterDesc::Box { radius: 3.0 }),
        ("tent", FilterDesc::Tent { radius: 1.0 }),
        ("gaussian", FilterDesc::Gaussian { stddev: 0.5, radius: 2.0 }),
        ("gaussian, narrow", FilterDesc::Gaussian { stddev: 0.1, radius: 4.0 }),
    ]
    .map(each)
    .into()
}
