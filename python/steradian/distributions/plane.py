"""Distributions in the plane."""

from __future__ import annotations

from steradian import _internal
from steradian.distributions.arguments import number
from steradian.distributions.base import Compiled


class Disk(Compiled):
    """Every point of the disk about the origin equally likely: p = 1 / (π radius²).

    By the concentric map (Shirley & Chiu 1997), so that neighbouring uniforms give neighbouring points.
    Raises ValueError if ``radius`` is not positive and finite.

    >>> import numpy as np, steradian as sr
    >>> float((sr.Disk(2).pdf([[0, 1.5], [2, 2]]) * np.pi)[0].round(12))
    0.25
    """

    def __init__(self, radius: float = 1.0) -> None:
        super().__init__(_internal.disk(number("radius", radius)), radius=radius)
