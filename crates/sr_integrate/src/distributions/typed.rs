//! The run-time face of distributions that are known when the program is compiled.

use std::fmt;

use sr_sampling::{
    Area, Counting, Cursor, Distribution, Invert, Line, Measure, Plane, PointOf, Real, SampleId, Sequence,
    SolidAngle, Uniforms,
};

use glam::{DVec3, Vec2, Vec3};

use crate::columns::{Columns, ColumnsMut};
use crate::density::{Density, DensityError, Inverse};
use crate::space::Space;

/// A measure whose points have coordinates.
pub trait Coordinates: Measure {
    /// The same measure at run time.
    const SPACE: Space;

    /// A point from as many coordinates as the space has; `None` if there is no such point.
    fn read(coordinates: &[f64]) -> Option<Self::Point>;

    /// The coordinates of a point.
    fn write(point: Self::Point, coordinates: &mut [f64]);
}

impl Coordinates for Line {
    const SPACE: Space = Space::Line;

    fn read(x: &[f64]) -> Option<f32> {
        Some(x[0] as f32)
    }

    fn write(point: f32, x: &mut [f64]) {
        x[0] = f64::from(point);
    }
}

impl Coordinates for Plane {
    const SPACE: Space = Space::Plane;

    fn read(x: &[f64]) -> Option<Vec2> {
        Some(Vec2::new(x[0] as f32, x[1] as f32))
    }

    fn write(point: Vec2, x: &mut [f64]) {
        x.copy_from_slice(&point.as_dvec2().to_array());
    }
}

impl Coordinates for SolidAngle {
    const SPACE: Space = Space::SolidAngle;

    /// Unit vectors, if only in single precision.
    fn read(x: &[f64]) -> Option<Vec3> {
        let w = DVec3::new(x[0], x[1], x[2]);
        ((w.length_squared() - 1.0).abs() <= 1e-4).then(|| w.normalize().as_vec3())
    }

    /// Of unit length in double precision.
    fn write(point: Vec3, x: &mut [f64]) {
        x.copy_from_slice(&point.as_dvec3().normalize_or_zero().to_array());
    }
}

impl Coordinates for Area {
    const SPACE: Space = Space::Area;

    fn read(x: &[f64]) -> Option<Vec3> {
        Some(Vec3::new(x[0] as f32, x[1] as f32, x[2] as f32))
    }

    fn write(point: Vec3, x: &mut [f64]) {
        x.copy_from_slice(&point.as_dvec3().to_array());
    }
}

impl Coordinates for Counting {
    const SPACE: Space = Space::Counting;

    fn read(x: &[f64]) -> Option<usize> {
        let index = x[0] as usize;
        (index as f64 == x[0]).then_some(index)
    }

    fn write(point: usize, x: &mut [f64]) {
        x[0] = point as f64;
    }
}

/// Numbers that are given, as a sequence of dimensions.
#[derive(Clone, Copy)]
struct Given<'a>(&'a [f32]);

impl Sequence for Given<'_> {
    fn get_1d(&self, _: SampleId, dim: u32) -> f32 {
        self.0[dim as usize]
    }

    fn get_2d(&self, _: SampleId, dim: u32) -> Vec2 {
        Vec2::new(self.0[dim as usize], self.0[dim as usize + 1])
    }

    fn replicate(&self, _: u32) -> Self {
        *self
    }
}

/// Any [`Distribution`] of `sr_sampling` as a [`Density`]: a light seen from a point, a scattering model with
/// `wo` held fixed, a warp. It stays in single precision: uniforms have 24 bits, and points and densities
/// seven digits.
#[derive(Clone)]
pub struct Typed<D: Distribution> {
    distribution: D,
    support: Vec<[f64; 2]>,
    mean: Option<Vec<f64>>,
    invert: Option<Inverter<D>>,
}

/// [`Invert::invert`] of those that have it.
type Inverter<D> = fn(&D, PointOf<D>) -> Option<<D as Distribution>::Uniform>;

impl<D: Distribution + fmt::Debug> fmt::Debug for Typed<D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("Typed").field(&self.distribution).finish()
    }
}

impl<D: Distribution<Measure: Coordinates>> Typed<D> {
    /// - `support`: as [`Density::support`], wide enough for points that were rounded to single precision
    ///
    /// # Panics
    /// If `support` has not as many sides as a point has coordinates.
    pub fn new(distribution: D, support: Vec<[f64; 2]>) -> Self {
        assert_eq!(support.len(), <D::Measure as Coordinates>::SPACE.dim(), "a side for each coordinate");
        Self { distribution, support, mean: None, invert: None }
    }

    /// One whose samples can be run backwards.
    ///
    /// # Panics
    /// As [`Typed::new`].
    pub fn invertible(distribution: D, support: Vec<[f64; 2]>) -> Self
    where
        D: Invert,
    {
        Self { invert: Some(D::invert), ..Self::new(distribution, support) }
    }

    /// Says what the expected point is.
    #[must_use]
    pub fn with_mean(self, mean: Vec<f64>) -> Self {
        Self { mean: Some(mean), ..self }
    }
}

/// The most coordinates of a point of any measure that is known when the program is compiled.
const MAX_DIM: usize = 3;

/// The largest `f32` below 1.
const BELOW_ONE: f32 = 1.0 - f32::EPSILON / 2.0;

impl<D> Density for Typed<D>
where
    D: Distribution<Measure: Coordinates> + Send + Sync + fmt::Debug,
{
    fn space(&self) -> Space {
        <D::Measure as Coordinates>::SPACE
    }

    fn uniforms(&self) -> usize {
        D::Uniform::COUNT
    }

    fn sample(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        let mut given = vec![0.0; D::Uniform::COUNT];
        let (mut point, dim) = ([0.0; MAX_DIM], self.space().dim());
        for (i, pdf) in pdf.iter_mut().enumerate() {
            for (j, number) in given.iter_mut().enumerate() {
                *number = (u.get(i, j) as f32).min(BELOW_ONE);
            }
            let sequence = Given(&given);
            let mut cursor = Cursor::new(&sequence, SampleId { pixel: 0, index: 0 });
            *pdf = match self.distribution.sample(D::Uniform::draw(&mut cursor)) {
                Some(sample) => {
                    <D::Measure as Coordinates>::write(sample.value, &mut point[..dim]);
                    sample.pdf.to_f64()
                }
                None => {
                    point.fill(f64::NAN);
                    0.0
                }
            };
            x.write(i, &point[..dim]);
        }
        Ok(())
    }

    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        let (mut point, dim) = ([0.0; MAX_DIM], self.space().dim());
        for (i, pdf) in pdf.iter_mut().enumerate() {
            x.read(i, &mut point[..dim]);
            let density = <D::Measure as Coordinates>::read(&point[..dim])
                .filter(|_| point[..dim].iter().all(|x| x.is_finite()))
                .map_or(0.0, |x| self.distribution.pdf(x).to_f64());
            *pdf = if density.is_nan() { 0.0 } else { density };
        }
        Ok(())
    }

    fn support(&self) -> Vec<[f64; 2]> {
        self.support.clone()
    }

    fn mean(&self) -> Option<Vec<f64>> {
        self.mean.clone()
    }

    fn inverse(&self) -> Option<&dyn Inverse> {
        self.invert.map(|_| self as &dyn Inverse)
    }
}

impl<D> Inverse for Typed<D>
where
    D: Distribution<Measure: Coordinates> + Send + Sync + fmt::Debug,
{
    fn invert(&self, x: Columns<'_>, mut u: ColumnsMut<'_>) -> Result<(), DensityError> {
        let mut numbers = vec![0.0; D::Uniform::COUNT];
        let mut point = [0.0; MAX_DIM];
        let dim = self.space().dim();
        for i in 0..x.len() {
            x.read(i, &mut point[..dim]);
            let uniforms = <D::Measure as Coordinates>::read(&point[..dim])
                .filter(|&x| self.distribution.pdf(x).to_f64() > 0.0)
                .and_then(|x| self.invert.and_then(|invert| invert(&self.distribution, x)));
            match uniforms {
                Some(uniforms) => uniforms.write(&mut numbers),
                None => numbers.fill(f32::NAN),
            }
            for (j, &number) in numbers.iter().enumerate() {
                u.set(i, j, f64::from(number));
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use sr_sampling::warp::{CosineHemisphere, UniformHemisphere};
    use sr_sampling::{AliasTable, Mix2, PiecewiseConstant1D};

    use super::*;

    #[test]
    fn a_distribution_keeps_its_samples() {
        let hemisphere = Typed::invertible(CosineHemisphere, vec![[-1.0, 1.0], [-1.0, 1.0], [0.0, 1.0]]);
        let (mut x, mut pdf, mut back) = ([0.0; 6], [0.0; 2], [0.0; 4]);
        let u = Columns::new(&[0.5, 0.25, 0.5, 0.75], 2);
        hemisphere.sample(u, ColumnsMut::new(&mut x, 2), &mut pdf).unwrap();
        let expected = CosineHemisphere.sample(Vec2::new(0.25, 0.75)).unwrap();
        assert!((Vec3::new(x[1] as f32, x[3] as f32, x[5] as f32) - expected.value).length() < 1e-7);
        assert_eq!(pdf[1], f64::from(expected.pdf));
        hemisphere.inverse().unwrap().invert(Columns::new(&x, 2), ColumnsMut::new(&mut back, 2)).unwrap();
        assert!((back[1] - 0.25).abs() < 1e-6 && (back[3] - 0.75).abs() < 1e-6);
        hemisphere.pdf(Columns::new(&[0.0, 0.0, f64::NAN, 3.0, 0.0, 0.0], 2), &mut pdf).unwrap();
        assert_eq!(pdf, [0.0; 2], "no directions");
    }

    #[test]
    fn uniforms_are_counted() {
        let pair = Mix2::new(0.5, CosineHemisphere, UniformHemisphere).unwrap();
        assert_eq!(Typed::new(pair, vec![[-1.0, 1.0]; 3]).uniforms(), 5);
        let line =
            Typed::invertible(PiecewiseConstant1D::from_values(&[1.0, 3.0]).unwrap(), vec![[0.0, 1.0]]);
        assert_eq!((line.space(), line.uniforms()), (Space::Line, 1));
        let table = Typed::new(AliasTable::new(&[1.0, 3.0]).unwrap(), vec![[0.0, 1.0]]);
        let mut pdf = [0.0; 3];
        table.pdf(Columns::new(&[1.0, 0.5, -1.0], 3), &mut pdf).unwrap();
        assert_eq!((table.space(), pdf), (Space::Counting, [0.75, 0.0, 0.0]));
    }
}
