//! Running checks on all cores, and adding up what they found.

use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

use rayon::prelude::*;
use sr_stats::sidak;

use crate::picture::Picture;
use crate::subject::{Group, Subject, Verdict};

/// A case that failed a check.
#[derive(Clone, Debug)]
pub struct Failure {
    /// The block and its parameters.
    pub case: String,
    /// What is wrong.
    pub what: String,
    /// Its samples and its density, if it is one of directions, and one of the first to fail.
    pub picture: Option<Picture>,
}

/// A check on all cases of a block.
#[derive(Clone, Debug)]
pub struct Row {
    /// What kind of block it is.
    pub group: Group,
    /// The block.
    pub block: String,
    /// The check.
    pub check: &'static str,
    /// How many cases there are.
    pub cases: usize,
    /// Those that fail.
    pub failures: Vec<Failure>,
    /// The smallest p-value, of checks that chance decides; 1 for others.
    pub least_p: f64,
    /// Seconds of work, of one core.
    pub seconds: f64,
}

/// What a run found.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// Sorted by group and block; checks in their order.
    pub rows: Vec<Row>,
    /// A p-value below this fails.
    pub level: f64,
    /// How many checks chance decided.
    pub decided_by_chance: usize,
}

impl Outcome {
    /// Did nothing fail?
    pub fn holds(&self) -> bool {
        self.rows.iter().all(|row| row.failures.is_empty())
    }
}

/// One check of one case, done.
struct Done<'a> {
    subject: &'a Subject,
    check: usize,
    verdict: Verdict,
    seconds: f64,
}

/// So many failures of a check are drawn; more would look the same.
const PICTURES: usize = 3;

/// Runs all checks, on rayon's current pool.
///
/// - `seed`: of all numbers; each case has numbers of its own, whichever others are run
/// - `failure_rate`: the chance of any false alarm in the whole run
/// - `done`: counts checks that are done
/// - `cancel`: if set, the remaining checks are left out, and the outcome is worth nothing
pub fn run(
    subjects: &[Subject],
    seed: u64,
    failure_rate: f64,
    done: &AtomicUsize,
    cancel: &AtomicBool,
) -> Outcome {
    let all: Vec<Done> = subjects
        .par_iter()
        .with_max_len(1)
        .flat_map_iter(|subject| {
            let seed = seed_of(&subject.case, seed);
            subject.checks.iter().enumerate().filter_map(move |(check, of)| {
                if cancel.load(Ordering::Relaxed) {
                    return None;
                }
                let began = Instant::now();
                let verdict = (of.run)(seed.wrapping_add(check as u64));
                done.fetch_add(1, Ordering::Relaxed);
                Some(Done { subject, check, verdict, seconds: began.elapsed().as_secs_f64() })
            })
        })
        .collect();
    let decided_by_chance = all.iter().filter(|done| matches!(done.verdict, Verdict::Chance(_))).count();
    let level = sidak(failure_rate, decided_by_chance.max(1));
    let mut rows: BTreeMap<(Group, &str, usize, &'static str), Row> = BTreeMap::new();
    for Done { subject, check, verdict, seconds } in &all {
        let name = subject.checks[*check].name;
        let order = order_of(name);
        let row = rows.entry((subject.group, &subject.block, order, name)).or_insert_with(|| Row {
            group: subject.group,
            block: subject.block.clone(),
            check: name,
            cases: 0,
            failures: Vec::new(),
            least_p: 1.0,
            seconds: 0.0,
        });
        row.cases += 1;
        row.seconds += seconds;
        let complaint = match verdict {
            Verdict::Holds => None,
            Verdict::Fails(what) => Some(what.clone()),
            Verdict::Chance(report) => {
                row.least_p = row.least_p.min(report.p_value);
                (!report.passes(level)).then(|| report.to_string())
            }
        };
        if let Some(what) = complaint {
            let draw = subject.picture.as_ref().filter(|_| row.failures.len() < PICTURES);
            let picture = draw.map(|draw| draw(seed_of(&subject.case, seed)));
            row.failures.push(Failure { case: subject.case.clone(), what, picture });
        }
    }
    Outcome { rows: rows.into_values().collect(), level, decided_by_chance }
}

/// A block that is wrong on purpose.
#[derive(Clone, Debug)]
pub struct Flaw {
    /// The block, its parameters, and what is wrong.
    pub case: String,
    /// The first check that it failed; `None` if nothing noticed.
    pub caught_by: Option<&'static str>,
}

/// A p-value below this is proof that something is wrong, also among hundreds of tests.
const CERTAIN: f64 = 1e-6;

/// Runs checks on blocks that are wrong on purpose, from the quickest, until one notices. `done` counts all their checks.
pub fn catch(subjects: &[Subject], seed: u64, done: &AtomicUsize, cancel: &AtomicBool) -> Vec<Flaw> {
    let caught_by = |subject: &Subject| {
        let seed = seed_of(&subject.case, seed);
        // The test of shapes takes longest.
        let (shapes, quick): (Vec<usize>, Vec<usize>) =
            (0..subject.checks.len()).partition(|&check| subject.checks[check].name == "chi-square");
        let mut order = quick.into_iter().chain(shapes).filter(|_| !cancel.load(Ordering::Relaxed));
        order.find(|&check| match (subject.checks[check].run)(seed.wrapping_add(check as u64)) {
            Verdict::Holds => false,
            Verdict::Fails(_) => true,
            Verdict::Chance(report) => !report.passes(CERTAIN),
        })
    };
    let flaw = |subject: &Subject| {
        let caught_by = caught_by(subject).map(|check| subject.checks[check].name);
        done.fetch_add(subject.checks.len(), Ordering::Relaxed);
        Flaw { case: subject.case.clone(), caught_by }
    };
    subjects.par_iter().with_max_len(1).map(flaw).collect()
}

/// Which comes first in a table.
fn order_of(check: &str) -> usize {
    ["chi-square", "normalised", "delta lobes", "cdf", "icdf", "slope", "invert", "mean"]
        .iter()
        .position(|known| *known == check)
        .unwrap_or(8)
}

/// Numbers of its own for each case, whichever others there are: FNV-1a of its name.
fn seed_of(case: &str, seed: u64) -> u64 {
    let hash = case
        .bytes()
        .fold(0xcbf2_9ce4_8422_2325_u64, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3));
    hash ^ seed.wrapping_mul(0x9e37_79b9_7f4a_7c15)
}
