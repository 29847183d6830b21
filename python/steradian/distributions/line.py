"""Distributions on the real line, and uniform ones in boxes."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from steradian import _internal
from steradian.distributions.arguments import array, number
from steradian.distributions.base import Compiled, Distribution, core_of


class Uniform(Compiled):
    """Every point of an interval, or of a box, equally likely: p = 1 / (high − low), in each dimension.

    ``low``, ``high``: numbers, or (dim,) of them for a box. Raises ValueError if they are not finite, or
    ``low`` is not below ``high``.

    >>> import steradian as sr
    >>> sr.Uniform(0, 5).pdf([1.0, 6.0])
    array([0.2, 0. ])
    >>> sr.Uniform([0, 0], [1, 2]).pdf([0.5, 0.5])
    np.float64(0.5)
    """

    def __init__(self, low: ArrayLike = 0.0, high: ArrayLike = 1.0) -> None:
        lows, highs = array("low", low), array("high", high)
        if lows.ndim > 1 or highs.ndim > 1 or (lows.ndim == highs.ndim == 1 and len(lows) != len(highs)):
            raise ValueError(
                f"low and high have shapes {lows.shape} and {highs.shape}; "
                f"they must be numbers, or (dim,) of them"
            )
        lows, highs = np.broadcast_arrays(lows, highs)
        if lows.ndim == 0:
            core = _internal.uniform(float(lows), float(highs))
        else:
            core = _internal.uniform_box([(float(a), float(b)) for a, b in zip(lows, highs, strict=True)])
        super().__init__(core, low=low, high=high)


class Linear(Compiled):
    """A density that rises or falls linearly from ``low`` to ``high``.

    ``at_low``, ``at_high``: its values there, up to a common factor. So ``Linear(0, 5)`` is p ∝ x, and
    integrates 2x without any variance. Raises ValueError if an end is not finite or not in order, a value is
    negative, or both are 0.

    >>> import steradian as sr
    >>> print(sr.integrate(lambda x: 2 * x, over=sr.Linear(0, 5), n=1024))
    25 ± 0 (n = 1024)
    """

    def __init__(
        self, low: float = 0.0, high: float = 1.0, at_low: float = 0.0, at_high: float = 1.0
    ) -> None:
        core = _internal.linear(
            number("low", low), number("high", high), number("at_low", at_low), number("at_high", at_high)
        )
        super().__init__(core, low=low, high=high, at_low=at_low, at_high=at_high)


class Tent(Compiled):
    """A density that rises linearly from ``low`` to ``peak`` and falls to ``high``.

    Raises ValueError if they are not finite, not in order, or ``low`` is not below ``high``.

    >>> import steradian as sr
    >>> sr.Tent(-1, 0, 1).pdf([-0.5, 0.0])
    array([0.5, 1. ])
    """

    def __init__(self, low: float = -1.0, peak: float = 0.0, high: float = 1.0) -> None:
        core = _internal.tent(number("low", low), number("peak", peak), number("high", high))
        super().__init__(core, low=low, peak=peak, high=high)


class Exponential(Compiled):
    """p(x) = rate · exp(−rate · x) for x ≥ 0.

    Raises ValueError if ``rate`` is not positive and finite.

    >>> import steradian as sr
    >>> sr.Exponential(2).mean
    0.5
    """

    def __init__(self, rate: float = 1.0) -> None:
        super().__init__(_internal.exponential(number("rate", rate)), rate=rate)


class Normal(Compiled):
    """The normal distribution, by inversion.

    ``mean``, ``sd``: of the values; ``sd`` is positive. Raises ValueError otherwise, naming the argument.

    >>> import steradian as sr
    >>> float(sr.Normal(0, 1).cdf(1.959963984540054).round(9))
    0.975
    """

    def __init__(self, mean: float = 0.0, sd: float = 1.0) -> None:
        super().__init__(_internal.normal(number("mean", mean), number("sd", sd)), mean=mean, sd=sd)


class Power(Compiled):
    """p(x) ∝ x^exponent on [low, high].

    Raises ValueError if an end is negative or not finite, they are not in order, or the integral is not
    finite; from ``low`` = 0 on, ``exponent`` must be above −1 by 0.05, or samples could not be told from 0.

    >>> import steradian as sr
    >>> float(sr.Power(2, 0, 1).cdf(0.5).round(12))
    0.125
    """

    def __init__(self, exponent: float, low: float = 0.0, high: float = 1.0) -> None:
        core = _internal.power(number("exponent", exponent), number("low", low), number("high", high))
        super().__init__(core, exponent=exponent, low=low, high=high)


class Truncated(Compiled):
    """Another distribution on the line, cut to [low, high] and scaled so that it still integrates to 1.

    Either end may be infinite. Raises ValueError if nothing of the distribution is in between.

    >>> import steradian as sr
    >>> sr.Truncated(sr.Normal(), 0, float("inf")).support
    array([[ 0., inf]])
    """

    def __init__(self, of: Distribution, low: float = -np.inf, high: float = np.inf) -> None:
        core = _internal.truncated(core_of("of", of), number("low", low), number("high", high))
        super().__init__(core, of=of, low=low, high=high)
