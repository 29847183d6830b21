//! Meeting a tree with a ray, with the instruction set of this processor.

use glam::Vec3;

use super::scan::scan;
#[cfg(target_arch = "x86_64")]
use super::simd::{Avx2, Avx512};
use super::simd::{Kernel, Walk};
use super::traverse::walk;
use super::{Bvh, Form, Met, Tree};
use crate::{Hit, Ray};

impl Bvh {
    /// The closest hit. `meet_other(i, ray)` answers for the primitives that are not triangles.
    #[inline]
    pub fn intersect(&self, tree: &Tree, ray: &Ray, meet_other: impl Fn(u32, &Ray) -> Met) -> Option<Hit> {
        let mut closest = Hit::none_before(ray.t_max);
        self.meet::<false>(tree, ray, meet_other, &mut closest).then_some(closest)
    }

    /// Is there any hit?
    #[inline]
    pub fn occluded(&self, tree: &Tree, ray: &Ray, meet_other: impl Fn(u32, &Ray) -> Met) -> bool {
        let mut unused = Hit::none_before(ray.t_max);
        self.meet::<true>(tree, ray, meet_other, &mut unused)
    }

    #[inline(always)]
    fn meet<const ANY: bool>(
        &self,
        tree: &Tree,
        ray: &Ray,
        meet_other: impl Fn(u32, &Ray) -> Met,
        closest: &mut Hit,
    ) -> bool {
        let ([x, y, z], [u, v, w]) = (ray.origin.to_array(), ray.direction.to_array());
        let at = (self, tree);
        match self.kernel {
            // SAFETY: an `Avx512` is the proof that this processor has these features.
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx512(avx512) => unsafe {
                meet_avx512::<ANY>(avx512, &at, x, y, z, u, v, w, ray.t_max, meet_other, closest)
            },
            // SAFETY: as above.
            #[cfg(target_arch = "x86_64")]
            Kernel::Avx2(avx2) => unsafe {
                meet_avx2::<ANY>(avx2, &at, x, y, z, u, v, w, ray.t_max, meet_other, closest)
            },
            Kernel::Portable(portable) => meet::<_, ANY>(portable, at, ray, meet_other, closest),
        }
    }
}

/// Was anything hit?
#[inline(always)]
pub(super) fn meet<S: Walk, const ANY: bool>(
    simd: S,
    (bvh, tree): (&Bvh, &Tree),
    ray: &Ray,
    meet_other: impl Fn(u32, &Ray) -> Met,
    closest: &mut Hit,
) -> bool {
    match tree.form {
        Form::Nodes(root) => walk::<_, ANY>(simd, bvh, (root, &tree.bounds), ray, meet_other, closest),
        Form::Few(few) => scan::<_, ANY>(simd, bvh.few(few), ray, closest),
    }
}

// A ray arrives as single numbers, in registers. In memory it would have been written in parts and be read as a whole,
// for which a processor waits as long as for a block of triangles.

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx512f,avx512vl,avx512dq,avx512bw,avx2,bmi1,bmi2,lzcnt,popcnt")]
#[allow(clippy::too_many_arguments)]
fn meet_avx512<const ANY: bool>(
    avx512: Avx512,
    at: &(&Bvh, &Tree),
    x: f32,
    y: f32,
    z: f32,
    u: f32,
    v: f32,
    w: f32,
    t_max: f32,
    meet_other: impl Fn(u32, &Ray) -> Met,
    closest: &mut Hit,
) -> bool {
    let ray = Ray { origin: Vec3::new(x, y, z), direction: Vec3::new(u, v, w), t_max };
    meet::<_, ANY>(avx512, *at, &ray, meet_other, closest)
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi1,bmi2,lzcnt,popcnt")]
#[allow(clippy::too_many_arguments)]
fn meet_avx2<const ANY: bool>(
    avx2: Avx2,
    at: &(&Bvh, &Tree),
    x: f32,
    y: f32,
    z: f32,
    u: f32,
    v: f32,
    w: f32,
    t_max: f32,
    meet_other: impl Fn(u32, &Ray) -> Met,
    closest: &mut Hit,
) -> bool {
    let ray = Ray { origin: Vec3::new(x, y, z), direction: Vec3::new(u, v, w), t_max };
    meet::<_, ANY>(avx2, *at, &ray, meet_other, closest)
}
