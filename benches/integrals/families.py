"""Genz's six families of integrands over the unit cube, and two peaks, with their integrals.

A. Genz, "Testing multidimensional integration routines", 1984. The difficulties h and exponents e are
those of his tests; a and w are random, a scaled so that its sum is h / dim^e.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
DIM = 5


@dataclass(frozen=True)
class Case:
    """An integrand, (n, DIM) → (n,), and its integral over the unit cube."""

    name: str
    f: Callable[[Array], Array]
    exact: float


def bell(scale: float, centre: float) -> float:
    """∫₀¹ exp(−scale² (x − centre)²) dx."""
    return math.sqrt(math.pi) / (2 * scale) * (math.erf(scale * (1 - centre)) + math.erf(scale * centre))


def oscillatory(a: Array, w: Array) -> Case:
    """cos(2π w₁ + a·x)."""
    exact = float(np.prod(2 * np.sin(a / 2) / a)) * math.cos(2 * math.pi * w[0] + a.sum() / 2)
    return Case("oscillatory", lambda x: np.cos(2 * np.pi * w[0] + x @ a), exact)


def product_peak(a: Array, w: Array) -> Case:
    """Π 1 / (aⱼ⁻² + (xⱼ − wⱼ)²)."""
    exact = float(np.prod(a * (np.arctan(a * (1 - w)) + np.arctan(a * w))))
    return Case("product peak", lambda x: 1 / np.prod(a**-2.0 + (x - w) ** 2, axis=1), exact)


def corner_peak(a: Array, w: Array) -> Case:
    """(1 + a·x)^−(dim + 1)."""
    terms = (
        (-1) ** sum(corner) / (1 + float(np.dot(corner, a)))
        for corner in itertools.product((0, 1), repeat=DIM)
    )
    exact = sum(terms) / (math.factorial(DIM) * float(np.prod(a)))
    return Case("corner peak", lambda x: (1 + x @ a) ** -(DIM + 1.0), exact)


def gaussian(a: Array, w: Array) -> Case:
    """exp(−Σ aⱼ² (xⱼ − wⱼ)²)."""
    exact = math.prod(bell(scale, centre) for scale, centre in zip(a, w, strict=True))
    return Case("Gaussian", lambda x: np.exp(-((x - w) ** 2) @ (a * a)), exact)


def continuous(a: Array, w: Array) -> Case:
    """exp(−Σ aⱼ |xⱼ − wⱼ|), with a kink."""
    exact = float(np.prod((2 - np.exp(-a * w) - np.exp(-a * (1 - w))) / a))
    return Case("continuous", lambda x: np.exp(-np.abs(x - w) @ a), exact)


def discontinuous(a: Array, w: Array) -> Case:
    """exp(a·x) where x₁ < w₁ and x₂ < w₂, and 0 elsewhere."""
    ends = np.concatenate([w[:2], np.ones(DIM - 2)])
    exact = float(np.prod(np.expm1(a * ends) / a))
    return Case(
        "discontinuous", lambda x: np.where((x[:, 0] > w[0]) | (x[:, 1] > w[1]), 0.0, np.exp(x @ a)), exact
    )


def two_peaks() -> Case:
    """exp(−100 |x − ¼|²) + exp(−100 |x − ¾|²)."""

    def f(x: Array) -> Array:
        return np.exp(-100 * ((x - 0.25) ** 2).sum(axis=1)) + np.exp(-100 * ((x - 0.75) ** 2).sum(axis=1))

    return Case(TWO_PEAKS, f, 2 * bell(10.0, 0.25) ** DIM)


TWO_PEAKS = "two peaks"
FAMILIES = (
    (oscillatory, 110.0, 1.5),
    (product_peak, 600.0, 2.0),
    (corner_peak, 600.0, 2.0),
    (gaussian, 100.0, 1.0),
    (continuous, 150.0, 2.0),
    (discontinuous, 100.0, 2.0),
)


def cases(draws: int) -> list[Case]:
    """Each family with ``draws`` sets of parameters, and the two peaks."""
    rng = np.random.default_rng(5)
    out = []
    for family, difficulty, exponent in FAMILIES:
        for _ in range(draws):
            w, a = rng.random(DIM), rng.random(DIM)
            out.append(family(a * difficulty / DIM**exponent / a.sum(), w))
    return [*out, two_peaks()]
