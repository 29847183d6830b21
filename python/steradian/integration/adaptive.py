"""Learning a density that fits an integrand, and integrating with it."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from steradian import _internal
from steradian.distributions.base import Distribution, as_distribution
from steradian.distributions.learned import Learned
from steradian.integration.errors import IntegrationWarning
from steradian.integration.estimate import Estimate
from steradian.integration.integrands import Integrand, prepare
from steradian.integration.requests import IntegrationProgress, domains_of, make_request, to_estimate

DISAGREEMENT = 1e-4
"""Below this probability, rounds that should estimate the same do not."""

DEFAULT_N = 1 << 17
"""Evaluations if nothing else says when to stop."""


class Iteration(NamedTuple):
    """What a round of learning estimated, with points of its own."""

    mean: float | NDArray[np.float64]
    stderr: float | NDArray[np.float64]
    n: int
    """Evaluations."""
    effective_n: float
    """As many equal points would do as well (Kish 1965)."""
    components: int
    """Of the density that drew its points."""
    strata: int
    """Of that density; 1 if it has none."""


@dataclass(frozen=True, eq=False)
class Adapted:
    """An integral, the density that was learned for it, and whether what was seen on the way agrees.

    ``n`` counts all evaluations, ``estimate.n`` those that were not for learning.

    >>> import numpy as np, steradian as sr
    >>> found = sr.adapt(lambda x: np.exp(-100 * ((x - 0.3) ** 2).sum(axis=1)), over=[(0, 1)] * 3, n=1 << 15)
    >>> abs(float(found.estimate) / (np.pi / 100) ** 1.5 - 1) < 0.01
    True
    """

    estimate: Estimate
    """From points that nothing was learned from, by a density that was fixed before."""
    density: Learned
    """What was learned: a distribution like any other."""
    iterations: list[Iteration]
    """What each round of learning estimated."""
    chi2: float
    """Squared differences between the estimate and the rounds that saw enough, over their variances."""
    dof: int
    """Its degrees of freedom."""
    n: int
    """All evaluations, those of learning included."""
    q: float
    """The probability of a larger ``chi2`` if all estimate the same; 1 if there is nothing to compare."""

    def __str__(self) -> str:
        return f"{self.estimate}, chi2/dof = {self.chi2:.3g}/{self.dof}, Q = {self.q:.2g}"


def adapt(
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
    domain: Sequence[tuple[float, float]] | None = None,
    nan: str = "raise",
    batch: int = 1 << 14,
    threads: int = 0,
    on_progress: Callable[[IntegrationProgress], object] | None = None,
) -> Adapted:
    """∫ f(x) dx by a density that is learned from ``f``: adaptive importance sampling.

    >>> import numpy as np, steradian as sr
    >>> peaks = lambda x: sum(np.exp(-100 * ((x - c) ** 2).sum(axis=1)) for c in (0.25, 0.75))
    >>> found = sr.adapt(peaks, over=[(0, 1)] * 5, rtol=1e-3)
    >>> abs(float(found.estimate) / (2 * (np.pi / 100) ** 2.5) - 1) < 0.005
    True
    >>> found.density.draw(3).value.shape
    (3, 5)

    First it learns, from up to a quarter of the evaluations, a map of every coordinate, and, if there are
    several peaks or one that lies askew, a mixture of maps with their own axes. What neither can follow, like
    an edge, it stratifies: more points where f / p still varies, if a round of learning shows that they pay.
    Then it integrates with that density, from new points, so that the error is as honest as for any fixed
    density. If the rounds of learning contradict the result it warns: then the integrand has features that
    the points miss, and more are needed.

    - ``f``, limits, ``seed``, ``domain``, ``nan``, …: as in :func:`integrate`; ``n`` counts all evaluations
      (2¹⁷ if there is no limit). If ``f`` returns several values a point, the density follows all of them.
    - ``over``: a distribution, or a box; what is learned multiplies its density.

    Raises what :func:`integrate` raises. Warns with :class:`IntegrationWarning` if rounds disagree, or a
    single point decides.

    Source: G. P. Lepage, J. Comput. Phys. 27 (1978) for the maps, 439 (2021) for the strata; O. Cappé et al.,
    "Adaptive importance sampling in general mixture classes", Stat. Comput. 18 (2008), for mixtures.
    """
    base = as_distribution(over)
    if n is None and not rtol and not atol and seconds is None:
        n = DEFAULT_N
    asked = make_request(n, rtol, atol, seconds, sequence, replicates, seed, nan, batch, threads, on_progress)
    asked |= {"known": [], "domains": domains_of([base], domain)}
    result = _internal.adapt(base._core, prepare(f, base.dim), asked)
    found = Adapted(
        estimate=to_estimate(result.integral),
        density=Learned(base, *result.parts),
        iterations=[
            Iteration(_plain(mean), _plain(stderr), count, effective_n, components, strata)
            for mean, stderr, count, effective_n, components, strata in result.rounds
        ],
        chi2=result.chi2,
        dof=result.dof,
        n=result.n,
        q=result.q,
    )
    if found.q < DISAGREEMENT:
        warnings.warn(
            f"rounds of learning and the estimate disagree (Q = {found.q:.1g}, chi2/dof = "
            f"{found.chi2 / max(found.dof, 1):.3g}): the integrand has features that points miss; use more",
            IntegrationWarning,
            stacklevel=2,
        )
    return found


def _plain(values: list[float]) -> float | NDArray[np.float64]:
    """One number, or an array of several."""
    return values[0] if len(values) == 1 else np.array(values)
