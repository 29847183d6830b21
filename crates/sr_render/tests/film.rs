//! The film: filters reconstruct what they should, and a crop is a part of the whole.

use std::f32::consts::PI;
use std::sync::atomic::AtomicBool;

use glam::{Mat4, Vec2, Vec3};
use sr_render::filter::PixelFilter;
use sr_render::{Control, Film, RenderSettings, RenderedImage, Scene, render};
use sr_sampling::SequenceKind;
use sr_scene::{CameraDesc, Crop, FilmDesc, FilterDesc, FovAxis, Projection, SceneDesc, Span};
use sr_testing::FILTERS;
use sr_testing::scenes::{diffuse_scene, polygon, shape};

/// Columns of the film, of which the first [`EDGE`] shine.
const COLUMNS: u32 = 12;
const EDGE: f32 = 5.3;

/// A shining half-plane at unit distance, one unit of length a pixel.
fn edge(filter: FilterDesc, sample_border: bool) -> SceneDesc {
    let half = 0.5 * COLUMNS as f32;
    // +X is to the left
    let facing_minus_z = [
        Vec3::new(half - EDGE, 9.0, 1.0),
        Vec3::new(99.0, 9.0, 1.0),
        Vec3::new(99.0, -9.0, 1.0),
        Vec3::new(half - EDGE, -9.0, 1.0),
    ];
    let film = FilmDesc { width: COLUMNS, height: 3, crop: None, filter, sample_border };
    let fov = 2.0 * half.atan();
    let mut desc = diffuse_scene(
        CameraDesc {
            world_from_camera: Mat4::IDENTITY,
            projection: Projection::Perspective {
                fov_axis: FovAxis::X,
                fov,
                principal_point_offset: Vec2::ZERO,
                lens: None,
            },
            near_clip: 1e-3,
            far_clip: 1e3,
            film,
            span: Span::default(),
        },
        0.0,
    );
    desc.shapes.push(shape(polygon(&facing_minus_z), Some(PI)));
    desc
}

fn rendered(desc: &SceneDesc, spp: u32) -> RenderedImage {
    let scene = Scene::compile(desc).unwrap();
    let settings =
        RenderSettings { seed: 3, sampler: SequenceKind::Independent, ..RenderSettings::from_scene(&scene) };
    let mut film = Film::new(settings.width, settings.height).unwrap();
    let cancel = AtomicBool::new(false);
    let control = Control { cancel: &cancel, deadline: None, on_pass: &|_, _| () };
    render(&scene, &settings, 0..spp, &mut film, &control).unwrap();
    assert_eq!(film.rejected_samples(), 0, "NaN or infinity");
    film.image()
}

#[test]
fn every_filter_blurs_an_edge_by_its_integral() {
    let level = sr_stats::sidak(0.01, 2 * FILTERS.len() * COLUMNS as usize);
    for filter in FILTERS {
        for sample_border in [true, false] {
            let image = rendered(&edge(filter, sample_border), 1 << 12);
            let one_axis = PixelFilter::new(filter);
            for x in 0..COLUMNS {
                let (low, high) = if sample_border { (0.0, 1.0) } else { one_axis.inside(x, COLUMNS) };
                let at_edge = one_axis.cdf(EDGE - x as f32 - 0.5).clamp(low, high);
                // ∫f up to the edge, over ∫f within the film
                let expected = match at_edge {
                    u if u <= low => 0.0,
                    u => (u - low) / one_axis.gain((low, u)) / ((high - low) / one_axis.gain((low, high))),
                };
                let at = 3 * (COLUMNS + x) as usize;
                let (value, error) = (image.rgb[at] / PI, image.stderr[at] / PI);
                // the edge itself is known to 10⁻⁵ of a pixel
                let t = (value - expected).abs() / error.max(1e-5);
                assert!(
                    sr_stats::student_beyond(t.into(), 7.0) > level,
                    "{filter:?}, column {x}: {value} ± {error}, expected {expected}"
                );
            }
        }
    }
}

#[test]
fn lobes_below_zero_ring() {
    let image = rendered(&edge(FilterDesc::Lanczos { lobes: 3 }, true), 256);
    let row = |x: usize| image.rgb[3 * (COLUMNS as usize + x)] / PI;
    let (least, most) =
        (0..COLUMNS as usize).map(row).fold((1.0f32, 0.0f32), |(a, b), v| (a.min(v), b.max(v)));
    assert!(least < -0.03 && most > 1.03, "{least} to {most}");
}

#[test]
fn a_crop_has_the_bits_of_the_whole() {
    for filter in [FILTERS[2], FILTERS[3]] {
        let whole = edge(filter, false);
        let all = rendered(&whole, 64);
        let crop = Crop { x: 3, y: 1, width: 5, height: 2 };
        let mut cut = whole;
        cut.camera.film.crop = Some(crop);
        let part = rendered(&cut, 64);
        assert_eq!((part.width, part.height), (5, 2));
        for y in 0..crop.height {
            for x in 0..crop.width {
                let at = 3 * (y * crop.width + x) as usize;
                let of_all = 3 * ((y + crop.y) * COLUMNS + x + crop.x) as usize;
                assert_eq!(part.rgb[at..at + 3], all.rgb[of_all..of_all + 3], "{x}, {y}");
                assert_eq!(part.stderr[at..at + 3], all.stderr[of_all..of_all + 3], "{x}, {y}");
            }
        }
    }
}
