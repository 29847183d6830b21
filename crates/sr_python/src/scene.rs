//! A compiled scene, and what can be said about it.

use std::sync::Arc;

use pyo3::prelude::*;
use pyo3::types::PyDict;
use sr_scene::{Geometry, Projection, SceneDesc};

use crate::names::value_error;

/// A compiled scene. Read-only.
#[pyclass(frozen, module = "steradian._internal")]
pub struct Scene {
    scene: Arc<sr_render::Scene>,
    counts: Counts,
    variants: Vec<String>,
}

/// What the description held.
#[derive(Clone, Copy)]
struct Counts {
    shapes: usize,
    instances: usize,
    triangles: usize,
}

impl Counts {
    fn of(desc: &SceneDesc) -> Self {
        let in_groups = desc.groups.iter().flat_map(|group| &group.shapes);
        let triangles = desc.shapes.iter().chain(in_groups.clone()).map(|shape| match &shape.geometry {
            Geometry::Mesh(mesh) => mesh.triangles.len(),
            _ => 0,
        });
        Self {
            shapes: desc.shapes.len() + in_groups.count(),
            instances: desc.instances.len(),
            triangles: triangles.sum(),
        }
    }
}

impl Scene {
    pub fn new(desc: &SceneDesc, scene: sr_render::Scene) -> Self {
        Self { scene: Arc::new(scene), counts: Counts::of(desc), variants: desc.variants.clone() }
    }

    pub fn shared(&self) -> Arc<sr_render::Scene> {
        self.scene.clone()
    }
}

/// A number of path edges from Python, where -1 means no limit.
pub fn edges(count: i64) -> PyResult<Option<u32>> {
    match count {
        -1 => Ok(None),
        count => u32::try_from(count).map(Some).map_err(value_error),
    }
}

fn edges_to_python(count: Option<u32>) -> i64 {
    count.map_or(-1, i64::from)
}

#[pymethods]
impl Scene {
    fn settings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let (settings, film) = (self.scene.settings(), &self.scene.camera().film);
        let dict = PyDict::new(py);
        let (width, height) = film.image_size();
        dict.set_item("width", width)?;
        dict.set_item("height", height)?;
        dict.set_item("spp", settings.spp)?;
        dict.set_item("max_depth", edges_to_python(settings.max_depth))?;
        dict.set_item("roulette_depth", edges_to_python(settings.roulette_depth))?;
        dict.set_item("hide_emitters", settings.hide_emitters)?;
        Ok(dict)
    }

    fn info<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        dict.set_item("camera", self.camera(py)?)?;
        dict.set_item("film", self.film(py)?)?;
        dict.set_item("settings", self.settings(py)?)?;
        dict.set_item("shapes", self.counts.shapes)?;
        dict.set_item("instances", self.counts.instances)?;
        dict.set_item("triangles", self.counts.triangles)?;
        dict.set_item("materials", self.scene.material_count())?;
        dict.set_item("textures", self.scene.texture_count())?;
        dict.set_item("lights", self.scene.lights().count())?;
        dict.set_item("variants", &self.variants)?;
        let bounds = self.scene.geometry().bounds();
        let corners = (!bounds.is_empty()).then(|| [bounds.min.to_array(), bounds.max.to_array()]);
        dict.set_item("bounds", corners)?;
        dict.set_item("memory_bytes", self.scene.memory_bytes())?;
        Ok(dict)
    }
}

impl Scene {
    fn camera<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let camera = self.scene.camera();
        let aspect = camera.film.width as f32 / camera.film.height as f32;
        let placement = camera.world_from_camera;
        let dict = PyDict::new(py);
        dict.set_item("position", placement.w_axis.truncate().to_array())?;
        dict.set_item("direction", placement.z_axis.truncate().normalize_or_zero().to_array())?;
        dict.set_item("up", placement.y_axis.truncate().normalize_or_zero().to_array())?;
        match &camera.projection {
            Projection::Perspective { fov_axis, fov, lens, .. } => {
                dict.set_item("projection", "perspective")?;
                dict.set_item("fov_x_deg", fov_axis.horizontal(*fov, aspect).to_degrees())?;
                dict.set_item("aperture_radius", lens.map_or(0.0, |lens| lens.aperture_radius))?;
                dict.set_item("focus_distance", lens.map(|lens| lens.focus_distance))?;
                dict.set_item("blades", lens.map_or(0, |lens| lens.blades))?;
            }
            Projection::Orthographic => {
                dict.set_item("projection", "orthographic")?;
                dict.set_item("width", 2.0 * placement.x_axis.truncate().length())?;
            }
            Projection::Spherical => dict.set_item("projection", "spherical")?,
        }
        Ok(dict)
    }

    fn film<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let film = &self.scene.camera().film;
        let (width, height) = film.image_size();
        let dict = PyDict::new(py);
        dict.set_item("width", width)?;
        dict.set_item("height", height)?;
        dict.set_item("crop_of", film.crop.map(|crop| [film.width, film.height, crop.x, crop.y]))?;
        dict.set_item("filter", film.filter.name())?;
        dict.set_item("filter_radius", film.filter.radius())?;
        Ok(dict)
    }
}
