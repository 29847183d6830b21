//! What is remembered of points: of a task's, and of all so far.

use std::ops::Range;

use super::IntegrateError;
use super::integral::Integral;
use super::lanes::{Summary, multiply};
use super::moments::Moments;
use super::plan::Plan;
use super::rounds::Drawn;
use super::scale::{self, Exponent};
use super::tail::{Maxima, Tail};

/// A task's terms f · factor, added up, and what is odd about them.
pub struct Tally {
    outputs: usize,
    /// Of each output: everything here is in units of two to this power.
    exponents: Vec<Exponent>,
    /// Replicate after replicate, the sum of each output.
    sums: Vec<f64>,
    /// Of the terms as samples, zeros included; empty unless they are independent.
    moments: Moments,
    /// Of the first output.
    summary: Summary,
    /// The largest |term| of the first output in each replicate, or, of independent points, in each of a few parts.
    maxima: Vec<f64>,
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
            exponents: Vec::with_capacity(outputs),
            sums: Vec::new(),
            moments: Moments::default(),
            summary: Summary::default(),
            maxima: Vec::new(),
            asked: asked as u64,
            drawn: n as u64,
            nans: 0,
            first: None,
        };
        let mut all = tally.summarise(&terms, n, keep_moments);
        if all.iter().any(|summary| !summary.sum.is_finite()) {
            tally.remove_odd(drawn, f, &mut terms);
            all = tally.summarise(&terms, n, keep_moments);
        }
        tally.exponents.extend(all.iter().map(|summary| scale::exponent_of(summary.largest)));
        if tally.exponents.iter().any(|exponent| exponent.is_far()) {
            for (terms, exponent) in terms.chunks_mut(n.max(1)).zip(&tally.exponents) {
                exponent.divide(terms);
            }
            all = tally.summarise(&terms, n, keep_moments);
        }
        tally.summary = all.first().copied().unwrap_or_default();
        let controls = drawn.control.chunks(asked.max(1)).take(outputs);
        if !keep_moments {
            let mut from = 0;
            for &kept in &drawn.kept {
                let of = |a: usize| match kept == n {
                    true => all[a],
                    false => Summary::of(&terms[a * n + from..a * n + from + kept]),
                };
                for a in 0..outputs {
                    let summary = of(a);
                    tally.sums.push(summary.sum);
                    if a == 0 {
                        tally.maxima.push(summary.largest);
                    }
                }
                from += kept;
            }
            for (a, control) in controls.enumerate() {
                for (replicate, control) in control.chunks(len).enumerate() {
                    tally.sums[replicate * outputs + a] -= tally.exponents[a].of(Summary::of(control).sum);
                }
            }
            return tally;
        }
        if n == asked && drawn.control.is_empty() {
            tally.moments = Moments::of_columns(&terms, n);
        } else {
            let mut padded = vec![0.0; asked * outputs.max(1)];
            for (padded, terms) in padded.chunks_mut(asked.max(1)).zip(terms.chunks(n.max(1))) {
                if drawn.rows.is_empty() {
                    padded[..n].copy_from_slice(terms);
                }
                drawn.rows.iter().zip(terms).for_each(|(&row, term)| padded[row] = *term);
            }
            for (a, (padded, control)) in padded.chunks_mut(asked.max(1)).zip(controls).enumerate() {
                let exponent = tally.exponents[a];
                padded.iter_mut().zip(control).for_each(|(term, control)| *term -= exponent.of(*control));
            }
            tally.moments = Moments::of_columns(&padded, asked);
        }
        tally
    }

    /// What there is to know of the terms of each output; of independent points also the maxima of parts.
    fn summarise(&mut self, terms: &[f64], n: usize, in_parts: bool) -> Vec<Summary> {
        self.maxima.clear();
        let column = |a: usize| &terms[a * n..(a + 1) * n];
        let mut all = Vec::with_capacity(self.outputs);
        for a in 0..self.outputs {
            if a > 0 || !in_parts {
                all.push(Summary::of(column(a)));
                continue;
            }
            let mut whole = Summary::default();
            for part in column(a).chunks(Maxima::PART) {
                let summary = Summary::of(part);
                self.maxima.push(summary.largest);
                whole.merge(&summary);
            }
            all.push(whole);
        }
        all
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
    /// Of each output: all sums are in units of two to this power.
    exponents: Vec<Exponent>,
    /// Of independent points: moments for each technique.
    moments: Vec<Moments>,
    /// Of others: for each technique and replicate, the number of points, and the sum of each output.
    counts: Vec<u64>,
    totals: Vec<Vec<f64>>,
    n: u64,
    nans: u64,
    not_drawn: u64,
    summary: Summary,
    maxima: Maxima,
    first: Option<Odd>,
}

impl Sums {
    pub fn new(techniques: usize, replicates: u32, independent: bool) -> Self {
        let cells = techniques * replicates as usize;
        Self {
            independent,
            replicates: replicates as usize,
            outputs: 0,
            exponents: Vec::new(),
            moments: vec![Moments::default(); techniques],
            counts: vec![0; cells],
            totals: vec![Vec::new(); cells],
            n: 0,
            nans: 0,
            not_drawn: 0,
            summary: Summary::default(),
            maxima: Maxima::default(),
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
        mut tally: Tally,
    ) -> Result<(), IntegrateError> {
        if self.outputs == 0 {
            self.outputs = tally.outputs;
        } else if tally.outputs != self.outputs && tally.drawn > 0 {
            return Err(IntegrateError::Outputs { expected: self.outputs, found: tally.outputs });
        }
        self.in_one_unit(&mut tally, replicates.len());
        let Tally { outputs, sums, moments, summary, maxima, asked, drawn, nans, first, .. } = tally;
        self.n += asked;
        self.nans += nans;
        if self.first.is_none() {
            self.first = first;
        }
        self.not_drawn += asked - drawn;
        self.summary.merge(&summary);
        if self.independent {
            maxima.into_iter().for_each(|largest| self.maxima.add_part(largest));
            self.moments[technique].merge(&moments);
            return Ok(());
        }
        for (replicate, largest) in replicates.clone().zip(maxima) {
            self.maxima.add_replicate(replicate as usize, largest);
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

    /// Brings these sums and a tally to the larger unit of both.
    fn in_one_unit(&mut self, tally: &mut Tally, replicates: usize) {
        self.exponents.resize(self.outputs, Exponent::default());
        if self.exponents == tally.exponents {
            return;
        }
        for (a, (ours, theirs)) in self.exponents.iter_mut().zip(&tally.exponents).enumerate() {
            let unit = (*ours).max(*theirs);
            let (us, them) = (ours.in_unit(unit), theirs.in_unit(unit));
            *ours = unit;
            if us != 1.0 {
                self.totals.iter_mut().filter_map(|totals| totals.get_mut(a)).for_each(|total| *total *= us);
                self.moments.iter_mut().for_each(|moments| moments.scale(a, us));
            }
            if them != 1.0 {
                (0..replicates).for_each(|r| {
                    tally.sums.get_mut(r * tally.outputs + a).into_iter().for_each(|sum| *sum *= them);
                });
                tally.moments.scale(a, them);
            }
            if a == 0 && (us != 1.0 || them != 1.0) {
                self.summary.scale(us);
                self.maxima.scale(us);
                tally.summary.scale(them);
                tally.maxima.iter_mut().for_each(|largest| *largest *= them);
            }
        }
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
        let unit = |a: usize| self.exponents.get(a).copied().unwrap_or_default();
        Integral {
            mean: mean.iter().enumerate().map(|(a, mean)| unit(a).out(*mean)).collect(),
            stderr: (0..m).map(|a| unit(a).out(covariance[a * m + a].max(0.0).sqrt())).collect(),
            covariance: (0..m * m).map(|i| unit(i / m).out(unit(i % m).out(covariance[i]))).collect(),
            dof: n.saturating_sub(1),
            n: self.n,
            nans: self.nans,
            not_drawn: self.not_drawn,
            largest_share: if absolute > 0.0 { largest / absolute } else { 0.0 },
            effective_n: if squares > 0.0 { absolute * absolute / squares } else { 0.0 },
            tail: Tail::new(&self.maxima, largest, squares, self.n),
            ended_by_cap: false,
            seconds,
        }
    }
}
