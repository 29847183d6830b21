"""Distributions from tables of numbers, and from functions."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from steradian import _internal
from steradian.distributions.arguments import Array, array, function, number, numbers, vector
from steradian.distributions.base import Compiled
from steradian.distributions.functions import evaluate


class PiecewiseConstant(Compiled):
    """A histogram as a density: constant in each bin, p = count / (sum of counts · width of the bin).

    ``edges``: (n + 1,), each above the one before; widths may differ. ``counts``: (n,), how much lies in
    each bin, in any unit. Raises ValueError naming the entry if a count is negative or not finite, all are
    0, there is none, or edges do not rise or do not fit.

    >>> import steradian as sr
    >>> p = sr.PiecewiseConstant([0, 1, 3], [1, 3])
    >>> p.pdf([0.5, 2.0])
    array([0.25 , 0.375])
    >>> p.icdf([0.25, 0.625])
    array([1., 2.])
    """

    def __init__(self, edges: ArrayLike, counts: ArrayLike) -> None:
        edges, counts = numbers("edges", edges), numbers("counts", counts)
        super().__init__(_internal.piecewise_constant(edges, counts), edges=edges, counts=counts)


class PiecewiseLinear(Compiled):
    """A density that is linear between the points of a table, and 0 beyond its ends.

    ``x``: (n,), n ≥ 2, each above the one before. ``y``: (n,), what the density is proportional to there.
    Raises ValueError naming the entry that is wrong.

    >>> import steradian as sr
    >>> sr.PiecewiseLinear([0, 1, 4], [0, 2, 0]).pdf([0.5, 1.0, 5.0])
    array([0.25, 0.5 , 0.  ])
    """

    def __init__(self, x: ArrayLike, y: ArrayLike) -> None:
        x, y = numbers("x", x), numbers("y", y)
        super().__init__(_internal.piecewise_linear(x, y), x=x, y=y)


class Tabulated2D(Compiled):
    """A density over a rectangle that is constant in each cell of a regular grid.

    A marginal density picks x, and a conditional one y. ``values``: (nx, ny), what the density is
    proportional to; the first index goes along x, as in ``numpy.histogram2d``. So give a picture as
    ``picture.T``. ``low``, ``high``: (2,), corners of the rectangle. Raises ValueError naming the value or
    the corner that is wrong.

    >>> import steradian as sr
    >>> sr.Tabulated2D([[1, 3], [0, 4]]).pdf([[0.2, 0.9], [0.9, 0.2]])
    array([1.5, 0. ])
    """

    def __init__(self, values: ArrayLike, low: ArrayLike = (0.0, 0.0), high: ArrayLike = (1.0, 1.0)) -> None:
        table = np.ascontiguousarray(array("values", values))
        if table.ndim != 2:
            raise ValueError(f"values has shape {table.shape}; it must be (nx, ny)")
        if not np.all((table >= 0) & np.isfinite(table)):
            i, j = np.argwhere(~((table >= 0) & np.isfinite(table)))[0]
            value = "NaN" if np.isnan(table[i, j]) else table[i, j]
            raise ValueError(f"values[{i}, {j}] is {value}; it must be finite and not negative")
        core = _internal.tabulated_2d(table, vector("low", low, 2), vector("high", high, 2))
        super().__init__(core, values=table, low=low, high=high)


class Discrete(Compiled):
    """An index from 0 to n − 1, as probable as its weight. Keeps the order of the uniforms.

    ``weights``: (n,), not negative, in any unit. Points are indices as floating-point numbers, and ``pdf``
    is a probability. Raises ValueError naming the weight if one is negative or not finite, there is none, or
    all are 0.

    >>> import steradian as sr
    >>> p = sr.Discrete([1, 0, 3])
    >>> p.sample([0.1, 0.9]).value, p.pdf([0, 1, 2])
    (array([0., 2.]), array([0.25, 0.  , 0.75]))
    """

    def __init__(self, weights: ArrayLike) -> None:
        weights = numbers("weights", weights)
        super().__init__(_internal.discrete(weights), weights=weights)


class Alias(Compiled):
    """An index from 0 to n − 1, as probable as its weight, by one look into a table (Walker 1977, Vose 1991).

    Faster than :class:`Discrete` for long lists, but neighbouring uniforms do not give neighbouring indices.
    ``weights``: as there, and so are the errors.

    >>> import steradian as sr
    >>> sr.Alias([1, 0, 3]).pdf([0, 1, 2])
    array([0.25, 0.  , 0.75])
    """

    def __init__(self, weights: ArrayLike) -> None:
        weights = numbers("weights", weights)
        super().__init__(_internal.alias(weights), weights=weights)


class FromPdf(Compiled):
    """A density proportional to any function on an interval, normalised and inverted numerically.

    ``f``: called with (n,) numbers between ``low`` and ``high``, returns (n,), not negative; it need not be
    normalised. It is called now, and never again: polynomials take its place, such that
    ∫ |p − f / ∫ f| is at most ``tolerance``. Samples follow these to the last digits, so an estimate is
    unbiased whatever the tolerance. ``error`` and ``integral`` (of ``f``) are known afterwards.

    Jumps and poles are closed in on. A peak, or a gap, that is narrower than about 1/900 of the interval may
    be missed: mix several intervals then. Raises ValueError, naming place and value, if ``f`` is negative,
    infinite or NaN, 0 everywhere, of the wrong shape, or cannot be resolved.

    After Derflinger, Hörmann & Leydold, "Random Variate Generation by Numerical Inversion when Only the
    Density Is Known", 2010.

    >>> import numpy as np, steradian as sr
    >>> p = sr.FromPdf(np.sin, 0, np.pi)
    >>> float(p.cdf(np.pi / 2).round(6)), round(p.integral, 6)
    (0.5, 2.0)
    """

    error: float
    """∫ |p − f / ∫ f|, as far as the values of ``f`` tell."""

    integral: float
    """∫ f over the interval."""

    def __init__(
        self, f: Callable[[Array], ArrayLike], low: float, high: float, tolerance: float = 1e-6
    ) -> None:
        function("f", f)
        ends = number("low", low), number("high", high)

        def checked(x: Array) -> Array:
            y = evaluate("f", f, x)
            if y.shape != x.shape:
                raise ValueError(f"f returned shape {y.shape} for {x.shape}; it must return (n,) for (n,)")
            return y

        core, self.error, self.integral = _internal.from_pdf(checked, *ends, number("tolerance", tolerance))
        super().__init__(core, f=f, low=low, high=high, tolerance=tolerance)
