//! Integrands that were compiled elsewhere: C, Numba.

use std::ffi::c_void;

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use sr_integrate::Columns;
use sr_integrate::integrate::Parallel;

/// How a compiled function is called.
#[derive(Clone, Copy, Debug)]
enum Call {
    /// `double f(double x)`
    Number(extern "C" fn(f64) -> f64),
    /// `double f(const double *x, int64_t dim)`
    Point(extern "C" fn(*const f64, i64) -> f64),
    /// `double f(int dim, double *x)`, SciPy's
    DimPoint(extern "C" fn(i32, *const f64) -> f64),
    /// `double f(int dim, double *x, void *user_data)`, SciPy's
    DimPointData(extern "C" fn(i32, *const f64, *mut c_void) -> f64),
    /// `void f(const double *x, int64_t n, int64_t dim, double *out)`; coordinate j of point i is `x[j * n + i]`
    Block(extern "C" fn(*const f64, i64, i64, *mut f64)),
}

/// A compiled function, which any thread may call.
#[pyclass(frozen, module = "steradian._internal")]
#[derive(Debug)]
pub struct Native {
    call: Call,
    /// The third argument of `DimPointData`, as an address.
    data: usize,
    /// Keeps the code alive.
    _owner: Py<PyAny>,
}

#[pymethods]
impl Native {
    /// `address` must be that of a function of the kind `call`, which `owner` keeps alive.
    #[new]
    fn new(address: usize, call: &str, data: usize, owner: Py<PyAny>) -> PyResult<Self> {
        if address == 0 {
            return Err(PyValueError::new_err("the address of the function is 0"));
        }
        let pointer = address as *const c_void;
        // SAFETY: Python says what is there, from the declared types of the function; see steradian/integrands.py.
        let call = unsafe {
            match call {
                "number" => {
                    Call::Number(std::mem::transmute::<*const c_void, extern "C" fn(f64) -> f64>(pointer))
                }
                "point" => Call::Point(std::mem::transmute::<
                    *const c_void,
                    extern "C" fn(*const f64, i64) -> f64,
                >(pointer)),
                "dim_point" => Call::DimPoint(std::mem::transmute::<
                    *const c_void,
                    extern "C" fn(i32, *const f64) -> f64,
                >(pointer)),
                "dim_point_data" => Call::DimPointData(std::mem::transmute::<
                    *const c_void,
                    extern "C" fn(i32, *const f64, *mut c_void) -> f64,
                >(pointer)),
                "block" => Call::Block(std::mem::transmute::<
                    *const c_void,
                    extern "C" fn(*const f64, i64, i64, *mut f64),
                >(pointer)),
                _ => return Err(PyValueError::new_err(format!("no such call: {call}"))),
            }
        };
        Ok(Self { call, data, _owner: owner })
    }

    /// The same function with the address of data, for those that take one.
    fn with_data(&self, py: Python<'_>, data: usize) -> Self {
        Self { call: self.call, data, _owner: self._owner.clone_ref(py) }
    }
}

impl Parallel for Native {
    fn eval(&self, x: Columns<'_>, f: &mut [f64]) {
        let (n, dim) = (x.len(), x.dim());
        match self.call {
            Call::Number(call) => f.iter_mut().zip(x.column(0)).for_each(|(f, &x)| *f = call(x)),
            Call::Block(call) => call(x.numbers().as_ptr(), n as i64, dim as i64, f.as_mut_ptr()),
            Call::Point(call) => by_point(x, f, |point| call(point.as_ptr(), dim as i64)),
            Call::DimPoint(call) => by_point(x, f, |point| call(dim as i32, point.as_ptr())),
            Call::DimPointData(call) => {
                by_point(x, f, |point| call(dim as i32, point.as_ptr(), self.data as *mut c_void));
            }
        }
    }
}

/// Rows instead of columns, for functions of a point.
fn by_point(x: Columns<'_>, f: &mut [f64], call: impl Fn(&[f64]) -> f64) {
    let (n, dim) = (x.len(), x.dim());
    let mut rows = vec![0.0; n * dim];
    for j in 0..dim {
        for (row, &x) in rows.chunks_exact_mut(dim).zip(x.column(j)) {
            row[j] = x;
        }
    }
    for (f, row) in f.iter_mut().zip(rows.chunks_exact(dim.max(1))) {
        *f = call(row);
    }
}
