//! Learning a density, and writing one down.

use std::sync::Arc;

use pyo3::prelude::*;
use sr_integrate::adaptive::{Learned, Part, Parts};

use super::density::Density;
use super::request::Request;
use super::run::Integral;
use crate::names::value_error;

/// Mean, standard error, points, points that would do as well, components and strata of a round.
type Round = (Vec<f64>, Vec<f64>, u64, f64, usize, usize);

/// A component: the knots of each axis, and the origin and rotation of its own axes, empty if it has none.
type PlainPart = (Vec<Vec<f64>>, Vec<f64>, Vec<f64>);

/// The axis that a cell is cut across and the probability of its lower half, cell before halves; nothing for a stratum.
type PlainStrata = Vec<Option<(usize, f64)>>;

/// An integral, the density that was learned for it, and whether what was seen on the way agrees.
#[pyclass(frozen, module = "steradian._internal", get_all)]
pub struct Adapted {
    integral: Py<Integral>,
    parts: (Vec<PlainPart>, Vec<u32>, PlainStrata),
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
    let Parts { components, shares, strata } = found.density.parts();
    let plain = |Part { knots, centre, rotation }| (knots, centre, rotation);
    Ok(Adapted {
        integral: Py::new(py, Integral::from(found.integral))?,
        parts: (components.into_iter().map(plain).collect(), shares, strata),
        rounds: rounds
            .map(|round| {
                (round.mean, round.stderr, round.n, round.effective_n, round.components, round.strata)
            })
            .collect(),
        chi2: found.chi2,
        dof: found.dof,
        n,
        q: found.q,
    })
}

/// A density that was learned before.
#[pyfunction]
pub fn learned(
    over: &Density,
    components: Vec<PlainPart>,
    shares: Vec<u32>,
    strata: PlainStrata,
) -> PyResult<Density> {
    let part = |(knots, centre, rotation)| Part { knots, centre, rotation };
    let parts = Parts { components: components.into_iter().map(part).collect(), shares, strata };
    let learned = Learned::from_parts(over.0.clone(), parts).map_err(value_error)?;
    Ok(Density(Arc::new(learned)))
}
