"""Distributions that are made of others."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, NoReturn

import numpy as np
from numpy.typing import ArrayLike

from steradian import _internal
from steradian.distributions.arguments import array, number
from steradian.distributions.base import Compiled, Distribution, core_of

WHOLE = 1e-9
"""How far a sum of weights may be from 1."""


class Product(Compiled):
    """Independent coordinates: the product of densities of lengths, areas or volumes.

    ``factors``: distributions, whose coordinates follow one another. ``p * q`` is short for ``Product([p,
    q])``. Raises ValueError if there is none, or one is a density of something else, such as solid angle.

    >>> import steradian as sr
    >>> (sr.Uniform(0, 2) * sr.Linear()).pdf([[0.5, 0.5]])
    array([0.5])
    """

    def __init__(self, factors: Sequence[Distribution]) -> None:
        cores = [core_of(f"factors[{i}]", p) for i, p in enumerate(factors)]
        super().__init__(_internal.product(cores), factors=list(factors))


class Mixture(Compiled):
    """p(x) = Σᵢ wᵢ pᵢ(x): one of several distributions of the same space is chosen, and sampled.

    ``components``: the distributions; ``weights``: not negative, summing to 1; equal ones if not given. ``0.3
    * p + 0.7 * q`` is short for ``Mixture([p, q], [0.3, 0.7])``, and ``sum`` adds any number of such parts.
    Raises ValueError naming the weight that is wrong, TypeError naming the component that is none.

    >>> import steradian as sr
    >>> half = 0.5 * sr.Uniform(0, 1) + 0.5 * sr.Uniform(0, 2)
    >>> half.pdf([0.5, 1.5])
    array([0.75, 0.25])
    """

    def __init__(self, components: Sequence[Distribution], weights: Sequence[float] | None = None) -> None:
        cores = [core_of(f"components[{i}]", p) for i, p in enumerate(components)]
        if weights is None:
            weights = [1 / max(len(cores), 1)] * len(cores)
        weights = [number(f"weights[{i}]", weight) for i, weight in enumerate(weights)]
        super().__init__(_internal.mixture(cores, weights), components=list(components), weights=weights)

    @property
    def components(self) -> list[Distribution]:
        """The distributions that are mixed."""
        return list(self._arguments["components"])

    @property
    def weights(self) -> list[float]:
        """Their weights."""
        return list(self._arguments["weights"])

    def __add__(self, other: Mixture) -> Mixture:
        """``0.3 * p + 0.7 * q``: unfinished until the weights sum to 1."""
        if not isinstance(other, Mixture):
            return NotImplemented
        return mixed(self.components + other.components, self.weights + other.weights)

    def __radd__(self, nothing: int) -> Mixture:
        """``0 + p``, with which Python's ``sum`` begins."""
        return self if isinstance(nothing, int) and nothing == 0 else NotImplemented


class Unfinished(Mixture):
    """A mixture on its way, as ``0.3 * p``, whose weights do not sum to 1 yet.

    All that can be done with it is to add the rest; whatever else is asked is a ValueError that says so.
    """

    def __init__(self, components: Sequence[Distribution], weights: Sequence[float]) -> None:
        self._arguments = {"components": list(components), "weights": list(weights)}
        self.dim = components[0].dim
        self.space = components[0].space

    def _refuse(self) -> NoReturn:
        raise ValueError(f"the weights of {self!r} sum to {sum(self.weights):g}, not to 1")

    @property
    def _core(self) -> _internal.Density:
        self._refuse()

    @property
    def uniforms(self) -> int:  # type: ignore[override]
        """Nobody knows before it is whole."""
        self._refuse()

    def to_dict(self) -> dict[str, Any]:
        """Nothing that could be written down."""
        self._refuse()

    def __repr__(self) -> str:
        return " + ".join(f"{w} * {p!r}" for w, p in zip(self.weights, self.components, strict=True))


def mixed(components: Sequence[Distribution], weights: Sequence[float]) -> Mixture:
    """A mixture, unfinished if the weights do not sum to 1."""
    whole = abs(sum(weights) - 1) < WHOLE
    return (Mixture if whole else Unfinished)(components, weights)


class Affine(Compiled):
    """Another distribution, stretched, turned and moved: x = matrix · y + offset; p(x) = p(y) / |det matrix|.

    ``of``: a distribution of lengths, areas or volumes. ``matrix``: (dim, dim), or a number to scale all axes
    alike. ``offset``: (dim,), or a number. Raises ValueError if shapes do not fit, a number is not finite, or
    the matrix cannot be inverted.

    >>> import steradian as sr
    >>> p = sr.Affine(sr.Exponential(1), -2, 3)  # falls from 3 towards −∞
    >>> p.support, p.mean
    (array([[-inf,   3.]]), 1.0)
    """

    def __init__(self, of: Distribution, matrix: ArrayLike, offset: ArrayLike = 0.0) -> None:
        core_of("of", of)
        rows, move = array("matrix", matrix), array("offset", offset)
        if rows.ndim == 0:
            rows = rows * np.eye(of.dim)
        if move.ndim == 0:
            move = np.full(of.dim, move)
        if rows.shape != (of.dim, of.dim):
            raise ValueError(f"matrix has shape {rows.shape}; it must be ({of.dim}, {of.dim})")
        if move.shape != (of.dim,):
            raise ValueError(f"offset has shape {move.shape}; it must be ({of.dim},)")
        core = _internal.affine(of._core, np.ascontiguousarray(rows).reshape(-1), np.ascontiguousarray(move))
        super().__init__(core, of=of, matrix=matrix, offset=offset)
