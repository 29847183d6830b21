"""Strategies as values: how directions are chosen at each vertex of a path.

    sr.bsdf                                  one density
    0.5 * sr.cosine + 0.5 * sr.light         a mixture: one direction from the sum
    sr.mis(sr.bsdf, sr.light)                one sample of each, weighted by the power heuristic

``str()`` of a strategy is the expression that the command line takes, and :func:`strategy` reads it back.
Every strategy converges to the same image; they differ in how fast.
"""

from __future__ import annotations

from collections.abc import Sequence
from numbers import Real

from steradian import _internal


class Strategy:
    """One density, or several combined by multiple importance sampling.

    Made by :func:`mis`, :func:`strategy`, or from a :class:`Density`; equal if their expressions are.

    >>> import steradian as sr
    >>> sr.mis(sr.bsdf, sr.light) == sr.strategy("mis(bsdf, light)")
    True
    """

    __slots__ = ("_expression",)

    def __init__(self, expression: str) -> None:
        """Raises ValueError, naming the place and the remedy, if ``expression`` is not a strategy."""
        self._expression = _internal.normalize_strategy(expression)

    def __str__(self) -> str:
        return self._expression

    def __repr__(self) -> str:
        return f"sr.strategy({self._expression!r})"

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Strategy | Density):
            return NotImplemented
        return str(self) == str(other)

    def __hash__(self) -> int:
        return hash(self._expression)


class Density:
    """A weighted sum of the basic densities; the weights of a finished one sum to 1.

    Weights are checked when the density is used or printed, so that ``0.5 * sr.cosine`` can be on its way to
    ``0.5 * sr.cosine + 0.5 * sr.light``.

    >>> import steradian as sr
    >>> print(0.5 * sr.cosine + 0.5 * sr.light)
    0.5 cosine + 0.5 light
    """

    __slots__ = ("_terms",)

    def __init__(self, terms: Sequence[tuple[float, str]]) -> None:
        self._terms = tuple((float(weight), name) for weight, name in terms)

    @property
    def terms(self) -> tuple[tuple[float, str], ...]:
        """``(weight, name)`` as they were written."""
        return self._terms

    def __mul__(self, factor: float) -> Density:
        if not isinstance(factor, Real):
            return NotImplemented
        return Density([(weight * float(factor), name) for weight, name in self._terms])

    __rmul__ = __mul__

    def __radd__(self, other: object) -> Density:
        # What sum() starts with.
        return self if other == 0 and isinstance(other, int) else NotImplemented

    def __add__(self, other: Density) -> Density:
        if not isinstance(other, Density):
            return NotImplemented
        return Density(self._terms + other._terms)

    def __str__(self) -> str:
        """The normal form; raises ValueError if the weights do not sum to 1."""
        return _internal.normalize_strategy(self._expression())

    def __repr__(self) -> str:
        return " + ".join(
            f"sr.{name}" if weight == 1 else f"{weight} * sr.{name}" for weight, name in self._terms
        )

    def __eq__(self, other: object) -> bool:
        if isinstance(other, Density) and self._terms == other._terms:
            return True
        if not isinstance(other, Strategy | Density):
            return NotImplemented
        try:
            return str(self) == str(other)
        except ValueError:
            return False

    def __hash__(self) -> int:
        try:
            return hash(str(self))
        except ValueError:
            return hash(self._terms)

    def _expression(self) -> str:
        return " + ".join(f"{weight!r} {name}" for weight, name in self._terms)


uniform = Density([(1.0, "uniform")])
"""Every direction of the hemisphere (the sphere, if the surface transmits) equally likely."""

cosine = Density([(1.0, "cosine")])
"""Proportional to the cosine between direction and normal."""

bsdf = Density([(1.0, "bsdf")])
"""As the scattering model samples itself."""

light = Density([(1.0, "light")])
"""Towards the lights."""


HEURISTICS = ("power", "balance", "cutoff", "maximum")
"""How :func:`mis` shares a sample among the techniques that could have drawn it."""


def mis(*techniques: Density, heuristic: str = "power") -> Strategy:
    """One sample from each technique, weighted so that the sum stays unbiased (Veach 1997, §9.2).

    ``heuristic``: ``"power"`` (β = 2), ``"balance"``, ``"cutoff"`` or ``"maximum"``.
    Raises ValueError for no technique, too many, weights that do not sum to 1, or an unknown heuristic.

    >>> import steradian as sr
    >>> sr.mis(sr.bsdf, sr.light, heuristic="balance")
    sr.strategy('mis(bsdf, light, heuristic=balance)')
    """
    for technique in techniques:
        if not isinstance(technique, Density):
            raise TypeError(f"mis() combines densities, such as sr.bsdf, not {technique!r}")
    if heuristic not in HEURISTICS:
        known = ", ".join(HEURISTICS)
        raise ValueError(f"there is no heuristic {heuristic!r}; there are {known}")
    if not techniques:
        return Strategy("")
    parts = ", ".join(technique._expression() for technique in techniques)
    return Strategy(f"mis({parts}, heuristic={heuristic})")


def strategy(value: str | Density | Strategy) -> Strategy:
    """A strategy from an expression, such as ``"0.5 cosine + 0.5 light"``, or from a density.

    Raises ValueError, with the column and the remedy, if it is none.

    >>> import steradian as sr
    >>> sr.strategy(0.5 * sr.cosine + 0.5 * sr.light)
    sr.strategy('0.5 cosine + 0.5 light')
    """
    if isinstance(value, Strategy):
        return value
    if isinstance(value, Density):
        return Strategy(value._expression())
    if isinstance(value, str):
        return Strategy(value)
    raise TypeError(f"a strategy is an expression or made of sr.bsdf and its like, not {value!r}")
