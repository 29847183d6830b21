"""What makes an integral less sure than it says is noticed, and what cannot be integrated is refused."""

import ctypes
import ctypes.util
import subprocess
import sys
import textwrap
import warnings

import numpy as np
import pytest

import steradian as sr

U = sr.Uniform()
CUBE = [(0.0, 1.0)] * 2


class Claims(sr.Distribution):
    """Uniform on [0, 1], with whatever density it is told to claim."""

    support = np.array([[0.0, 1.0]])

    def __init__(self, sampled=1.0, evaluated=1.0):
        self.sampled, self.evaluated = sampled, evaluated

    def sample(self, u):
        return sr.Samples(u, np.full(len(u), self.sampled))

    def pdf(self, x):
        return np.full(len(x), self.evaluated)


def needle(x):
    return (np.abs(x[:, 0] - 0.5) < 1e-4) * 5e3


def test_nothing_seen_is_no_answer_within_a_tolerance():
    found = sr.integrate(needle, over=CUBE, rtol=0.1)
    assert found.n > 1 << 14 and 0 < found.stderr <= 0.1 * found.mean
    low, high = found.interval(0.9999)
    assert low < 1 < high
    with pytest.warns(sr.IntegrationWarning, match="f was 0 at all 1024 points"):
        assert sr.integrate(lambda x: np.zeros(len(x)), over=U, n=1024).mean == 0
    with pytest.warns(sr.IntegrationWarning, match="f was 0 at all"):
        sr.adapt(lambda x: np.zeros(len(x)), over=U, n=1024)


def test_an_integral_of_zero_ends():
    with pytest.warns(sr.IntegrationWarning, match="the tolerance was not met after 67108864 points"):
        found = sr.integrate(lambda x: x - 0.5, over=U, rtol=1e-3, batch=1 << 20)
    assert abs(found.mean) < 1e-6
    with pytest.raises(ValueError, match="seconds is inf"):
        sr.integrate(lambda x: x, over=U, seconds=float("inf"))


@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf])
def test_densities_of_one_s_own_are_checked(value):
    said = {-1.0: "-1", np.inf: "inf"}.get(value, "NaN")
    wrong = Claims(sampled=value)
    message = rf"the pdf of Claims\.sample is {said} at x = 0\.\d+; it must be finite and not negative"
    for call in (
        lambda: sr.integrate(lambda x: x, over=wrong, n=256),
        lambda: sr.mis_integrate(lambda x: x, [wrong, U], n=256),
        lambda: sr.ris_integrate(lambda x: x, wrong, target=U, n=256),
        lambda: sr.adapt(lambda x: x, over=wrong, n=4096),
        lambda: sr.integrate(lambda x: x[:, 0], over=wrong * U, n=256),
    ):
        with pytest.raises(ValueError, match=message):
            call()
    with pytest.raises(ValueError, match=rf"Claims\.pdf is {said} at x = "):
        sr.mis_integrate(lambda x: x, [Claims(evaluated=value), U], n=256)
    with pytest.raises(AssertionError, match="not a positive number"):
        sr.testing.chi2(wrong).check()


def test_a_density_that_draws_nothing_is_warned_of():
    with pytest.warns(sr.IntegrationWarning, match="the density drew none of 256 points"):
        sr.integrate(lambda x: x, over=Claims(sampled=0.0), n=256)


@pytest.mark.parametrize(
    ("target", "error", "message"),
    [
        (lambda x: x - 0.5, ValueError, r"target is -0\.\d+ at x = 0\.[0-4]"),
        (lambda x: np.where(x > 0.5, np.nan, 1), ValueError, r"target is NaN at x = 0\.[5-9]"),
        (lambda x: np.where(x > 0.5, np.inf, 1), ValueError, r"target is inf at x = 0\.[5-9]"),
        (lambda x: (x > 0.5) * 1.0, sr.SupportError, r"target is 0 at x = 0\.[0-4]\d*, where f is 0"),
        (lambda x: (x > 0.01) * 1.0, sr.SupportError, r"target is 0 at x = 0\.00"),
        (lambda x: np.stack([x, x], axis=1), ValueError, "target must return one number a point"),
    ],
)
def test_targets_are_checked(target, error, message):
    with pytest.raises(error, match=message):
        sr.ris_integrate(lambda x: x, U, target=target)


@pytest.mark.parametrize("scale", [1e-300, 1e-200, 1e-160, 1e150, 1e200, 1.7e308])
def test_units_do_not_matter(scale):
    for run in (sr.integrate, sr.adapt):
        results = [run(lambda x, s=s: s * np.exp(-x), over=U, n=4096) for s in (1.0, scale)]
        one, other = [getattr(result, "estimate", result) for result in results]
        assert other.mean / scale == pytest.approx(one.mean, rel=1e-12)
        assert other.stderr / scale == pytest.approx(one.stderr, rel=1e-3)
        assert other.diagnostics["effective_n"] == pytest.approx(one.diagnostics["effective_n"])


def test_controls_are_checked():
    def run(g, known, **more):
        return sr.integrate(lambda x: x * x, over=U, n=4096, control=(g, known), **more)

    with pytest.raises(ValueError, match=r"control\[0\] returned shape \(\d+, 2\) .* must return \(n,\)"):
        run(lambda x: np.stack([x, x * x], 1), 0.5)
    with pytest.warns(sr.IntegrationWarning, match=r"give control\[0\] an integral of 0\.500"):
        run(lambda x: x, 0.9)
    with pytest.raises(sr.IntegrandError, match=r"control\[0\] returned nan at x = 0\."):
        run(lambda x: np.where(x > 0.5, np.nan, x), 0.5)
    cosine = ctypes.CDLL(ctypes.util.find_library("m")).cos
    cosine.argtypes, cosine.restype = [ctypes.c_double], ctypes.c_double
    with pytest.raises(TypeError, match=r"control\[0\] must be a NumPy function"):
        run(cosine, 0.5)
    with pytest.raises(TypeError, match="target must be a NumPy function"):
        sr.ris_integrate(lambda x: x, U, target=cosine)


def test_holes_between_several_densities_are_found():
    halves = [sr.Uniform(0, 0.4), sr.Uniform(0.6, 1)]
    with pytest.raises(sr.SupportError, match=r"density 0 at x = 0\.[45]"):
        sr.mis_integrate(lambda x: x, halves)
    sr.mis_integrate(lambda x: np.where(np.abs(x - 0.5) < 0.1, 0, x), halves)
    for call in (
        lambda: sr.mis_integrate(lambda x: x, [U, U], domain=(0, 2)),
        lambda: sr.ris_integrate(lambda x: x, U, target=lambda x: x + 1, domain=(0, 2)),
        lambda: sr.adapt(lambda x: x, over=U, domain=(0, 2)),
    ):
        with pytest.raises(sr.SupportError, match=r"density 0 at x = 1\."):
            call()


def test_every_density_gets_two_independent_points():
    found = sr.mis_integrate(lambda x: x, [sr.Normal(), U, U], n=2, sequence="independent")
    assert found.n == 6 and found.stderr > 0


def test_masked_numbers_are_none():
    def masked(x):
        return np.ma.masked_where(x > 0.5, x)

    with pytest.raises(sr.IntegrandError, match="f returned NaN at x = 0"):
        sr.integrate(masked, over=U)
    with pytest.raises(ValueError, match="counts is a masked array"):
        sr.PiecewiseConstant([0, 1, 2], np.ma.array([1, 2], mask=[0, 1]))


HEAVY = [
    (lambda x: 1 / x, U),
    (lambda x: 1 / (1 + x * x), sr.Normal()),
    (lambda x: np.exp(-x * x / 8), sr.Normal()),
    (lambda x: x**-0.7, U),
]
HARMLESS = [
    (lambda x: x**-0.1, U),
    (np.log, U),
    (lambda x: np.cos(200 * x) * x, U),
    (lambda x: x**4 * np.exp(-x * x / 2), sr.Normal(0, 1.2)),
    (lambda x: 4.0 * ((x**2).sum(axis=1) < 1), CUBE),
    (lambda x: np.prod(x + 0.5, axis=1), [(0, 1)] * 8),
]


@pytest.mark.parametrize("sequence", ["sobol", "independent"])
def test_heavy_tails_are_warned_of(sequence):
    for f, over in HEAVY:
        noticed = 0
        for seed in range(20):
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                sr.integrate(f, over=over, n=1 << 14, seed=seed, sequence=sequence)
            noticed += any(warning.category is sr.IntegrationWarning for warning in caught)
        assert noticed >= 17
    for f, over in HARMLESS:
        for seed in range(20):
            sr.integrate(f, over=over, n=1 << 14, seed=seed, sequence=sequence)


@pytest.mark.parametrize("after", [0.0, 0.3])
def test_ctrl_c_is_answered(after):
    """In a process of its own, whose first array is made while the signal waits."""
    code = f"""
        import os, signal, threading, time
        import steradian as sr
        sr.testing  # imports NumPy, which answers a signal by an ImportError of its own
        def interrupt():
            time.sleep({after})
            os.kill(os.getpid(), signal.SIGINT)
        threading.Thread(target=interrupt).start()
        try:
            sr.testing.chi2(sr.Product([sr.Normal()] * 50), n=1 << 22)
        except KeyboardInterrupt:
            print("interrupted")
    """
    done = subprocess.run(
        [sys.executable, "-c", textwrap.dedent(code)], capture_output=True, text=True, timeout=60
    )
    assert done.stdout.strip() == "interrupted", done.stderr
