"""The tests that users can run on distributions: what is right passes, what is wrong does not."""

from __future__ import annotations

import numpy as np
import pytest

import steradian as sr

LEVEL = 1e-4


class Squares(sr.Distribution):
    """u², with a density that is right only for ``scale`` 1 and ``power`` −½."""

    support = np.array([[0.0, 1.0]])

    def __init__(self, scale=1.0, power=-0.5, said=1.0):
        self.scale, self.power, self.said = scale, power, said

    def sample(self, u):
        x = (1 - u) ** 2
        return sr.Samples(x, self.said * self.pdf(x))

    def pdf(self, x):
        x = np.asarray(x)
        with np.errstate(divide="ignore", invalid="ignore"):
            return np.where((x > 0) & (x <= 1), self.scale * (1 + self.power) * x**self.power, 0.0)

    def cdf(self, x):
        return np.clip(x, 0, 1) ** (1 + self.power)


@pytest.mark.parametrize(
    "over",
    [
        sr.Uniform(2, 3),
        sr.Normal(-1, 1e-3),
        sr.Exponential(5),
        0.3 * sr.Uniform(0, 1) + 0.7 * sr.Tent(0, 2, 3),
        sr.Uniform([0, -1], [1, 1]),
        sr.Normal() * sr.Linear() * sr.Tent() * sr.Exponential(),
        Squares(),
        Squares() * sr.Normal(),
    ],
    ids=lambda over: type(over).__name__,
)
def test_what_is_right_passes(over):
    report = sr.testing.chi2(over)
    assert report.passes(LEVEL), report
    assert report.dof > 100
    assert report.check() is report


@pytest.mark.parametrize(
    ("over", "says"),
    [
        (Squares(scale=1.02), r"p [=<]"),
        (Squares(power=0.0), "worst at"),
        (Squares(said=1.01), "carry a pdf that is not the density there"),
        (Squares(scale=np.nan), "not a positive number"),
        (Squares(power=0.0) * sr.Normal(), r"p [=<]"),
    ],
)
def test_what_is_wrong_does_not(over, says):
    report = sr.testing.chi2(over)
    assert not report.passes(1e-9), report
    with pytest.raises(AssertionError, match=says):
        report.check()


def test_ks_of_cdfs():
    for over in (sr.Uniform(2, 3), sr.Normal(), sr.Power(2, 0, 1), Squares()):
        assert sr.testing.ks(over).passes(LEVEL), over
    assert not sr.testing.ks(Squares(power=-0.45)).passes(LEVEL)


def test_same_seed_same_report():
    assert sr.testing.chi2(sr.Normal(), seed=5) == sr.testing.chi2(sr.Normal(), seed=5)
    assert sr.testing.chi2(sr.Normal(), seed=5) != sr.testing.chi2(sr.Normal(), seed=6)


def test_bad_arguments_are_named():
    with pytest.raises(TypeError, match="over must be a distribution"):
        sr.testing.chi2(3)
    with pytest.raises(ValueError, match="n is 3"):
        sr.testing.chi2(sr.Normal(), n=3)
    with pytest.raises(ValueError, match="cells is 1"):
        sr.testing.chi2(sr.Normal(), cells=1)
    with pytest.raises(ValueError, match="seed is -1"):
        sr.testing.ks(sr.Normal(), seed=-1)
    with pytest.raises(TypeError, match="has no cdf"):
        sr.testing.ks(sr.Uniform([0, 0], [1, 1]))


def test_errors_of_a_distribution_come_through():
    class Broken(Squares):
        def pdf(self, x):
            raise KeyError("pdf")

    with pytest.raises(KeyError, match="pdf"):
        sr.testing.chi2(Broken())
