"""Distributions that are made of others."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from steradian import _internal
from steradian.distributions.base import Compiled, Distribution


class Product(Compiled):
    """Independent coordinates: the product of densities of lengths, areas or volumes.

    ``factors``: distributions, whose coordinates follow one another. ``p * q`` is short for ``Product([p,
    q])``. Raises ValueError if there is none, or one is a density of something else, such as solid angle.

    >>> import steradian as sr
    >>> (sr.Uniform(0, 2) * sr.Linear()).pdf([[0.5, 0.5]])
    array([0.5])
    """

    def __init__(self, factors: Sequence[Distribution]) -> None:
        factors = list(factors)
        super().__init__(_internal.product([p._core for p in factors]), factors=factors)


class Mixture(Compiled):
    """p(x) = Σᵢ wᵢ pᵢ(x): one of several distributions of the same space is chosen, and sampled.

    ``components``: the distributions; ``weights``: not negative, summing to 1; equal ones if not given. ``0.3
    * p + 0.7 * q`` is short for ``Mixture([p, q], [0.3, 0.7])``. Raises ValueError naming the weight that is
    wrong.

    >>> import steradian as sr
    >>> half = 0.5 * sr.Uniform(0, 1) + 0.5 * sr.Uniform(0, 2)
    >>> half.pdf([0.5, 1.5])
    array([0.75, 0.25])
    """

    def __init__(self, components: Sequence[Distribution], weights: Sequence[float] | None = None) -> None:
        components = list(components)
        if weights is None:
            weights = [1 / max(len(components), 1)] * len(components)
        weights = [float(weight) for weight in weights]
        super().__init__(
            _internal.mixture([p._core for p in components], weights), components=components, weights=weights
        )


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
        rows, move = np.asarray(matrix, float), np.asarray(offset, float)
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
