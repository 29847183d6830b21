//! Learning a density, and writing one down.

use std::sync::Arc;

use pyo3::prelude::*;
use sr_integrate::adaptive::{Learned, Part};

use super::density::Density;
use super::request::Request;
use super::run::Integral;
use crate::names::value_error;

/// Mean, standard error, points, points that would do as well, and components of a round.
type Round = (Vec<f64>, Vec<f64>, u64, f64, usize);

/// A component: the knots of each axis, and the origin and rotation of its own axes, empty if it has none.
type PlainPart = (Vec<Vec<f64>>, Vec<f64>, Vec<f64>);

/// An integral, the density that was learned for it, and whether what was seen on the way agrees.
#[pyclass(frozen, module = "steradian._internal", get_all)]
pub struct Adapted {
    integral: Py<Integral>,
    parts: (Vec<PlainPart>, Vec<u32>),
    rounds: Vec<Round>,
    chi2: f64,
    dof: u64,
    n: u64,
    q: f64,
}

/// Learns a density over another, and integrates with it.
#[pyfunction]
pub fn adapt(py: Python<'_>, over: &Density, f: &Bound<'_, PyAny>, request: Request) -> PyResult<Adapted> {
    let found = request.run(py, f, |integrand, plan, pool, on_round| {
        sr_integrate::adaptive::adapt(&over.0, integrand, plan, pool, on_round)
    })?;
    let n = found.n();
    let rounds = found.rounds.into_iter();
    let (parts, shares) = found.density.parts();
    Ok(Adapted {
        integral: Py::new(py, Integral::from(found.integral))?,
        parts: (
            parts.into_iter().map(|Part { knots, centre, rotation }| (knots, centre, rotation)).collect(),
            shares,
        ),
        rounds: rounds
            .map(|round| (round.mean, round.stderr, round.n, round.effective_n, round.components))
            .collect(),
        chi2: found.chi2,
        dof: found.dof,
        n,
        q: found.q,
    })
}

/// A density that was learned before.
#[pyfunction]
pub fn learned(over: &Density, parts: Vec<PlainPart>, shares: Vec<u32>) -> PyResult<Density> {
    let parts = parts.into_iter().map(|(knots, centre, rotation)| Part { knots, centre, rotation }).collect();
    let learned = Learned::from_parts(over.0.clone(), parts, shares).map_err(value_error)?;
    Ok(Density(Arc::new(learned)))
}
