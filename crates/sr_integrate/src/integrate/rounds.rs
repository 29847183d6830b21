//! Rounds of points, until the plan is fulfilled.
//!
//! A round gives every replicate of every technique its next points. They are drawn by all threads, in tasks of some
//! hundred; evaluated by all threads, too, or in one block by the calling one; and added up in the order of the tasks, so
//! that the result is the same for any number of threads.

use std::error::Error;
use std::time::Instant;

use rayon::ThreadPool;
use rayon::prelude::*;

use super::IntegrateError;
use super::integral::Integral;
use super::integrand::{Integrand, Parallel};
use super::moments::Moments;
use super::plan::Plan;
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

/// A task draws at most so many points …
const TASK_ROWS: u64 = 1024;
/// … and uniforms.
const TASK_UNIFORMS: u64 = 1 << 19;

/// Points of a round that are drawn at once.
struct Task {
    technique: usize,
    replicate: u32,
    first: u64,
    len: usize,
}

/// What a task drew: only points that count.
struct Drawn {
    x: Vec<f64>,
    factor: Vec<f64>,
    /// Points that were asked for.
    asked: u64,
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
    on_round: &mut dyn FnMut(&Progress) -> Result<(), Box<dyn Error + Send + Sync>>,
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
    let target = plan.n.map_or(limit, |n| n.div_ceil(a_unit).min(limit));
    let points: Vec<Points> = (0..techniques.len())
        .map(|t| {
            Points::new(plan.sequence, techniques[t].0.uniforms(), plan.seed.wrapping_add((t as u64) << 40))
        })
        .collect();

    let batch = match integrand {
        Integrand::Blocks(_) => plan.batch as u64,
        Integrand::Parallel(_) => (plan.batch as u64).max(1 << 19),
    };
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
                let work = |task: &Task| reduce(*f, techniques, &points, task);
                for (task, reduced) in tasks.iter().zip(run(pool, &tasks, work)) {
                    sums.add(task, reduced?, plan)?;
                }
            }
            Integrand::Blocks(_) => {
                let drawn = run(pool, &tasks, |task| draw(techniques, &points, task));
                let drawn = drawn.into_iter().collect::<Result<Vec<_>, _>>()?;
                add_block(integrand, techniques, &tasks, &drawn, &mut sums, plan)?;
            }
        }
        done += len;
        let seconds = began.elapsed().as_secs_f64();
        let integral = sums.integral(seconds);
        on_round(&Progress {
            n: sums.n,
            n_max: plan.n.map(|_| target * a_unit),
            seconds,
            mean: integral.mean.clone(),
            stderr: integral.stderr(),
        })
        .map_err(IntegrateError::Foreign)?;
        let late = plan.seconds.is_some_and(|most| seconds >= most);
        let mut sure = false;
        if plan.has_tolerance() && done >= next_look {
            sure = integral.is_within(plan.rtol, plan.atol);
            next_look = done * 2;
        }
        if done >= target || late || sure {
            return Ok(integral);
        }
    }
}

/// All values of f at points, whoever may evaluate it; returns the number of outputs.
pub(super) fn values_of(
    integrand: &mut Integrand<'_>,
    x: Columns<'_>,
    f: &mut Vec<f64>,
) -> Result<usize, IntegrateError> {
    match integrand {
        Integrand::Blocks(blocks) => blocks.values(x, f),
        Integrand::Parallel(parallel) => {
            f.clear();
            f.resize(x.len(), 0.0);
            parallel.eval(x, f);
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
        for replicate in 0..replicates {
            let mut from = first;
            while from < end {
                let len = rows.min(end - from);
                tasks.push(Task { technique: t, replicate, first: from, len: len as usize });
                from += len;
            }
        }
    }
    tasks
}

/// Does the tasks, in the pool if there is one and it pays; the results are in their order.
fn run<R: Send>(pool: Option<&ThreadPool>, tasks: &[Task], work: impl Fn(&Task) -> R + Sync) -> Vec<R> {
    match pool {
        Some(pool) if tasks.len() > 1 => pool.install(|| tasks.par_iter().map(&work).collect()),
        _ => tasks.iter().map(work).collect(),
    }
}

fn draw(
    techniques: &[(&dyn Technique, u32)],
    points: &[Points],
    task: &Task,
) -> Result<Drawn, IntegrateError> {
    let (technique, n) = (techniques[task.technique].0, task.len);
    let mut u = vec![0.0; technique.uniforms() * n];
    points[task.technique].fill(task.replicate, task.first, ColumnsMut::new(&mut u, n));
    let mut x = vec![0.0; technique.space().dim() * n];
    let mut factor = vec![0.0; n];
    technique.draw(Columns::new(&u, n), ColumnsMut::new(&mut x, n), &mut factor)?;
    if factor.iter().any(|&factor| !(factor > 0.0)) {
        let keep = |i: usize| factor[i] > 0.0;
        x = x.chunks(n).flat_map(|column| (0..n).filter(|&i| keep(i)).map(|i| column[i])).collect();
        factor.retain(|&factor| factor > 0.0);
    }
    Ok(Drawn { x, factor, asked: n as u64 })
}

/// A block's terms f · factor and what is odd about them.
#[derive(Default)]
struct Terms {
    /// Output after output; points that do not count are not there.
    numbers: Vec<f64>,
    outputs: usize,
    asked: u64,
    drawn: u64,
    nans: u64,
    /// The first point at which f, or f · factor, is not finite: the point, f, factor.
    first: Option<(Vec<f64>, f64, f64)>,
}

fn terms(x: Columns<'_>, f: &[f64], factor: &[f64], outputs: usize, asked: u64) -> Terms {
    let n = factor.len();
    let mut numbers = Vec::with_capacity(n * outputs);
    for column in f.chunks(n.max(1)) {
        numbers.extend(column.iter().zip(factor).map(|(f, factor)| f * factor));
    }
    let mut terms = Terms { numbers, outputs, asked, drawn: n as u64, ..Terms::default() };
    if terms.numbers.iter().sum::<f64>().is_finite() {
        return terms;
    }
    for i in 0..n {
        let bad = (0..outputs).find(|a| !terms.numbers[a * n + i].is_finite());
        let Some(a) = bad else { continue };
        terms.nans += 1;
        terms.first.get_or_insert_with(|| (x.point(i), f[a * n + i], factor[i]));
        (0..outputs).for_each(|a| terms.numbers[a * n + i] = 0.0);
    }
    terms
}

fn reduce(
    f: &dyn Parallel,
    techniques: &[(&dyn Technique, u32)],
    points: &[Points],
    task: &Task,
) -> Result<Terms, IntegrateError> {
    let drawn = draw(techniques, points, task)?;
    let x = Columns::new(&drawn.x, drawn.factor.len());
    let mut values = vec![0.0; drawn.factor.len()];
    f.eval(x, &mut values);
    Ok(terms(x, &values, &drawn.factor, 1, drawn.asked))
}

/// Evaluates f at all points of a round in one block, and adds the terms of each task.
fn add_block(
    integrand: &mut Integrand<'_>,
    techniques: &[(&dyn Technique, u32)],
    tasks: &[Task],
    drawn: &[Drawn],
    sums: &mut Sums,
    plan: &Plan,
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
    let outputs = if n > 0 { values_of(integrand, Columns::new(&x, n), &mut f)? } else { sums.outputs };
    let mut from = 0;
    let mut part = Vec::new();
    for (task, drawn) in tasks.iter().zip(drawn) {
        let len = drawn.factor.len();
        part.clear();
        (0..outputs).for_each(|a| part.extend_from_slice(&f[a * n + from..a * n + from + len]));
        let x = Columns::new(&drawn.x, len);
        sums.add(task, terms(x, &part, &drawn.factor, outputs, drawn.asked), plan)?;
        from += len;
    }
    Ok(())
}

/// Everything that is remembered of the points so far.
struct Sums {
    independent: bool,
    replicates: u32,
    outputs: usize,
    /// Of independent points: moments for each technique.
    moments: Vec<Moments>,
    /// Of others: for each technique and replicate, the number of points, and the sum of each output.
    counts: Vec<u64>,
    totals: Vec<Vec<f64>>,
    n: u64,
    nans: u64,
    not_drawn: u64,
    absolute: f64,
    squares: f64,
    largest: f64,
}

impl Sums {
    fn new(techniques: usize, replicates: u32, independent: bool) -> Self {
        let cells = techniques * replicates as usize;
        Self {
            independent,
            replicates,
            outputs: 0,
            moments: vec![Moments::default(); techniques],
            counts: vec![0; cells],
            totals: vec![Vec::new(); cells],
            n: 0,
            nans: 0,
            not_drawn: 0,
            absolute: 0.0,
            squares: 0.0,
            largest: 0.0,
        }
    }

    fn add(&mut self, task: &Task, terms: Terms, plan: &Plan) -> Result<(), IntegrateError> {
        let Terms { mut numbers, outputs, asked, drawn, nans, first } = terms;
        if let Some((x, value, factor)) = first.filter(|_| !plan.nan_as_zero) {
            return Err(match value.is_finite() {
                true => IntegrateError::Overflow { x, value, pdf: 1.0 / factor },
                false => IntegrateError::NotFinite { x, value, count: nans, n: drawn },
            });
        }
        if self.outputs == 0 {
            self.outputs = outputs;
        } else if outputs != self.outputs && drawn > 0 {
            return Err(IntegrateError::Outputs { expected: self.outputs, found: outputs });
        }
        self.n += asked;
        self.nans += nans;
        self.not_drawn += asked - drawn;
        let n = drawn as usize;
        for t in &numbers[..n] {
            self.absolute += t.abs();
            self.squares += t * t;
            self.largest = self.largest.max(t.abs());
        }
        if self.independent {
            if asked > drawn {
                let mut padded = Vec::with_capacity(asked as usize * self.outputs.max(1));
                for a in 0..self.outputs.max(1) {
                    padded.extend_from_slice(numbers.get(a * n..(a + 1) * n).unwrap_or_default());
                    padded.resize((a + 1) * asked as usize, 0.0);
                }
                numbers = padded;
            }
            self.moments[task.technique].merge(&Moments::of_columns(&numbers, asked as usize));
        } else {
            let cell = task.technique * self.replicates as usize + task.replicate as usize;
            self.counts[cell] += asked;
            let totals = &mut self.totals[cell];
            totals.resize(self.outputs, 0.0);
            for (total, column) in totals.iter_mut().zip(numbers.chunks(n.max(1))) {
                *total += column.iter().sum::<f64>();
            }
        }
        Ok(())
    }

    /// What is known by now.
    fn integral(&self, seconds: f64) -> Integral {
        let m = self.outputs.max(1);
        let (mean, covariance, dof) = if self.independent {
            let (mut mean, mut covariance) = (vec![0.0; m], vec![0.0; m * m]);
            for moments in &self.moments {
                mean.iter_mut().zip(moments.mean()).for_each(|(sum, x)| *sum += x);
                covariance.iter_mut().zip(moments.covariance_of_mean()).for_each(|(sum, x)| *sum += x);
            }
            (mean, covariance, self.moments.iter().map(|moments| moments.n()).min().unwrap_or(0))
        } else {
            let r = self.replicates as usize;
            let mut means = vec![0.0; m * r];
            for (cell, totals) in self.totals.iter().enumerate() {
                for (a, total) in totals.iter().enumerate() {
                    means[a * r + cell % r] += total / self.counts[cell] as f64;
                }
            }
            let moments = Moments::of_columns(&means, r);
            (moments.mean().to_vec(), moments.covariance_of_mean(), moments.n())
        };
        Integral {
            mean,
            covariance,
            dof: dof.saturating_sub(1),
            n: self.n,
            nans: self.nans,
            not_drawn: self.not_drawn,
            largest_share: if self.absolute > 0.0 { self.largest / self.absolute } else { 0.0 },
            effective_n: if self.squares > 0.0 { self.absolute * self.absolute / self.squares } else { 0.0 },
            seconds,
        }
    }
}
