//! What a round of learning saw, and what follows from it.

use super::axis::Axis;
use super::component::Component;
use super::cube::CubeDensity;
use crate::columns::{Columns, ColumnsMut};

/// Some points of a round: where they are in the cube, how dense they were drawn, and how large f is.
#[derive(Clone, Debug)]
pub struct Block {
    /// Columns in the cube.
    pub x: Vec<f64>,
    /// The density that drew the points.
    pub pdf: Vec<f64>,
    /// The size of f over the base density: what the cube's density shall be proportional to. Finite, not negative.
    pub size: Vec<f64>,
}

impl Block {
    fn len(&self) -> usize {
        self.pdf.len()
    }

    pub fn columns(&self) -> Columns<'_> {
        Columns::new(&self.x, self.len())
    }
}

/// How one component meets the points of a block.
struct Met {
    /// Its uniforms.
    u: Vec<f64>,
    /// Its density.
    pdf: Vec<f64>,
}

fn meet(component: &Component, block: &Block) -> Met {
    let (n, dim) = (block.len(), component.axes().len());
    let mut met = Met { u: vec![0.0; n * dim], pdf: vec![0.0; n] };
    component.invert(block.columns(), ColumnsMut::new(&mut met.u, n), &mut met.pdf);
    met
}

/// A round's points, with exponents to flatten f.
pub struct Training<'a> {
    pub blocks: &'a [Block],
    /// f is learned to this power, at most 1.
    pub power: f64,
}

/// Sums over points in equal steps of u, along each axis.
struct Histogram {
    steps: usize,
    /// Σ v and Σ v², axis after axis.
    sums: Vec<f64>,
    squares: Vec<f64>,
}

impl Training<'_> {
    /// f to the power, over the density.
    fn weight(&self, block: &Block, i: usize) -> f64 {
        let size = block.size[i];
        if size > 0.0 {
            (if self.power == 1.0 { size } else { size.powf(self.power) }) / block.pdf[i]
        } else {
            0.0
        }
    }

    /// All weights, in order.
    pub fn weights(&self) -> Vec<f64> {
        self.blocks.iter().flat_map(|block| (0..block.len()).map(|i| self.weight(block, i))).collect()
    }

    /// A product along the cube's coordinates, refined as if it were to follow all of f by itself.
    pub fn refined_alone(&self, component: &Component, floor: f64) -> Component {
        let points: usize = self.blocks.iter().map(Block::len).sum();
        let steps = steps(points as f64);
        let mut histogram = Histogram::new(steps, component.axes().len());
        for block in self.blocks {
            let met = meet(component, block);
            // (f / p)² dp for its own density p, at points of another.
            let value = |i: usize| self.weight(block, i).powi(2) * block.pdf[i] / met.pdf[i];
            histogram.add(&met, value);
        }
        let each = points as f64 / steps as f64;
        component.with_axes(histogram.refine(component, each, floor))
    }

    /// Components with densities along their axes that follow the part of f for which each is responsible: the
    /// refinement of vegas, for each channel of a mixture (T. Ohl, "Vegas revisited", Comput. Phys. Commun. 120, 1999).
    pub fn refined(&self, cube: &CubeDensity, floor: f64) -> Vec<Component> {
        let points: usize = self.blocks.iter().map(Block::len).sum();
        let refine = |(component, weight): (&Component, f64)| {
            let steps = steps(points as f64 * weight);
            let mut histogram = Histogram::new(steps, cube.dim());
            for block in self.blocks {
                let met = meet(component, block);
                let value = |i: usize| self.weight(block, i).powi(2) * weight * met.pdf[i] / block.pdf[i];
                histogram.add(&met, value);
            }
            let each = points as f64 * weight / steps as f64;
            component.with_axes(histogram.refine(component, each, floor))
        };
        cube.components().iter().zip(cube.weights()).map(refine).collect()
    }

    /// Weights of components that lower the variance: W_k = E[(f/p)² p_k/p] are equal where it is least, so each weight
    /// is multiplied by √W_k (R. Kleiss & R. Pittau, Comput. Phys. Commun. 83, 1994), some times.
    ///
    /// Returns the weights and, for them, E[(f/p)²] / E[f/p]².
    pub fn fit_weights(&self, components: &[Component], start: &[f64]) -> (Vec<f64>, f64) {
        // So many blocks, from all replicates, are enough to tell.
        let step = self.blocks.len().div_ceil(FITTED_BLOCKS);
        let some: Vec<&Block> = self.blocks.iter().step_by(step.max(1)).collect();
        let each = |component: &Component| some.iter().flat_map(|block| meet(component, block).pdf).collect();
        let densities: Vec<Vec<f64>> = components.iter().map(each).collect();
        let size = |block: &Block, i: usize| self.weight(block, i);
        let weights: Vec<f64> =
            some.iter().flat_map(|block| (0..block.len()).map(move |i| size(block, i))).collect();
        let pdf: Vec<f64> = some.iter().flat_map(|block| block.pdf.iter().copied()).collect();
        let mean = weights.iter().sum::<f64>() / weights.len() as f64;
        let mut shares = start.to_vec();
        let mut second = f64::INFINITY;
        for _ in 0..12 {
            let total: f64 = shares.iter().sum();
            shares.iter_mut().for_each(|share| *share /= total);
            let mut gains = vec![0.0; shares.len()];
            second = 0.0;
            for (i, (&weight, &pdf)) in weights.iter().zip(&pdf).enumerate() {
                if weight > 0.0 {
                    let mixed: f64 = shares.iter().zip(&densities).map(|(share, p)| share * p[i]).sum();
                    let square = (weight * pdf).powi(2) / (mixed * pdf);
                    second += square;
                    gains.iter_mut().zip(&densities).for_each(|(gain, p)| *gain += square * p[i] / mixed);
                }
            }
            second /= weights.len() as f64;
            shares.iter_mut().zip(&gains).for_each(|(share, gain)| *share *= gain.sqrt());
        }
        let total: f64 = shares.iter().sum();
        shares.iter_mut().for_each(|share| *share /= total);
        (shares, second / (mean * mean))
    }
}

/// Weights are fitted to the points of about so many blocks.
const FITTED_BLOCKS: usize = 6;

/// Bins of an axis, at least: a constant needs no more than one, but what follows may.
const MIN_BINS: usize = 16;

/// As many steps as so many points can fill.
fn steps(points: f64) -> usize {
    let most = (points / 24.0).clamp(8.0, 128.0) as usize;
    1 << most.ilog2()
}

impl Histogram {
    fn new(steps: usize, dim: usize) -> Self {
        Self { steps, sums: vec![0.0; steps * dim], squares: vec![0.0; steps * dim] }
    }

    /// Adds `value` of each point that the component can draw, at its uniforms.
    fn add(&mut self, met: &Met, value: impl Fn(usize) -> f64) {
        let (n, steps) = (met.pdf.len(), self.steps);
        let values: Vec<f64> = (0..n).map(|i| if met.pdf[i] > 0.0 { value(i) } else { 0.0 }).collect();
        for (j, u) in met.u.chunks(n.max(1)).enumerate() {
            let sums = &mut self.sums[j * steps..][..steps];
            let squares = &mut self.squares[j * steps..][..steps];
            for (u, v) in u.iter().zip(&values) {
                let m = ((u * steps as f64) as usize).min(steps - 1);
                sums[m] += v;
                squares[m] += v * v;
            }
        }
    }

    /// The component's axes, refined; `each`: about how many points a step has.
    fn refine(&self, component: &Component, each: f64, floor: f64) -> Vec<Axis> {
        let axes = component.axes().iter().enumerate();
        axes.map(|(j, axis)| axis.refined(&self.factors(j, each), self.steps.max(MIN_BINS), floor)).collect()
    }

    /// By what the density along axis `j` shall be multiplied in each step: smoothed, and drawn towards the same for
    /// all by as much of their differences as chance explains.
    fn factors(&self, j: usize, each: f64) -> Vec<f64> {
        let steps = self.steps;
        let sums = &self.sums[j * steps..][..steps];
        let mean = sums.iter().sum::<f64>() / steps as f64;
        if !(mean > 0.0) {
            return vec![1.0; steps];
        }
        let smooth: Vec<f64> = (0..steps)
            .map(|m| {
                let (before, after) = (sums[m.saturating_sub(1)], sums[(m + 1).min(steps - 1)]);
                (before + 6.0 * sums[m] + after) / 8.0
            })
            .collect();
        let spread = smooth.iter().map(|sum| (sum - mean).powi(2)).sum::<f64>();
        let squares = self.squares[j * steps..][..steps].iter().sum::<f64>();
        let within = squares - sums.iter().map(|sum| sum * sum).sum::<f64>() / each;
        let noise = within.max(0.0) * (38.0 / 64.0); // of a sum, smoothed by 1, 6, 1
        let sure = if spread > 0.0 { (1.0 - noise / spread).max(0.0) } else { 0.0 };
        smooth.iter().map(|sum| (mean + sure * (sum - mean)).max(0.0).sqrt()).collect()
    }
}
