"""Densities that were learned from an integrand."""

from __future__ import annotations

from collections.abc import Sequence

from steradian import _internal
from steradian.distributions.base import Compiled, Distribution, core_of

Component = tuple[Sequence[Sequence[float]], Sequence[float], Sequence[float]]
"""Knots of each axis; the origin and the rotation matrix (row after row) of its own axes, or two empty."""


class Learned(Compiled):
    """What :func:`adapt` learns: the density of ``over``, times one on the cube of its uniforms.

    That one is a mixture of products. Each factor is the density of a monotone map of [0, 1], given by its
    knots, between which it has equal probabilities; a component may have axes of its own.

    - ``over``: the distribution that it was learned over
    - ``components``: each (knots of each axis, origin, rotation); origin and rotation are empty along the
      coordinates
    - ``shares``: of each component, whole numbers that sum to 64
    - ``strata``: how the mixture's own uniforms are drawn, if not evenly: a tree of cells, each before its
      lower and that before its upper half, as (the axis that it is cut across, the probability of its lower
      half), or None for a stratum, which is not cut

    Raises ValueError, naming what is wrong, if these are no such density.

    >>> import steradian as sr
    >>> learned = sr.Learned(sr.Uniform(), [([[0.0, 0.1, 1.0]], [], [])], [64])
    >>> bool(learned.pdf(0.05) > learned.pdf(0.9))
    True
    """

    def __init__(
        self,
        over: Distribution,
        components: Sequence[Component],
        shares: Sequence[int],
        strata: Sequence[tuple[int, float] | None] = (),
    ) -> None:
        core = _internal.learned(
            core_of("over", over),
            [(list(knots), list(origin), list(rotation)) for knots, origin, rotation in components],
            list(shares),
            [None if cell is None else (cell[0], cell[1]) for cell in strata],
        )
        super().__init__(core, over=over, components=components, shares=shares, strata=strata)

    def __repr__(self) -> str:
        count, cells = len(self._arguments["components"]), len(self._arguments["strata"])
        strata = f", {(cells + 1) // 2} strata" if cells else ""
        return f"<Learned over {self._arguments['over']!r}, {count} component{'s' * (count > 1)}{strata}>"
