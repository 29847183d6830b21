//! Tests of densities, also of those that are written in Python.

use std::sync::Arc;

use numpy::PyReadonlyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sr_integrate::{Columns, ColumnsMut, DensityError, Space};
use sr_stats::chi2::blocks::{self, Blocks};
use sr_stats::{Chi2Settings, TestReport};

use super::density::{Density, density_error};

/// Statistic, degrees of freedom, p-value, and what a person should look at first.
type Outcome = (f64, f64, f64, String);

fn outcome(report: TestReport) -> Outcome {
    (report.statistic, report.dof, report.p_value, report.remark)
}

/// A density as the chi-square test sees it; every call may end the test by a signal.
struct AsBlocks(Arc<dyn sr_integrate::Density>);

/// Lets Python answer signals.
fn check_signals() -> Result<(), DensityError> {
    Python::attach(|py| py.check_signals()).map_err(|error| DensityError::Foreign(Box::new(error)))
}

impl Blocks for AsBlocks {
    type Error = DensityError;

    fn dim(&self) -> usize {
        self.0.space().dim()
    }

    fn uniforms(&self) -> usize {
        self.0.uniforms()
    }

    fn support(&self) -> Vec<[f64; 2]> {
        self.0.support()
    }

    fn sample(&mut self, u: &[f64], x: &mut [f64], pdf: &mut [f64]) -> Result<(), DensityError> {
        check_signals()?;
        let n = pdf.len();
        self.0.sample(Columns::new(u, n), ColumnsMut::new(x, n), pdf)
    }

    fn pdf(&mut self, x: &[f64], pdf: &mut [f64]) -> Result<(), DensityError> {
        check_signals()?;
        self.0.pdf(Columns::new(x, pdf.len()), pdf)
    }
}

/// Do samples follow their density? `cells`: about so many.
#[pyfunction]
pub fn chi2(py: Python<'_>, density: &Density, samples: u32, cells: usize, seed: u64) -> PyResult<Outcome> {
    let mut of = AsBlocks(density.0.clone());
    let settings = Chi2Settings { samples, bins: (cells, 1), seed };
    let space = density.0.space();
    let report = match space {
        Space::Area => {
            return Err(PyValueError::new_err(
                "a density of surface area cannot be tested: it is not known which surface",
            ));
        }
        Space::Counting => {
            let last = density.0.support().first().map_or(f64::NAN, |[_, high]| *high);
            if !(0.0..=1e7).contains(&last) {
                return Err(PyValueError::new_err(format!(
                    "support ends at {last}; a test of indices needs it to end from 0 to 10,000,000"
                )));
            }
            py.detach(|| blocks::indices(&mut of, last as usize + 1, settings))
        }
        Space::SolidAngle => py.detach(|| blocks::directions(&mut of, settings)),
        Space::Line | Space::Plane | Space::Volume(_) => py.detach(|| blocks::real(&mut of, settings)),
    };
    match report {
        Ok(report) => Ok(outcome(report)),
        // What cannot be integrated with is a finding here.
        Err(improper @ DensityError::Improper { .. }) => {
            let remark = format!("a density that is not a positive number: {improper}");
            Ok((f64::INFINITY, 0.0, 0.0, remark))
        }
        Err(error) => Err(density_error(py, error)),
    }
}

/// Were numbers, in ascending order, drawn with a distribution function that has these values at them?
#[pyfunction]
pub fn ks(x: PyReadonlyArray1<'_, f64>, cdf: PyReadonlyArray1<'_, f64>) -> PyResult<Outcome> {
    let (x, cdf) = (x.as_slice()?, cdf.as_slice()?);
    if x.len() != cdf.len() {
        return Err(PyValueError::new_err("x and cdf differ in length"));
    }
    let at = |value: f64| cdf.get(x.partition_point(|&x| x < value)).copied().unwrap_or(f64::NAN);
    Ok(outcome(sr_stats::ks(x, at)))
}
