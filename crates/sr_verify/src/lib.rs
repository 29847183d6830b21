//! Every check on every building block.
//!
//! In: nothing, or names. Out: for each block and check, how many cases there were and which of them fail, and why. It is
//! what `steradian verify` prints, and what `tests/` asserts.
//!
//! - [`Subject`]: a block with certain parameters, and the checks that apply to it. [`subjects`] is all of them: scattering
//!   models, lights, distributions, pixel filters, weights of multiple importance sampling, scenes with known answers.
//! - [`Check`], [`Verdict`]: a check, and what it found. Chance decides some of them: these are judged together, at one
//!   failure rate for the whole run.
//! - [`broken_subjects`]: blocks that are wrong on purpose. Each must fail at least one check.
//! - [`run`]: runs subjects on all cores, and adds up [`Row`]s. [`catch`]: the first check that notices a flaw.

mod broken;
mod bsdf_checks;
mod bsdfs;
mod densities;
mod directions;
mod filters;
mod lights;
mod picture;
mod run;
mod scenes;
mod subject;
mod warps;
mod weights;

pub use broken::broken_subjects;
pub use picture::Picture;
pub use run::{Failure, Flaw, Outcome, Row, catch, run};
pub use subject::{Check, Group, Subject, Verdict};

/// All blocks, with all their parameters.
pub fn subjects() -> Vec<Subject> {
    let mut all = bsdfs::subjects();
    all.extend(lights::subjects());
    all.extend(warps::subjects());
    all.extend(densities::subjects());
    all.extend(filters::subjects());
    all.extend(weights::subjects());
    all.extend(scenes::subjects());
    all
}
