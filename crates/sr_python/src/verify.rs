//! Checks of all building blocks, on a thread of their own.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use pyo3::prelude::*;
use sr_verify::{Failure, Outcome, Row, Subject};

use crate::job::Job;

/// A case that failed, why, and the samples that were drawn and expected in each cell of the sphere.
type PlainFailure = (String, String, Option<(Vec<f64>, Vec<f64>)>);
/// Group, block, check, number of cases, least p-value, seconds of work, failures.
type PlainRow = (&'static str, String, &'static str, usize, f64, f64, Vec<PlainFailure>);
/// A block that is wrong on purpose, and the check that noticed, if one did.
type PlainFlaw = (String, Option<&'static str>);

/// Rows, the level of a test, the number of tests that chance decides; and flaws.
type Found = (Vec<PlainRow>, f64, usize, Vec<PlainFlaw>);

/// Checks that run.
#[pyclass(frozen, module = "steradian._internal")]
pub struct VerifyJob {
    job: Job<Found>,
    done: Arc<AtomicUsize>,
    cancel: Arc<AtomicBool>,
    total: usize,
}

fn select(all: Vec<Subject>, names: &[String]) -> Vec<Subject> {
    all.into_iter()
        .filter(|subject| names.is_empty() || names.iter().any(|name| subject.is_named(name)))
        .collect()
}

/// Group and name of every block, and how many cases it has.
#[pyfunction]
pub fn verify_blocks(py: Python<'_>) -> Vec<(&'static str, String, usize)> {
    let subjects = py.detach(sr_verify::subjects);
    let mut blocks: Vec<(&'static str, String, usize)> = Vec::new();
    for Subject { group, block, .. } in subjects {
        match blocks.iter_mut().find(|(known, name, _)| *known == group.name() && *name == block) {
            Some((_, _, count)) => *count += 1,
            None => blocks.push((group.name(), block, 1)),
        }
    }
    blocks
}

#[pymethods]
impl VerifyJob {
    /// Starts all checks on the blocks that have one of the names, or on all; `flaws`: and on broken ones.
    #[staticmethod]
    fn start(
        py: Python<'_>,
        names: Vec<String>,
        seed: u64,
        failure_rate: f64,
        flaws: bool,
        threads: usize,
    ) -> PyResult<Self> {
        let (right, broken) = py.detach(|| {
            let broken = if flaws { sr_verify::broken_subjects() } else { Vec::new() };
            (select(sr_verify::subjects(), &names), select(broken, &names))
        });
        let total = right.iter().chain(&broken).map(|subject| subject.checks.len()).sum();
        let (done, cancel) = (Arc::new(AtomicUsize::new(0)), Arc::new(AtomicBool::new(false)));
        let (counts, stop) = (Arc::clone(&done), Arc::clone(&cancel));
        let job = Job::start(threads, move || {
            // Side by side, so that no core waits for the last of either.
            let (Outcome { rows, level, decided_by_chance }, flaws) = rayon::join(
                || sr_verify::run(&right, seed, failure_rate, &counts, &stop),
                || sr_verify::catch(&broken, seed, &counts, &stop),
            );
            let flaws = flaws.into_iter().map(|flaw| (flaw.case, flaw.caught_by)).collect();
            Ok((rows.into_iter().map(plain).collect(), level, decided_by_chance, flaws))
        })?;
        Ok(Self { job, done, cancel, total })
    }

    /// Waits at most so long; is it done?
    fn wait(&self, py: Python<'_>, seconds: f64) -> PyResult<bool> {
        self.job.wait(py, seconds)
    }

    /// How many checks are done, of how many.
    fn progress(&self) -> (usize, usize) {
        (self.done.load(Ordering::Relaxed), self.total)
    }

    /// Leaves the remaining checks out.
    fn cancel(&self) {
        self.cancel.store(true, Ordering::Relaxed);
    }

    /// What was found, once.
    fn take(&self) -> PyResult<Found> {
        self.job.take()
    }
}

fn plain(row: Row) -> PlainRow {
    let failure = |Failure { case, what, picture }| {
        (case, what, picture.map(|picture: sr_verify::Picture| (picture.drawn, picture.expected)))
    };
    let failures = row.failures.into_iter().map(failure).collect();
    (row.group.name(), row.block, row.check, row.cases, row.least_p, row.seconds, failures)
}
