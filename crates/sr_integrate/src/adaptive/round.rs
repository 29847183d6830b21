//! A round of learning: points from the density so far, and f there.

use std::sync::Arc;

use rayon::ThreadPool;
use rayon::prelude::*;

use super::cube::CubeDensity;
use super::training::Block;
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Density, DensityError};
use crate::integrate::{Integrand, IntegrateError, values_of};
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

/// Points of a block, also where the base density puts them.
struct Drawn {
    replicate: usize,
    block: Block,
    x: Vec<f64>,
    base: Vec<f64>,
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
    let (mut v, mut pdf) = (vec![0.0; dim * n], vec![0.0; n]);
    cube.sample(Columns::new(&u, n), ColumnsMut::new(&mut v, n), &mut pdf);
    let (mut x, mut p) = (vec![0.0; out * n], vec![0.0; n]);
    base.sample(Columns::new(&v, n), ColumnsMut::new(&mut x, n), &mut p)?;
    if (0..n).any(|i| !(pdf[i] > 0.0 && p[i] > 0.0)) {
        let kept: Vec<usize> = (0..n).filter(|&i| pdf[i] > 0.0 && p[i] > 0.0).collect();
        let keep = |numbers: &[f64]| -> Vec<f64> {
            numbers.chunks(n).flat_map(|column| kept.iter().map(|&i| column[i])).collect()
        };
        (v, pdf, x, p) = (keep(&v), keep(&pdf), keep(&x), keep(&p));
    }
    Ok(Drawn { replicate: replicate as usize, block: Block { x: v, pdf, size: Vec::new() }, x, base: p })
}

/// Draws about `n` points, evaluates f there, and tells what they say of the integral, with the mean size of each
/// output. Where f is not finite it counts as 0.
pub fn round(
    base: &Arc<dyn Density>,
    cube: &CubeDensity,
    integrand: &mut Integrand<'_>,
    (n, seed): (u64, u64),
    pool: Option<&ThreadPool>,
) -> Result<(Round, Vec<f64>, Vec<Block>), IntegrateError> {
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
    let (round, scales, blocks) = summed(drawn, &f, outputs, each);
    Ok((Round { components: cube.components().len(), ..round }, scales, blocks))
}

fn summed(drawn: Vec<Drawn>, f: &[f64], outputs: usize, each: u64) -> (Round, Vec<f64>, Vec<Block>) {
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
    let (mut mean, mut stderr) = (Vec::new(), Vec::new());
    for sums in sums.chunks(replicates) {
        let (count, each) = (replicates as f64, each as f64);
        let middle = sums.iter().sum::<f64>() / count;
        let spread = sums.iter().map(|sum| (sum - middle).powi(2)).sum::<f64>() / (count - 1.0) / count;
        mean.push(middle / each);
        stderr.push(spread.sqrt() / each);
    }
    let (mut absolute, mut squares) = (0.0, 0.0);
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
    (Round { mean, stderr, n, effective_n, components: 0 }, sizes, blocks)
}
