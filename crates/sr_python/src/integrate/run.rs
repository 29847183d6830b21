//! Running an integration, and what comes out of it.

use std::sync::Arc;

use numpy::PyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sr_integrate::integrate::{
    Combined, MAX_CANDIDATES, Resampled, Single, Target, Technique, look_past_target,
};
use sr_integrate::{ColumnsMut, Points};

use super::arrays::to_rows;
use super::density::Density;
use super::foreign::Function;
use super::request::Request;
use crate::names::value_error;

/// The most points that [`points`] makes at a time.
const MAX_NUMBERS: usize = 1 << 31;

/// An integral, or several, with what is known of their errors.
#[pyclass(frozen, module = "steradian._internal", get_all)]
pub struct Integral {
    mean: Vec<f64>,
    stderr: Vec<f64>,
    covariance: Vec<f64>,
    dof: u64,
    n: u64,
    nans: u64,
    not_drawn: u64,
    largest_share: f64,
    effective_n: f64,
    /// By the largest points; `None` if these are too few.
    tail_index: Option<f64>,
    has_heavy_tail: bool,
    ended_by_cap: bool,
    seconds: f64,
    /// A control, and the mean and standard error of its points, which contradict its known integral.
    contradicted: Option<(usize, f64, f64)>,
}

impl From<sr_integrate::Integral> for Integral {
    fn from(integral: sr_integrate::Integral) -> Self {
        let sr_integrate::Integral { mean, stderr, covariance, dof, n, .. } = integral;
        let sr_integrate::Integral { nans, not_drawn, largest_share, effective_n, .. } = integral;
        Self {
            mean,
            stderr,
            covariance,
            dof,
            n,
            nans,
            not_drawn,
            largest_share,
            effective_n,
            tail_index: integral.tail.index,
            has_heavy_tail: integral.tail.is_heavy(),
            ended_by_cap: integral.ended_by_cap,
            seconds: integral.seconds,
            contradicted: None,
        }
    }
}

/// ∫ f over one density.
#[pyfunction]
pub fn integrate(
    py: Python<'_>,
    density: &Density,
    f: &Bound<'_, PyAny>,
    request: Request,
) -> PyResult<Integral> {
    run(py, &[(&Single(density.0.clone()), 1)], f, &request)
}

/// ∫ f over several densities, whose samples are weighted.
#[pyfunction]
pub fn mis_integrate(
    py: Python<'_>,
    densities: Vec<Py<Density>>,
    counts: Vec<u32>,
    heuristic: &str,
    f: &Bound<'_, PyAny>,
    request: Request,
) -> PyResult<Integral> {
    let densities: Vec<Arc<dyn sr_integrate::Density>> =
        densities.iter().map(|p| p.get().0.clone()).collect();
    let combined =
        Combined::all(&densities, &counts, heuristic.parse().map_err(value_error)?).map_err(value_error)?;
    let techniques: Vec<(&dyn Technique, u32)> = combined
        .iter()
        .zip(&counts)
        .map(|(technique, &count)| (technique as &dyn Technique, count))
        .collect();
    run(py, &techniques, f, &request)
}

/// ∫ f with points that are chosen among candidates, in proportion to a target.
#[pyfunction]
pub fn ris_integrate(
    py: Python<'_>,
    source: &Density,
    target: &Bound<'_, PyAny>,
    candidates: usize,
    f: &Bound<'_, PyAny>,
    request: Request,
) -> PyResult<Integral> {
    if !(1..=MAX_CANDIDATES).contains(&candidates) {
        return Err(PyValueError::new_err(format!(
            "candidates is {candidates}; it must be from 1 to {MAX_CANDIDATES}"
        )));
    }
    fn go<T: Target>(
        py: Python<'_>,
        source: &Density,
        target: T,
        candidates: usize,
        f: &Bound<'_, PyAny>,
        request: &Request,
    ) -> PyResult<Integral> {
        let resampled = Resampled::new(source.0.clone(), target, candidates);
        let integral = request.run(py, f, |integrand, plan, pool, on_round| {
            look_past_target(&*source.0, resampled.target(), integrand)?;
            sr_integrate::integrate(&[(&resampled, 1)], integrand, plan, pool, on_round)
        })?;
        Ok(integral.into())
    }
    match target.cast::<Density>() {
        Ok(density) if density.get().0.space() == source.0.space() => {
            go(py, source, density.get().0.clone(), candidates, f, &request)
        }
        Ok(density) => Err(PyValueError::new_err(format!(
            "target is a density of {}, and over one of {}",
            density.get().0.space(),
            source.0.space()
        ))),
        Err(_) => go(py, source, Function(target.clone().unbind()), candidates, f, &request),
    }
}

fn run(
    py: Python<'_>,
    techniques: &[(&dyn Technique, u32)],
    f: &Bound<'_, PyAny>,
    request: &Request,
) -> PyResult<Integral> {
    let integral = request.run(py, f, |integrand, plan, pool, on_round| {
        sr_integrate::integrate(techniques, integrand, plan, pool, on_round)
    })?;
    if request.known.is_empty() {
        return Ok(integral.into());
    }
    let controlled = integral.with_controls(&request.known).map_err(value_error)?;
    let contradicted = integral.contradicted(&request.known);
    let contradicted = contradicted.map(|(index, found)| (index, found.mean, found.stderr));
    Ok(Integral { contradicted, ..controlled.into() })
}

/// Points (n, dim) of a sequence, from index `first` of a replicate on.
#[pyfunction]
pub fn points<'py>(
    py: Python<'py>,
    sequence: &str,
    dim: usize,
    n: usize,
    seed: u64,
    replicate: u32,
    first: u64,
) -> PyResult<Bound<'py, PyArray2<f64>>> {
    if dim.saturating_mul(n) > MAX_NUMBERS {
        return Err(PyValueError::new_err(format!(
            "{n} points of {dim} uniforms are too many; the limit is 2^31 numbers"
        )));
    }
    let points = Points::new(sequence.parse().map_err(value_error)?, dim, seed);
    let mut numbers = vec![0.0; dim * n];
    py.detach(|| points.fill(replicate, first, ColumnsMut::new(&mut numbers, n)));
    to_rows(py, numbers, n)
}

/// The number that Student's t with `dof` degrees of freedom stays below with probability `p`.
#[pyfunction]
pub fn student_t(p: f64, dof: f64) -> f64 {
    sr_stats::student_t_quantile(p, dof)
}

/// A mean and its error as text.
#[pyfunction]
pub fn format_uncertain(mean: f64, stderr: f64) -> String {
    sr_sampling::format_uncertain(mean, stderr)
}
