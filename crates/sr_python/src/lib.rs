//! `steradian._internal`: conversion between Python and the crates, and nothing else.
//!
//! In: Python objects that `python/steradian` has checked. Out: the same, converted. Work that takes long runs
//! as a [`job`], outside the interpreter's lock, so that Python can go on answering signals.

mod convert;
mod image;
mod integrate;
mod job;
mod limits;
mod load;
mod names;
mod node;
mod output;
mod render;
mod scene;
mod verify;

use pyo3::prelude::*;

#[pymodule]
fn _internal(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("MAX_THREADS", job::MAX_THREADS)?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<load::LoadJob>()?;
    module.add_class::<convert::ConvertJob>()?;
    module.add_class::<render::RenderJob>()?;
    module.add_class::<image::Film>()?;
    module.add_class::<image::Image>()?;
    module.add_function(wrap_pyfunction!(limits::check_limits, module)?)?;
    module.add_function(wrap_pyfunction!(load::load_file, module)?)?;
    module.add_function(wrap_pyfunction!(load::load_dict, module)?)?;
    module.add_function(wrap_pyfunction!(convert::convert_file, module)?)?;
    module.add_function(wrap_pyfunction!(convert::convert_dict, module)?)?;
    module.add_function(wrap_pyfunction!(convert::check_target, module)?)?;
    module.add_function(wrap_pyfunction!(names::normalize_strategy, module)?)?;
    module.add_function(wrap_pyfunction!(names::normalize_sampler, module)?)?;
    module.add_function(wrap_pyfunction!(names::tones, module)?)?;
    module.add_function(wrap_pyfunction!(image::check_film_size, module)?)?;
    module.add_function(wrap_pyfunction!(image::film_bytes, module)?)?;
    module.add_function(wrap_pyfunction!(output::check_format, module)?)?;
    module.add_function(wrap_pyfunction!(output::write_image, module)?)?;
    module.add_function(wrap_pyfunction!(output::encode_png, module)?)?;
    module.add_class::<verify::VerifyJob>()?;
    module.add_function(wrap_pyfunction!(verify::verify_blocks, module)?)?;
    integrate::register(module)
}
