"""What every integration asks of compiled code, and what it makes of the answer."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from steradian import _internal
from steradian.distributions.arguments import choice, function, number, whole
from steradian.distributions.base import SEQUENCES, Distribution
from steradian.distributions.composite import Mixture
from steradian.integration.errors import IntegrationWarning
from steradian.integration.estimate import Estimate, format_uncertain

DEFAULT_N = 1 << 16
"""Evaluations if nothing else says when to stop."""

FEW = 100
"""Of fewer points nothing is said of their shares."""

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
    rtol, atol = rtol or 0.0, atol or 0.0
    if n is None and seconds is None and rtol == 0 and atol == 0:
        n = DEFAULT_N
    on_round = None
    if on_progress is not None:
        function("on_progress", on_progress)

        def report(*values: Any) -> object:
            return on_progress(IntegrationProgress(*values))

        on_round = report
    return {
        "sequence": choice("sequence", sequence, SEQUENCES),
        "replicates": whole("replicates", replicates, most=1 << 16),
        "seed": whole("seed", seed, 0, (1 << 64) - 1),
        "n": None if n is None else whole("n", n),
        "rtol": number("rtol", rtol),
        "atol": number("atol", atol),
        "seconds": None if seconds is None else number("seconds", seconds),
        "batch": whole("batch", batch),
        "nan_as_zero": choice("nan", nan, ("raise", "zero")) == "zero",
        "threads": whole("threads", threads, 0, _internal.MAX_THREADS),
        "on_round": on_round,
    }


Box = list[tuple[float, float]]


def domains_of(
    densities: Sequence[Distribution], domain: Sequence[tuple[float, float]] | None = None
) -> list[tuple[_internal.Density, Box]]:
    """The box that densities together should cover, with their mixture.

    That is the box given, or theirs if they know one.
    """
    first = densities[0]
    if any(density.space != first.space or density.dim != first.dim for density in densities):
        return []  # compiled code says what is wrong
    cover = first if len(densities) == 1 else Mixture(densities)
    sides = cover._core.domain() if domain is None else box("domain", domain, first.dim)
    return [] if sides is None else [(cover._core, sides)]


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


def to_estimate(integral: _internal.Integral) -> Estimate:
    """What the user gets; warns of what makes it unreliable."""
    m = len(integral.mean)
    covariance = np.array(integral.covariance).reshape(m, m)
    stderr = np.array(integral.stderr)
    for doubt in _doubts(integral):
        warnings.warn(doubt, IntegrationWarning, stacklevel=3)
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
            "tail_index": integral.tail_index,
            "largest_share": integral.largest_share,
            "not_drawn": integral.not_drawn,
        },
    )


def _doubts(integral: _internal.Integral) -> Iterator[str]:
    """What makes an answer less sure than it says."""
    n = integral.n
    if integral.not_drawn == n:
        yield f"the density drew none of {n} points: 0 is no estimate"
    elif not any(integral.mean) and not any(integral.stderr) and integral.effective_n == 0:
        yield f"f was 0 at all {n} points: what it is elsewhere nobody knows, and 0 ± 0 is no error"
    elif integral.largest_share > SUSPICIOUS_SHARE and n > FEW:
        yield (
            f"a single one of {n} points makes up {integral.largest_share:.0%} of the sum: the error is "
            f"unreliable, and a density nearer to f is needed"
        )
    elif integral.has_heavy_tail:
        index = "" if integral.tail_index is None else f" (tail index {integral.tail_index:.2f})"
        yield (
            f"a few of {n} points decide{index}: f / p has a heavy tail, perhaps no variance, and the error "
            f"is unreliable; a density nearer to f is needed where f / p is largest, or more points"
        )
    if integral.nans:
        yield f"f was not finite at {integral.nans} of {n} points, which count as 0"
    if integral.ended_by_cap:
        yield (
            f"the tolerance was not met after {n} points: an integral of 0 meets no rtol, give atol then; or "
            f"give n or seconds to go further"
        )
    if integral.contradicted is not None:
        which, mean, stderr = integral.contradicted
        yield (
            f"the points give control[{which}] an integral of {format_uncertain(mean, stderr)}, which "
            f"contradicts the one that is said to be known: the estimate is wrong"
        )
