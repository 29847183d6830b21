//! The lists of subjects. That every block holds, and that every flaw is caught, `tests/test_verify.py` asserts, with
//! optimised code: it is a minute's work there.

use sr_verify::{Subject, broken_subjects, subjects};

fn names(subjects: &[Subject]) -> Vec<String> {
    subjects
        .iter()
        .map(|subject| {
            let checks: Vec<&str> = subject.checks.iter().map(|check| check.name).collect();
            format!("{}/{} {checks:?}", subject.group.name(), subject.case)
        })
        .collect()
}

#[test]
fn names_tell_cases_apart() {
    for (subjects, at_least) in [(subjects(), 1000), (broken_subjects(), 100)] {
        assert!(subjects.len() > at_least, "only {} cases", subjects.len());
        let mut names = names(&subjects);
        names.sort();
        let all = names.len();
        names.dedup();
        assert_eq!(names.len(), all);
    }
}

/// A name chooses a group, a block, or cases; and a block has all its cases.
#[test]
fn names_choose() {
    let all = subjects();
    let named = |name: &str| all.iter().filter(|subject| subject.is_named(name)).count();
    assert!(named("bsdf") > 500 && named("light") > 50 && named("distribution") > 100);
    assert!(named("Rough Conductor") >= named("rough conductor ggx") && named("rough conductor ggx") > 10);
    assert_eq!(named("no such block"), 0);
}
