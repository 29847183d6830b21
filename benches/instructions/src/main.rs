//! A fixed set of works whose instructions `benches/instructions.py` counts.
//!
//! `bench_instructions --list` prints their names; `bench_instructions WORK` prepares one and then does it once,
//! inside [`counted`], on one thread. Nothing is timed here. Whoever counts instructions counts those between entering
//! and leaving [`counted`], so that preparation is free.
//!
//! Invariant: a work does the same each time; what changes its count is the code that it runs.

#![allow(clippy::print_stdout, reason = "the list of works is what this program is for")]

mod geometry;
mod paths;

#[path = "../../../crates/sr_geometry/tests/common/mod.rs"]
mod common;

use std::process::ExitCode;

/// Prepared work. Its result is only there to be kept.
type Work = Box<dyn FnOnce() -> f64>;

/// Prepares work.
type Prepare = fn() -> Work;

/// Every work by its name.
const WORKS: &[(&str, Prepare)] = &[
    ("load", paths::load),
    ("paths-cornell", paths::cornell),
    ("paths-materials", paths::materials),
    ("paths-mesh", paths::mesh),
    ("paths-strategy", paths::strategy),
    ("build", geometry::build),
    ("closest", geometry::closest),
    ("any", geometry::any),
    ("closest-batch", geometry::closest_batch),
    ("any-batch", geometry::any_batch),
    ("closest-box-batch", geometry::closest_box_batch),
];

fn main() -> ExitCode {
    // The main thread is the pool: instructions are counted thread by thread.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread();
    pool.build_global().expect("nothing has used the pool before");
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match arguments.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["--list"] => WORKS.iter().for_each(|(name, _)| println!("{name}")),
        [name] => match WORKS.iter().find(|(known, _)| *known == name) {
            Some((_, prepare)) => {
                std::hint::black_box(counted(prepare()));
            }
            None => return usage(),
        },
        _ => return usage(),
    }
    ExitCode::SUCCESS
}

/// Does the work. A function of its own in the compiled program: instructions are counted in it.
#[inline(never)]
fn counted(work: Work) -> f64 {
    std::hint::black_box(work())
}

fn usage() -> ExitCode {
    eprintln!("usage: bench_instructions --list | WORK");
    ExitCode::from(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn works_do_something_and_always_the_same() {
        for (name, prepare) in WORKS {
            let (first, second) = (prepare()(), prepare()());
            assert!(first.is_finite() && first > 0.0, "{name}: {first}");
            assert_eq!(first, second, "{name}");
        }
    }
}
