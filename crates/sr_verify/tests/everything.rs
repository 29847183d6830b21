//! Everything that is right passes, and everything that is wrong is caught.

use std::sync::atomic::{AtomicBool, AtomicUsize};

use sr_verify::{Outcome, Subject, broken_subjects, catch, run, subjects};

/// The chance that a run of this file raises a false alarm, had its seed not been fixed.
const FAILURE_RATE: f64 = 1e-3;

fn outcome(subjects: &[Subject]) -> Outcome {
    run(subjects, 1, FAILURE_RATE, &AtomicUsize::new(0), &AtomicBool::new(false))
}

#[test]
fn every_block_holds() {
    let all = subjects();
    assert!(all.len() > 500, "only {} cases", all.len());
    let Outcome { rows, level, decided_by_chance } = outcome(&all);
    assert!(decided_by_chance > 1000, "only {decided_by_chance} tests");
    let failures: Vec<String> = rows
        .iter()
        .flat_map(|row| row.failures.iter().map(move |failure| (row, failure)))
        .map(|(row, failure)| {
            format!("{}/{}, {}: {}", row.group.name(), failure.case, row.check, failure.what)
        })
        .collect();
    assert!(failures.is_empty(), "{} fail at level {level:e}:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn names_tell_cases_apart() {
    let mut names: Vec<(String, Vec<&str>)> = subjects()
        .into_iter()
        .map(|s| {
            (format!("{}/{}", s.group.name(), s.case), s.checks.iter().map(|check| check.name).collect())
        })
        .collect();
    let all = names.len();
    names.sort();
    names.dedup();
    assert_eq!(names.len(), all);
}

#[test]
fn every_flaw_is_caught() {
    let all = broken_subjects();
    assert!(all.len() > 100, "only {} flaws", all.len());
    let flaws = catch(&all, 1, &AtomicUsize::new(0), &AtomicBool::new(false));
    let missed: Vec<String> =
        flaws.into_iter().filter(|flaw| flaw.caught_by.is_none()).map(|flaw| flaw.case).collect();
    assert!(missed.is_empty(), "{} of {} are not caught:\n{}", missed.len(), all.len(), missed.join("\n"));
}
