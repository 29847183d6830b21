//! Resampled importance sampling: the best of several candidates.

use crate::columns::{Columns, ColumnsMut};
use crate::density::{Density, DensityError};
use crate::space::Space;
use std::fmt::Debug;
use std::sync::Arc;

use super::technique::Technique;

/// The most candidates of a sample.
pub const MAX_CANDIDATES: usize = 1 << 12;

/// What resampled points should be proportional to. It need not be normalised; it is an error if it is
/// negative, infinite or not a number.
pub trait Target: Sync + Debug {
    /// The target at each point.
    ///
    /// # Errors
    /// Only those of targets that somebody else wrote.
    fn eval(&self, x: Columns<'_>, target: &mut [f64]) -> Result<(), DensityError>;
}

impl Target for Arc<dyn Density> {
    fn eval(&self, x: Columns<'_>, target: &mut [f64]) -> Result<(), DensityError> {
        self.pdf(x, target)
    }
}

/// Candidates from a density that is easy to sample, one of which is chosen in proportion to ĝ / p: the more there are,
/// the nearer the points are to the target ĝ (J. Talbot, D. Cline & P. Egbert, "Importance resampling for global
/// illumination", EGSR 2005; T. Bitterli et al., "Spatiotemporal reservoir resampling …", 2020, eq. 6).
///
/// The factor is (1 / ĝ(x)) · (1 / m) Σ ĝ(xₖ) / p(xₖ): unbiased for any m wherever ĝ and p are positive where f is not 0.
#[derive(Debug)]
pub struct Resampled<T> {
    source: Arc<dyn Density>,
    target: T,
    candidates: usize,
}

impl<T: Target> Resampled<T> {
    /// Of `candidates` points from `source`, one in proportion to `target`.
    ///
    /// # Panics
    /// If there is no candidate, or more than [`MAX_CANDIDATES`].
    pub fn new(source: Arc<dyn Density>, target: T, candidates: usize) -> Self {
        assert!((1..=MAX_CANDIDATES).contains(&candidates), "{candidates} candidates");
        Self { source, target, candidates }
    }

    /// What points are to be proportional to.
    pub fn target(&self) -> &T {
        &self.target
    }
}

impl<T: Target> Technique for Resampled<T> {
    fn space(&self) -> Space {
        self.source.space()
    }

    /// One to choose with, and those of each candidate.
    fn uniforms(&self) -> usize {
        1 + self.candidates * self.source.uniforms()
    }

    fn draw(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, factor: &mut [f64]) -> Result<(), DensityError> {
        let (n, m) = (factor.len(), self.candidates);
        let (dim, uniforms) = (self.space().dim(), self.source.uniforms());
        let mut points = vec![0.0; m * dim * n];
        let mut targets = vec![0.0; m * n];
        let mut ratios = vec![0.0; m * n];
        for k in 0..m {
            let points = &mut points[k * dim * n..(k + 1) * dim * n];
            let (target, ratio) = (&mut targets[k * n..(k + 1) * n], &mut ratios[k * n..(k + 1) * n]);
            let first = 1 + k * uniforms;
            self.source.sample(u.columns(first..first + uniforms), ColumnsMut::new(points, n), ratio)?;
            let points = Columns::new(points, n);
            self.target.eval(points, target)?;
            DensityError::check("target", target, points, |i| ratio[i] > 0.0)?;
            for (ratio, target) in ratio.iter_mut().zip(target) {
                *ratio = if *ratio > 0.0 { *target / *ratio } else { 0.0 };
            }
        }
        for (i, factor) in factor.iter_mut().enumerate() {
            let ratio = |k: usize| ratios[k * n + i];
            let sum: f64 = (0..m).map(ratio).sum();
            *factor = 0.0;
            if !(sum > 0.0) {
                continue;
            }
            let mut left = u.get(i, 0) * sum;
            let mut chosen = None;
            for k in (0..m).filter(|&k| ratio(k) > 0.0) {
                chosen = Some(k);
                if left < ratio(k) {
                    break;
                }
                left -= ratio(k);
            }
            let Some(k) = chosen else { continue };
            for j in 0..dim {
                x.set(i, j, points[(k * dim + j) * n + i]);
            }
            *factor = sum / m as f64 / targets[k * n + i];
        }
        Ok(())
    }
}
