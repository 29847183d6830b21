//! Work on a thread of its own, with its own pool, that Python waits for in short turns.

use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::mpsc::{Receiver, RecvTimeoutError, channel};
use std::sync::{Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use pyo3::exceptions::{PyRuntimeError, PyValueError};
use pyo3::prelude::*;

/// The most threads that may be asked for.
pub const MAX_THREADS: usize = 1024;

/// The longest single wait.
const MAX_WAIT: f64 = 3600.0;

/// Work that will end in a `T`. Dropping a job does not stop its work.
pub struct Job<T>(Mutex<State<T>>);

struct State<T> {
    receiver: Receiver<PyResult<T>>,
    result: Option<PyResult<T>>,
}

impl<T: Send + 'static> Job<T> {
    /// Starts `work` in a pool of `threads` threads; 0 means as many as this process may use at once.
    pub fn start(threads: usize, work: impl FnOnce() -> PyResult<T> + Send + 'static) -> PyResult<Self> {
        let (sender, receiver) = channel();
        let run = move || {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(thread_count(threads)).build();
            let pool = pool.map_err(|error| PyRuntimeError::new_err(format!("no threads: {error}")))?;
            catch_unwind(AssertUnwindSafe(|| pool.install(work))).unwrap_or_else(|_| {
                Err(PyRuntimeError::new_err("internal error; please report the message above"))
            })
        };
        thread::Builder::new()
            .name("steradian".into())
            // Nobody listens any more if the job was dropped.
            .spawn(move || sender.send(run()).ok())?;
        Ok(Self(Mutex::new(State { receiver, result: None })))
    }

    /// Waits at most `seconds`, without the interpreter's lock. Is it done?
    pub fn wait(&self, py: Python<'_>, seconds: f64) -> PyResult<bool> {
        if !(0.0..=MAX_WAIT).contains(&seconds) {
            return Err(PyValueError::new_err(format!("seconds to wait are 0 to {MAX_WAIT}, not {seconds}")));
        }
        py.detach(|| {
            let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            if state.result.is_some() {
                return Ok(true);
            }
            match state.receiver.recv_timeout(Duration::from_secs_f64(seconds)) {
                Ok(result) => state.result = Some(result),
                Err(RecvTimeoutError::Timeout) => return Ok(false),
                Err(RecvTimeoutError::Disconnected) => {
                    return Err(PyRuntimeError::new_err("the result was taken already"));
                }
            }
            Ok(true)
        })
    }

    /// The result, once.
    pub fn take(&self) -> PyResult<T> {
        let mut state = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        state
            .result
            .take()
            .unwrap_or_else(|| Err(PyRuntimeError::new_err("the work is not done, or was taken")))
    }
}

/// As many threads as the affinity mask and the control group allow, unless a number is given.
pub fn thread_count(asked: usize) -> usize {
    match asked {
        0 => thread::available_parallelism().map_or(1, usize::from).min(MAX_THREADS),
        asked => asked.min(MAX_THREADS),
    }
}
