//! Running an integration, and what comes out of it.

use std::error::Error;
use std::sync::Arc;

use numpy::PyArray2;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::{ThreadPool, ThreadPoolBuilder};
use sr_integrate::integrate::{
    Combined, Integrand, MAX_CANDIDATES, Progress, Resampled, Single, Target, Technique, look_for_holes,
};
use sr_integrate::{ColumnsMut, IntegrateError, Plan, Points};

use super::arrays::to_rows;
use super::density::{Density, density_error, foreign_error};
use super::foreign::Function;
use super::native::Native;
use crate::job::thread_count;
use crate::names::value_error;

/// Below so many points a pool of threads costs more than it saves.
const POOL_PAYS: u64 = 1 << 16;

/// The most points that [`points`] makes at a time.
const MAX_NUMBERS: usize = 1 << 31;

/// What Python asks for, by name.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Request {
    sequence: String,
    replicates: u32,
    seed: u64,
    n: Option<u64>,
    rtol: f64,
    atol: f64,
    seconds: Option<f64>,
    batch: usize,
    nan_as_zero: bool,
    /// 0 is all.
    threads: usize,
    /// The integrals of the last outputs, which are control variates.
    known: Vec<f64>,
    /// Called with (n, n_max, seconds, mean, stderr) after each round.
    on_round: Option<Py<PyAny>>,
    /// Boxes, each with the density that should cover it.
    domains: Vec<(Py<Density>, Vec<[f64; 2]>)>,
}

/// An integral, or several, with what is known of their errors.
#[pyclass(frozen, module = "steradian._internal", get_all)]
pub struct Integral {
    mean: Vec<f64>,
    covariance: Vec<f64>,
    dof: u64,
    n: u64,
    nans: u64,
    not_drawn: u64,
    largest_share: f64,
    effective_n: f64,
    seconds: f64,
}

impl From<sr_integrate::Integral> for Integral {
    fn from(integral: sr_integrate::Integral) -> Self {
        let sr_integrate::Integral { mean, covariance, dof, n, .. } = integral;
        let sr_integrate::Integral { nans, not_drawn, largest_share, effective_n, seconds, .. } = integral;
        Self { mean, covariance, dof, n, nans, not_drawn, largest_share, effective_n, seconds }
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
    run(py, &[(&Single(density.0.clone()), 1)], f, request)
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
    run(py, &techniques, f, request)
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
        request: Request,
    ) -> PyResult<Integral> {
        run(py, &[(&Resampled::new(source.0.clone(), target, candidates), 1)], f, request)
    }
    match target.cast::<Density>() {
        Ok(density) if density.get().0.space() == source.0.space() => {
            go(py, source, density.get().0.clone(), candidates, f, request)
        }
        Ok(density) => Err(PyValueError::new_err(format!(
            "target is a density of {}, and over one of {}",
            density.get().0.space(),
            source.0.space()
        ))),
        Err(_) => go(py, source, Function(target.clone().unbind()), candidates, f, request),
    }
}

fn run(
    py: Python<'_>,
    techniques: &[(&dyn Technique, u32)],
    f: &Bound<'_, PyAny>,
    request: Request,
) -> PyResult<Integral> {
    let plan = Plan {
        sequence: request.sequence.parse().map_err(value_error)?,
        replicates: request.replicates,
        seed: request.seed,
        n: request.n,
        rtol: request.rtol,
        atol: request.atol,
        seconds: request.seconds,
        batch: request.batch,
        nan_as_zero: request.nan_as_zero,
    };
    plan.check().map_err(value_error)?;
    let domains: Vec<_> =
        request.domains.iter().map(|(p, domain)| (p.get().0.clone(), domain.clone())).collect();
    let native = f.cast::<Native>().ok().map(|native| native.clone().unbind());
    let mut function = Function(f.clone().unbind());
    let mut on_round = |progress: &Progress| -> Result<(), Box<dyn Error + Send + Sync>> {
        Ok(Python::attach(|py| {
            py.check_signals()?;
            let Some(callback) = &request.on_round else { return Ok(()) };
            let Progress { n, n_max, seconds, mean, stderr } = progress.clone();
            callback.call1(py, (n, n_max, seconds, mean, stderr)).map(drop)
        })?)
    };
    let pool = pool(&plan, request.threads)?;
    let integral = py.detach(|| {
        let mut integrand = match &native {
            Some(native) => Integrand::Parallel(native.get()),
            None => Integrand::Blocks(&mut function),
        };
        for (density, domain) in &domains {
            look_for_holes(&**density, domain, &mut integrand)?;
        }
        sr_integrate::integrate(techniques, &mut integrand, &plan, pool.as_ref(), &mut on_round)
    });
    let integral = integral.map_err(|error| integrate_error(py, error))?;
    if request.known.is_empty() {
        return Ok(integral.into());
    }
    Ok(integral.with_controls(&request.known).map_err(value_error)?.into())
}

/// Threads of this call alone, so that nothing is left behind, and a forked process finds nothing broken.
fn pool(plan: &Plan, threads: usize) -> PyResult<Option<ThreadPool>> {
    let threads = thread_count(threads);
    if threads == 1 || plan.n.is_some_and(|n| n < POOL_PAYS) {
        return Ok(None);
    }
    let pool = ThreadPoolBuilder::new().num_threads(threads).build();
    Ok(Some(pool.map_err(|error| PyValueError::new_err(format!("no threads: {error}")))?))
}

/// What Python raises.
fn integrate_error(py: Python<'_>, error: IntegrateError) -> PyErr {
    let message = error.to_string();
    let raise = |class: &str, x: Vec<f64>, value: f64, count: u64| {
        let make = || -> PyResult<PyErr> {
            let class = py.import("steradian.integration.errors")?.getattr(class)?;
            let arguments = PyDict::new(py);
            arguments.set_item("x", x)?;
            arguments.set_item("value", value)?;
            arguments.set_item("count", count)?;
            Ok(PyErr::from_value(class.call((message,), Some(&arguments))?))
        };
        make().unwrap_or_else(|error| error)
    };
    match error {
        IntegrateError::Foreign(error) => foreign_error(py, error),
        IntegrateError::Density(error) => density_error(py, error),
        IntegrateError::NotFinite { x, value, count, .. } => raise("IntegrandError", x, value, count),
        IntegrateError::Overflow { x, .. } => raise("IntegrandError", x, f64::INFINITY, 1),
        IntegrateError::Hole { x, value } => raise("SupportError", x, value, 1),
        IntegrateError::Plan(_) | IntegrateError::Outputs { .. } => PyValueError::new_err(error.to_string()),
    }
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
