//! What every integration is asked: when to stop, where to run, what to call.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rayon::{ThreadPool, ThreadPoolBuilder};
use sr_integrate::integrate::{Integrand, OnRound, Progress, look_for_holes};
use sr_integrate::{IntegrateError, Plan};

use super::density::{Density, density_error, foreign_error};
use super::foreign::Function;
use super::native::Native;
use crate::job::thread_count;
use crate::names::value_error;

/// Below so many points a pool of threads costs more than it saves.
const POOL_PAYS: u64 = 1 << 16;

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
    pub known: Vec<f64>,
    /// Called with (n, n_max, seconds, mean, stderr) after each round.
    on_round: Option<Py<PyAny>>,
    /// Boxes, each with the density that should cover it.
    domains: Vec<(Py<Density>, Vec<[f64; 2]>)>,
}

impl Request {
    /// Checks the plan, looks where densities should cover f, and does the work, without the interpreter's lock.
    pub fn run<T: Send>(
        &self,
        py: Python<'_>,
        f: &Bound<'_, PyAny>,
        work: impl FnOnce(
            &mut Integrand<'_>,
            &Plan,
            Option<&ThreadPool>,
            &mut OnRound<'_>,
        ) -> Result<T, IntegrateError>
        + Send,
    ) -> PyResult<T> {
        let plan = self.plan()?;
        let pool = pool(&plan, self.threads)?;
        let domains: Vec<_> = self.domains.iter().map(|(p, domain)| (p.get().0.clone(), domain)).collect();
        let native = f.cast::<Native>().ok().map(|native| native.clone().unbind());
        let mut function = Function(f.clone().unbind());
        let mut on_round = |progress: &Progress| Ok(Python::attach(|py| self.tell(py, progress))?);
        py.detach(|| {
            let mut integrand = match &native {
                Some(native) => Integrand::Parallel(native.get()),
                None => Integrand::Blocks(&mut function),
            };
            for (density, domain) in &domains {
                look_for_holes(&**density, domain, &mut integrand)?;
            }
            work(&mut integrand, &plan, pool.as_ref(), &mut on_round)
        })
        .map_err(|error| integrate_error(py, error))
    }

    fn plan(&self) -> PyResult<Plan> {
        let plan = Plan {
            sequence: self.sequence.parse().map_err(value_error)?,
            replicates: self.replicates,
            seed: self.seed,
            n: self.n,
            rtol: self.rtol,
            atol: self.atol,
            seconds: self.seconds,
            batch: self.batch,
            nan_as_zero: self.nan_as_zero,
        };
        plan.check().map_err(value_error)?;
        Ok(plan)
    }

    /// Lets Python answer signals, and calls back.
    fn tell(&self, py: Python<'_>, progress: &Progress) -> PyResult<()> {
        py.check_signals()?;
        let Some(callback) = &self.on_round else { return Ok(()) };
        let Progress { n, n_max, seconds, mean, stderr } = progress.clone();
        callback.call1(py, (n, n_max, seconds, mean, stderr)).map(drop)
    }
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
        IntegrateError::Overflow { x, value, .. } => raise("IntegrandError", x, value, 1),
        IntegrateError::Hole { x, value } | IntegrateError::TargetHole { x, value } => {
            raise("SupportError", x, value, 1)
        }
        IntegrateError::Plan(_) | IntegrateError::Outputs { .. } => PyValueError::new_err(error.to_string()),
    }
}
