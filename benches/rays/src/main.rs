//! Rays per second, build times and bytes per triangle, side by side with Embree in one process.
//!
//! In: names of scenes and how often to measure. Out: lines of four fields with tabs between them, scene, quantity,
//! contender, and a value for each run with spaces between them; `benches/run.py` makes tables of them.
//!
//! | quantity | values |
//! | --- | --- |
//! | `triangles` | one: how many there are in all; instances count their group's again |
//! | `build_wall`, `build_cpu` | seconds for a build, of the clock and of all threads |
//! | `bytes_per_triangle` | one: of the tree and what is stored with it; without the mesh's own arrays |
//! | `closest`, `any` | processor nanoseconds a ray, on one thread |
//! | `differ` | one: the share of the rays whose closest hits are not at the same distance as ours |
//!
//! Embree is a shared library that `--embree` names; without it, only our own rows are printed. Contenders take turns
//! in each run, so that a machine whose speed drifts favours none.

#![allow(clippy::print_stdout, reason = "the lines are what this program is for")]

mod arguments;
mod contenders;
mod embree;
mod measure;
mod rays;
mod scenes;

#[path = "../../../crates/sr_geometry/tests/common/mod.rs"]
mod common;

use std::error::Error;
use std::process::ExitCode;

use arguments::Arguments;
use embree::Device;

fn main() -> ExitCode {
    match run() {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run() -> Result<(), Box<dyn Error>> {
    let Some(arguments) = Arguments::parse(std::env::args().skip(1))? else {
        println!("{}", arguments::HELP);
        return Ok(());
    };
    rayon::ThreadPoolBuilder::new().num_threads(arguments.threads).build_global()?;
    let device = arguments.embree.as_deref().map(|path| Device::new(path, arguments.threads)).transpose()?;
    for scene in &arguments.scenes {
        measure::scene(scene, &arguments, device.as_ref());
    }
    Ok(())
}
