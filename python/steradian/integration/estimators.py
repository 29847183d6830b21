"""Integrals as the mean of f(X) / p(X)."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from steradian import _internal
from steradian.distributions.base import Distribution, as_distribution
from steradian.integration.errors import IntegrationWarning
from steradian.integration.estimate import Estimate
from steradian.integration.integrands import checked, prepare

Array = NDArray[np.float64]

Integrand = Callable[[Array], Any]
"""From points, (n,) for one coordinate and (n, dim) otherwise, to (n,) or (n, m); or a native function."""

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


def integrate(
    f: Integrand,
    over: Distribution | Sequence[tuple[float, float]],
    *,
    n: int | None = None,
    rtol: float = 0.0,
    atol: float = 0.0,
    seconds: float | None = None,
    sequence: str = "sobol",
    replicates: int = 32,
    seed: int = 0,
    control: tuple[Integrand, float] | Sequence[tuple[Integrand, float]] | None = None,
    domain: Sequence[tuple[float, float]] | None = None,
    nan: str = "raise",
    batch: int = 1 << 14,
    threads: int = 0,
    on_progress: Callable[[IntegrationProgress], object] | None = None,
) -> Estimate:
    """∫ f(x) dx as the mean of f(X) / p(X), X drawn from the density ``over``.

    >>> import steradian as sr
    >>> print(sr.integrate(lambda x: 2 * x, over=sr.Uniform(0, 5), sequence="independent", n=100_000, seed=1))
    24.989 ± 0.046 (n = 100000)

    - ``f``: from points (n,), or (n, dim), to (n,), or to (n, m) for m integrals at once. Points come with
      each coordinate contiguous. A Numba ``@cfunc`` or a ctypes function is called from all cores, without
      Python.
    - ``over``: a :class:`Distribution`, or (low, high) for each dimension of a box. The integral is over its
      support.
    - It stops at the first limit that is met: ``n`` evaluations (2¹⁶ if there is no other limit; rounded up
      to a whole number for each replicate), a standard error of ``rtol`` times the mean or of ``atol``, or
      ``seconds``.
    - ``sequence``: ``"sobol"`` (Owen-scrambled), ``"lattice"``, ``"stratified"`` or ``"independent"``. The
      error is that of ``replicates`` independent randomisations of the points, or, for independent points, of
      the points. Powers of two suit Sobol' and lattice points best.
    - ``control``: control variates, as (g, its known integral) or a list of these.
    - ``domain``: (low, high) for each dimension where ``over`` should cover ``f``; some 500 points are looked
      at. Tables know theirs.
    - ``nan``: ``"raise"``, or ``"zero"`` to count points where ``f`` is not finite as 0; see
      ``Estimate.nans``.
    - ``batch``: about how many points ``f`` gets at a time. ``threads``: 0 is all cores; what ``f`` does is
      its own affair.
    - ``on_progress``: is called with an :class:`IntegrationProgress` after each batch; an exception ends
      everything.

    The same arguments give the same bits, for any number of threads.

    Raises :class:`IntegrandError` where ``f`` is not finite, :class:`SupportError` where ``over`` is 0 and
    ``f`` is not, and ValueError or TypeError that name the argument. Warns with :class:`IntegrationWarning`
    if a single point decides.

    Source: every textbook; scrambling and replicates: A. B. Owen, Ann. Stat. 25 (1997).
    """
    density = as_distribution(over)
    integrand, known = _with_controls(f, control, density.dim)
    domains = (
        [(density._core, _box("domain", domain, density.dim))] if domain is not None else _domains([density])
    )
    request = _request(n, rtol, atol, seconds, sequence, replicates, seed, nan, batch, threads, on_progress)
    return _estimate(
        _internal.integrate(density._core, integrand, request | {"known": known, "domains": domains})
    )


def mis_integrate(
    f: Integrand,
    over: Sequence[Distribution],
    *,
    heuristic: str = "balance",
    counts: Sequence[int] | None = None,
    n: int | None = None,
    rtol: float = 0.0,
    atol: float = 0.0,
    seconds: float | None = None,
    sequence: str = "sobol",
    replicates: int = 32,
    seed: int = 0,
    control: tuple[Integrand, float] | Sequence[tuple[Integrand, float]] | None = None,
    nan: str = "raise",
    batch: int = 1 << 14,
    threads: int = 0,
    on_progress: Callable[[IntegrationProgress], object] | None = None,
) -> Estimate:
    """∫ f(x) dx by multiple importance sampling: samples of several densities, weighted.

    >>> import numpy as np, steradian as sr
    >>> peak = lambda x: np.exp(-50 * (x - 0.3) ** 2) + 0.1
    >>> print(sr.mis_integrate(peak, [sr.Uniform(0, 1), sr.Truncated(sr.Normal(0.3, 0.1), 0, 1)], n=8192))
    0.350333 ± 0.000022 (n = 8192)

    - ``over``: distributions over the same space. Wherever f is not 0, one of them must not be.
    - ``heuristic``: ``"balance"``, ``"power"`` (β = 2), ``"cutoff"`` (α = 0.1) or ``"maximum"``.
    - ``counts``: samples of each, relative to one another; one each if not given.

    Everything else as in :func:`integrate`.

    Source: E. Veach & L. Guibas, "Optimally combining sampling techniques for Monte Carlo rendering", 1995.
    """
    densities = _distributions(over)
    shares = (
        [1] * len(densities) if counts is None else [_whole(f"counts[{i}]", c) for i, c in enumerate(counts)]
    )
    integrand, known = _with_controls(f, control, densities[0].dim)
    request = _request(n, rtol, atol, seconds, sequence, replicates, seed, nan, batch, threads, on_progress)
    request |= {"known": known, "domains": []}
    cores = [density._core for density in densities]
    return _estimate(_internal.mis_integrate(cores, shares, heuristic, integrand, request))


def ris_integrate(
    f: Integrand,
    over: Distribution | Sequence[tuple[float, float]],
    target: Integrand | Distribution,
    *,
    candidates: int = 32,
    n: int | None = None,
    rtol: float = 0.0,
    atol: float = 0.0,
    seconds: float | None = None,
    sequence: str = "sobol",
    replicates: int = 32,
    seed: int = 0,
    nan: str = "raise",
    batch: int = 1 << 14,
    threads: int = 0,
    on_progress: Callable[[IntegrationProgress], object] | None = None,
) -> Estimate:
    """∫ f(x) dx by resampled importance sampling: the best of several candidates.

    >>> import numpy as np, steradian as sr
    >>> f = lambda x: np.exp(-50 * (x - 0.3) ** 2) * (1 + 0.1 * np.sin(40 * x))
    >>> target = lambda x: np.exp(-50 * (x - 0.3) ** 2)
    >>> plain = sr.integrate(f, over=sr.Uniform(0, 1), n=8192, sequence="independent")
    >>> resampled = sr.ris_integrate(f, over=sr.Uniform(0, 1), target=target, n=8192, sequence="independent")
    >>> bool(resampled.stderr < 0.4 * plain.stderr)
    True

    - ``over``: what the candidates are drawn from.
    - ``target``: a function of points, or a distribution; it need not be normalised, and must be positive
      where ``f`` is not 0. It pays where it is near ``f`` and cheaper.
    - ``candidates``: how many for each sample, 1 to 4096; ``n`` counts samples, for each of which ``f`` is
      evaluated once.

    Everything else as in :func:`integrate`.

    Source: J. Talbot, D. Cline & P. Egbert, "Importance resampling for global illumination", EGSR 2005.
    """
    density = as_distribution(over)
    if isinstance(target, Distribution):
        goal: Any = target._core
    elif callable(target):
        goal = checked(target, density.dim, "target")
    else:
        raise TypeError(f"target must be a distribution or a function of points, not {target!r}")
    integrand = prepare(f, density.dim)
    request = _request(n, rtol, atol, seconds, sequence, replicates, seed, nan, batch, threads, on_progress)
    request |= {"known": [], "domains": _domains([density])}
    chosen = _whole("candidates", candidates)
    return _estimate(_internal.ris_integrate(density._core, goal, chosen, integrand, request))


def _distributions(values: object) -> list[Distribution]:
    """A list of distributions, or a TypeError that names the one that is none."""
    if isinstance(values, Distribution) or not isinstance(values, Sequence):
        raise TypeError(f"over must be a list of distributions, not {values!r}")
    for i, value in enumerate(values):
        if not isinstance(value, Distribution):
            raise TypeError(f"over[{i}] must be a distribution, not {value!r}")
    if not values:
        raise ValueError("over is empty; it must hold at least one distribution")
    return list(values)


def _domains(densities: Sequence[Distribution]) -> list[tuple[_internal.Density, list[tuple[float, float]]]]:
    """The boxes that densities should cover, if they know."""
    cores = [density._core for density in densities]
    return [(core, domain) for core in cores if (domain := core.domain()) is not None]


def _box(argument: str, value: object, dim: int) -> list[tuple[float, float]]:
    """(low, high) for each dimension, or an error that names the argument."""
    try:
        box = np.asarray(value, float)
    except (TypeError, ValueError):
        raise TypeError(f"{argument} must be (low, high) for each dimension, not {value!r}") from None
    if box.shape == (2,) and dim == 1:
        box = box.reshape(1, 2)
    if box.shape != (dim, 2):
        raise ValueError(
            f"{argument} has shape {box.shape}; it must be (low, high) for each of {dim} dimensions"
        )
    for j, (low, high) in enumerate(box):
        if not (math.isfinite(low) and math.isfinite(high) and low < high):
            raise ValueError(f"{argument}[{j}] is ({low}, {high}); it must be finite, and low below high")
    return [(float(low), float(high)) for low, high in box]


def _with_controls(f: Integrand, control: object, dim: int) -> tuple[Any, list[float]]:
    """The integrand with its control variates as further outputs, and their integrals."""
    if control is None:
        return prepare(f, dim), []
    pairs: Any = (
        [control] if isinstance(control, tuple) and len(control) == 2 and callable(control[0]) else control
    )
    try:
        functions = [checked(g, dim, f"control[{i}]") for i, (g, _) in enumerate(pairs)]
        known = [float(value) for _, value in pairs]
    except (TypeError, ValueError):
        raise TypeError(f"control must be (g, its integral), or a list of these, not {control!r}") from None
    main = prepare(f, dim)
    if isinstance(main, _internal.Native):
        raise TypeError("control variates need f to be a NumPy function, not a native one")

    def both(x: Array) -> Array:
        return np.column_stack([main(x), *(g(x) for g in functions)])

    return both, known


def _whole(argument: str, value: object) -> int:
    """A positive whole number, or an error that names the argument."""
    if isinstance(value, bool) or not isinstance(value, int | float | np.integer) or value != value // 1:
        raise TypeError(f"{argument} must be a whole number, not {value!r}")
    if not 0 < int(value) < 1 << 63:
        raise ValueError(f"{argument} is {value}; it must be positive")
    return int(value)


def _request(
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
        "replicates": _whole("replicates", replicates),
        "seed": int(seed),
        "n": None if n is None else _whole("n", n),
        "rtol": float(rtol or 0.0),
        "atol": float(atol or 0.0),
        "seconds": None if seconds is None else float(seconds),
        "batch": _whole("batch", batch),
        "nan_as_zero": nan == "zero",
        "threads": threads,
        "on_round": on_round,
    }


def _estimate(integral: _internal.Integral) -> Estimate:
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
