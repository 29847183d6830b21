"""Evaluations a second: a native integrand of ours, and the same in NumPy with vegas."""

from __future__ import annotations

import math
import time

import numba
import numpy as np
import vegas

import steradian as sr
from integrals.families import DIM, Array

SIGNATURE = "void(CPointer(float64), int64, int64, CPointer(float64))"


@numba.cfunc(SIGNATURE, fastmath=True, error_model="numpy")
def gaussian(x, n, dim, out):  # type: ignore[no-untyped-def]
    """exp(−10 |x − ½|²) of n points, a column for each coordinate."""
    for i in range(n):
        total = 0.0
        for j in range(5):
            t = x[j * n + i] - 0.5
            total += t * t
        out[i] = math.exp(-10.0 * total)


@numba.cfunc(SIGNATURE, fastmath=True, error_model="numpy")
def product_peak(x, n, dim, out):  # type: ignore[no-untyped-def]
    """Π 1 / (0.02 + (xⱼ − ½)²)."""
    for i in range(n):
        product = 1.0
        for j in range(5):
            t = x[j * n + i] - 0.5
            product *= 0.02 + t * t
        out[i] = 1.0 / product


def numpy_gaussian(x: Array) -> Array:
    """The same in NumPy."""
    return np.exp(-10 * ((x - 0.5) ** 2).sum(axis=1))


def numpy_product_peak(x: Array) -> Array:
    """The same in NumPy."""
    return 1 / np.prod(0.02 + (x - 0.5) ** 2, axis=1)


PAIRS = {"Gaussian": (gaussian, numpy_gaussian), "product peak": (product_peak, numpy_product_peak)}


def rates(runs: int) -> dict[str, list[tuple[float, float]]]:
    """For each integrand, (ours, vegas's) million evaluations a second, of runs in turn."""
    out: dict[str, list[tuple[float, float]]] = {}
    for name, (native, plain) in PAIRS.items():
        sr.integrate(native, over=[(0, 1)] * DIM, n=1 << 20)
        out[name] = []
        for seed in range(runs):
            start = time.perf_counter()
            n = sr.integrate(native, over=[(0, 1)] * DIM, n=1 << 26, seed=seed).n
            own = n / (time.perf_counter() - start) / 1e6
            integrator = vegas.Integrator([[0, 1]] * DIM)
            start = time.perf_counter()
            done = integrator(vegas.lbatchintegrand(plain), nitn=5, neval=1e6)
            out[name].append((own, done.sum_neval / (time.perf_counter() - start) / 1e6))
    return out
