"""Integrals as the mean of f(X) / p(X)."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from steradian import _internal
from steradian.distributions.arguments import choice, number, short, whole
from steradian.distributions.base import Array, Distribution, as_distribution, core_of
from steradian.integration.errors import IntegrandError
from steradian.integration.estimate import Estimate
from steradian.integration.integrands import Integrand, checked, prepare, refuse_native
from steradian.integration.requests import IntegrationProgress, domains_of, make_request, to_estimate

HEURISTICS = ("balance", "power", "cutoff", "maximum")
"""How samples of several densities are weighted."""


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
      ``seconds``. With tolerances alone it gives up after 2²⁶ evaluations, with a warning: a mean of 0
      meets no ``rtol``.
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
    if few points decide, so that the error cannot be trusted; if ``f`` is 0 at all of them; if a tolerance
    was not met; or if a control's points contradict its known integral.

    Source: every textbook; scrambling and replicates: A. B. Owen, Ann. Stat. 25 (1997).
    """
    density = as_distribution(over)
    integrand, known = _with_controls(f, control, density.dim, nan != "zero")
    boxes = domains_of([density], domain)
    request = make_request(
        n, rtol, atol, seconds, sequence, replicates, seed, nan, batch, threads, on_progress
    )
    return to_estimate(
        _internal.integrate(density._core, integrand, request | {"known": known, "domains": boxes})
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
    domain: Sequence[tuple[float, float]] | None = None,
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
    - ``domain``: where all of them together should cover ``f``. On the line, and for tables, the box around
      their supports if not given: a gap between two of them is looked at.

    Everything else as in :func:`integrate`.

    Source: E. Veach & L. Guibas, "Optimally combining sampling techniques for Monte Carlo rendering", 1995.
    """
    densities = _distributions(over)
    shares = (
        [1] * len(densities)
        if counts is None
        else [whole(f"counts[{i}]", c, most=1 << 16) for i, c in enumerate(counts)]
    )
    choice("heuristic", heuristic, HEURISTICS)
    integrand, known = _with_controls(f, control, densities[0].dim, nan != "zero")
    request = make_request(
        n, rtol, atol, seconds, sequence, replicates, seed, nan, batch, threads, on_progress
    )
    request |= {"known": known, "domains": domains_of(densities, domain)}
    cores = [density._core for density in densities]
    return to_estimate(_internal.mis_integrate(cores, shares, heuristic, integrand, request))


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
    domain: Sequence[tuple[float, float]] | None = None,
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
      where ``f`` is not 0, which some 2,000 points check. It pays where it is near ``f`` and cheaper.
    - ``candidates``: how many for each sample, 1 to 4096; ``n`` counts samples, for each of which ``f`` is
      evaluated once.

    Everything else as in :func:`integrate`. Raises ValueError naming ``target`` where it is negative,
    infinite or NaN, and :class:`SupportError` where it is 0 and ``f`` is not.

    Source: J. Talbot, D. Cline & P. Egbert, "Importance resampling for global illumination", EGSR 2005.
    """
    density = as_distribution(over)
    if isinstance(target, Distribution):
        goal: Any = target._core
    elif callable(target):
        refuse_native("target", target)
        goal = checked(target, density.dim, "target")
    else:
        raise TypeError(f"target must be a distribution or a function of points, not {short(target)}")
    integrand = prepare(f, density.dim)
    request = make_request(
        n, rtol, atol, seconds, sequence, replicates, seed, nan, batch, threads, on_progress
    )
    request |= {"known": [], "domains": domains_of([density], domain)}
    chosen = whole("candidates", candidates, most=1 << 12)
    return to_estimate(_internal.ris_integrate(density._core, goal, chosen, integrand, request))


def _distributions(values: object) -> list[Distribution]:
    """A list of distributions, or a TypeError that names the one that is none."""
    if isinstance(values, Distribution) or not isinstance(values, Sequence):
        raise TypeError(f"over must be a list of distributions, not {short(values)}")
    for i, value in enumerate(values):
        core_of(f"over[{i}]", value)
    if not values:
        raise ValueError("over is empty; it must hold at least one distribution")
    return list(values)


def _with_controls(f: Integrand, control: object, dim: int, is_finite: bool) -> tuple[Any, list[float]]:
    """The integrand with its control variates as further outputs, and their integrals."""
    if control is None:
        return prepare(f, dim), []
    pairs: Any = (
        [control] if isinstance(control, tuple) and len(control) == 2 and callable(control[0]) else control
    )
    try:
        given = [(g, value) for g, value in pairs]
    except (TypeError, ValueError):
        raise TypeError(
            f"control must be (g, its integral), or a list of these, not {short(control)}"
        ) from None
    functions, known = [], []
    for i, (g, value) in enumerate(given):
        refuse_native(f"control[{i}]", g)
        if not callable(g):
            raise TypeError(f"control[{i}] must be (g, its integral), g a function, not {short(g)}")
        functions.append(_one_column(checked(g, dim, f"control[{i}]"), f"control[{i}]", is_finite))
        known.append(number(f"the known integral of control {i}", value))
    main = prepare(f, dim)
    if isinstance(main, _internal.Native):
        raise TypeError("control variates need f to be a NumPy function, not a native one")

    def both(x: Array) -> Array:
        return np.column_stack([main(x), *(g(x) for g in functions)])

    return both, known


def _one_column(g: Callable[[Array], Array], name: str, is_finite: bool) -> Callable[[Array], Array]:
    """A control variate whose values are checked: one for each point and, if so, finite."""

    def evaluate(x: Array) -> Array:
        values = g(x)
        if values.shape != (len(x),):
            raise ValueError(f"{name} returned shape {values.shape} for {len(x)} points; it must return (n,)")
        if is_finite and not np.isfinite(values).all():
            i = int(np.argmin(np.isfinite(values)))
            at = x[i].tolist() if x.shape[1] > 1 else float(x[i, 0])
            raise IntegrandError(
                f"{name} returned {values[i]} at x = {at}", x[i].tolist(), float(values[i]), 1
            )
        return values

    return evaluate
