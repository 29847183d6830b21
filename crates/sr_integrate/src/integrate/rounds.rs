//! Rounds of points, until the plan is fulfilled.
//!
//! A round gives every replicate of every technique its next points. They are drawn by all threads, in tasks of some
//! hundred; evaluated by all threads, too, or in one block by the calling one; and added up in the order of the tasks, so
//! that the result is the same for any number of threads.

use std::error::Error;
use std::mem::take;
use std::ops::Range;
use std::time::Instant;

use rayon::ThreadPool;
use rayon::prelude::*;

use super::IntegrateError;
use super::integral::Integral;
use super::integrand::{Integrand, Parallel};
use super::lanes::count_positive;
use super::plan::Plan;
use super::sums::{Sums, Tally};
use super::technique::Technique;
use crate::columns::{Columns, ColumnsMut};
use crate::points::{Points, Sequence};

/// What is known between two rounds.
#[derive(Clone, Debug)]
pub struct Progress {
    /// Points so far.
    pub n: u64,
    /// The most there can be, if the plan says.
    pub n_max: Option<u64>,
    /// Seconds so far.
    pub seconds: f64,
    /// The mean and standard error of each output so far.
    pub mean: Vec<f64>,
    /// See `mean`.
    pub stderr: Vec<f64>,
}

/// What is told after each round, and may end everything by an error.
pub type OnRound<'a> = dyn FnMut(&Progress) -> Result<(), Box<dyn Error + Send + Sync>> + 'a;

/// A task draws at most so many points …
const TASK_ROWS: u64 = 1024;
/// … and uniforms.
const TASK_UNIFORMS: u64 = 1 << 19;

/// A round draws about so many uniforms at most.
const ROUND_UNIFORMS: u64 = 1 << 25;

/// Points of a round that are drawn at once: the same of several replicates.
struct Task {
    technique: usize,
    replicates: Range<u32>,
    first: u64,
    len: usize,
}

impl Task {
    fn rows(&self) -> usize {
        self.replicates.len() * self.len
    }
}

/// What a task drew: only points that count.
#[derive(Default)]
pub struct Drawn {
    /// Columns.
    pub x: Vec<f64>,
    /// By what f is multiplied.
    pub factor: Vec<f64>,
    /// How many points of each replicate count.
    pub kept: Vec<usize>,
    /// Which rows they are of those that were asked for; empty if all are.
    pub rows: Vec<usize>,
    /// What is taken off the terms of the rows that were asked for: a column for each of the first outputs.
    pub control: Vec<f64>,
}

impl Drawn {
    /// The points.
    pub fn points(&self) -> Columns<'_> {
        Columns::new(&self.x, self.factor.len())
    }
}

/// Integrates, with points from one or more techniques.
///
/// - `techniques`: each with the number of its points, relative to the others'. The integral is the sum of their means
/// - `pool`: where points are drawn, and integrands that allow it evaluated; the calling thread if there is none
/// - `on_round`: is told after each round, and may end everything by an error
///
/// # Errors
/// See [`IntegrateError`].
///
/// # Panics
/// If there is no technique, or one of no points.
pub fn integrate(
    techniques: &[(&dyn Technique, u32)],
    integrand: &mut Integrand<'_>,
    plan: &Plan,
    pool: Option<&ThreadPool>,
    on_round: &mut OnRound<'_>,
) -> Result<Integral, IntegrateError> {
    plan.check()?;
    assert!(!techniques.is_empty() && techniques.iter().all(|&(_, share)| share > 0));
    let began = Instant::now();
    let shares: u64 = techniques.iter().map(|&(_, share)| u64::from(share)).sum();
    let most_share = techniques.iter().map(|&(_, share)| u64::from(share)).max().unwrap_or(1);
    let independent = plan.sequence == Sequence::Independent;
    let replicates = if independent { 1 } else { plan.replicates };
    let a_unit = shares * u64::from(replicates);
    let limit = if independent { u64::MAX / a_unit } else { Points::MAX_LEN / most_share };
    // One independent point of a technique has no variance.
    let lone = techniques.iter().any(|&(_, share)| share == 1);
    let least = if independent && lone { 2 } else { 1 };
    let target = plan.most().map_or(limit, |n| n.div_ceil(a_unit).clamp(least, limit));
    let points: Vec<Points> = (0..techniques.len())
        .map(|t| {
            Points::new(plan.sequence, techniques[t].0.uniforms(), plan.seed.wrapping_add((t as u64) << 40))
        })
        .collect();

    let batch = match integrand {
        Integrand::Blocks(_) => plan.batch as u64,
        Integrand::Parallel(_) => (plan.batch as u64).max(1 << 19),
    };
    // Rounds of many uniforms would keep others waiting: for memory, for progress, for an end.
    let widest = techniques.iter().map(|(technique, _)| technique.uniforms()).max().unwrap_or(1).max(1);
    let batch = batch.min((ROUND_UNIFORMS / widest as u64).max(1));
    let units_a_round = 1 << (batch / a_unit).max(1).ilog2();
    let mut sums = Sums::new(techniques.len(), replicates, independent);
    let (mut done, mut next_look) = (0, Plan::FIRST_LOOK.div_ceil(a_unit).next_power_of_two());
    loop {
        let len = units_a_round.min(target - done).min(if plan.has_tolerance() {
            next_look - done
        } else {
            u64::MAX
        });
        let tasks = tasks(techniques, replicates, done, len);
        match integrand {
            Integrand::Parallel(f) => {
                let work = |scratch: &mut Scratch, task: &Task| {
                    reduce(*f, techniques, &points, task, scratch, independent)
                };
                for (task, tally) in tasks.iter().zip(run(pool, &tasks, work)) {
                    sums.add(task.technique, &task.replicates, tally?)?;
                }
            }
            Integrand::Blocks(_) => {
                let work = |scratch: &mut Scratch, task: &Task| {
                    draw(techniques, &points, task, scratch)?;
                    Ok(take(&mut scratch.drawn))
                };
                let drawn = run(pool, &tasks, work);
                let drawn = drawn.into_iter().collect::<Result<Vec<_>, IntegrateError>>()?;
                add_block(integrand, techniques, &tasks, &drawn, &mut sums)?;
            }
        }
        sums.check(plan)?;
        done += len;
        let seconds = began.elapsed().as_secs_f64();
        let mut integral = sums.integral(seconds);
        on_round(&Progress {
            n: sums.n(),
            n_max: plan.n.map(|_| target * a_unit),
            seconds,
            mean: integral.mean.clone(),
            stderr: integral.stderr.clone(),
        })
        .map_err(IntegrateError::Foreign)?;
        let late = plan.seconds.is_some_and(|most| seconds >= most);
        let mut sure = false;
        if plan.has_tolerance() && done >= next_look {
            sure = integral.is_within(plan.rtol, plan.atol);
            next_look = done * 2;
        }
        if done >= target || late || sure {
            integral.ended_by_cap = plan.n.is_none() && !late && !sure;
            return Ok(integral);
        }
    }
}

/// All values of f at points, whoever may evaluate it; returns the number of outputs.
pub(crate) fn values_of(
    integrand: &mut Integrand<'_>,
    x: Vec<f64>,
    n: usize,
    f: &mut Vec<f64>,
) -> Result<usize, IntegrateError> {
    match integrand {
        Integrand::Blocks(blocks) => blocks.eval(x, n, f).map_err(IntegrateError::Foreign),
        Integrand::Parallel(parallel) => {
            f.resize(n, 0.0);
            parallel.eval(Columns::new(&x, n), f);
            Ok(1)
        }
    }
}

/// The tasks of a round: `len` units from `done` on.
fn tasks(techniques: &[(&dyn Technique, u32)], replicates: u32, done: u64, len: u64) -> Vec<Task> {
    let mut tasks = Vec::new();
    for (t, &(technique, share)) in techniques.iter().enumerate() {
        let rows = (TASK_UNIFORMS / technique.uniforms().max(1) as u64).clamp(16, TASK_ROWS);
        let (first, end) = (done * u64::from(share), (done + len) * u64::from(share));
        let together = (rows / (end - first).min(rows)) as u32;
        for replicate in (0..replicates).step_by(together as usize) {
            let replicates = replicate..(replicate + together).min(replicates);
            let mut from = first;
            while from < end {
                let len = rows.min(end - from);
                let replicates = replicates.clone();
                tasks.push(Task { technique: t, replicates, first: from, len: len as usize });
                from += len;
            }
        }
    }
    tasks
}

/// Does the tasks, in the pool if there is one and it pays; the results are in their order.
fn run<R: Send>(
    pool: Option<&ThreadPool>,
    tasks: &[Task],
    work: impl Fn(&mut Scratch, &Task) -> R + Sync,
) -> Vec<R> {
    match pool {
        Some(pool) if tasks.len() > 1 => {
            pool.install(|| tasks.par_iter().map_init(Scratch::default, &work).collect())
        }
        _ => {
            let mut scratch = Scratch::default();
            tasks.iter().map(|task| work(&mut scratch, task)).collect()
        }
    }
}

/// Memory that a thread's tasks share.
#[derive(Default)]
struct Scratch {
    u: Vec<f64>,
    drawn: Drawn,
    f: Vec<f64>,
}

/// Draws a task's points into `scratch.drawn`.
fn draw(
    techniques: &[(&dyn Technique, u32)],
    points: &[Points],
    task: &Task,
    scratch: &mut Scratch,
) -> Result<(), IntegrateError> {
    let (technique, n) = (techniques[task.technique].0, task.rows());
    let Scratch { u, drawn: Drawn { x, factor, kept, rows, control }, .. } = scratch;
    u.resize(technique.uniforms() * n, 0.0);
    x.resize(technique.space().dim() * n, 0.0);
    factor.resize(n, 0.0);
    for (j, column) in u.chunks_mut(n).enumerate() {
        for (replicate, u) in task.replicates.clone().zip(column.chunks_mut(task.len)) {
            points[task.technique].fill_column(replicate, task.first, j, u);
        }
    }
    technique.draw(Columns::new(u, n), ColumnsMut::new(x, n), factor)?;
    if let Some(variate) = technique.control() {
        control.resize(variate.outputs() * n, 0.0);
        variate.fill(Columns::new(u, n), ColumnsMut::new(control, n));
    } else {
        control.clear();
    }
    kept.clear();
    kept.extend(factor.chunks(task.len).map(count_positive));
    rows.clear();
    if kept.iter().any(|&kept| kept < task.len) {
        rows.extend((0..n).filter(|&i| factor[i] > 0.0));
        *x = x.chunks(n).flat_map(|column| rows.iter().map(|&i| column[i])).collect();
        factor.retain(|&factor| factor > 0.0);
    }
    Ok(())
}

/// Draws, evaluates and adds up a task's points.
fn reduce(
    f: &dyn Parallel,
    techniques: &[(&dyn Technique, u32)],
    points: &[Points],
    task: &Task,
    scratch: &mut Scratch,
    keep_moments: bool,
) -> Result<Tally, IntegrateError> {
    draw(techniques, points, task, scratch)?;
    let Scratch { drawn, f: values, .. } = scratch;
    values.resize(drawn.factor.len(), 0.0);
    f.eval(drawn.points(), values);
    Ok(Tally::new(drawn, values, [1, task.len], keep_moments))
}

/// Evaluates f at all points of a round in one block, and adds the terms of each task.
fn add_block(
    integrand: &mut Integrand<'_>,
    techniques: &[(&dyn Technique, u32)],
    tasks: &[Task],
    drawn: &[Drawn],
    sums: &mut Sums,
) -> Result<(), IntegrateError> {
    let dim = techniques[0].0.space().dim();
    let n: usize = drawn.iter().map(|drawn| drawn.factor.len()).sum();
    let mut x = Vec::with_capacity(n * dim);
    for j in 0..dim {
        for Drawn { x: part, factor, .. } in drawn {
            x.extend_from_slice(&part[j * factor.len()..(j + 1) * factor.len()]);
        }
    }
    let mut f = Vec::new();
    let outputs = if n > 0 { values_of(integrand, x, n, &mut f)? } else { sums.outputs() };
    let mut from = 0;
    let mut part = Vec::new();
    for (task, drawn) in tasks.iter().zip(drawn) {
        let len = drawn.factor.len();
        part.clear();
        (0..outputs).for_each(|a| part.extend_from_slice(&f[a * n + from..a * n + from + len]));
        let tally = Tally::new(drawn, &part, [outputs, task.len], sums.keeps_moments());
        sums.add(task.technique, &task.replicates, tally)?;
        from += len;
    }
    Ok(())
}
