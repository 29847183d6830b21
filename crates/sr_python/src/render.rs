//! A render as a job: started, looked at, cancelled, and its result taken.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use pyo3::prelude::*;
use sr_render::{Control, PassReport, RenderSettings, Stop};

use crate::image::{Film, film_error};
use crate::job::Job;
use crate::names::value_error;
use crate::scene::{Scene, edges};

/// The mean relative error reads the whole film: it is worked out at most this often,
const ERROR_INTERVAL: Duration = Duration::from_millis(500);
/// and at most every so many times what it takes.
const ERROR_SHARE: u32 = 50;

/// A render under way. Dropping it cancels it.
#[pyclass(frozen, module = "steradian._internal")]
pub struct RenderJob {
    job: Job<Rendered>,
    cancel: Arc<AtomicBool>,
    watch: Arc<Watch>,
}

/// What Python asks for, by name.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub struct Request {
    width: u32,
    height: u32,
    strategy: String,
    sampler: String,
    seed: u64,
    /// -1 is unbounded.
    max_depth: i64,
    /// -1 is as late as may be.
    roulette_depth: i64,
    hide_emitters: bool,
    first_sample: u32,
    count: u32,
    /// In seconds.
    time_limit: Option<f64>,
    /// 0 is all.
    threads: usize,
    /// Will progress be asked for?
    watch_error: bool,
}

impl Request {
    fn settings(&self) -> PyResult<RenderSettings> {
        Ok(RenderSettings {
            width: self.width,
            height: self.height,
            max_depth: edges(self.max_depth)?,
            roulette_depth: edges(self.roulette_depth)?,
            hide_emitters: self.hide_emitters,
            strategy: self.strategy.parse().map_err(value_error)?,
            sampler: self.sampler.parse().map_err(value_error)?,
            seed: self.seed,
        })
    }
}

struct Rendered {
    film: sr_render::Film,
    stop: Stop,
    seconds: f64,
}

#[derive(Clone, Copy, Default)]
struct Progress {
    samples_done: u32,
    seconds: f64,
    mean_relative_error: Option<f64>,
}

/// What a render tells while it runs.
struct Watch {
    progress: Mutex<Progress>,
    /// When the error is due next; none if nobody asks for it.
    error_due: Mutex<Option<Instant>>,
}

impl Watch {
    fn update(&self, report: &PassReport, film: &sr_render::Film) {
        let error = self.error(film);
        let mut progress = lock(&self.progress);
        progress.samples_done = report.samples_done;
        progress.seconds = report.elapsed.as_secs_f64();
        progress.mean_relative_error = error.or(progress.mean_relative_error);
    }

    fn error(&self, film: &sr_render::Film) -> Option<f64> {
        let mut due = lock(&self.error_due);
        let began = Instant::now();
        if due.is_none_or(|due| began < due) || film.spp() < 2 {
            return None;
        }
        let error = film.image().mean_relative_error();
        *due = Some(Instant::now() + ERROR_INTERVAL.max(ERROR_SHARE * began.elapsed()));
        Some(error)
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[pymethods]
impl RenderJob {
    /// Starts.
    #[new]
    fn new(scene: &Scene, request: Request) -> PyResult<Self> {
        let settings = request.settings()?;
        let Request { width, height, first_sample, count, time_limit, threads, watch_error, .. } = request;
        let end = first_sample.checked_add(count).ok_or_else(|| value_error("too many samples"))?;
        let limit = time_limit.map(Duration::try_from_secs_f64).transpose().map_err(value_error)?;
        let mut film = sr_render::Film::new(width, height).map_err(film_error)?;
        let cancel = Arc::new(AtomicBool::new(false));
        let watch = Arc::new(Watch {
            progress: Mutex::new(Progress::default()),
            error_due: Mutex::new(watch_error.then(Instant::now)),
        });
        let (scene, cancelled, watched) = (scene.shared(), cancel.clone(), watch.clone());
        let job = Job::start(threads, move || {
            let start = Instant::now();
            let control = Control {
                cancel: &cancelled,
                // A limit beyond the clock's range is no limit.
                deadline: limit.and_then(|limit| start.checked_add(limit)),
                on_pass: &|report, film| watched.update(report, film),
            };
            let stop = sr_render::render(&scene, &settings, first_sample..end, &mut film, &control);
            let stop = stop.map_err(film_error)?;
            Ok(Rendered { film, stop, seconds: start.elapsed().as_secs_f64() })
        })?;
        Ok(Self { job, cancel, watch })
    }

    /// Waits at most `seconds`; is it done?
    fn wait(&self, py: Python<'_>, seconds: f64) -> PyResult<bool> {
        self.job.wait(py, seconds)
    }

    /// Samples per pixel done, seconds since the start, mean relative error if known.
    fn progress(&self, py: Python<'_>) -> (u32, f64, Option<f64>) {
        let now = py.detach(|| *lock(&self.watch.progress));
        (now.samples_done, now.seconds, now.mean_relative_error)
    }

    /// Asks it to stop soon.
    fn cancel(&self) {
        self.cancel.store(true, Ordering::Relaxed);
    }

    /// The film, why it ended, and seconds of sampling. Once, when it is done.
    fn result(&self) -> PyResult<(Film, &'static str, f64)> {
        let Rendered { film, stop, seconds } = self.job.take()?;
        let stopped = match stop {
            Stop::Complete => "complete",
            Stop::Cancelled => "interrupted",
            Stop::Deadline => "time",
        };
        Ok((Film(film), stopped, seconds))
    }
}

impl Drop for RenderJob {
    fn drop(&mut self) {
        self.cancel();
    }
}
