"""Densities that can be sampled, evaluated, mixed and compared."""

from steradian.distributions.base import Distribution, Samples
from steradian.distributions.composite import Mixture, Product
from steradian.distributions.line import Exponential, Linear, Normal, Power, Tent, Truncated, Uniform

__all__ = [
    "Distribution",
    "Exponential",
    "Linear",
    "Mixture",
    "Normal",
    "Power",
    "Product",
    "Samples",
    "Tent",
    "Truncated",
    "Uniform",
]
