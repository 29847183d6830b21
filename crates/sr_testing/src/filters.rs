//! Pixel filters.

use sr_scene::FilterDesc;

/// One of each kind, as they are by default.
pub const FILTERS: [FilterDesc; 7] = [
    FilterDesc::Box { radius: 0.5 },
    FilterDesc::Tent { radius: 1.0 },
    FilterDesc::Gaussian { stddev: 0.5, radius: 2.0 },
    FilterDesc::Mitchell { b: 1.0 / 3.0, c: 1.0 / 3.0 },
    FilterDesc::CatmullRom,
    FilterDesc::Lanczos { lobes: 3 },
    FilterDesc::BlackmanHarris { radius: 1.5 },
];

/// More of them: wide and narrow ones, and cubic splines far from those that are used.
pub fn filters() -> Vec<FilterDesc> {
    let mut all: Vec<FilterDesc> = FILTERS.into();
    all.extend([
        FilterDesc::Box { radius: 3.0 },
        FilterDesc::Tent { radius: 0.2 },
        FilterDesc::Gaussian { stddev: 0.1, radius: 4.0 },
        FilterDesc::BlackmanHarris { radius: 8.0 },
    ]);
    all.extend([1, 2, 8, 32].map(|lobes| FilterDesc::Lanczos { lobes }));
    let halves = || (-4..=4).map(|k| 0.5 * k as f32);
    all.extend(halves().flat_map(|b| halves().map(move |c| FilterDesc::Mitchell { b, c })));
    all
}
