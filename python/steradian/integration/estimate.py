"""A mean with an error that can be believed."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from steradian import _internal

Array = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class Estimate:
    """What is known of an integral: ``25.0013 ± 0.0046 (n = 100000)``.

    Numbers for one integral, arrays (m,) for an integrand that returns m values a point. Two are equal if
    their means, errors and numbers of points are, however long they took.

    >>> import steradian as sr
    >>> estimate = sr.integrate(lambda x: 2 * x, over=sr.Uniform(0, 5), n=4096)
    >>> abs(estimate.mean - 25) < 5 * estimate.stderr
    True
    """

    mean: float | Array
    """The estimate."""
    stderr: float | Array
    """Its standard error: of independent samples, or from the spread of independent replicates."""
    n: int
    """Evaluations of the integrand, those included that count as 0."""
    dof: int = 0
    """Degrees of freedom of ``stderr``: what Student's t takes for an interval."""
    seconds: float = 0.0
    """How long it took."""
    nans: int = 0
    """Points where the integrand was infinite or not a number, and counted as 0 (with ``nan="zero"``)."""
    covariance: Array | None = None
    """(m, m), of the means; ``None`` for one integral."""
    diagnostics: dict[str, Any] = field(default_factory=dict)
    """What was noticed: ``effective_n`` (Kish), ``largest_share`` (of a single point), ``not_drawn``, …"""

    @classmethod
    def of(cls, numbers: ArrayLike) -> Estimate:
        """The mean of independent numbers, (n,), and its standard error. Raises ValueError for less than two.

        >>> import steradian as sr
        >>> print(sr.Estimate.of([1, 2, 3, 4, 5]))
        3.00 ± 0.71 (n = 5)
        """
        array = np.asarray(numbers, float)
        if array.ndim != 1 or len(array) < 2:
            raise ValueError(f"numbers has shape {array.shape}; it must be (n,), n at least 2")
        stderr = float(array.std(ddof=1)) / math.sqrt(len(array))
        return cls(mean=float(array.mean()), stderr=stderr, n=len(array), dof=len(array) - 1)

    def interval(self, level: float = 0.95) -> tuple[float | Array, float | Array]:
        """The interval that holds the integral with probability ``level``, by Student's t.

        It is never narrower than what rounding leaves unsure.

        >>> import steradian as sr
        >>> low, high = sr.integrate(lambda x: x * x, over=[(0, 1)], n=4096).interval()
        >>> low < 1 / 3 < high
        True
        """
        if not 0 < level < 1:
            raise ValueError(f"level is {level}; it must be between 0 and 1")
        rounding = 4 * np.finfo(float).eps * np.abs(self.mean)
        half = _internal.student_t(0.5 + 0.5 * level, self.dof) * self.stderr + rounding
        if np.ndim(half) == 0:
            return float(self.mean - half), float(self.mean + half)
        return self.mean - half, self.mean + half

    @property
    def relative_error(self) -> float | Array:
        """The standard error relative to the mean, without its sign."""
        with np.errstate(divide="ignore", invalid="ignore"):
            relative = np.divide(self.stderr, np.abs(self.mean))
        return relative if np.ndim(relative) else float(relative)

    def _key(self) -> tuple[object, ...]:
        parts = (np.ravel(self.mean).tolist(), np.ravel(self.stderr).tolist())
        return (np.shape(self.mean), *map(tuple, parts), self.n, self.dof, self.nans)

    def __eq__(self, other: object) -> bool:
        return self._key() == other._key() if isinstance(other, Estimate) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._key())

    def __float__(self) -> float:
        return float(self.mean)

    def __str__(self) -> str:
        if np.ndim(self.mean) == 0:
            return f"{format_uncertain(float(self.mean), float(self.stderr))} (n = {self.n})"
        both = zip(np.ravel(self.mean), np.ravel(self.stderr), strict=True)
        parts = (format_uncertain(float(mean), float(stderr)) for mean, stderr in both)
        return f"[{', '.join(parts)}] (n = {self.n})"


def format_uncertain(mean: float, stderr: float) -> str:
    """The error with two digits, the mean with as many decimals.

    >>> format_uncertain(25.00132, 0.00463)
    '25.0013 ± 0.0046'
    """
    return _internal.format_uncertain(mean, stderr)
