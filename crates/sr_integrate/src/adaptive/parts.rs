//! Learned densities as plain numbers, to be kept and read back.

use std::sync::Arc;

use thiserror::Error;

use super::axis::Axis;
use super::component::{Component, Frame};
use super::cube::{CubeDensity, PARTS};
use super::learned::Learned;
use super::strata::{Strata, Written};
use crate::density::Density;

/// A component of a learned density as plain numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// The knots of each axis; their number is a power of two, and one.
    pub knots: Vec<Vec<f64>>,
    /// The origin of its own axes; empty if it lies along the coordinates.
    pub centre: Vec<f64>,
    /// Their directions: an orthonormal matrix, row after row; empty with `centre`.
    pub rotation: Vec<f64>,
}

/// A learned density as plain numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct Parts {
    /// What it is a mixture of.
    pub components: Vec<Part>,
    /// The share of each component, in [`PARTS`].
    pub shares: Vec<u32>,
    /// The strata that the mixture's uniforms come from, cell before lower half before upper half: the axis that a cell
    /// is cut across and the probability of its lower half, or nothing for a stratum. No cell: no strata.
    pub strata: Vec<Written>,
}

/// Why numbers are no learned density.
#[derive(Clone, Debug, PartialEq, Error)]
pub enum PartsError {
    /// No component, or not a share for each.
    #[error("{components} components have {shares} shares; there must be one for each, and one at least")]
    Count {
        /// How many components there are.
        components: usize,
        /// How many shares.
        shares: usize,
    },
    /// Shares that are not whole.
    #[error("the shares sum to {0}; they must be positive, and sum to {PARTS}")]
    Shares(u64),
    /// Not an axis for each uniform.
    #[error("component {component} has {axes} axes, and the density that it was learned over {dim} uniforms")]
    Axes {
        /// Position in the list.
        component: usize,
        /// How many axes it has.
        axes: usize,
        /// How many it needs.
        dim: usize,
    },
    /// Knots that are not in order.
    #[error("axis {axis} of component {component}: {what}")]
    Knots {
        /// Position of the component.
        component: usize,
        /// Which of its axes.
        axis: usize,
        /// What is wrong.
        what: &'static str,
    },
    /// Cells that are no tree.
    #[error(
        "the strata are no tree of cells: each must be cut across one of {dim} axes, with a probability between 0 \
         and 1 for its lower half, and be followed by its halves"
    )]
    Strata {
        /// How many axes there are.
        dim: usize,
    },
    /// A matrix that is no rotation.
    #[error("the axes of component {component} are not orthonormal, or too few numbers")]
    Frame {
        /// Position in the list.
        component: usize,
    },
}

impl Learned {
    /// What it was learned as.
    pub fn parts(&self) -> Parts {
        let part = |component: &Component| Part {
            knots: component.axes().iter().map(|axis| axis.knots().to_vec()).collect(),
            centre: component.frame().map_or(Vec::new(), |frame| frame.centre.clone()),
            rotation: component.frame().map_or(Vec::new(), |frame| frame.rotation.clone()),
        };
        Parts {
            components: self.cube().components().iter().map(part).collect(),
            shares: self.cube().shares().to_vec(),
            strata: self.cube().strata().map_or(Vec::new(), Strata::written),
        }
    }

    /// The density that [`Learned::parts`] describes, over the same `base`.
    ///
    /// # Errors
    /// If they describe none: they may come from anywhere.
    pub fn from_parts(base: Arc<dyn Density>, parts: Parts) -> Result<Self, PartsError> {
        let Parts { components, shares, strata } = parts;
        if components.is_empty() || components.len() != shares.len() {
            return Err(PartsError::Count { components: components.len(), shares: shares.len() });
        }
        let sum: u64 = shares.iter().map(|&share| u64::from(share)).sum();
        if sum != u64::from(PARTS) || shares.contains(&0) {
            return Err(PartsError::Shares(sum));
        }
        let dim = base.uniforms();
        let components = components.into_iter().enumerate();
        let components =
            components.map(|(i, part)| component(i, part, dim)).collect::<Result<Vec<_>, _>>()?;
        let mut cube = CubeDensity::from_shares(components, shares);
        if !strata.is_empty() {
            cube = cube.with_strata(Strata::from_written(dim, &strata).ok_or(PartsError::Strata { dim })?);
        }
        Ok(Self::new(base, cube))
    }
}

fn component(component: usize, part: Part, dim: usize) -> Result<Component, PartsError> {
    let Part { knots, centre, rotation } = part;
    if knots.len() != dim {
        return Err(PartsError::Axes { component, axes: knots.len(), dim });
    }
    let frame = match (centre.is_empty(), rotation.is_empty()) {
        (true, true) => None,
        _ => Some(frame(centre, rotation, dim).ok_or(PartsError::Frame { component })?),
    };
    let ranges = frame.as_ref().map_or(vec![[0.0, 1.0]; dim], Frame::ranges);
    let axes = knots.into_iter().zip(ranges).enumerate().map(|(axis, (knots, range))| {
        let bins = knots.len().saturating_sub(1);
        let what = if !bins.is_power_of_two() || bins > Axis::MAX_BINS {
            "the number of knots is not a power of two, and one"
        } else if knots.windows(2).any(|pair| !(pair[0] < pair[1])) {
            "each knot must be above the one before"
        } else if (knots[0] - range[0]).abs() > 1e-9 || (knots[bins] - range[1]).abs() > 1e-9 {
            "the first and the last knot are not the ends of the unit cube"
        } else {
            return Ok(Axis::new(knots));
        };
        Err(PartsError::Knots { component, axis, what })
    });
    Ok(Component::new(axes.collect::<Result<Vec<_>, _>>()?, frame))
}

/// Axes of a component, if the matrix is a rotation (or a reflection) to about single precision.
fn frame(centre: Vec<f64>, rotation: Vec<f64>, dim: usize) -> Option<Frame> {
    if centre.len() != dim || rotation.len() != dim * dim || centre.iter().any(|x| !(x.abs() < 1e6)) {
        return None;
    }
    for a in 0..dim {
        for b in 0..=a {
            let product: f64 = (0..dim).map(|k| rotation[k * dim + a] * rotation[k * dim + b]).sum();
            if !((product - f64::from(u8::from(a == b))).abs() < 1e-6) {
                return None;
            }
        }
    }
    Some(Frame { centre, rotation })
}
