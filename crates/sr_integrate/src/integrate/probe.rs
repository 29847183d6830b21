//! Looking for places that a density misses.

use super::integrand::Integrand;
use super::{IntegrateError, rounds::values_of};
use crate::columns::{Columns, ColumnsMut};
use crate::density::Density;
use crate::points::{Points, Sequence};
use crate::space::Space;

/// How many points are looked at.
const POINTS: usize = 512;

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
    Points::new(Sequence::Sobol, dim, 0x70726f6265).fill(0, 0, x.reborrow());
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
    let missed: Vec<usize> = (0..POINTS).filter(|&i| pdf[i] == 0.0).collect();
    if missed.is_empty() {
        return Ok(());
    }
    let all = x.as_columns();
    let mut there = vec![0.0; dim * missed.len()];
    for (j, column) in there.chunks_mut(missed.len()).enumerate() {
        for (to, &i) in column.iter_mut().zip(&missed) {
            *to = all.get(i, j);
        }
    }
    let mut f = Vec::new();
    let outputs = values_of(integrand, there.clone(), missed.len(), &mut f)?;
    let there = Columns::new(&there, missed.len());
    for i in 0..missed.len() {
        for a in 0..outputs {
            let value = f[a * missed.len() + i];
            if value != 0.0 && value.is_finite() {
                return Err(IntegrateError::Hole { x: there.point(i), value });
            }
        }
    }
    Ok(())
}
