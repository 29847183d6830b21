"""What every integration asks of compiled code, and what it makes of the answer."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from steradian import _internal
from steradian.distributions.base import Distribution
from steradian.integration.errors import IntegrationWarning
from steradian.integration.estimate import Estimate

DEFAULT_N = 1 << 16
"""Evaluations if nothing else says when to stop."""

SUSPICIOUS_SHARE = 0.25
"""A single point with more than this share of the sum of many makes the error unreliable."""


@dataclass(frozen=True)
class IntegrationProgress:
    """What is known between two rounds of points."""

    n: int
    """Evaluations so far."""
    n_max: int | None
    """How many there can be, if ``n`` was given."""
    seconds: float
    """Time so far."""
    mean: list[float]
    """The mean of each output so far."""
    stderr: list[float]
    """Its standard error."""


def make_request(
    n: int | None,
    rtol: float,
    atol: float,
    seconds: float | None,
    sequence: str,
    replicates: int,
    seed: int,
    nan: str,
    batch: int,
    threads: int,
    on_progress: Callable[[IntegrationProgress], object] | None,
) -> dict[str, Any]:
    """The plan, as compiled code wants it."""
    if n is None and not rtol and not atol and seconds is None:
        n = DEFAULT_N
    if nan not in ("raise", "zero"):
        raise ValueError(f'nan is {nan!r}; it must be "raise" or "zero"')
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or not 0 <= seed < 1 << 64:
        raise ValueError(f"seed is {seed!r}; it must be a whole number from 0 to 2^64 - 1")
    if not 0 <= threads <= _internal.MAX_THREADS:
        raise ValueError(f"threads is {threads}; it must be from 0 to {_internal.MAX_THREADS}")
    on_round = None
    if on_progress is not None:
        on_round = lambda *values: on_progress(IntegrationProgress(*values))  # noqa: E731
    return {
        "sequence": sequence,
        "replicates": whole("replicates", replicates),
        "seed": int(seed),
        "n": None if n is None else whole("n", n),
        "rtol": float(rtol or 0.0),
        "atol": float(atol or 0.0),
        "seconds": None if seconds is None else float(seconds),
        "batch": whole("batch", batch),
        "nan_as_zero": nan == "zero",
        "threads": threads,
        "on_round": on_round,
    }


def domains_of(
    densities: Sequence[Distribution],
) -> list[tuple[_internal.Density, list[tuple[float, float]]]]:
    """The boxes that densities should cover, if they know."""
    cores = [density._core for density in densities]
    return [(core, domain) for core in cores if (domain := core.domain()) is not None]


def box(argument: str, value: object, dim: int) -> list[tuple[float, float]]:
    """(low, high) for each dimension, or an error that names the argument."""
    try:
        sides = np.asarray(value, float)
    except (TypeError, ValueError):
        raise TypeError(f"{argument} must be (low, high) for each dimension, not {value!r}") from None
    if sides.shape == (2,) and dim == 1:
        sides = sides.reshape(1, 2)
    if sides.shape != (dim, 2):
        raise ValueError(
            f"{argument} has shape {sides.shape}; it must be (low, high) for each of {dim} dimensions"
        )
    for j, (low, high) in enumerate(sides):
        if not (math.isfinite(low) and math.isfinite(high) and low < high):
            raise ValueError(f"{argument}[{j}] is ({low}, {high}); it must be finite, and low below high")
    return [(float(low), float(high)) for low, high in sides]


def whole(argument: str, value: object) -> int:
    """A positive whole number, or an error that names the argument."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.integer) or value != value // 1:
        raise TypeError(f"{argument} must be a whole number, not {value!r}")
    if not 0 < int(value) < 1 << 63:
        raise ValueError(f"{argument} is {value}; it must be positive")
    return int(value)


def to_estimate(integral: _internal.Integral) -> Estimate:
    """What the user gets; warns of what makes it unreliable."""
    m = len(integral.mean)
    covariance = np.array(integral.covariance).reshape(m, m)
    stderr = np.sqrt(np.maximum(np.diag(covariance), 0))
    if integral.largest_share > SUSPICIOUS_SHARE and integral.n > 100:
        warnings.warn(
            f"a single one of {integral.n} points makes up {integral.largest_share:.0%} of the sum: the "
            f"error is unreliable, and a density nearer to f is needed",
            IntegrationWarning,
            stacklevel=3,
        )
    if integral.nans:
        warnings.warn(
            f"f was not finite at {integral.nans} of {integral.n} points, which count as 0",
            IntegrationWarning,
            stacklevel=3,
        )
    return Estimate(
        mean=integral.mean[0] if m == 1 else np.array(integral.mean),
        stderr=float(stderr[0]) if m == 1 else stderr,
        n=integral.n,
        dof=integral.dof,
        seconds=integral.seconds,
        nans=integral.nans,
        covariance=None if m == 1 else covariance,
        diagnostics={
            "effective_n": integral.effective_n,
            "largest_share": integral.largest_share,
            "not_drawn": integral.not_drawn,
        },
    )
