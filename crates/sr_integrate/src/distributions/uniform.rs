//! All values equally likely: on an interval, and in a box.

use sr_sampling::isa::{Isa, Work};

use super::line::{OnLine, below_one};
use super::parameter::{ParameterError, width};
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Cumulative, Density, DensityError, Inverse};
use crate::space::Space;

/// Uniform on [low, high]; pdf = 1 / (high − low).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Uniform {
    low: f64,
    high: f64,
    width: f64,
}

impl Uniform {
    /// # Errors
    /// If an end or the width is not finite, or the width is not positive.
    pub fn new(low: f64, high: f64) -> Result<Self, ParameterError> {
        Ok(Self { low, high, width: width("[low, high]", low, high)? })
    }
}

impl OnLine for Uniform {
    #[inline]
    fn density(&self, x: f64) -> f64 {
        if x >= self.low && x <= self.high { 1.0 / self.width } else { 0.0 }
    }

    fn ends(&self) -> [f64; 2] {
        [self.low, self.high]
    }

    fn expected(&self) -> Option<f64> {
        Some(0.5 * self.low + 0.5 * self.high)
    }
}

impl Cumulative for Uniform {
    #[inline]
    fn cdf(&self, x: f64) -> f64 {
        ((x - self.low) / self.width).clamp(0.0, 1.0)
    }

    #[inline(always)]
    fn icdf(&self, u: f64) -> f64 {
        (self.low + u * self.width).min(self.high)
    }

    fn above(&self, x: f64) -> f64 {
        ((self.high - x) / self.width).clamp(0.0, 1.0)
    }

    fn inverse_above(&self, q: f64) -> f64 {
        (self.high - q * self.width).max(self.low)
    }
}

/// Uniform in a box of any number of dimensions; pdf = 1 / volume. Every coordinate takes a uniform.
#[derive(Clone, Debug)]
pub struct UniformBox {
    sides: Vec<Uniform>,
    density: f64,
}

impl UniformBox {
    /// The box of these sides, as (low, high) of each coordinate.
    ///
    /// # Errors
    /// If there is no side, one has an end that is not finite, or no width, or if 1 / volume is no finite
    /// positive number.
    pub fn new(sides: &[[f64; 2]]) -> Result<Self, ParameterError> {
        if sides.is_empty() {
            return Err(ParameterError::Length { argument: "the box", len: 0, need: "at least 1".into() });
        }
        let side = |(j, &[low, high]): (usize, &[f64; 2])| {
            let name = if sides.len() == 1 { "[low, high]".into() } else { format!("[low, high][{j}]") };
            Ok(Uniform { low, high, width: width(&name, low, high)? })
        };
        let sides = sides.iter().enumerate().map(side).collect::<Result<Vec<_>, ParameterError>>()?;
        let volume: f64 = sides.iter().map(|side| side.width).product();
        let density = super::parameter::positive("the volume of the box", volume)?.recip();
        Ok(Self { sides, density })
    }
}

/// One coordinate of some points.
struct Spread<'a> {
    side: Uniform,
    u: &'a [f64],
    x: &'a mut [f64],
}

impl Work for Spread<'_> {
    type Out = ();

    #[inline(always)]
    fn run(self) {
        for (&u, x) in self.u.iter().zip(self.x) {
            *x = self.side.icdf(u);
        }
    }
}

impl Density for UniformBox {
    fn space(&self) -> Space {
        Space::real(self.sides.len())
    }

    fn uniforms(&self) -> usize {
        self.sides.len()
    }

    fn sample(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        for (j, side) in self.sides.iter().enumerate() {
            Isa::detect().run(Spread { side: *side, u: u.column(j), x: x.column(j) });
        }
        pdf.fill(self.density);
        Ok(())
    }

    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        pdf.fill(self.density);
        for (j, side) in self.sides.iter().enumerate() {
            for (&x, pdf) in x.column(j).iter().zip(&mut *pdf) {
                *pdf = if x >= side.low && x <= side.high { *pdf } else { 0.0 };
            }
        }
        Ok(())
    }

    fn support(&self) -> Vec<[f64; 2]> {
        self.sides.iter().map(OnLine::ends).collect()
    }

    fn mean(&self) -> Option<Vec<f64>> {
        self.sides.iter().map(OnLine::expected).collect()
    }

    fn inverse(&self) -> Option<&dyn Inverse> {
        Some(self)
    }

    fn cumulative(&self) -> Option<&dyn Cumulative> {
        if let [side] = self.sides.as_slice() { Some(side) } else { None }
    }
}

impl Inverse for UniformBox {
    fn invert(&self, x: Columns<'_>, mut u: ColumnsMut<'_>) -> Result<(), DensityError> {
        let mut pdf = vec![0.0; x.len()];
        self.pdf(x, &mut pdf)?;
        for (j, side) in self.sides.iter().enumerate() {
            for ((&x, u), &pdf) in x.column(j).iter().zip(u.column(j)).zip(&pdf) {
                *u = if pdf > 0.0 { below_one(side.cdf(x)) } else { f64::NAN };
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_interval_of_one_ulp() {
        let uniform = Uniform::new(1.0, 1.0_f64.next_up()).unwrap();
        for u in [0.0, 0.3, 0.7, 1.0 - f64::EPSILON / 2.0] {
            assert_eq!(uniform.density(uniform.icdf(u)), 1.0 / f64::EPSILON);
        }
    }

    #[test]
    fn a_box_is_a_product_of_intervals() {
        let uniform = UniformBox::new(&[[0.0, 2.0], [-1.0, 3.0]]).unwrap();
        let (mut x, mut pdf) = ([0.0; 4], [0.0; 2]);
        uniform
            .sample(Columns::new(&[0.5, 0.0, 0.25, 1.0], 2), ColumnsMut::new(&mut x, 2), &mut pdf)
            .unwrap();
        assert_eq!((x, pdf), ([1.0, 0.0, 0.0, 3.0], [0.125; 2]));
        uniform.pdf(Columns::new(&[1.0, f64::NAN, 3.0, 0.0], 2), &mut pdf).unwrap();
        assert_eq!(pdf, [0.125, 0.0]);
        assert!(uniform.cumulative().is_none());
    }

    #[test]
    fn errors_name_the_interval() {
        for (low, high) in [(1.0, 1.0), (2.0, 1.0), (0.0, f64::INFINITY), (f64::NAN, 1.0), (-1e308, 1e308)] {
            assert!(matches!(Uniform::new(low, high).unwrap_err(), ParameterError::Interval { .. }));
        }
        let error = UniformBox::new(&[[0.0, 1.0], [3.0, 3.0]]).unwrap_err();
        assert!(error.to_string().contains("[low, high][1] = [3, 3]"), "{error}");
        assert!(UniformBox::new(&[]).is_err());
        assert!(UniformBox::new(&[[0.0, 1e-200]; 2]).is_err());
    }
}
