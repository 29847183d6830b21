"""Integrands of every kind, as compiled code wants them."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from steradian import _internal
from steradian.distributions.functions import evaluate as call

Array = NDArray[np.float64]

Integrand = Callable[[Array], Any]
"""From points, (n,) for one coordinate and (n, dim) otherwise, to (n,) or (n, m); or a native function."""

SIGNATURES = """\
    double f(double x)                              one dimension
    double f(const double *x, int64_t dim)          a point
    double f(int dim, double *x)                    a point, as scipy.LowLevelCallable
    double f(int dim, double *x, void *user_data)   the same with data
    void f(const double *x, int64_t n, int64_t dim, double *out)
                                                    n points; coordinate j of point i is x[j * n + i]"""

_FUNCTION: Any = ctypes.CFUNCTYPE(None).__mro__[1]
"""What all of ctypes' functions are."""


def prepare(f: object, dim: int, name: str = "f") -> Callable[[Array], Array] | _internal.Native:
    """What compiled code calls for ``f``: a native function, or one from (n, dim) to (n,) or (n, m), checked.

    Raises TypeError, naming ``name``, if ``f`` is neither callable nor a native function of a known
    signature.
    """
    native = _native(f, dim, name)
    if native is not None:
        return native
    if not callable(f):
        raise TypeError(f"{name} must be callable, or a native function, not {f!r}")
    return checked(f, dim, name)


def refuse_native(name: str, f: object) -> None:
    """Raises TypeError if ``f`` is a native function, where only NumPy functions will do."""
    is_native = isinstance(f, _FUNCTION) or isinstance(getattr(f, "ctypes", None), _FUNCTION)
    if is_native or type(f).__name__ == "LowLevelCallable":
        raise TypeError(f"{name} must be a NumPy function; native ones are for f alone")


def checked(f: Callable[[Array], Any], dim: int, name: str) -> Callable[[Array], Array]:
    """``f`` over points (n, dim), or (n,) if ``dim`` is 1, with its result as float64, or a clear error."""

    def evaluate(x: Array) -> Array:
        n = len(x)
        values = call(name, f, x[:, 0] if dim == 1 else x)
        if values.ndim not in (1, 2) or len(values) != n or (values.ndim == 2 and values.shape[1] == 0):
            points = "(n,)" if dim == 1 else f"(n, {dim})"
            raise ValueError(
                f"{name} returned shape {values.shape} for {n} points; from points of shape {points} it must "
                f"return (n,), or (n, m) for m integrals"
            )
        return values

    return evaluate


def _native(f: object, dim: int, name: str) -> _internal.Native | None:
    """A compiled function, if it is one."""
    inner = getattr(f, "ctypes", None)
    if hasattr(f, "address") and isinstance(inner, _FUNCTION):  # Numba's
        return _native(inner, dim, name)
    if isinstance(f, _FUNCTION):
        address = ctypes.cast(f, ctypes.c_void_p).value or 0
        if not f.argtypes:
            raise TypeError(
                f"{name} is a ctypes function without argtypes; set these and restype to one of\n{SIGNATURES}"
            )
        types = [_ctypes_name(a) for a in f.argtypes]
        return _internal.Native(address, _call(types, _ctypes_name(f.restype), dim, name), 0, f)
    if type(f).__name__ == "LowLevelCallable" and hasattr(f, "signature"):
        return _low_level_callable(f, dim, name)
    return None


def _low_level_callable(f: Any, dim: int, name: str) -> _internal.Native:
    """SciPy's wrapper of a C function with a pointer to data."""
    inner = _native(f.function, dim, name) if not isinstance(f.function, str) else None
    if inner is None:
        raise TypeError(
            f"{name} is a LowLevelCallable that is made neither of a ctypes nor of a Numba function"
        )
    data = ctypes.cast(f.user_data, ctypes.c_void_p).value if f.user_data is not None else 0
    return inner.with_data(data or 0)


def _ctypes_name(kind: Any) -> str:
    """A C type, as Numba would write it."""
    if kind is None:
        return "none"
    if kind is ctypes.c_double:
        return "float64"
    if kind is ctypes.c_void_p:
        return "void*"
    if isinstance(kind, type) and issubclass(kind, ctypes._Pointer) and kind._type_ is ctypes.c_double:
        return "float64*"
    if kind in (ctypes.c_int8, ctypes.c_int16, ctypes.c_int32, ctypes.c_int64, ctypes.c_longlong):
        return f"int{8 * ctypes.sizeof(kind)}"
    return {ctypes.c_float: "float32", ctypes.c_bool: "bool"}.get(kind, getattr(kind, "__name__", str(kind)))


def _call(arguments: list[str], result: str, dim: int, name: str) -> str:
    """Which call these types ask for. Raises TypeError that lists those there are."""
    short = {
        "CPointer(float64)": "float64*",
        "CPointer(void)": "void*",
        "voidptr": "void*",
        "CPointer(none)": "void*",
    }
    types = [short.get(argument, argument) for argument in arguments]
    known = {
        ("float64",): "number",
        ("float64*", "int64"): "point",
        ("int32", "float64*"): "dim_point",
        ("int32", "float64*", "void*"): "dim_point_data",
        ("float64*", "int64", "int64", "float64*"): "block",
    }
    call = known.get(tuple(types))
    if call is None or (result != "float64") != (call == "block"):
        raise TypeError(
            f"{name} is a native function {result}({', '.join(types)}); it must be one of\n{SIGNATURES}"
        )
    if call == "number" and dim != 1:
        raise TypeError(
            f"{name} takes one number, and points have {dim} coordinates; it must be one of\n{SIGNATURES}"
        )
    return call
