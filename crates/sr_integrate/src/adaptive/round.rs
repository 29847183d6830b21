//! A round of learning: points from the density so far, and f there.

use std::sync::Arc;

use rayon::ThreadPool;
use rayon::prelude::*;

use super::cube::CubeDensity;
use super::level::Level;
use super::strata::Strata;
use super::stratify::Observed;
use super::training::Block;
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Density, DensityError};
use crate::integrate::{Control, Integrand, IntegrateError, values_of};
use crate::points::{Points, Sequence};

/// Rounds have so many replicates, from which their errors are known.
pub const REPLICATES: u32 = 16;

/// At most so many points are drawn at once.
const BLOCK: u64 = 1024;

/// What a round estimated, with points of its own.
#[derive(Clone, Debug)]
pub struct Round {
    /// The mean of each output.
    pub mean: Vec<f64>,
    /// Its standard error, from 16 replicates.
    pub stderr: Vec<f64>,
    /// The number of points.
    pub n: u64,
    /// (Σ |f / p|)² / Σ (f / p)²: as many equal points would do as well (Kish 1965).
    pub effective_n: f64,
    /// The number of components of the density that drew the points.
    pub components: usize,
    /// The number of its strata; 1 if it has none.
    pub strata: usize,
}

impl Round {
    /// The variance that a single independent point would have to have for these errors, over the squared mean size of
    /// f / p: what its estimates cost, low-discrepancy points' gain included.
    pub(super) fn cost(&self, scales: &[f64]) -> f64 {
        let costs = self.stderr.iter().zip(scales).filter(|(_, scale)| **scale > 0.0);
        let costs = costs.map(|(stderr, scale)| self.n as f64 * (stderr / scale).powi(2));
        costs.fold(0.0, f64::max)
    }
}

/// What a round saw.
pub struct Seen {
    /// What it estimated.
    pub round: Round,
    /// The mean size of each output.
    pub scales: Vec<f64>,
    /// Its points, and f there.
    pub blocks: Vec<Block>,
    /// The same in the cube of the mixture's uniforms.
    pub observed: Observed,
}

/// Points of a block, also where the base density puts them.
struct Drawn {
    replicate: usize,
    block: Block,
    x: Vec<f64>,
    base: Vec<f64>,
    /// The mixture's uniforms of all points, those included that draw nothing.
    u: Vec<f64>,
    /// The strata of which they are drawn, and the density of these.
    strata: Vec<u32>,
    density: Vec<f64>,
    /// Which of them are in the block.
    kept: Vec<usize>,
}

fn draw(
    base: &dyn Density,
    cube: &CubeDensity,
    points: &Points,
    (replicate, first, n): (u32, u64, usize),
) -> Result<Drawn, DensityError> {
    let (dim, out) = (cube.dim(), base.space().dim());
    let mut u = vec![0.0; dim * n];
    points.fill(replicate, first, ColumnsMut::new(&mut u, n));
    let mut density = vec![1.0; n];
    let drawn = cube.strata().map(|strata| strata.sample(ColumnsMut::new(&mut u, n), &mut density));
    let strata = drawn.unwrap_or_default();
    let (mut v, mut pdf) = (vec![0.0; dim * n], vec![0.0; n]);
    cube.mix(Columns::new(&u, n), &density, ColumnsMut::new(&mut v, n), &mut pdf);
    let (mut x, mut p) = (vec![0.0; out * n], vec![0.0; n]);
    base.sample(Columns::new(&v, n), ColumnsMut::new(&mut x, n), &mut p)?;
    let kept: Vec<usize> = (0..n).filter(|&i| pdf[i] > 0.0 && p[i] > 0.0).collect();
    if kept.len() < n {
        let keep = |numbers: &[f64]| -> Vec<f64> {
            numbers.chunks(n).flat_map(|column| kept.iter().map(|&i| column[i])).collect()
        };
        (v, pdf, x, p) = (keep(&v), keep(&pdf), keep(&x), keep(&p));
    }
    let block = Block { x: v, pdf, size: Vec::new() };
    Ok(Drawn { replicate: replicate as usize, block, x, base: p, u, strata, density, kept })
}

/// Draws about `n` points, evaluates f there, and tells what they say of the integral; `level` is taken off and added
/// again. Where f is not finite it counts
/// as 0.
pub fn round(
    base: &Arc<dyn Density>,
    (cube, level): (&CubeDensity, Option<&Level>),
    integrand: &mut Integrand<'_>,
    (n, seed): (u64, u64),
    pool: Option<&ThreadPool>,
) -> Result<Seen, IntegrateError> {
    let each = n.div_ceil(u64::from(REPLICATES)).max(1);
    let points = Points::new(Sequence::Sobol, cube.dim(), seed);
    let blocks = each.div_ceil(BLOCK);
    let tasks: Vec<(u32, u64, usize)> = (0..REPLICATES)
        .flat_map(|r| (0..blocks).map(move |b| (r, b * BLOCK, (each - b * BLOCK).min(BLOCK) as usize)))
        .collect();
    let work = |task: &(u32, u64, usize)| draw(base.as_ref(), cube, &points, *task);
    let drawn = match pool {
        Some(pool) => pool.install(|| tasks.par_iter().map(work).collect::<Result<Vec<_>, _>>()),
        None => tasks.iter().map(work).collect(),
    }?;

    let total: usize = drawn.iter().map(|drawn| drawn.base.len()).sum();
    let mut x = Vec::with_capacity(total * base.space().dim());
    for j in 0..base.space().dim() {
        for Drawn { x: part, base, .. } in &drawn {
            x.extend_from_slice(&part[j * base.len()..(j + 1) * base.len()]);
        }
    }
    let mut f = Vec::new();
    let outputs = if total > 0 { values_of(integrand, x, total, &mut f)? } else { 1 };
    let mut seen = summed(drawn, &f, outputs, each, level);
    seen.round.components = cube.components().len();
    seen.round.strata = cube.strata().map_or(1, Strata::count);
    Ok(seen)
}

fn summed(drawn: Vec<Drawn>, f: &[f64], outputs: usize, each: u64, level: Option<&Level>) -> Seen {
    let total: usize = drawn.iter().map(|drawn| drawn.base.len()).sum();
    let replicates = REPLICATES as usize;
    let n = each * u64::from(REPLICATES);
    let mut sums = vec![0.0; replicates * outputs];
    let mut sizes = vec![0.0; outputs];
    let mut terms = vec![0.0; total * outputs];
    for a in 0..outputs {
        let mut i = a * total;
        for Drawn { replicate, block, base, .. } in &drawn {
            for (q, p) in block.pdf.iter().zip(base) {
                let term = f[i] / (q * p);
                if term.is_finite() {
                    terms[i] = term;
                    sums[a * replicates + replicate] += term;
                    sizes[a] += term.abs();
                }
                i += 1;
            }
        }
    }
    sizes.iter_mut().for_each(|size| *size /= n as f64);
    for (Drawn { replicate, strata, .. }, level) in drawn.iter().flat_map(|drawn| Some(drawn).zip(level)) {
        let rows = strata.len();
        let mut control = vec![0.0; rows * level.outputs()];
        level.fill_drawn(strata, ColumnsMut::new(&mut control, rows));
        for (a, control) in control.chunks(rows.max(1)).enumerate().take(outputs) {
            sums[a * replicates + replicate] -= control.iter().sum::<f64>();
        }
    }
    let (mut mean, mut stderr) = (Vec::new(), Vec::new());
    for sums in sums.chunks(replicates) {
        let (count, each) = (replicates as f64, each as f64);
        let middle = sums.iter().sum::<f64>() / count;
        let spread = sums.iter().map(|sum| (sum - middle).powi(2)).sum::<f64>() / (count - 1.0) / count;
        mean.push(middle / each);
        stderr.push(spread.sqrt() / each);
    }
    let (mut absolute, mut squares) = (0.0, 0.0);
    let observed = observed(&drawn, &terms, &sizes);
    let mut from = 0;
    let blocks = drawn.into_iter().map(|Drawn { mut block, .. }| {
        block.size = (0..block.pdf.len())
            .map(|i| {
                let part = |a: usize| {
                    let scale = if outputs == 1 { 1.0 } else { sizes[a] };
                    if scale > 0.0 { (terms[a * total + from + i] / scale).powi(2) } else { 0.0 }
                };
                let size = (0..outputs).map(part).sum::<f64>().sqrt();
                absolute += size;
                squares += size * size;
                size * block.pdf[i]
            })
            .collect();
        from += block.pdf.len();
        block
    });
    let blocks: Vec<Block> = blocks.collect();
    let effective_n = if squares > 0.0 { absolute * absolute / squares } else { 0.0 };
    let round = Round { mean, stderr, n, effective_n, components: 1, strata: 1 };
    Seen { round, scales: sizes, blocks, observed }
}

/// Of more outputs only the mean size is kept for strata.
const OUTPUTS_FOR_STRATA: usize = 8;

/// Points in the cube of the mixture's uniforms; `terms`: f / p of those that were kept, output after output.
fn observed(drawn: &[Drawn], terms: &[f64], sizes: &[f64]) -> Observed {
    let total: usize = drawn.iter().map(|drawn| drawn.kept.len()).sum();
    let outputs = if sizes.len() <= OUTPUTS_FOR_STRATA { sizes.len() } else { 1 };
    let size = |i: usize| {
        let of =
            (0..sizes.len()).filter(|&a| sizes[a] > 0.0).map(|a| (terms[a * total + i] / sizes[a]).abs());
        of.sum::<f64>()
    };
    let mut all = Observed::default();
    let mut from = 0;
    for Drawn { u, density, kept, .. } in drawn {
        let mut f = vec![vec![0.0; density.len()]; outputs];
        for (a, column) in f.iter_mut().enumerate() {
            for (i, &row) in kept.iter().enumerate() {
                let term = if outputs == sizes.len() { terms[a * total + from + i] } else { size(from + i) };
                column[row] = term * density[row];
            }
        }
        from += kept.len();
        let u = u.chunks(density.len().max(1)).map(<[f64]>::to_vec).collect();
        let is_exact = outputs == sizes.len();
        all.extend(Observed {
            u,
            f,
            is_exact,
            weight: density.iter().map(|density| 1.0 / density).collect(),
        });
    }
    all
}
