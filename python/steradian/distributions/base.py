"""What every distribution can do, and how to write one's own."""

from __future__ import annotations

import json
from abc import ABC, abstractmethod
from numbers import Real
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from steradian import _internal
from steradian.distributions.arguments import array, choice, short, whole

if TYPE_CHECKING:
    from steradian.distributions.composite import Mixture, Product

_internal.find_numpy()

Array = NDArray[np.float64]

SEQUENCES = ("independent", "stratified", "sobol", "lattice")
"""The kinds of points."""


class Samples(NamedTuple):
    """Points and the densities that they were drawn with."""

    value: Array
    """(n,) if the distribution has one coordinate, (n, dim) otherwise."""
    pdf: Array
    """(n,), positive. 0 where nothing was drawn: that contributes nothing, and the value may be anything."""


class Distribution(ABC):
    """A probability density that can be sampled and evaluated.

    To bring your own, give a subclass ``sample`` and ``pdf`` over NumPy arrays, and, where they differ from
    these, the attributes ``dim``, ``uniforms``, ``space`` and ``support``. It then works wherever the
    built-in ones do.

    >>> import numpy as np, steradian as sr
    >>> class Triangle(sr.Distribution):
    ...     "Density 2x on [0, 1]."
    ...     def sample(self, u):
    ...         return sr.Samples(np.sqrt(u), 2 * np.sqrt(u))
    ...     def pdf(self, x):
    ...         return np.where((x >= 0) & (x <= 1), 2 * x, 0.0)
    >>> print(sr.integrate(lambda x: 3 * x, over=Triangle(), n=1024))
    1.5 ± 0 (n = 1024)
    """

    dim: int = 1
    """Coordinates of a point."""

    uniforms: int = 1
    """Uniforms in [0, 1) that a sample consumes."""

    space: str | None = None
    """What the density is a density of.

    ``"solid angle"``, ``"surface area"``, ``"counting"``, or ``None`` for length, area or volume, by ``dim``.
    """

    @abstractmethod
    def sample(self, u: ArrayLike) -> Samples:
        """Draws a point from each row of uniforms.

        ``u``: (n,) or (n, uniforms), each in [0, 1). Returns points and their densities; see
        :class:`Samples`.
        """

    @abstractmethod
    def pdf(self, x: ArrayLike) -> Array:
        """The density at points, (...,) for one coordinate, (..., dim) otherwise → (...,).

        0 outside the support.
        """

    @property
    def support(self) -> Array:
        """(dim, 2): the least box that holds the support, infinite where it has no end."""
        return np.tile([-np.inf, np.inf], (self.dim, 1))

    @property
    def mean(self) -> float | Array | None:
        """The expected point; ``None`` if it is not known or does not exist."""
        return None

    def draw(self, n: int, seed: int = 0, sequence: str = "independent") -> Samples:
        """``n`` samples from the uniforms of a sequence.

        That is ``"independent"``, ``"stratified"``, ``"sobol"`` or ``"lattice"``.

        >>> import steradian as sr
        >>> sr.Uniform(2, 3).draw(1000).value.mean().round(1)
        np.float64(2.5)
        """
        u = _internal.points(
            choice("sequence", sequence, SEQUENCES),
            self.uniforms,
            whole("n", n),
            whole("seed", seed, 0, (1 << 64) - 1),
            0,
            0,
        )
        return self.sample(u[:, 0] if self.uniforms == 1 else u)

    def to_dict(self) -> dict[str, Any]:
        """What :meth:`from_dict` makes the same distribution of: name and arguments, as JSON can hold them.

        Raises TypeError for distributions that are not made of numbers and other distributions alone.
        """
        raise TypeError(f"{type(self).__name__} is a distribution of your own, which cannot be written down")

    def save(self, path: str | Path) -> None:
        """Writes the distribution to a JSON file.

        >>> import steradian as sr, tempfile, pathlib
        >>> path = pathlib.Path(tempfile.mkdtemp()) / "mixture.json"
        >>> (0.5 * sr.Uniform(0, 1) + 0.5 * sr.Uniform(0, 2)).save(path)
        >>> sr.Distribution.load(path).pdf([0.5, 1.5])
        array([0.75, 0.25])
        """
        Path(path).write_text(json.dumps(self.to_dict()), encoding="utf-8")

    @staticmethod
    def load(path: str | Path) -> Distribution:
        """Reads what :meth:`save` wrote. Raises ValueError that names the file if it is none."""
        try:
            return Distribution.from_dict(json.loads(Path(path).read_text(encoding="utf-8")))
        except (ValueError, TypeError, KeyError, OverflowError, AttributeError, RecursionError) as error:
            raise ValueError(f"{path} holds no distribution: {error}") from None

    @staticmethod
    def from_dict(description: dict[str, Any]) -> Distribution:
        """What :meth:`to_dict` described. Raises ValueError or TypeError if it is no distribution."""
        value = _from_plain(description)
        if not isinstance(value, Distribution):
            raise ValueError('a distribution is an object with its name as "type"')
        return value

    def __mul__(self, other: Distribution | float) -> Product | Mixture:
        """``p * q`` is the product, of independent coordinates; ``p * 0.5`` a part of a mixture."""
        from steradian.distributions.composite import Product, mixed

        if isinstance(other, Distribution):
            return Product([self, other])
        if isinstance(other, Real):
            return mixed([self], [float(other)])
        return NotImplemented

    def __rmul__(self, weight: float) -> Mixture:
        """``0.3 * p``: a part of a mixture, ``0.3 * p + 0.7 * q``."""
        from steradian.distributions.composite import mixed

        if isinstance(weight, Real):
            return mixed([self], [float(weight)])
        return NotImplemented

    @property
    def _core(self) -> _internal.Density:
        """The compiled density that this is."""
        support = [(float(low), float(high)) for low, high in np.asarray(self.support, float).reshape(-1, 2)]
        return _internal.foreign_density(
            self, type(self).__name__, self.space or "", self.dim, self.uniforms, support
        )

    def _sample_rows(self, u: Array) -> tuple[Array, Array]:
        """What compiled code calls: ``sample`` of (n, uniforms), with its result checked."""
        value, pdf = self.sample(u[:, 0] if self.uniforms == 1 else u)
        value = _checked(f"{type(self).__name__}.sample", value, len(u), self.dim)
        return value, _checked(f"the pdf of {type(self).__name__}.sample", pdf, len(u), 1)[:, 0]

    def _pdf_rows(self, x: Array) -> Array:
        """What compiled code calls: ``pdf`` of (n, dim), with its result checked."""
        pdf = self.pdf(x[:, 0] if self.dim == 1 else x)
        return _checked(f"{type(self).__name__}.pdf", pdf, len(x), 1)[:, 0]


class Compiled(Distribution):
    """A distribution that is evaluated by compiled code."""

    def __init__(self, core: _internal.Density, **arguments: Any) -> None:
        self.__core = core
        self._arguments = {name: _owned(value) for name, value in arguments.items()}
        self.dim = core.dim()
        self.uniforms = core.uniforms()
        self.space = core.space()

    @property
    def _core(self) -> _internal.Density:
        return self.__core

    def sample(self, u: ArrayLike) -> Samples:
        """Draws a point from each row of ``u``: (n,) or (n, uniforms), in [0, 1).

        Raises ValueError if a uniform is outside, or the shape is another.
        """
        rows = as_rows("u", u, self.uniforms)
        if not np.all((rows >= 0) & (rows < 1)):
            bad = rows[~((rows >= 0) & (rows < 1))][0]
            raise ValueError(f"u holds {bad}; uniforms are in [0, 1)")
        value, pdf = self._core.sample(rows)
        return Samples(value[:, 0] if self.dim == 1 else value, pdf)

    def pdf(self, x: ArrayLike) -> Array:
        """The density at points, (...,) for one coordinate, (..., dim) otherwise → (...,).

        0 outside the support.
        """
        points = np.asarray(x, float)
        shape = points.shape if self.dim == 1 else points.shape[:-1]
        if self.dim > 1 and (points.ndim == 0 or points.shape[-1] != self.dim):
            raise ValueError(f"x has shape {points.shape}; the last axis must have {self.dim} coordinates")
        return self._core.pdf(points.reshape(-1, self.dim)).reshape(shape)[()]

    def invert(self, x: ArrayLike) -> Array:
        """The uniforms that ``sample`` maps to points, (n,) or (n, dim) → (n,) or (n, uniforms).

        NaN outside the support. Raises TypeError if this distribution cannot be inverted.
        """
        u = self._core.invert(as_rows("x", x, self.dim))
        return u[:, 0] if self.uniforms == 1 else u

    def cdf(self, x: ArrayLike) -> Array:
        """The probability of a value of at most ``x``, any shape. Raises TypeError if that is not known."""
        points = np.asarray(x, float)
        return self._core.cdf(points.reshape(-1)).reshape(points.shape)[()]

    def icdf(self, u: ArrayLike) -> Array:
        """The value below which a share ``u`` in [0, 1] of the probability lies, any shape.

        Raises TypeError if that is not known, ValueError if a share is outside.
        """
        shares = np.asarray(u, float)
        if not np.all((shares >= 0) & (shares <= 1)):
            raise ValueError(
                f"u holds {shares[~((shares >= 0) & (shares <= 1))].flat[0]}; shares are in [0, 1]"
            )
        return self._core.icdf(shares.reshape(-1)).reshape(shares.shape)[()]

    @property
    def support(self) -> Array:
        """(dim, 2): the least box that holds the support, infinite where it has no end."""
        return np.array(self._core.support()).reshape(-1, 2)

    @property
    def mean(self) -> float | Array | None:
        """The expected point; ``None`` if it is not known or does not exist."""
        mean = self._core.mean()
        if mean is None:
            return None
        return mean[0] if self.dim == 1 else np.array(mean)

    def __repr__(self) -> str:
        arguments = ", ".join(f"{name}={_written(value)}" for name, value in self._arguments.items())
        return f"{type(self).__name__}({arguments})"

    def to_dict(self) -> dict[str, Any]:
        """What :meth:`from_dict` makes the same distribution of: name and arguments, as JSON can hold them.

        Raises TypeError if an argument is a function.
        """
        arguments = {name: _to_plain(value) for name, value in self._arguments.items()}
        return {"type": type(self).__name__, **arguments}

    def __reduce__(self) -> tuple[Any, ...]:
        return _remake, (type(self), self._arguments)


def as_distribution(value: object, argument: str = "over") -> Distribution:
    """A distribution from one, or from a list of (low, high) for a box.

    Raises TypeError or ValueError, naming ``argument``, if it is neither.
    """
    from steradian.distributions.line import Uniform

    if isinstance(value, Distribution):
        core_of(argument, value)
        return value
    try:
        box = np.asarray(value, float)
    except (TypeError, ValueError):
        box = np.empty(0)
    if box.shape == (2,):
        box = box.reshape(1, 2)
    if box.ndim == 2 and box.shape[1:] == (2,) and np.isinf(box).any() and not np.isnan(box).any():
        j = int(np.argwhere(np.isinf(box).any(axis=1))[0, 0])
        raise ValueError(
            f"{argument}[{j}] is ({box[j, 0]:g}, {box[j, 1]:g}), and a box must be finite: over an infinite "
            f"range integrate over a distribution that covers it, such as Exponential or Normal"
        )
    if box.ndim != 2 or box.shape[1] != 2 or len(box) == 0:
        raise TypeError(
            f"{argument} must be a distribution, or (low, high) for each dimension, not {value!r}"
        )
    return Uniform(box[:, 0], box[:, 1]) if len(box) > 1 else Uniform(box[0, 0], box[0, 1])


def core_of(argument: str, value: object) -> _internal.Density:
    """The compiled density of a distribution. Raises TypeError naming ``argument`` if it is none."""
    if not isinstance(value, Distribution):
        raise TypeError(f"{argument} must be a distribution, not {short(value)}")
    return value._core


def as_rows(argument: str, value: ArrayLike, width: int) -> Array:
    """``value`` as (n, width) numbers; (n,) will do if ``width`` is 1. Raises ValueError that names it."""
    found = array(argument, value)
    rows = found.reshape(-1, 1) if found.ndim < 2 and width == 1 else found
    if rows.shape == (0,):
        rows = rows.reshape(0, width)
    if rows.ndim != 2 or rows.shape[1] != width:
        wanted = f"(n, {width})" if width > 1 else "(n,)"
        raise ValueError(f"{argument} has shape {found.shape}; it must be {wanted}")
    return rows


def _checked(what: str, value: object, n: int, width: int) -> Array:
    """The result of somebody's method as (n, width) numbers, or a ValueError that says what is wrong."""
    try:
        rows = np.asarray(value, float)
    except (TypeError, ValueError):
        raise TypeError(
            f"{what} returned {type(value).__name__}, which is no array of real numbers"
        ) from None
    found = rows.shape
    if found == (n,) and width == 1:
        rows = rows.reshape(n, 1)
    if rows.shape != (n, width):
        wanted = f"({n}, {width})" if width > 1 else f"({n},)"
        raise ValueError(f"{what} returned shape {found}; it must be {wanted}")
    return rows


def _to_plain(value: Any) -> Any:
    """A value as JSON can hold it."""
    if isinstance(value, Distribution):
        return value.to_dict()
    if isinstance(value, np.ndarray | np.generic):
        return _to_plain(value.tolist())
    if isinstance(value, list | tuple):
        return [_to_plain(item) for item in value]
    if value is None or isinstance(value, bool | int | float | str):
        return value
    raise TypeError(f"{value!r} cannot be written down")


def _from_plain(value: Any) -> Any:
    """What :func:`_to_plain` was given, but for lists instead of arrays."""
    import steradian.distributions as known

    if isinstance(value, list):
        return [_from_plain(item) for item in value]
    if not isinstance(value, dict):
        return value
    name = value.get("type")
    kind = getattr(known, name, None) if isinstance(name, str) and name in known.__all__ else None
    if not (isinstance(kind, type) and issubclass(kind, Compiled)):
        raise ValueError(f"there is no distribution {name!r}")
    return kind(**{key: _from_plain(item) for key, item in value.items() if key != "type"})


def _written(value: object) -> str:
    """A value as it may stand in a line of text."""
    if isinstance(value, np.ndarray):
        return np.array2string(value, threshold=6, separator=", ").replace("\n", "")
    return repr(value)


def _owned(value: Any) -> Any:
    """A value that nobody else can change: arrays and lists are copied."""
    if isinstance(value, np.ndarray):
        copy = value.copy()
        copy.flags.writeable = False
        return copy
    return [_owned(item) for item in value] if isinstance(value, list) else value


def _remake(kind: type[Compiled], arguments: dict[str, Any]) -> Compiled:
    return kind(**arguments)
