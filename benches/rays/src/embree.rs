//! Embree 4 by its C interface, loaded when the program runs.
//!
//! In: a path to the shared library, meshes and placements. Out: [`EmbreeScene`], which answers for single rays and
//! for packets of 16. Numbers and layouts are those of Embree's headers `rtcore_*.h`, version 4.4.

use std::ffi::{c_char, c_int, c_void};
use std::path::Path;
use std::sync::atomic::{AtomicIsize, Ordering};

use libloading::Library;
use sr_geometry::Ray;

use crate::scenes::Scene;

type Handle = *mut c_void;

/// What Embree gives to rays that hit nothing.
const INVALID: u32 = u32::MAX;
const GEOMETRY_TRIANGLE: c_int = 0;
const GEOMETRY_INSTANCE: c_int = 121;
const BUFFER_INDEX: c_int = 0;
const BUFFER_VERTEX: c_int = 1;
const FORMAT_UINT3: c_int = 0x5003;
const FORMAT_FLOAT3: c_int = 0x9003;
const FORMAT_FLOAT3X4_COLUMN_MAJOR: c_int = 0x9234;
const COHERENT: c_int = 1 << 16;
const ALL_FEATURES: c_int = -1;
/// Rays of a packet.
pub const PACKET: usize = 16;

/// How a scene is built.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Build {
    /// Watertight, as ours is: `RTC_SCENE_FLAG_ROBUST`.
    pub robust: bool,
    /// With spatial splits: `RTC_BUILD_QUALITY_HIGH` instead of `MEDIUM`.
    pub high_quality: bool,
}

impl Build {
    /// `RTC_SCENE_FLAG_ROBUST` or none.
    fn flags(self) -> c_int {
        if self.robust { 1 << 2 } else { 0 }
    }

    fn quality(self) -> c_int {
        if self.high_quality { 2 } else { 1 }
    }
}

/// `RTCRayHit`. Only one level of instances is ever used; the padding is more than any build of Embree needs.
#[repr(C, align(64))]
struct RayHit {
    origin: [f32; 3],
    near: f32,
    direction: [f32; 3],
    time: f32,
    far: f32,
    mask: u32,
    id: u32,
    flags: u32,
    normal: [f32; 3],
    uv: [f32; 2],
    primitive: u32,
    geometry: u32,
    instance: [u32; 15],
}

/// `RTCRayHit16`, with as much padding.
#[repr(C, align(64))]
struct RayHit16 {
    origin: [[f32; PACKET]; 3],
    near: [f32; PACKET],
    direction: [[f32; PACKET]; 3],
    time: [f32; PACKET],
    far: [f32; PACKET],
    mask: [u32; PACKET],
    id: [u32; PACKET],
    flags: [u32; PACKET],
    normal: [[f32; PACKET]; 3],
    uv: [[f32; PACKET]; 2],
    primitive: [u32; PACKET],
    geometry: [u32; PACKET],
    instance: [[u32; PACKET]; 15],
}

/// `RTCIntersectArguments` and `RTCOccludedArguments`, with room for what later versions add.
#[repr(C)]
struct QueryArguments {
    flags: c_int,
    features: c_int,
    context: Handle,
    functions: [Handle; 6],
}

const COHERENT_QUERY: QueryArguments = QueryArguments {
    flags: COHERENT,
    features: ALL_FEATURES,
    context: std::ptr::null_mut(),
    functions: [std::ptr::null_mut(); 6],
};

/// Declares the functions that are used, each with its C name and type, and how they are all looked up.
macro_rules! functions {
    ($($field:ident: $symbol:literal, fn($($argument:ty),*) $(-> $result:ty)?;)*) => {
        struct Functions { $($field: unsafe extern "C" fn($($argument),*) $(-> $result)?,)* }

        impl Functions {
            fn load(library: &Library) -> Result<Self, libloading::Error> {
                // SAFETY: these are the types that Embree 4's headers declare.
                unsafe { Ok(Self { $($field: *library.get(concat!($symbol, "\0").as_bytes())?,)* }) }
            }
        }
    };
}

functions! {
    new_device: "rtcNewDevice", fn(*const c_char) -> Handle;
    release_device: "rtcReleaseDevice", fn(Handle);
    set_monitor: "rtcSetDeviceMemoryMonitorFunction",
        fn(Handle, extern "C" fn(Handle, isize, bool) -> bool, *const AtomicIsize);
    new_scene: "rtcNewScene", fn(Handle) -> Handle;
    release_scene: "rtcReleaseScene", fn(Handle);
    set_flags: "rtcSetSceneFlags", fn(Handle, c_int);
    set_quality: "rtcSetSceneBuildQuality", fn(Handle, c_int);
    commit_scene: "rtcCommitScene", fn(Handle);
    new_geometry: "rtcNewGeometry", fn(Handle, c_int) -> Handle;
    release_geometry: "rtcReleaseGeometry", fn(Handle);
    set_buffer: "rtcSetSharedGeometryBuffer",
        fn(Handle, c_int, u32, c_int, *const c_void, usize, usize, usize);
    set_geometry_quality: "rtcSetGeometryBuildQuality", fn(Handle, c_int);
    set_instanced: "rtcSetGeometryInstancedScene", fn(Handle, Handle);
    set_transform: "rtcSetGeometryTransform", fn(Handle, u32, c_int, *const f32);
    commit_geometry: "rtcCommitGeometry", fn(Handle);
    attach: "rtcAttachGeometry", fn(Handle, Handle) -> u32;
    intersect: "rtcIntersect1", fn(Handle, *mut RayHit, *const QueryArguments);
    occluded: "rtcOccluded1", fn(Handle, *mut RayHit, *const QueryArguments);
    intersect_16: "rtcIntersect16", fn(*const [c_int; PACKET], Handle, *mut RayHit16, *const QueryArguments);
    occluded_16: "rtcOccluded16", fn(*const [c_int; PACKET], Handle, *mut RayHit16, *const QueryArguments);
}

/// Embree with a number of threads.
pub struct Device {
    device: Handle,
    functions: Functions,
    /// What Embree has allocated; boxed, as Embree knows its address.
    bytes: Box<AtomicIsize>,
    /// Dropped last.
    _library: Library,
}

extern "C" fn count(bytes: Handle, change: isize, _after: bool) -> bool {
    // SAFETY: the pointer that `Device::new` has given, which lives as long as the device.
    let bytes = unsafe { &*bytes.cast::<AtomicIsize>() };
    bytes.fetch_add(change, Ordering::Relaxed);
    true
}

impl Device {
    /// Loads the library and starts its threads.
    pub fn new(library: &Path, threads: usize) -> Result<Self, String> {
        let failed = |error| format!("{} is no Embree 4: {error}", library.display());
        // SAFETY: loading Embree runs no more than its own and its scheduler's constructors.
        let loaded = unsafe { Library::new(library) }.map_err(failed)?;
        let functions = Functions::load(&loaded).map_err(failed)?;
        let config = format!("threads={threads}\0");
        let bytes = Box::new(AtomicIsize::new(0));
        // SAFETY: the text ends in a zero; `bytes` outlives the device.
        let device = unsafe {
            let device = (functions.new_device)(config.as_ptr().cast());
            if device.is_null() {
                return Err(format!("{} makes no device", library.display()));
            }
            (functions.set_monitor)(device, count, &raw const *bytes);
            device
        };
        Ok(Self { device, functions, bytes, _library: loaded })
    }

    /// Bytes that Embree has allocated.
    pub fn bytes(&self) -> isize {
        self.bytes.load(Ordering::Relaxed)
    }

    /// Builds the trees. The arrays in `vertices` are shared, not copied.
    pub fn build<'a>(
        &'a self,
        scene: &Scene,
        vertices: &'a PaddedVertices<'a>,
        how: Build,
    ) -> EmbreeScene<'a> {
        let meshes = self.scene(how, |handle| {
            for (positions, triangles) in &vertices.0 {
                let buffers = [
                    (BUFFER_INDEX, FORMAT_UINT3, triangles.as_ptr().cast(), triangles.len()),
                    (BUFFER_VERTEX, FORMAT_FLOAT3, positions.as_ptr().cast::<c_void>(), positions.len() / 3),
                ];
                self.attach(handle, GEOMETRY_TRIANGLE, how, |geometry| {
                    for (kind, format, data, count) in buffers {
                        // SAFETY: `count` items of 12 bytes, padded as Embree asks, live as long as the scene.
                        unsafe { (self.functions.set_buffer)(geometry, kind, 0, format, data, 0, 12, count) };
                    }
                });
            }
        });
        if scene.placements.is_empty() {
            return meshes;
        }
        self.scene(how, |handle| {
            for placement in &scene.placements {
                let columns = placement.to_cols_array().map(|x| x as f32);
                self.attach(handle, GEOMETRY_INSTANCE, how, |geometry| {
                    // SAFETY: Embree counts references to `meshes`' handle; it reads the 12 numbers now.
                    unsafe {
                        (self.functions.set_instanced)(geometry, meshes.handle);
                        let format = FORMAT_FLOAT3X4_COLUMN_MAJOR;
                        (self.functions.set_transform)(geometry, 0, format, columns.as_ptr());
                    }
                });
            }
        })
    }

    fn scene(&self, how: Build, fill: impl FnOnce(Handle)) -> EmbreeScene<'_> {
        let f = &self.functions;
        // SAFETY: handles are valid until they are released, which `EmbreeScene` does.
        unsafe {
            let handle = (f.new_scene)(self.device);
            (f.set_flags)(handle, how.flags());
            (f.set_quality)(handle, how.quality());
            fill(handle);
            (f.commit_scene)(handle);
            EmbreeScene { device: self, handle }
        }
    }

    fn attach(&self, scene: Handle, kind: c_int, how: Build, fill: impl FnOnce(Handle)) {
        let f = &self.functions;
        // SAFETY: the scene keeps the geometry once it is attached.
        unsafe {
            let geometry = (f.new_geometry)(self.device, kind);
            (f.set_geometry_quality)(geometry, how.quality());
            fill(geometry);
            (f.commit_geometry)(geometry);
            (f.attach)(scene, geometry);
            (f.release_geometry)(geometry);
        }
    }
}

impl Drop for Device {
    fn drop(&mut self) {
        // SAFETY: scenes borrow the device, so that none is left.
        unsafe { (self.functions.release_device)(self.device) }
    }
}

/// Positions as Embree reads them, 4 bytes longer than they are, and triangles; a pair for each mesh.
pub struct PaddedVertices<'a>(Vec<(Vec<f32>, &'a [[u32; 3]])>);

impl<'a> PaddedVertices<'a> {
    /// Of all meshes.
    pub fn new(scene: &'a Scene) -> Self {
        let padded = scene.meshes.iter().map(|mesh| {
            let mut positions: Vec<f32> = mesh.positions.iter().flat_map(|p| p.to_array()).collect();
            positions.push(0.0);
            (positions, &mesh.triangles[..])
        });
        Self(padded.collect())
    }
}

/// A scene that rays can meet.
pub struct EmbreeScene<'a> {
    device: &'a Device,
    handle: Handle,
}

impl Drop for EmbreeScene<'_> {
    fn drop(&mut self) {
        // SAFETY: it is released once.
        unsafe { (self.device.functions.release_scene)(self.handle) }
    }
}

impl EmbreeScene<'_> {
    /// The distance of the closest hit in units of the direction's length; infinity: none.
    #[inline]
    pub fn closest(&self, ray: &Ray) -> f32 {
        let mut query = RayHit::new(ray);
        // SAFETY: `query` is what `rtcIntersect1` reads and writes; no arguments are the default ones.
        unsafe { (self.device.functions.intersect)(self.handle, &mut query, std::ptr::null()) };
        if query.geometry == INVALID { f32::INFINITY } else { query.far }
    }

    /// Does the ray hit anything?
    #[inline]
    pub fn occluded(&self, ray: &Ray) -> bool {
        let mut query = RayHit::new(ray);
        // SAFETY: as above; `rtcOccluded1` reads and writes the first part.
        unsafe { (self.device.functions.occluded)(self.handle, &mut query, std::ptr::null()) };
        query.far < 0.0
    }

    /// As [`Self::closest`], for up to [`PACKET`] rays that run alike.
    #[inline]
    pub fn closest_packet(&self, rays: &[Ray], t: &mut [f32]) {
        let (mut query, valid) = RayHit16::new(rays);
        // SAFETY: `query` is what `rtcIntersect16` reads and writes.
        unsafe { (self.device.functions.intersect_16)(&valid, self.handle, &mut query, &COHERENT_QUERY) };
        for (i, t) in t.iter_mut().enumerate() {
            *t = if query.geometry[i] == INVALID { f32::INFINITY } else { query.far[i] };
        }
    }

    /// How many of up to [`PACKET`] rays that run alike hit anything.
    #[inline]
    pub fn occluded_packet(&self, rays: &[Ray]) -> usize {
        let (mut query, valid) = RayHit16::new(rays);
        // SAFETY: as above; `rtcOccluded16` reads and writes the first part.
        unsafe { (self.device.functions.occluded_16)(&valid, self.handle, &mut query, &COHERENT_QUERY) };
        query.far[..rays.len()].iter().filter(|&&far| far < 0.0).count()
    }
}

impl RayHit {
    #[inline]
    fn new(ray: &Ray) -> Self {
        Self {
            origin: ray.origin.to_array(),
            near: 0.0,
            direction: ray.direction.to_array(),
            time: 0.0,
            far: ray.t_max,
            mask: u32::MAX,
            id: 0,
            flags: 0,
            normal: [0.0; 3],
            uv: [0.0; 2],
            primitive: INVALID,
            geometry: INVALID,
            instance: [INVALID; 15],
        }
    }
}

impl RayHit16 {
    /// The rays, and which lanes have one.
    #[inline]
    fn new(rays: &[Ray]) -> (Self, [c_int; PACKET]) {
        let mut out = Self {
            origin: [[0.0; PACKET]; 3],
            near: [0.0; PACKET],
            direction: [[0.0; PACKET]; 3],
            time: [0.0; PACKET],
            far: [0.0; PACKET],
            mask: [u32::MAX; PACKET],
            id: [0; PACKET],
            flags: [0; PACKET],
            normal: [[0.0; PACKET]; 3],
            uv: [[0.0; PACKET]; 2],
            primitive: [INVALID; PACKET],
            geometry: [INVALID; PACKET],
            instance: [[INVALID; PACKET]; 15],
        };
        let mut valid = [0; PACKET];
        for (i, ray) in rays.iter().enumerate() {
            valid[i] = -1;
            out.far[i] = ray.t_max;
            for axis in 0..3 {
                out.origin[axis][i] = ray.origin[axis];
                out.direction[axis][i] = ray.direction[axis];
            }
        }
        (out, valid)
    }
}
