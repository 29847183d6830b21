//! The concentric map of the square onto a disk, and the uniform distribution over one.

use std::f64::consts::{FRAC_PI_4, PI};

use super::line::below_one;
use super::parameter::{ParameterError, positive};
use crate::columns::{Columns, ColumnsMut};
use crate::density::{Density, DensityError, Inverse};
use crate::space::Space;

/// The point of the unit disk that the concentric map gives (Shirley & Chiu 1997).
///
/// Squares about the centre become circles; areas keep their proportion.
#[inline]
pub(crate) fn concentric(u: [f64; 2]) -> [f64; 2] {
    let [x, y] = u.map(|u| 2.0 * u - 1.0);
    if x.abs() > y.abs() {
        let (sin, cos) = (FRAC_PI_4 * (y / x)).sin_cos();
        [x * cos, x * sin]
    } else if y == 0.0 {
        [0.0; 2]
    } else {
        let (sin, cos) = (FRAC_PI_4 * (x / y)).sin_cos();
        [y * sin, y * cos]
    }
}

/// The uniforms that [`concentric`] maps to a point.
pub(crate) fn invert_concentric([x, y]: [f64; 2]) -> [f64; 2] {
    let r = x.hypot(y);
    if r == 0.0 {
        return [0.5; 2];
    }
    let square = if x.abs() > y.abs() {
        let side = r.copysign(x);
        [side, side * (y / x).atan() / FRAC_PI_4]
    } else {
        let side = r.copysign(y);
        [side * (x / y).atan() / FRAC_PI_4, side]
    };
    square.map(|side| below_one(0.5 * side + 0.5))
}

/// Uniform over the disk about the origin; pdf = 1 / (π radius²).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disk {
    radius: f64,
}

impl Disk {
    /// # Errors
    /// If the radius is not positive, or its square or the inverse of that is no finite number.
    pub fn new(radius: f64) -> Result<Self, ParameterError> {
        positive("radius", radius)?;
        positive("the square of radius", radius * radius)?;
        Ok(Self { radius })
    }
}

impl Density for Disk {
    fn space(&self) -> Space {
        Space::Plane
    }

    fn uniforms(&self) -> usize {
        2
    }

    fn sample(&self, u: Columns<'_>, mut x: ColumnsMut<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        for i in 0..u.len() {
            x.write(i, &concentric([u.get(i, 0), u.get(i, 1)]).map(|x| x * self.radius));
        }
        pdf.fill(1.0 / (PI * self.radius * self.radius));
        Ok(())
    }

    fn pdf(&self, x: Columns<'_>, pdf: &mut [f64]) -> Result<(), DensityError> {
        // Rounding may push a sample over the rim.
        let rim = self.radius * (1.0 + 4.0 * f64::EPSILON);
        for ((x, y), pdf) in x.column(0).iter().zip(x.column(1)).zip(pdf) {
            *pdf = if x.hypot(*y) <= rim { 1.0 / (PI * self.radius * self.radius) } else { 0.0 };
        }
        Ok(())
    }

    fn support(&self) -> Vec<[f64; 2]> {
        vec![[-self.radius, self.radius]; 2]
    }

    fn mean(&self) -> Option<Vec<f64>> {
        Some(vec![0.0; 2])
    }

    fn inverse(&self) -> Option<&dyn Inverse> {
        Some(self)
    }
}

impl Inverse for Disk {
    fn invert(&self, x: Columns<'_>, mut u: ColumnsMut<'_>) -> Result<(), DensityError> {
        let mut pdf = vec![0.0; x.len()];
        self.pdf(x, &mut pdf)?;
        for (i, pdf) in pdf.into_iter().enumerate() {
            let inverted = invert_concentric([x.get(i, 0) / self.radius, x.get(i, 1) / self.radius]);
            u.write(i, &if pdf > 0.0 { inverted } else { [f64::NAN; 2] });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn squares_become_circles_and_back() {
        for i in 0..=32 {
            for j in 0..=32 {
                let u = [f64::from(i) / 32.0, f64::from(j) / 32.0];
                let [x, y] = concentric(u);
                let side = u.map(|u| (2.0 * u - 1.0).abs()).into_iter().fold(0.0, f64::max);
                assert!((x.hypot(y) - side).abs() < 1e-15, "{u:?}");
                let back = invert_concentric([x, y]);
                assert!((0..2).all(|k| (back[k] - u[k]).abs() < 1e-15), "{u:?} {back:?}");
            }
        }
    }

    #[test]
    fn errors_name_the_radius() {
        for radius in [0.0, -1.0, f64::NAN, f64::INFINITY, 1e200] {
            assert!(Disk::new(radius).unwrap_err().to_string().contains("radius"), "{radius}");
        }
    }
}
