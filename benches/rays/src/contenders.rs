//! Who is timed: ways of meeting the same rays.

use sr_geometry::{BATCH, Geometry, Hits, Ray, Rays};

use crate::embree::{EmbreeScene, PACKET};

/// A way of meeting rays.
pub trait Contender {
    /// As the output names it.
    fn name(&self) -> &'static str;
    /// Distances of the closest hits, infinity for none.
    fn closest(&mut self, rays: &[Ray], t: &mut [f32]);
    /// How many rays hit anything.
    fn any(&mut self, rays: &[Ray]) -> usize;
}

/// Our rays one by one.
pub struct Single<'a>(pub &'a Geometry);

impl Contender for Single<'_> {
    fn name(&self) -> &'static str {
        "steradian"
    }

    fn closest(&mut self, rays: &[Ray], t: &mut [f32]) {
        for (ray, t) in rays.iter().zip(t) {
            *t = self.0.intersect(ray).map_or(f32::INFINITY, |hit| hit.t);
        }
    }

    fn any(&mut self, rays: &[Ray]) -> usize {
        rays.iter().filter(|ray| self.0.occluded(ray)).count()
    }
}

/// Our rays in batches, as the path tracer has them; filling the batches counts.
pub struct Batches<'a> {
    geometry: &'a Geometry,
    rays: Box<Rays>,
    hits: Box<Hits>,
    occluded: Box<[bool; BATCH]>,
}

impl<'a> Batches<'a> {
    /// With memory for a batch.
    pub fn new(geometry: &'a Geometry) -> Self {
        Self {
            geometry,
            rays: Box::new(Rays::NONE),
            hits: Box::new(Hits::NONE),
            occluded: Box::new([false; BATCH]),
        }
    }

    fn fill(&mut self, rays: &[Ray]) {
        rays.iter().enumerate().for_each(|(i, ray)| self.rays.set(i, ray));
    }
}

impl Contender for Batches<'_> {
    fn name(&self) -> &'static str {
        "steradian-batches"
    }

    fn closest(&mut self, rays: &[Ray], t: &mut [f32]) {
        for (rays, t) in rays.chunks(BATCH).zip(t.chunks_mut(BATCH)) {
            self.fill(rays);
            self.geometry.intersect_batch(&self.rays, rays.len(), &mut self.hits);
            t.copy_from_slice(&self.hits.t[..rays.len()]);
        }
    }

    fn any(&mut self, rays: &[Ray]) -> usize {
        let mut count = 0;
        for rays in rays.chunks(BATCH) {
            self.fill(rays);
            self.geometry.occluded_batch(&self.rays, rays.len(), &mut self.occluded);
            count += self.occluded[..rays.len()].iter().filter(|&&occluded| occluded).count();
        }
        count
    }
}

/// Embree's rays one by one.
pub struct EmbreeSingle<'a> {
    /// As the output names it.
    pub name: &'static str,
    /// What the rays meet.
    pub scene: &'a EmbreeScene<'a>,
}

impl Contender for EmbreeSingle<'_> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn closest(&mut self, rays: &[Ray], t: &mut [f32]) {
        for (ray, t) in rays.iter().zip(t) {
            *t = self.scene.closest(ray);
        }
    }

    fn any(&mut self, rays: &[Ray]) -> usize {
        rays.iter().filter(|ray| self.scene.occluded(ray)).count()
    }
}

/// Embree's packets of 16, told that their rays run alike.
pub struct EmbreePackets<'a>(pub &'a EmbreeScene<'a>);

impl Contender for EmbreePackets<'_> {
    fn name(&self) -> &'static str {
        "embree-packets"
    }

    fn closest(&mut self, rays: &[Ray], t: &mut [f32]) {
        for (rays, t) in rays.chunks(PACKET).zip(t.chunks_mut(PACKET)) {
            self.0.closest_packet(rays, t);
        }
    }

    fn any(&mut self, rays: &[Ray]) -> usize {
        rays.chunks(PACKET).map(|rays| self.0.occluded_packet(rays)).sum()
    }
}
