"""Is a distribution what it says it is? Statistical tests, for those of this library and for your own.

    sr.testing.chi2(p).check()          # raises AssertionError if samples and density disagree
    sr.testing.ks(p).p_value            # on the line, where the cdf is known

A p-value is the probability of samples at least this odd if nothing is wrong. So a test at level 0.001
raises a false alarm once in a thousand runs. Seeds are fixed, so a test that passes goes on passing until
something changes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from steradian import _internal
from steradian.distributions.arguments import whole
from steradian.distributions.base import Distribution, core_of

__all__ = ["LEVEL", "Report", "chi2", "ks"]

LEVEL = 1e-4
"""The level of :meth:`Report.check`, unless another is given."""

MAX_DIM = 200
"""Coordinates of a point that :func:`chi2` takes at most."""


@dataclass(frozen=True)
class Report:
    """What a test found."""

    subject: str
    """What was tested."""
    statistic: float
    """χ², or the D of Kolmogorov and Smirnov."""
    dof: float
    """Degrees of freedom of χ²; the number of samples for Kolmogorov–Smirnov."""
    p_value: float
    """The probability of a statistic at least this large if nothing is wrong; 0 if something certainly is;
    NaN if the samples are no evidence."""
    remark: str
    """What to look at first: the worst cell, or what is certainly wrong."""

    def passes(self, level: float = LEVEL) -> bool:
        """Is there no evidence against it, at this level?"""
        return self.p_value > level

    def check(self, level: float = LEVEL) -> Report:
        """The report itself. Raises AssertionError, which says what is wrong, if it does not pass."""
        if not self.passes(level):
            raise AssertionError(f"{self.subject}: samples and density disagree: {self._finding()}")
        return self

    def _finding(self) -> str:
        if self.p_value == 0 and not np.isfinite(self.statistic):
            return self.remark
        size = "p < 1e-300" if self.p_value < 1e-300 else f"p = {self.p_value:.2g}"
        return f"{size}; {self.remark}"

    def __str__(self) -> str:
        return f"{self.subject}: {self._finding()}"


def chi2(over: Distribution, *, n: int = 1 << 18, cells: int = 512, seed: int = 1) -> Report:
    """Do samples follow their density? Pearson's chi-square test, in up to 200 dimensions.

    >>> import numpy as np, steradian as sr
    >>> sr.testing.chi2(sr.Normal(0, 1)).passes()
    True
    >>> class Wrong(sr.Distribution):
    ...     def sample(self, u):
    ...         return sr.Samples(u**2, np.ones(len(u)))
    ...     def pdf(self, x):
    ...         return np.where((x >= 0) & (x <= 1), 1.0, 0.0)
    >>> sr.testing.chi2(Wrong()).passes()
    False

    - ``over``: on the line, in a box, over directions or indices; built-in, or a subclass of your own.
    - ``n``: samples that are counted. ``cells``: about so many; they hold about equally many samples. In
      each, the density is integrated by points of its own, and the error of that counts as well. In many
      dimensions a cell is cut along some axes only, so that a mistake between others can hide, and if
      coordinates hang together closely few of these points count: then mistakes must be larger to be seen.
      Test the factors of a product as well.
    - ``seed``: of the samples, 0 to 2^64 − 1.

    Certainly wrong, whatever the counts: a density that is negative, infinite or NaN; samples where it is 0;
    samples whose ``pdf`` is not the density there.

    Raises TypeError if ``over`` is no distribution, ValueError if it cannot be tested (surface area, whose
    surface is not known) or an argument makes no sense, and whatever its own methods raise.

    Source: K. Pearson, Phil. Mag. 50 (1900).
    """
    n, seed = _checked(over, n, seed)
    cells = whole("cells", cells, 2, 1 << 20)
    if over.dim > MAX_DIM:
        raise ValueError(
            f"over has {over.dim} coordinates; the test takes up to {MAX_DIM}: test the factors of a product"
        )
    return Report(_name(over), *_internal.chi2(over._core, n, cells, seed))


def ks(over: Distribution, *, n: int = 1 << 16, seed: int = 1) -> Report:
    """Do samples follow the cumulative distribution? Kolmogorov–Smirnov's test, on the line.

    >>> import steradian as sr
    >>> sr.testing.ks(sr.Exponential(2)).passes()
    True

    - ``over``: a distribution that has a ``cdf``. ``n``: samples, at least 10. ``seed``: of the samples.

    Raises TypeError if ``over`` is no distribution or has no ``cdf``, and ValueError if an argument makes no
    sense.

    Source: M. A. Stephens, J. R. Stat. Soc. B 32 (1970), for the p-value.
    """
    n, seed = _checked(over, n, seed)
    cdf = getattr(over, "cdf", None)
    if cdf is None or over.dim != 1:
        raise TypeError(f"{_name(over)} has no cdf; sr.testing.chi2 needs none")
    value, pdf = over.draw(n, seed)
    x = np.sort(value[pdf != 0])
    return Report(_name(over), *_internal.ks(x, np.ascontiguousarray(cdf(x), float)))


def _checked(over: object, n: int, seed: int) -> tuple[int, int]:
    """``n`` and ``seed`` as whole numbers, or an error that names the argument."""
    core_of("over", over)
    return whole("n", n, 10, (1 << 32) - 1), whole("seed", seed, 0, (1 << 64) - 1)


def _name(over: Distribution) -> str:
    return type(over).__name__
