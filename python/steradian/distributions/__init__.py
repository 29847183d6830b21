"""Densities that can be sampled, evaluated, mixed and compared."""

from steradian.distributions.base import Distribution, Samples
from steradian.distributions.composite import Affine, Mixture, Product
from steradian.distributions.directions import (
    AreaLight,
    Cone,
    CosineHemisphere,
    SphericalRectangle,
    SphericalTriangle,
    UniformHemisphere,
    UniformSphere,
    VisibleNormals,
    VonMisesFisher,
)
from steradian.distributions.learned import Learned
from steradian.distributions.line import Exponential, Linear, Normal, Power, Tent, Truncated, Uniform
from steradian.distributions.plane import Disk
from steradian.distributions.tables import (
    Alias,
    Discrete,
    FromPdf,
    PiecewiseConstant,
    PiecewiseLinear,
    Tabulated2D,
)

__all__ = [
    "Affine",
    "Alias",
    "AreaLight",
    "Cone",
    "CosineHemisphere",
    "Discrete",
    "Disk",
    "Distribution",
    "Exponential",
    "FromPdf",
    "Learned",
    "Linear",
    "Mixture",
    "Normal",
    "PiecewiseConstant",
    "PiecewiseLinear",
    "Power",
    "Product",
    "Samples",
    "SphericalRectangle",
    "SphericalTriangle",
    "Tabulated2D",
    "Tent",
    "Truncated",
    "Uniform",
    "UniformHemisphere",
    "UniformSphere",
    "VisibleNormals",
    "VonMisesFisher",
]
