"""Integrals from Python: answers, errors, and what becomes of bad input."""

import ctypes
import ctypes.util
import math
import threading

import numpy as np
import pytest

import steradian as sr

CUBE = [(0.0, 1.0)] * 3


def within(estimate, exact, level=0.9999):
    low, high = estimate.interval(level)
    return low <= exact <= high


@pytest.mark.parametrize("sequence", ["independent", "stratified", "sobol", "lattice"])
def test_the_article_s_first_integral(sequence):
    estimate = sr.integrate(lambda x: 2 * x, over=sr.Uniform(0, 5), sequence=sequence, n=20_000, seed=4)
    assert within(estimate, 25)
    assert abs(float(estimate) - 25) < 0.5
    assert estimate.n >= 20_000
    assert str(estimate).endswith(f"(n = {estimate.n})")


def test_a_perfect_density_leaves_rounding():
    estimate = sr.integrate(lambda x: 2 * x, over=sr.Linear(0, 5), n=1000)
    assert estimate.mean == pytest.approx(25, rel=1e-13)
    assert estimate.stderr < 1e-12


def test_points_are_columns():
    seen = []

    def f(x):
        seen.append(x)
        return x[:, 0]

    sr.integrate(f, over=CUBE, n=5000)
    assert all(x.shape[1] == 3 and x.flags.f_contiguous for x in seen)
    assert sum(len(x) for x in seen) == 5024  # 32 replicates of 157


def test_several_integrals_at_once_have_a_covariance():
    estimate = sr.integrate(
        lambda x: np.stack([x, x**2, 1 - x], axis=1), over=sr.Uniform(), n=4096, sequence="independent"
    )
    assert estimate.mean.shape == estimate.stderr.shape == (3,)
    assert estimate.covariance.shape == (3, 3)
    assert np.allclose(np.sqrt(np.diag(estimate.covariance)), estimate.stderr)
    correlation = estimate.covariance[0, 2] / estimate.stderr[0] / estimate.stderr[2]
    assert correlation == pytest.approx(-1)
    low, high = estimate.interval(0.9999)
    assert np.all((low < [1 / 2, 1 / 3, 1 / 2]) & (high > [1 / 2, 1 / 3, 1 / 2]))


def test_the_same_call_gives_the_same_bits():
    def run(**more):
        e = sr.integrate(lambda x: np.exp(x.sum(axis=1)), over=CUBE, n=50_000, seed=7, **more)
        return e.mean, e.stderr

    assert run() == run(threads=1) == run(threads=3)
    assert run() != run(sequence="lattice")
    assert (
        sr.integrate(lambda x: x, over=sr.Uniform(), n=64, seed=1).mean
        != sr.integrate(lambda x: x, over=sr.Uniform(), n=64, seed=2).mean
    )


def test_limits():
    def f(x):
        return np.exp(-x.sum(axis=1))

    loose = sr.integrate(f, over=CUBE, rtol=1e-3, sequence="independent")
    tight = sr.integrate(f, over=CUBE, rtol=1e-4, sequence="independent")
    assert loose.relative_error <= 1e-3 < 0.1 and tight.relative_error <= 1e-4
    assert tight.n > 10 * loose.n
    assert sr.integrate(f, over=CUBE, atol=1e-3).stderr <= 1e-3
    assert sr.integrate(f, over=CUBE, seconds=0.05).seconds < 2
    assert sr.integrate(f, over=CUBE, rtol=1e-12, n=4096).n == 4096


def test_progress_is_told_and_may_stop():
    told = []
    sr.integrate(lambda x: x, over=sr.Uniform(), n=1 << 18, on_progress=told.append)
    assert [p.n for p in told] == sorted(p.n for p in told) and told[-1].n == told[-1].n_max == 1 << 18

    class EnoughError(Exception):
        pass

    def stop(progress):
        raise EnoughError

    with pytest.raises(EnoughError):
        sr.integrate(lambda x: x, over=sr.Uniform(), n=1 << 18, on_progress=stop)


def test_a_control_variate_removes_what_it_explains():
    def f(x):
        return np.exp(x)

    plain = sr.integrate(f, over=sr.Uniform(), n=4096, sequence="independent")
    helped = sr.integrate(f, over=sr.Uniform(), n=4096, sequence="independent", control=(lambda x: x, 0.5))
    assert helped.stderr < 0.2 * plain.stderr
    assert within(helped, math.e - 1)
    both = sr.integrate(
        f,
        over=sr.Uniform(),
        n=4096,
        sequence="independent",
        control=[(lambda x: x, 0.5), (lambda x: x**2, 1 / 3)],
    )
    assert both.stderr < 0.2 * helped.stderr and within(both, math.e - 1)


def test_multiple_importance_sampling_beats_its_parts():
    def f(x):
        return np.exp(-2000 * (x - 0.3) ** 2) + 0.01 * x

    exact = math.sqrt(math.pi / 2000) + 0.005
    parts = [sr.Uniform(), sr.Truncated(sr.Normal(0.3, 0.02), 0, 1)]
    alone = sr.integrate(f, over=parts[0], n=8192, sequence="independent")
    for heuristic in ["balance", "power", "cutoff", "maximum"]:
        combined = sr.mis_integrate(f, parts, heuristic=heuristic, n=8192, sequence="independent")
        assert within(combined, exact) and combined.stderr < 0.5 * alone.stderr
    assert within(sr.mis_integrate(f, parts, counts=[1, 3], n=8192), exact)
    mixture = sr.integrate(f, over=0.5 * parts[0] + 0.5 * parts[1], n=8192)
    assert within(mixture, exact)


def test_resampling_approaches_its_target():
    def f(x):
        return np.exp(-200 * (x - 0.3) ** 2) * (2 + np.sin(60 * x))

    exact = sr.integrate(f, over=sr.Uniform(), n=1 << 16, sequence="lattice").mean

    def target(x):
        return np.exp(-200 * (x - 0.3) ** 2) + 1e-4

    errors = []
    for candidates in [1, 8, 64]:
        estimate = sr.ris_integrate(
            f, over=sr.Uniform(), target=target, candidates=candidates, n=4096, sequence="independent"
        )
        assert within(estimate, exact)
        errors.append(estimate.stderr)
    assert errors[0] > 2 * errors[1] > 2 * errors[2]


class Ramp(sr.Distribution):
    """Density 2x on [0, 1], in Python."""

    support = np.array([[0.0, 1.0]])

    def sample(self, u):
        return sr.Samples(np.sqrt(u), 2 * np.sqrt(u))

    def pdf(self, x):
        return np.where((x >= 0) & (x <= 1), 2 * x, 0.0)


def test_a_distribution_of_one_s_own_works_like_any_other():
    assert within(sr.integrate(lambda x: x**2, over=Ramp(), n=8192), 1 / 3)
    assert within(sr.integrate(lambda x: x**2, over=0.5 * Ramp() + 0.5 * sr.Uniform(), n=8192), 1 / 3)
    assert within(sr.mis_integrate(lambda x: x**2, [Ramp(), sr.Uniform()], n=8192), 1 / 3)
    product = Ramp() * sr.Uniform(0, 2)
    assert within(sr.integrate(lambda x: x[:, 0] * x[:, 1], over=product, n=8192), 1.0)


def test_errors_of_one_s_own_distribution_are_clear():
    class Short(Ramp):
        def sample(self, u):
            return sr.Samples(np.sqrt(u)[:-1], 2 * np.sqrt(u))

    with pytest.raises(ValueError, match=r"Short\.sample returned shape"):
        sr.integrate(lambda x: x, over=Short(), n=1024)

    class Angry(Ramp):
        def sample(self, u):
            raise RuntimeError("no")

    with pytest.raises(RuntimeError, match=r"^no$"):
        sr.integrate(lambda x: x, over=Angry(), n=1024)


def test_native_functions_agree_with_numpy():
    library = ctypes.CDLL(ctypes.util.find_library("m"))
    cosine = library.cos
    cosine.argtypes, cosine.restype = [ctypes.c_double], ctypes.c_double
    native = sr.integrate(cosine, over=sr.Uniform(0, 1), n=1 << 16)
    numpy = sr.integrate(np.cos, over=sr.Uniform(0, 1), n=1 << 16)
    assert native.mean == pytest.approx(numpy.mean, rel=1e-13)
    with pytest.raises(TypeError, match="f takes one number, and points have 3 coordinates"):
        sr.integrate(cosine, over=CUBE)
    untyped = library.sin
    with pytest.raises(TypeError, match="without argtypes"):
        sr.integrate(untyped, over=sr.Uniform())


def test_callbacks_of_every_signature():
    pointer = ctypes.POINTER(ctypes.c_double)

    @ctypes.CFUNCTYPE(ctypes.c_double, pointer, ctypes.c_int64)
    def point(x, dim):
        return sum(x[j] for j in range(dim))

    @ctypes.CFUNCTYPE(ctypes.c_double, ctypes.c_int, pointer)
    def dim_point(dim, x):
        return sum(x[j] for j in range(dim))

    @ctypes.CFUNCTYPE(None, pointer, ctypes.c_int64, ctypes.c_int64, pointer)
    def block(x, n, dim, out):
        for i in range(n):
            out[i] = sum(x[j * n + i] for j in range(dim))

    expected = sr.integrate(lambda x: x.sum(axis=1), over=CUBE, n=2048)
    for f in [point, dim_point, block]:
        assert sr.integrate(f, over=CUBE, n=2048).mean == pytest.approx(expected.mean, rel=1e-12)


def test_nan_and_infinity_name_the_point():
    with pytest.raises(
        sr.IntegrandError, match=r"f returned NaN at x = 0\.[0-4]\d*, and at 2047 others of 4096"
    ) as caught:
        sr.integrate(lambda x: np.where(x < 0.5, np.nan, 1.0), over=sr.Uniform(), n=4096)
    assert caught.value.x[0] < 0.5 and math.isnan(caught.value.value) and caught.value.count == 2048
    with pytest.raises(sr.IntegrandError, match=r"f returned inf at x = \["):
        sr.integrate(lambda x: np.where(x[:, 0] < 0.5, np.inf, 1.0), over=CUBE)
    with pytest.warns(sr.IntegrationWarning, match="not finite at 2048 of 4096 points"):
        estimate = sr.integrate(
            lambda x: np.where(x < 0.5, np.nan, 1.0), over=sr.Uniform(), n=4096, nan="zero"
        )
    assert estimate.nans == 2048 and estimate.mean == pytest.approx(0.5)


def test_a_hole_in_the_support_is_found():
    holed = sr.PiecewiseConstant([0, 1, 2, 3], [5, 0, 3])
    with pytest.raises(sr.SupportError, match=r"density 0 at x = 1\.\d+, where f is") as caught:
        sr.integrate(lambda x: x, over=holed)
    assert 1 < caught.value.x[0] < 2 and caught.value.value == pytest.approx(caught.value.x[0])
    sr.integrate(lambda x: np.where((x >= 1) & (x <= 2), 0, x), over=holed)
    with pytest.raises(sr.SupportError):
        sr.integrate(lambda x: x, over=sr.Uniform(0, 1), domain=(0, 2))


def test_a_single_point_that_decides_is_warned_of():
    with pytest.warns(sr.IntegrationWarning, match="a single one of"):
        sr.integrate(lambda x: np.exp(-2e4 * ((x - 0.5) ** 2).sum(axis=1)), over=CUBE, n=1024)


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: sr.integrate(lambda x: x[:-1], over=CUBE), ValueError, r"f returned shape \(\d+, 3\) for"),
        (lambda: sr.integrate(lambda x: 1.0, over=CUBE), ValueError, r"f returned shape \(\) for"),
        (lambda: sr.integrate(lambda x: ["a"] * len(x), over=CUBE), TypeError, "f returned list"),
        (lambda: sr.integrate(lambda x: x[:, 0] + 1j, over=CUBE), TypeError, "f returned ndarray"),
        (lambda: sr.integrate(3, over=CUBE), TypeError, "f must be callable"),
        (lambda: sr.integrate(np.cos, over=3), TypeError, "over must be a distribution"),
        (lambda: sr.integrate(np.cos, over=[(0, 0)]), ValueError, r"\[low, high\]"),
        (lambda: sr.integrate(np.cos, over=[(0, math.inf)]), ValueError, "inf"),
        (lambda: sr.integrate(np.cos, over=[(0, math.nan)]), ValueError, "NaN"),
        (lambda: sr.integrate(np.cos, over=sr.Uniform(), n=0), ValueError, "n is 0"),
        (lambda: sr.integrate(np.cos, over=sr.Uniform(), n=2.5), TypeError, "n must be a whole number"),
        (lambda: sr.integrate(np.cos, over=sr.Uniform(), rtol=-1), ValueError, "rtol is -1"),
        (lambda: sr.integrate(np.cos, over=sr.Uniform(), seconds=0), ValueError, "seconds is 0"),
        (lambda: sr.integrate(np.cos, over=sr.Uniform(), sequence="halton"), ValueError, '"halton"'),
        (lambda: sr.integrate(np.cos, over=sr.Uniform(), replicates=1), ValueError, "replicates is 1"),
        (lambda: sr.integrate(np.cos, over=sr.Uniform(), seed=-1), ValueError, "seed is -1"),
        (lambda: sr.integrate(np.cos, over=sr.Uniform(), nan="skip"), ValueError, "nan is 'skip'"),
        (lambda: sr.integrate(np.cos, over=sr.Uniform(), control=3), TypeError, "control must be"),
        (
            lambda: sr.integrate(np.cos, over=sr.Uniform(), control=(np.sin, math.nan)),
            ValueError,
            "control 0 is NaN",
        ),
        (lambda: sr.integrate(np.cos, over=sr.Uniform(), domain=[(1, 0)]), ValueError, r"domain\[0\] is \(1"),
        (lambda: sr.integrate(np.cos, over=0.3 * sr.Uniform()), ValueError, "sum to 0.3"),
        (lambda: sr.mis_integrate(np.cos, []), ValueError, "over is empty"),
        (lambda: sr.mis_integrate(np.cos, [sr.Uniform(), 3]), TypeError, r"over\[1\] must be"),
        (lambda: sr.mis_integrate(np.cos, [sr.Uniform()], counts=[1, 2]), ValueError, "counts has 2"),
        (lambda: sr.mis_integrate(np.cos, [sr.Uniform()], counts=[0]), ValueError, r"counts\[0\] is 0"),
        (lambda: sr.mis_integrate(np.cos, [sr.Uniform()], heuristic="best"), ValueError, '"best"'),
        (
            lambda: sr.mis_integrate(np.cos, [sr.Uniform(), sr.Uniform([0, 0], [1, 1])]),
            ValueError,
            "density 1",
        ),
        (lambda: sr.ris_integrate(np.cos, sr.Uniform(), np.cos, candidates=0), ValueError, "candidates is 0"),
        (lambda: sr.ris_integrate(np.cos, sr.Uniform(), 3), TypeError, "target must be"),
    ],
)
def test_bad_input_is_one_clear_error(call, error, message):
    with pytest.raises(error, match=message):
        call()


def test_scalar_functions_get_advice():
    with pytest.raises(TypeError) as caught:
        sr.integrate(lambda x: math.exp(x), over=sr.Uniform())
    assert any("numpy.vectorize" in note for note in caught.value.__notes__)


def test_integrals_run_in_threads():
    results = []

    def work():
        results.append(sr.integrate(lambda x: x**2, over=sr.Uniform(), n=1 << 16).mean)

    threads = [threading.Thread(target=work) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert len(set(results)) == 1 and len(results) == 4
