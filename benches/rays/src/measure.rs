//! The measurements of a scene, contenders in turn.

use std::time::Instant;

use cpu_time::{ProcessTime, ThreadTime};
use sr_geometry::Geometry;

use crate::arguments::{Arguments, SceneName};
use crate::contenders::{Batches, Contender, EmbreePackets, EmbreeSingle, Single};
use crate::embree::{Build, Device, EmbreeScene, PaddedVertices};
use crate::rays::TimedRays;
use crate::scenes::Scene;

/// Embree's ways of building, as the output names them.
const EMBREE_BUILDS: [(&str, Build); 3] = [
    ("embree", Build { robust: false, high_quality: false }),
    ("embree-robust", Build { robust: true, high_quality: false }),
    ("embree-high", Build { robust: false, high_quality: true }),
];

/// Distances that differ by more, relatively, count as different hits.
const SAME_DISTANCE: f32 = 1e-3;

/// Prints all quantities of a scene.
pub fn scene(name: &SceneName, arguments: &Arguments, device: Option<&Device>) {
    let scene = Scene::new(name);
    let vertices = PaddedVertices::new(&scene);
    let print = |quantity: &str, who: &str, values: &[f64]| {
        let values: Vec<String> = values.iter().map(|x| format!("{x:.6e}")).collect();
        println!("{name}\t{quantity}\t{who}\t{}", values.join(" "));
    };
    print("triangles", "scene", &[scene.triangles() as f64]);

    let mut times = BuildTimes::default();
    let (mut ours, mut theirs): (Option<Geometry>, Vec<EmbreeScene<'_>>) = (None, Vec::new());
    for _ in 0..arguments.runs {
        drop(ours.take());
        theirs.clear();
        ours = Some(times.add("steradian", || scene.build()));
        for (who, how) in EMBREE_BUILDS {
            if let Some(device) = device {
                let before = device.bytes();
                theirs.push(times.add(who, || device.build(&scene, &vertices, how)));
                times.bytes(who, device.bytes() - before);
            }
        }
    }
    let geometry = ours.expect("the command line asks for at least one run");
    times.bytes("steradian", (geometry.memory_bytes() - scene.mesh_bytes()) as isize);
    for (who, wall, cpu, bytes) in &times.rows {
        print("build_wall", who, wall);
        print("build_cpu", who, cpu);
        print("bytes_per_triangle", who, &[*bytes as f64 / scene.stored_triangles() as f64]);
    }

    let rays = TimedRays::new(name, &scene, &geometry, arguments.rays);
    let mut contenders: Vec<Box<dyn Contender + '_>> =
        vec![Box::new(Single(&geometry)), Box::new(Batches::new(&geometry))];
    for ((name, _), scene) in EMBREE_BUILDS.iter().zip(&theirs) {
        contenders.push(Box::new(EmbreeSingle { name, scene }));
    }
    if let Some(scene) = theirs.first() {
        contenders.push(Box::new(EmbreePackets(scene)));
    }
    race(&mut contenders, &rays, arguments.runs, print);
}

/// Seconds and bytes of every builder.
#[derive(Default)]
struct BuildTimes {
    /// Name, wall clock, processor time, bytes.
    rows: Vec<(&'static str, Vec<f64>, Vec<f64>, isize)>,
}

impl BuildTimes {
    fn add<T>(&mut self, who: &'static str, build: impl FnOnce() -> T) -> T {
        let (wall, cpu) = (Instant::now(), ProcessTime::now());
        let built = build();
        let (wall, cpu) = (wall.elapsed().as_secs_f64(), cpu.elapsed().as_secs_f64());
        let row = self.row(who);
        row.1.push(wall);
        row.2.push(cpu);
        built
    }

    fn bytes(&mut self, who: &'static str, bytes: isize) {
        self.row(who).3 = bytes;
    }

    fn row(&mut self, who: &'static str) -> &mut (&'static str, Vec<f64>, Vec<f64>, isize) {
        let known = self.rows.iter().position(|row| row.0 == who);
        let at = known.unwrap_or_else(|| {
            self.rows.push((who, Vec::new(), Vec::new(), 0));
            self.rows.len() - 1
        });
        &mut self.rows[at]
    }
}

/// Each contender meets all rays, in turn, after one round that is not counted.
fn race(
    contenders: &mut [Box<dyn Contender + '_>],
    rays: &TimedRays,
    runs: usize,
    print: impl Fn(&str, &str, &[f64]),
) {
    let mut closest = vec![Vec::new(); contenders.len()];
    let mut any = closest.clone();
    let mut distances = vec![vec![0.0f32; rays.closest.len()]; contenders.len()];
    for run in 0..=runs {
        for (i, contender) in contenders.iter_mut().enumerate() {
            let start = ThreadTime::now();
            contender.closest(&rays.closest, &mut distances[i]);
            let closest_seconds = start.elapsed().as_secs_f64();
            let start = ThreadTime::now();
            std::hint::black_box(contender.any(&rays.any));
            let any_seconds = start.elapsed().as_secs_f64();
            if run > 0 {
                closest[i].push(1e9 * closest_seconds / rays.closest.len() as f64);
                any[i].push(1e9 * any_seconds / rays.any.len() as f64);
            }
        }
    }
    for (i, contender) in contenders.iter().enumerate() {
        print("closest", contender.name(), &closest[i]);
        print("any", contender.name(), &any[i]);
        print("differ", contender.name(), &[differing(&distances[0], &distances[i])]);
    }
}

/// The share of distances that are not the same.
fn differing(a: &[f32], b: &[f32]) -> f64 {
    let same = |(&a, &b): (&f32, &f32)| a == b || (a - b).abs() <= SAME_DISTANCE * a.abs().min(b.abs());
    1.0 - a.iter().zip(b).filter(|&pair| same(pair)).count() as f64 / a.len() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn hits_differ_by_distance() {
        let none = f32::INFINITY;
        assert_eq!(differing(&[1.0, none, 2.0, 1.0], &[1.0001, none, none, 2.0]), 0.5);
    }
}
