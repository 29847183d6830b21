//! Hits against brute force in `f64`.

mod common;

use common::{Random, check_against_brute_force, closed_box, meet_batch, meet_both, soup};
use glam::Vec3;
use sr_geometry::Ray;

#[test]
fn random_triangles() {
    let mut random = Random(1);
    for count in [1, 2, 7, 8, 9, 20, 64, 100, 1000, 5000] {
        for size in [0.02, 0.3, 2.0] {
            let geometry = soup(&mut random, count, size).build();
            let mut hits = 0;
            for _ in 0..500 {
                let ray = Ray::new(1.5 * random.cube(), random.direction());
                for (hit, occluded) in meet_both(&geometry, &ray) {
                    hits += u32::from(hit.is_some());
                    assert_eq!(occluded, hit.is_some());
                    check_against_brute_force(&geometry, &ray, hit, 1e-3);
                }
                if let Some(hit) = geometry.intersect(&ray) {
                    assert!(!geometry.occluded(&Ray { t_max: hit.t, ..ray }), "{ray:?} {hit:?}");
                    let (before, after) = (hit.t * (1.0 - 1e-3) - 1e-4, hit.t * (1.0 + 1e-3) + 1e-4);
                    let rays = [before, after].map(|t_max| Ray { t_max, ..ray });
                    let [before, after] = meet_batch(&geometry, &rays)[..] else { unreachable!() };
                    assert_eq!((before, after.1), ((None, false), true), "{ray:?} {hit:?}");
                    assert!(after.0.is_some());
                }
            }
            assert!(hits > 0 || count < 1000, "nothing was hit");
        }
    }
}

#[test]
fn rays_along_the_axes_of_a_box() {
    let mut random = Random(2);
    for n in [1, 2, 5] {
        let geometry = closed_box(n).build();
        for _ in 0..2000 {
            let mut direction = Vec3::splat(if random.bits() & 1 == 0 { 0.0 } else { -0.0 });
            direction[random.below(3)] = if random.bits() & 1 == 0 { 1.0 } else { -1.0 };
            let ray = Ray::new(0.999 * random.cube(), direction);
            for (hit, _) in meet_both(&geometry, &ray) {
                let hit = hit.expect("the box is closed");
                check_against_brute_force(&geometry, &ray, Some(hit), 1e-4);
            }
        }
    }
}
