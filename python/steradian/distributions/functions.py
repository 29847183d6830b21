"""Functions that users bring, called with arrays of points."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def evaluate(name: str, f: Callable[[Array], Any], x: Array) -> Array:
    """``f(x)`` as float64 numbers of any shape; where it is masked, NaN.

    Raises whatever ``f`` raises, with advice if it takes single points only, and TypeError that names it if
    it returns no real numbers.
    """
    try:
        result = f(x)
    except (TypeError, ValueError) as error:
        if _takes_points(f, x):
            error.add_note(
                f"{name} is called with arrays of points: use numpy's functions instead of math's, "
                f"numpy.where instead of if, or wrap it in numpy.vectorize"
            )
        raise
    try:
        if np.iscomplexobj(result):
            raise TypeError("complex numbers are integrated as their real and imaginary parts, (n, 2)")
        if isinstance(result, np.ma.MaskedArray):
            return np.ma.filled(np.ma.asarray(result, dtype=np.float64), np.nan)
        return np.asarray(result, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise TypeError(
            f"{name} returned {type(result).__name__}, which is no array of real numbers: {error}"
        ) from None


def _takes_points(f: Callable[[Any], Any], x: Array) -> bool:
    """Does ``f`` work with a single point?"""
    try:
        return np.ndim(f(float(x[0]) if x.ndim == 1 else x[0])) == 0
    except Exception:  # whatever it is, it is no advice
        return False
