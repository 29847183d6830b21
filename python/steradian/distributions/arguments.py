"""Checks of arguments: one for each kind, and each failure one exception that names argument and value."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]


def number(argument: str, value: object) -> float:
    """A real number, as a float. Raises TypeError that names ``argument``."""
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, bool | np.bool_) or not isinstance(value, int | float | np.integer | np.floating):
        raise TypeError(f"{argument} must be a number, not {short(value)}")
    try:
        return float(value)
    except OverflowError:
        raise ValueError(f"{argument} is {short(value)}, which is too large") from None


def whole(argument: str, value: object, least: int = 1, most: int = (1 << 63) - 1) -> int:
    """A whole number from ``least`` to ``most``. Raises TypeError or ValueError that names ``argument``."""
    if (
        isinstance(value, bool | np.bool_)
        or not isinstance(value, int | float | np.integer | np.floating)
        or not math.isfinite(value)
        or value != int(value)
    ):
        raise TypeError(f"{argument} must be a whole number, not {short(value)}")
    if not least <= int(value) <= most:
        raise ValueError(f"{argument} is {short(value)}; it must be {_range(least, most)}")
    return int(value)


def choice(argument: str, value: object, names: Sequence[str]) -> str:
    """One of several names. Raises TypeError or ValueError that lists them."""
    listed = ", ".join(f'"{name}"' for name in names[:-1]) + f' or "{names[-1]}"'
    if not isinstance(value, str):
        raise TypeError(f"{argument} must be {listed}, not {short(value)}")
    if value not in names:
        shown = f"'{value}'" if argument == "nan" else f'"{value}"'
        raise ValueError(f"{argument} is {shown}; it must be {listed}")
    return value


def array(argument: str, value: ArrayLike) -> Array:
    """Numbers of any shape, as an array of one's own. Raises TypeError or ValueError naming ``argument``."""
    if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
        raise ValueError(f"{argument} is a masked array; fill it first, as by value.filled(numpy.nan)")
    try:
        if np.iscomplexobj(value):
            raise TypeError("complex")
        return np.array(value, float)
    except (TypeError, ValueError, OverflowError):
        raise TypeError(f"{argument} must be real numbers, not {short(value)}") from None


def numbers(argument: str, value: ArrayLike) -> Array:
    """``value`` as (n,) numbers. Raises TypeError or ValueError naming ``argument``."""
    found = array(argument, value)
    if found.ndim != 1:
        raise ValueError(f"{argument} has shape {found.shape}; it must be (n,)")
    return found


def vector(argument: str, value: ArrayLike, size: int = 3) -> list[float]:
    """``value`` as a list of ``size`` numbers. Raises TypeError or ValueError naming ``argument``."""
    found = array(argument, value)
    if found.shape != (size,):
        raise ValueError(f"{argument} has shape {found.shape}; it must be ({size},)")
    return [float(x) for x in found]


def function(argument: str, value: object) -> Any:
    """Something that can be called. Raises TypeError that names ``argument``."""
    if not callable(value):
        raise TypeError(f"{argument} must be a function, not {short(value)}")
    return value


def short(value: object) -> str:
    """A value as it may stand in a line of text."""
    text = repr(value)
    return text if len(text) <= 200 else f"{text[:90]} … {text[-90:]}"


def _range(least: int, most: int) -> str:
    if most == (1 << 63) - 1:
        return "positive" if least == 1 else f"at least {least}"
    power = (most + 1).bit_length() - 1
    end = f"2^{power} - 1" if most + 1 == 1 << power and power > 16 else f"{most}"
    return f"from {least} to {end}"
