//! Looking for places that a density misses.

use super::integrand::Integrand;
use super::resampled::Target;
use super::{IntegrateError, rounds::values_of};
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Density, DensityError};
use crate::points::{Points, Sequence};
use crate::space::Space;

/// How many points are looked at.
const POINTS: usize = 512;
/// How many points of a source of candidates.
const CANDIDATES: usize = 2048;
/// Of the points that are looked at.
const SEED: u64 = 0x70726f6265;

/// Evaluates the integrand at even points of a box where the density is 0, and fails if it is not 0 there, too.
///
/// Samples of a density never show where it is 0, so that an integral could be missing a part without anybody
/// noticing; this finds holes that take up a share of the box of some 1 / 512 or more. Without a density of 0 in the
/// box the integrand is not evaluated. Where it is not a number, outside its own domain perhaps, nothing is said.
///
/// # Errors
/// A hole; or the density's or the integrand's own errors.
pub fn look_for_holes(
    density: &dyn Density,
    domain: &[[f64; 2]],
    integrand: &mut Integrand<'_>,
) -> Result<(), IntegrateError> {
    let dim = domain.len();
    if domain.iter().any(|[low, high]| !(low.is_finite() && high.is_finite())) {
        return Ok(());
    }
    let mut numbers = vec![0.0; dim * POINTS];
    let mut x = ColumnsMut::new(&mut numbers, POINTS);
    Points::new(Sequence::Sobol, dim, SEED).fill(0, 0, x.reborrow());
    for (j, [low, high]) in domain.iter().enumerate() {
        if density.space() == Space::Counting {
            // Between indices there is nothing to miss.
            x.column(j).iter_mut().for_each(|x| *x = (low + (*x * (high - low + 1.0)).floor()).min(*high));
        } else {
            x.column(j).iter_mut().for_each(|x| *x = low + *x * (high - low));
        }
    }
    let mut pdf = vec![0.0; POINTS];
    density.pdf(x.as_columns(), &mut pdf)?;
    match first_not_zero(x.as_columns(), |i| pdf[i] == 0.0, integrand)? {
        Some((x, value)) => Err(IntegrateError::Hole { x, value }),
        None => Ok(()),
    }
}

/// Evaluates the integrand at points of `source` where a target of resampling is 0, and fails if it is not 0 there, too.
///
/// # Errors
/// A target that is 0 where f is not, or no target; or the errors of all three.
pub fn look_past_target(
    source: &dyn Density,
    target: &impl Target,
    integrand: &mut Integrand<'_>,
) -> Result<(), IntegrateError> {
    let n = CANDIDATES;
    let mut u = vec![0.0; source.uniforms() * n];
    Points::new(Sequence::Sobol, source.uniforms(), SEED).fill(0, 0, ColumnsMut::new(&mut u, n));
    let (mut x, mut pdf, mut goal) = (vec![0.0; source.space().dim() * n], vec![0.0; n], vec![0.0; n]);
    source.sample(Columns::new(&u, n), ColumnsMut::new(&mut x, n), &mut pdf)?;
    let x = Columns::new(&x, n);
    target.eval(x, &mut goal)?;
    DensityError::check("target", &goal, x, |i| pdf[i] > 0.0)?;
    match first_not_zero(x, |i| goal[i] == 0.0 && pdf[i] > 0.0, integrand)? {
        Some((x, value)) => Err(IntegrateError::TargetHole { x, value }),
        None => Ok(()),
    }
}

/// The first of some of the points where f is a number other than 0, and that number. If there are none of them, f is
/// not evaluated.
fn first_not_zero(
    all: Columns<'_>,
    is_one: impl Fn(usize) -> bool,
    integrand: &mut Integrand<'_>,
) -> Result<Option<(Vec<f64>, f64)>, IntegrateError> {
    let some: Vec<usize> = (0..all.len()).filter(|&i| is_one(i)).collect();
    if some.is_empty() {
        return Ok(None);
    }
    let there: Vec<f64> = (0..all.dim()).flat_map(|j| some.iter().map(move |&i| all.get(i, j))).collect();
    let mut f = Vec::new();
    let n = some.len();
    let outputs = values_of(integrand, there.clone(), n, &mut f)?;
    let tells = |&i: &usize| f[i] != 0.0 && f[i].is_finite();
    let first = (0..n).find_map(|i| (0..outputs).map(|a| a * n + i).find(tells));
    Ok(first.map(|at| (Columns::new(&there, n).point(at % n), f[at])))
}
