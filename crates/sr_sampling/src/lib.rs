//! Densities, and how to draw from them.
//!
//! An estimate of ∫ f(x) dx is the mean of f(X) / p(X), X drawn from p. Everything else is choosing p:
//! [`Distribution`] is that choice, [`Measure`] says what p is a density of, [`Mixture`] and
//! [`mis_estimate`] combine several. Nothing here knows rendering.

pub mod distribution;
pub mod estimate;
pub mod isa;
pub mod measure;
pub mod mis;
pub mod mixture;
pub mod prefetch;
pub mod sequence;
pub mod table;
pub mod uniforms;
pub mod warp;

pub use distribution::{Distribution, Invert, PointOf, RealOf, Sample};
pub use estimate::{Accumulator, Estimate, format_uncertain};
pub use measure::{Area, Counting, Lebesgue, Line, Measure, Plane, Real, SolidAngle, to_solid_angle};
pub use mis::{Heuristic, UnknownHeuristic, balance_weight, mis_estimate, power_weight};
pub use mixture::{Mix2, Mixture, MixtureError};
pub use prefetch::prefetch;
pub use sequence::{Cursor, Independent, OwenSobol, SampleId, Sequence, SequenceKind, UnknownSequence};
pub use table::{
    AliasTable, Discrete, Draw2D, PiecewiseConstant1D, PiecewiseConstant2D, SummedArea, TableError, Window,
};
pub use uniforms::Uniforms;
