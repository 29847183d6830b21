//! What is remembered of points: of a task's, and of all so far.

use std::ops::Range;

use super::IntegrateError;
use super::integral::Integral;
use super::lanes::{Summary, multiply};
use super::moments::Moments;
use super::plan::Plan;
use super::rounds::Drawn;

/// A task's terms f · factor, added up, and what is odd about them.
pub struct Tally {
    outputs: usize,
    /// Replicate after replicate, the sum of each output.
    sums: Vec<f64>,
    /// Of the terms as samples, zeros included; empty unless they are independent.
    moments: Moments,
    /// Of the first output.
    summary: Summary,
    asked: u64,
    drawn: u64,
    nans: u64,
    /// The first point that cannot be added.
    first: Option<Odd>,
}

/// A point that cannot be added: f, or at least f · factor, is not finite there.
struct Odd {
    x: Vec<f64>,
    value: f64,
    factor: f64,
}

impl Tally {
    /// - `f`: the values of each output, one after the other, at the points that were drawn
    /// - `[outputs, len]`: the number of outputs; how many points each replicate was to have. Those missing count as 0
    pub fn new(drawn: &Drawn, f: &[f64], [outputs, len]: [usize; 2], keep_moments: bool) -> Self {
        let (n, asked) = (drawn.factor.len(), len * drawn.kept.len());
        let mut terms = vec![0.0; f.len()];
        for (terms, f) in terms.chunks_mut(n.max(1)).zip(f.chunks(n.max(1))) {
            multiply(f, &drawn.factor, terms);
        }
        let mut tally = Self {
            outputs,
            sums: Vec::new(),
            moments: Moments::default(),
            summary: Summary::of(&terms[..n]),
            asked: asked as u64,
            drawn: n as u64,
            nans: 0,
            first: None,
        };
        if !(tally.summary.sum.is_finite() && Summary::of(&terms[n..]).sum.is_finite()) {
            tally.remove_odd(drawn, f, &mut terms);
            tally.summary = Summary::of(&terms[..n]);
        }
        let controls = drawn.control.chunks(asked.max(1)).take(outputs);
        if !keep_moments {
            let mut from = 0;
            for &kept in &drawn.kept {
                let column = |a: usize| &terms[a * n + from..a * n + from + kept];
                let whole = kept == n && outputs == 1;
                let sum = |a: usize| if whole { tally.summary.sum } else { Summary::of(column(a)).sum };
                tally.sums.extend((0..outputs).map(sum));
                from += kept;
            }
            for (a, control) in controls.enumerate() {
                for (replicate, control) in control.chunks(len).enumerate() {
                    tally.sums[replicate * outputs + a] -= Summary::of(control).sum;
                }
            }
        } else if n == asked && drawn.control.is_empty() {
            tally.moments = Moments::of_columns(&terms, n);
        } else {
            let mut padded = vec![0.0; asked * outputs.max(1)];
            for (padded, terms) in padded.chunks_mut(asked.max(1)).zip(terms.chunks(n.max(1))) {
                if drawn.rows.is_empty() {
                    padded[..n].copy_from_slice(terms);
                }
                drawn.rows.iter().zip(terms).for_each(|(&row, term)| padded[row] = *term);
            }
            for (padded, control) in padded.chunks_mut(asked.max(1)).zip(controls) {
                padded.iter_mut().zip(control).for_each(|(term, control)| *term -= control);
            }
            tally.moments = Moments::of_columns(&padded, asked);
        }
        tally
    }

    /// Counts points with terms that are not finite, and makes these 0.
    fn remove_odd(&mut self, drawn: &Drawn, f: &[f64], terms: &mut [f64]) {
        let Drawn { factor, .. } = drawn;
        let n = factor.len();
        for i in 0..n {
            let Some(a) = (0..self.outputs).find(|a| !terms[a * n + i].is_finite()) else { continue };
            self.nans += 1;
            self.first.get_or_insert_with(|| Odd {
                x: drawn.points().point(i),
                value: f[a * n + i],
                factor: factor[i],
            });
            (0..self.outputs).for_each(|a| terms[a * n + i] = 0.0);
        }
    }
}

/// Everything that is remembered of the points so far.
pub struct Sums {
    independent: bool,
    replicates: usize,
    outputs: usize,
    /// Of independent points: moments for each technique.
    moments: Vec<Moments>,
    /// Of others: for each technique and replicate, the number of points, and the sum of each output.
    counts: Vec<u64>,
    totals: Vec<Vec<f64>>,
    n: u64,
    nans: u64,
    not_drawn: u64,
    summary: Summary,
    first: Option<Odd>,
}

impl Sums {
    pub fn new(techniques: usize, replicates: u32, independent: bool) -> Self {
        let cells = techniques * replicates as usize;
        Self {
            independent,
            replicates: replicates as usize,
            outputs: 0,
            moments: vec![Moments::default(); techniques],
            counts: vec![0; cells],
            totals: vec![Vec::new(); cells],
            n: 0,
            nans: 0,
            not_drawn: 0,
            summary: Summary::default(),
            first: None,
        }
    }

    /// # Errors
    /// If a term is not finite and the plan does not take that for 0.
    pub fn check(&self, plan: &Plan) -> Result<(), IntegrateError> {
        let Some(Odd { x, value, factor }) = self.first.as_ref().filter(|_| !plan.nan_as_zero) else {
            return Ok(());
        };
        let x = x.clone();
        Err(match value.is_finite() {
            true => IntegrateError::Overflow { x, value: *value, pdf: 1.0 / factor },
            false => IntegrateError::NotFinite { x, value: *value, count: self.nans, n: self.n },
        })
    }

    /// The number of points so far.
    pub fn n(&self) -> u64 {
        self.n
    }

    /// The number of outputs, once it is known.
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// Are moments wanted of tallies, rather than sums?
    pub fn keeps_moments(&self) -> bool {
        self.independent
    }

    /// Adds a task's points.
    ///
    /// # Errors
    /// If the number of outputs changed.
    pub fn add(
        &mut self,
        technique: usize,
        replicates: &Range<u32>,
        tally: Tally,
    ) -> Result<(), IntegrateError> {
        let Tally { outputs, sums, moments, summary, asked, drawn, nans, first } = tally;
        if self.outputs == 0 {
            self.outputs = outputs;
        } else if outputs != self.outputs && drawn > 0 {
            return Err(IntegrateError::Outputs { expected: self.outputs, found: outputs });
        }
        self.n += asked;
        self.nans += nans;
        if self.first.is_none() {
            self.first = first;
        }
        self.not_drawn += asked - drawn;
        self.summary.merge(&summary);
        if self.independent {
            self.moments[technique].merge(&moments);
            return Ok(());
        }
        for (i, replicate) in replicates.clone().enumerate() {
            let cell = technique * self.replicates + replicate as usize;
            self.counts[cell] += asked / replicates.len() as u64;
            let totals = &mut self.totals[cell];
            totals.resize(self.outputs, 0.0);
            let sums = sums.iter().skip(i * outputs).take(outputs);
            totals.iter_mut().zip(sums).for_each(|(total, sum)| *total += sum);
        }
        Ok(())
    }

    /// What is known by now.
    pub fn integral(&self, seconds: f64) -> Integral {
        let m = self.outputs.max(1);
        let (mean, covariance, n) = if self.independent {
            let (mut mean, mut covariance) = (vec![0.0; m], vec![0.0; m * m]);
            for moments in &self.moments {
                mean.iter_mut().zip(moments.mean()).for_each(|(sum, x)| *sum += x);
                covariance.iter_mut().zip(moments.covariance_of_mean()).for_each(|(sum, x)| *sum += x);
            }
            (mean, covariance, self.moments.iter().map(Moments::n).min().unwrap_or(0))
        } else {
            let r = self.replicates;
            let mut means = vec![0.0; m * r];
            for (cell, totals) in self.totals.iter().enumerate() {
                for (a, total) in totals.iter().enumerate() {
                    means[a * r + cell % r] += total / self.counts[cell] as f64;
                }
            }
            let moments = Moments::of_columns(&means, r);
            (moments.mean().to_vec(), moments.covariance_of_mean(), moments.n())
        };
        let Summary { absolute, squares, largest, .. } = self.summary;
        Integral {
            mean,
            covariance,
            dof: n.saturating_sub(1),
            n: self.n,
            nans: self.nans,
            not_drawn: self.not_drawn,
            largest_share: if absolute > 0.0 { largest / absolute } else { 0.0 },
            effective_n: if squares > 0.0 { absolute * absolute / squares } else { 0.0 },
            seconds,
        }
    }
}
