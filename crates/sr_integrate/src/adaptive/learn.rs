//! Learning a density, round by round.
//!
//! Two candidates learn from the same points: a product along the coordinates, as vegas has it, and a mixture of
//! products around the clusters in which f is large, along their own principal axes. The mixture is taken only where
//! the points say that it lowers the variance.
//!
//! As long as a few points outweigh all others, f is learned to a power below 1, which flattens it, so that every round
//! moves as far as its points can tell (annealing, as in R. Neal, "Annealed importance sampling", Stat. Comput. 11,
//! 2001). Narrow peaks are found from their slopes that way, and of several peaks the lower are not lost.
//!
//! What cannot be followed by either, an edge or a shell, is stratified in the end: [`stratify`](super::stratify) finds
//! where f / p still varies, and a round tells whether points do better there.

use std::sync::Arc;
use std::time::Instant;

use rayon::ThreadPool;
use sr_sampling::sequence::mix::{derive_key, mix64};

use super::axis::Axis;
use super::cluster::{Cloud, Cluster, clusters};
use super::component::{Component, Frame};
use super::cube::{CubeDensity, PARTS};
use super::level::Level;
use super::matrix::eigenvectors;
use super::round::{Round, Seen, round};
use super::stratify::Observed;
use super::training::{Block, Training};
use crate::density::Density;
use crate::integrate::{Integrand, IntegrateError};

/// This share of the probability along an axis is spread evenly, so that nothing is out of reach.
const FLOOR: f64 = 0.005;

/// How much to learn.
#[derive(Clone, Debug)]
pub struct Learning {
    /// Different seeds give unrelated points.
    pub seed: u64,
    /// At most about so many evaluations.
    pub evaluations: u64,
    /// Enough has been learned if what remains to be done for this relative error costs less than what was done.
    pub rtol: f64,
    /// No round begins later.
    pub until: Option<Instant>,
}

/// What was learned.
#[derive(Clone, Debug)]
pub struct Lesson {
    /// Where to draw uniforms for the base density.
    pub cube: CubeDensity,
    /// What to take off the terms, if the cube has strata.
    pub level: Option<Level>,
    /// What the rounds estimated.
    pub rounds: Vec<Round>,
}

impl Lesson {
    /// The number of evaluations.
    pub fn n(&self) -> u64 {
        self.rounds.iter().map(|round| round.n).sum()
    }
}

/// Learns where f / `base` is large.
///
/// - `on_round`: is told after each round, and may end everything by an error
///
/// # Errors
/// Those of the density and the integrand. Values that are not finite count as 0: the estimate that follows sees them.
pub fn learn(
    base: &Arc<dyn Density>,
    integrand: &mut Integrand<'_>,
    learning: &Learning,
    pool: Option<&ThreadPool>,
    on_round: &mut dyn FnMut(&Round) -> Result<(), IntegrateError>,
) -> Result<Lesson, IntegrateError> {
    let dim = base.uniforms();
    let mut pupil = Pupil::new(dim, derive_key(learning.seed, 0x1ea2));
    let mut rounds: Vec<Round> = Vec::new();
    let (mut spent, mut best, mut stale) = (0, None::<Best>, 0);
    let mut size = (learning.evaluations / 10).clamp(MIN_ROUND, 1 << 16);
    // Nobody knows how much is needed, or how long f takes: rounds begin small, and grow.
    let grows = learning.rtol > 0.0 || learning.until.is_some();
    if grows {
        size = size.min(2 * MIN_ROUND);
    }
    // Strata for what has been learned, once it has.
    let mut trial: Option<(CubeDensity, Level)> = None;
    let in_time = || learning.until.is_none_or(|until| Instant::now() < until);
    while rounds.is_empty() || spent + size <= learning.evaluations && in_time() {
        let seed = derive_key(learning.seed, rounds.len() as u32);
        let (drew, level) = match trial.clone() {
            Some((cube, level)) => (cube, Some(level)),
            None => (pupil.cube.clone(), None),
        };
        let Seen { round: seen, scales, blocks, observed } =
            round(base, (&drew, level.as_ref()), integrand, (size, seed), pool)?;
        on_round(&seen)?;
        spent += seen.n;
        let cost = seen.cost(&scales);
        let efficiency = seen.effective_n / seen.n as f64;
        rounds.push(seen);
        let known = best.as_ref().map_or(f64::INFINITY, |best| best.cost);
        let whole = trial.is_some() || pupil.learn(&blocks, efficiency);
        let settled = whole && efficiency > 0.0;
        if let (Some(best), Some(_)) = (&mut best, &trial) {
            stale = 2;
            best.observed.extend(observed);
            if !(cost < WORTH_STRATA * known) {
                break;
            }
            (best.cost, best.cube, best.level) = (cost, drew, level);
        } else if settled || best.is_none() {
            stale = if cost < 0.8 * known { 0 } else { stale + 1 };
            if cost < 1.3 * known || best.is_none() {
                best = Some(Best { cost: cost.min(known), cube: drew, level: None, observed });
            }
        }
        let enough = settled && learning.rtol > 0.0 && cost / learning.rtol.powi(2) < 2.0 * spent as f64;
        if enough || settled && cost < GOOD_ENOUGH {
            break;
        }
        if grows {
            size += size / 2;
        }
        let ends = spent + 2 * size > learning.evaluations;
        if settled && (stale >= 2 && rounds.len() >= 5 || stale >= 1 && ends) {
            trial = best.as_ref().and_then(Best::with_strata);
            if trial.is_none() {
                break;
            }
        }
    }
    // What the last round taught has not been tried; it was right to go on so far, unless rounds had become worse.
    let (cube, level) = match best {
        Some(best) if stale > 0 => (best.cube, best.level),
        _ => (pupil.cube, None),
    };
    Ok(Lesson { cube, level, rounds })
}

/// The best density so far, and what its points saw.
struct Best {
    cost: f64,
    cube: CubeDensity,
    level: Option<Level>,
    observed: Observed,
}

impl Best {
    /// The same with new strata, if they promise to be worth it.
    fn with_strata(&self) -> Option<(CubeDensity, Level)> {
        let (level, left) = self.observed.stratified()?;
        (left < WORTH_TRYING).then(|| (self.cube.with_strata(level.strata().clone()), level))
    }
}

/// Strata are tried if they promise to leave at most this share of the variance …
const WORTH_TRYING: f64 = 0.5;

/// … and kept if a point costs at most this share of what it costs without them, or with those before.
const WORTH_STRATA: f64 = 0.8;

/// Rounds of fewer points teach little.
const MIN_ROUND: u64 = 1024;

/// The variance of a point, relative to the square of the mean, at which nothing need be learned any more.
const GOOD_ENOUGH: f64 = 1e-3;

/// A product is refined so often with the points of a round: its coordinates have to agree with one another.
const PASSES: u32 = 3;

/// Points are flattened until this share of them would do as well if they were equal.
const EFFECTIVE: f64 = 0.05;

/// What has been learned so far.
struct Pupil {
    key: u64,
    /// The best product along the coordinates, on its own.
    alone: Component,
    /// What draws the next round.
    cube: CubeDensity,
    /// The power of f that it follows.
    power: f64,
    lessons: u32,
    /// Clusterings since f is learned as it is.
    whole: u32,
    /// Did the last clusters not pay?
    failed: bool,
}

impl Pupil {
    fn new(dim: usize, key: u64) -> Self {
        let alone = Component::uniform(dim);
        Self { key, alone, cube: CubeDensity::uniform(dim), power: 0.0, lessons: 0, whole: 0, failed: false }
    }

    /// Learns from a round. Returns whether its points were drawn for f as it is.
    fn learn(&mut self, blocks: &[Block], efficiency: f64) -> bool {
        let drawn_for_all = self.power == 1.0;
        if !(efficiency > 0.0) {
            return false;
        }
        self.lessons += 1;
        let power = temper(blocks, self.lessons);
        // No progress: points will not tell more than they do.
        self.power = if power < 1.1 * self.power { 1.0 } else { power };
        let training = Training { blocks, power: self.power };
        let mut alone = f64::INFINITY;
        for _ in 0..PASSES {
            self.alone = training.refined_alone(&self.alone, FLOOR);
            alone = training.fit_weights(std::slice::from_ref(&self.alone), &[1.0]).1;
            if alone < 1.1 {
                break;
            }
        }
        let single = CubeDensity::single(self.alone.clone());
        // While the product itself is still moving, clusters would only help it out.
        let mixed = self.cube.components().len() > 1;
        let helpless = match self.power < 1.0 {
            true => alone > 1.05,
            false => alone > 1.3 && self.lessons > 2 && self.whole < 2,
        };
        // They did not pay, and may not yet: a round is left out.
        let unlikely = std::mem::take(&mut self.failed) && alone < 2.0;
        if !mixed && (!helpless || unlikely) {
            self.cube = single;
            return drawn_for_all;
        }
        let afresh = !mixed || self.power < 1.0 || self.whole < 2;
        self.whole += u32::from(self.power == 1.0);
        let components = if afresh { self.clustered(&training) } else { training.refined(&self.cube, FLOOR) };
        let (weights, mixture) = training.fit_weights(&components, &vec![1.0; components.len()]);
        let price = 1.0 + 0.3 * components.len() as f64;
        let pays = alone - 1.0 > price * (mixture - 1.0) + 0.02;
        self.failed = !pays;
        self.cube = if pays { mixture_with_reserve(components, weights) } else { single };
        drawn_for_all
    }

    /// The product on its own, the constant density, and one around each cluster.
    fn clustered(&self, training: &Training<'_>) -> Vec<Component> {
        let dim = self.cube.dim();
        let key = derive_key(self.key, self.lessons);
        let cloud = resampled(training, dim, key);
        let points = training.blocks.iter().map(|block| block.pdf.len()).sum::<usize>();
        let worth = cloud.weights.iter().sum::<f64>();
        let found = clusters(&cloud, (points / 512).clamp(2, 24), key);
        let mut components = vec![Component::uniform(dim), self.alone.clone()];
        components.extend(found.iter().map(|cluster| around(cluster, worth)));
        components
    }
}

/// The mixture, at least one part of which is a constant density.
fn mixture_with_reserve(components: Vec<Component>, mut weights: Vec<f64>) -> CubeDensity {
    let dim = components[0].axes().len();
    let part = 1.0 / f64::from(PARTS);
    let constant = Component::uniform(dim);
    let mut components = components;
    match components.iter().position(|component| *component == constant) {
        Some(k) => weights[k] = weights[k].max(1.02 * part),
        None => {
            components.push(constant);
            weights.push(1.02 * part);
        }
    }
    CubeDensity::mixture(components, &weights)
}

/// The largest power of f, at most 1, of which enough points are left that count.
fn temper(blocks: &[Block], lesson: u32) -> f64 {
    let all: Vec<(f64, f64)> = blocks
        .iter()
        .flat_map(|block| block.size.iter().zip(&block.pdf))
        .filter(|(size, _)| **size > 0.0)
        .map(|(size, pdf)| (size.ln(), pdf.ln()))
        .collect();
    let points: usize = blocks.iter().map(|block| block.pdf.len()).sum();
    // A sample of them says it.
    let step = (all.len() / 4096).max(1);
    let some: Vec<(f64, f64)> = all.iter().skip(lesson as usize % step).step_by(step).copied().collect();
    let share = 1.0 / step as f64;
    let effective = |power: f64| {
        let log = |&(size, pdf): &(f64, f64)| power * size - pdf;
        let top = some.iter().map(log).fold(f64::NEG_INFINITY, f64::max);
        let (sum, squares) =
            some.iter().map(|pair| (log(pair) - top).exp()).fold((0.0, 0.0), |(s, q), w| (s + w, q + w * w));
        sum * sum / squares / share
    };
    let goal = EFFECTIVE * points as f64;
    if effective(1.0) >= goal {
        return 1.0;
    }
    let (mut low, mut high) = (0.01_f64, 1.0);
    for _ in 0..12 {
        let middle = (low * high).sqrt();
        if effective(middle) >= goal { low = middle } else { high = middle }
    }
    low
}

/// Points in proportion to their weights; worth as many as their effective number.
fn resampled(training: &Training<'_>, dim: usize, key: u64) -> Cloud {
    let weights = training.weights();
    let (sum, squares) = weights.iter().fold((0.0, 0.0), |(s, q), w| (s + w, q + w * w));
    let effective = sum * sum / squares;
    let count = (1.5 * effective).clamp(64.0, 512.0);
    let step = sum / count;
    let mut goal = step * (mix64(key) as f64 / u64::MAX as f64);
    let (mut points, mut copies) = (Vec::new(), Vec::new());
    let (mut reached, mut from) = (0.0, 0);
    for block in training.blocks {
        let n = block.pdf.len();
        for i in 0..n {
            reached += weights[from + i];
            let mut here = 0.0;
            while goal < reached {
                here += 1.0;
                goal += step;
            }
            if here > 0.0 {
                points.extend((0..dim).map(|j| block.x[j * n + i]));
                copies.push(here);
            }
        }
        from += n;
    }
    let scale = effective.min(count) / copies.iter().sum::<f64>();
    copies.iter_mut().for_each(|copies| *copies *= scale);
    Cloud { dim, points, weights: copies }
}

/// A product around a cluster: along its principal axes, if these differ from the cube's.
fn around(cluster: &Cluster, worth: f64) -> Component {
    const BINS: usize = 32;
    const WIDER: f64 = 1.15;
    let dim = cluster.mean.len();
    let c = |a: usize, b: usize| cluster.covariance[a * dim + b];
    let correlation = (0..dim)
        .flat_map(|a| (0..a).map(move |b| (a, b)))
        .map(|(a, b)| (c(a, b) / (c(a, a) * c(b, b)).sqrt()).abs())
        .fold(0.0, f64::max);
    let chance = 3.5 / (cluster.share * worth).max(1.0).sqrt();
    if correlation < chance.max(0.2) {
        let axis = |j: usize| Axis::bell(cluster.mean[j], WIDER * c(j, j).sqrt(), [0.0, 1.0], BINS, FLOOR);
        return Component::new((0..dim).map(axis).collect(), None);
    }
    let rotation = eigenvectors(&cluster.covariance, dim);
    let frame = Frame { centre: cluster.mean.clone(), rotation };
    let ranges = frame.ranges();
    let axis = |j: usize| {
        let along = |a: usize| frame.rotation[a * dim + j];
        let variance: f64 =
            (0..dim * dim).map(|i| along(i / dim) * c(i / dim, i % dim) * along(i % dim)).sum();
        Axis::bell(0.0, WIDER * variance.max(1e-30).sqrt(), ranges[j], BINS, FLOOR)
    };
    let axes = (0..dim).map(axis).collect();
    Component::new(axes, Some(frame))
}
