"""Distributions from Python: shapes, agreement of their methods, and what becomes of bad parameters."""

import pickle

import numpy as np
import pytest

import steradian as sr

INF, NAN = float("inf"), float("nan")
LIGHT = ((-1, -1, 1), (2, 0, 0), (0, 2, 0))

DISTRIBUTIONS = [
    sr.Uniform(2, 3),
    sr.Uniform([0, 0, 0], [1, 2, 3]),
    sr.Linear(0, 5),
    sr.Tent(-1, 0.5, 1),
    sr.Exponential(2),
    sr.Normal(1, 2),
    sr.Truncated(sr.Normal(), 8, 9),
    sr.Truncated(sr.Exponential(), 1, INF),
    sr.Power(-0.5, 0, 4),
    sr.PiecewiseConstant([0, 1, 3, 4], [1, 0, 3]),
    sr.PiecewiseLinear([0, 1, 4], [1, 2, 0]),
    sr.FromPdf(np.sin, 0, np.pi),
    sr.Tabulated2D([[1, 2], [3, 0]], (-1, 0), (1, 5)),
    sr.Discrete([1, 0, 3]),
    sr.Alias([1, 0, 3]),
    sr.Disk(2),
    sr.UniformSphere(),
    sr.UniformHemisphere(),
    sr.CosineHemisphere((1, 1, 0)),
    sr.Cone((0, -2, 0), 0.3),
    sr.SphericalTriangle((1, 0, 0), (0, 1, 0), (0, 0, 1)),
    sr.SphericalRectangle(*LIGHT),
    sr.VonMisesFisher((0, 0, 1), 1e6),
    sr.VisibleNormals((0.6, 0, 0.8), (0.1, 0.5)),
    sr.AreaLight(*LIGHT, seen_from=(0.1, 0.2, 0.3)),
    sr.Product([sr.Normal(), sr.Disk(), sr.Linear()]),
    0.3 * sr.Normal() + 0.7 * sr.Uniform(-1, 5),
    sr.Affine(sr.Disk(), [[1, 2], [0, 1]], [5, 6]),
]


def name(distribution):
    return type(distribution).__name__


@pytest.mark.parametrize("p", DISTRIBUTIONS, ids=name)
def test_methods_agree_with_one_another(p):
    n = 1000
    u = np.random.default_rng(1).random((n, p.uniforms) if p.uniforms > 1 else n)
    value, pdf = p.sample(u)
    assert value.shape == ((n, p.dim) if p.dim > 1 else (n,))
    assert pdf.shape == (n,)
    assert np.all(pdf > 0)
    assert np.allclose(p.pdf(value), pdf, rtol=1e-5)
    rows = value.reshape(n, -1)
    assert np.all((rows >= p.support[:, 0]) & (rows <= p.support[:, 1]))
    # Any leading shape.
    folded = value.reshape((10, 100, p.dim) if p.dim > 1 else (10, 100))
    assert np.array_equal(p.pdf(folded), p.pdf(value).reshape(10, 100))
    if p.mean is not None:
        error = np.std(rows, axis=0) / np.sqrt(n)
        assert np.all(np.abs(rows.mean(axis=0) - np.atleast_1d(p.mean)) < 5 * error + 1e-12)


@pytest.mark.parametrize("p", DISTRIBUTIONS, ids=name)
def test_samples_can_be_run_backwards(p):
    u = np.random.default_rng(2).random((1000, p.uniforms) if p.uniforms > 1 else 1000)
    value = p.sample(u).value
    if name(p) in ("Mixture", "Alias"):
        with pytest.raises(TypeError, match="cannot be inverted"):
            p.invert(value)
        return
    back = p.invert(value)
    assert back.shape == u.shape
    if isinstance(p, sr.Discrete):
        assert np.array_equal(p.sample(back).value, value)
    else:
        single = isinstance(p, (sr.SphericalTriangle, sr.SphericalRectangle))
        assert np.allclose(back, u, atol=1e-3 if single else 1e-7)


@pytest.mark.parametrize("p", [p for p in DISTRIBUTIONS if p.dim == 1], ids=name)
def test_distribution_functions(p):
    value = p.draw(1000, seed=3).value
    if isinstance(p, sr.Alias):
        with pytest.raises(TypeError, match="not known"):
            p.cdf(value)
        return
    assert np.allclose(p.icdf(p.cdf(value)), value, rtol=1e-9)
    assert np.all(np.diff(p.cdf(np.sort(value))) >= 0)
    assert p.icdf(0.0) == p.support[0, 0] and p.icdf(1.0) == p.support[0, 1]
    with pytest.raises(ValueError, match=r"u holds 1.5"):
        p.icdf([0.5, 1.5])


def test_there_is_no_distribution_function_of_directions():
    with pytest.raises(TypeError, match="not known"):
        sr.UniformSphere().cdf([0.5])


@pytest.mark.parametrize("p", DISTRIBUTIONS, ids=name)
def test_distributions_are_written_to_pickles(p):
    u = np.full((3, p.uniforms), 0.3)
    assert repr(p).startswith(name(p) + "(")
    again = pickle.loads(pickle.dumps(p))
    assert np.array_equal(again.sample(u).value, p.sample(u).value)


def test_the_article_s_histogram():
    rng = np.random.default_rng(5)
    data = rng.gamma(2.0, 1.0, 10_000)
    counts, edges = np.histogram(data, bins=[0, 0.5, 1, 2, 4, 8, 20])
    p = sr.PiecewiseConstant(edges, counts)
    assert np.allclose(p.pdf((edges[1:] + edges[:-1]) / 2), np.histogram(data, edges, density=True)[0])
    assert np.allclose(p.cdf(edges), np.append(0, np.cumsum(counts) / counts.sum()))
    landed, _ = np.histogram(p.draw(2**16, sequence="sobol").value, edges)
    assert np.allclose(landed / 2**16, counts / counts.sum(), atol=1e-3)


def test_what_a_function_says_is_followed():
    p = sr.FromPdf(lambda x: np.where(x < 0.3, 2.0, np.exp(-x)), 0, 5, tolerance=1e-8)
    exact = 0.6 + np.exp(-0.3) - np.exp(-5)
    assert p.integral == pytest.approx(exact, rel=1e-7)
    assert p.error < 1e-8
    assert p.pdf([0.1, 1.0, 6.0]) == pytest.approx([2 / exact, np.exp(-1) / exact, 0], rel=1e-6)

    def fails(x):
        raise KeyError("mine")

    with pytest.raises(KeyError, match="mine"):
        sr.FromPdf(fails, 0, 1)


def test_irradiance_of_an_area_light():
    # A square of side 2 at a distance of 1, facing the receiver: Lambert's formula by four equal corners.
    light = sr.AreaLight(*LIGHT)
    estimate = sr.integrate(lambda w: w[:, 2], over=light, n=2**14)
    side = 1 / np.sqrt(2)
    exact = 4 * side * np.arctan(side)
    low, high = estimate.interval(0.9999)
    assert low < exact < high


BAD = [
    (lambda: sr.Uniform(1, 1), r"\[low, high\] = \[1, 1\]"),
    (lambda: sr.Uniform(0, INF), "inf"),
    (lambda: sr.Uniform([0, 2], [1, 2]), r"\[low, high\]\[1\] = \[2, 2\]"),
    (lambda: sr.Linear(0, 1, -1, 1), "at_low is -1"),
    (lambda: sr.Tent(0, 3, 1), "peak is 3"),
    (lambda: sr.Exponential(0), "rate is 0"),
    (lambda: sr.Normal(0, -1), "sd is -1"),
    (lambda: sr.Normal(NAN, 1), "mean is NaN"),
    (lambda: sr.Truncated(sr.Uniform(), 2, 3), r"\[low, high\] = \[2, 3\] holds nothing"),
    (lambda: sr.Truncated(sr.Normal(), 3, 3), r"\[3, 3\]"),
    (lambda: sr.Truncated(sr.Disk(), 0, 1), "area in the plane"),
    (lambda: sr.Power(-1, 0, 1), "exponent is -1"),
    (lambda: sr.PiecewiseConstant([0], []), "counts has 0 entries"),
    (lambda: sr.PiecewiseConstant([0, 1], [0]), "counts are all 0"),
    (lambda: sr.PiecewiseConstant([0, 1, 2], [1, -2]), r"counts\[1\] is -2"),
    (lambda: sr.PiecewiseConstant([0, 1, 1], [1, 2]), r"edges\[2\] is 1"),
    (lambda: sr.PiecewiseConstant([0, 1], [1, 2]), "edges has 2 entries; it must have 3"),
    (lambda: sr.PiecewiseLinear([0, 1], [1, INF]), r"y\[1\] is inf"),
    (lambda: sr.FromPdf(lambda x: x - 0.5, 0, 1), "the density at 0.0.* is -0.4"),
    (lambda: sr.FromPdf(lambda x: x * 0, 0, 1), "the density is 0"),
    (lambda: sr.FromPdf(lambda x: x[:3], 0, 1), r"f returned shape \(3,\)"),
    (lambda: sr.FromPdf(np.sin, 0, 1, tolerance=0), "tolerance is 0"),
    (lambda: sr.Tabulated2D([1, 2]), r"values has shape \(2,\)"),
    (lambda: sr.Tabulated2D([[1, NAN]]), r"values\[0, 1\] is NaN"),
    (lambda: sr.Tabulated2D([[1]], (0, 0), (1, 0)), r"\[low, high\]\[1\] = \[0, 0\]"),
    (lambda: sr.Discrete([]), "weights has 0 entries"),
    (lambda: sr.Discrete([[1]]), r"weights has shape \(1, 1\)"),
    (lambda: sr.Alias([1, INF]), r"weights\[1\] is inf"),
    (lambda: sr.Disk(-1), "radius is -1"),
    (lambda: sr.UniformHemisphere((0, 0, 0)), "the length of axis is 0"),
    (lambda: sr.CosineHemisphere((0, NAN, 1)), "axis.y is NaN"),
    (lambda: sr.Cone((0, 0, 1), 4), "angle is 4"),
    (lambda: sr.Cone((0, 1), 1), r"axis has shape \(2,\)"),
    (lambda: sr.SphericalTriangle((1, 0, 0), (2, 0, 0), (0, 1, 0)), r"a = \[1.0, 0.0, 0.0\]"),
    (lambda: sr.SphericalRectangle((0, 0, 1), (1, 0, 0), (1, 1, 0)), "no rectangle"),
    (lambda: sr.VonMisesFisher((0, 0, 1), -1), "kappa is -1"),
    (lambda: sr.VisibleNormals((0, 0, -1), 0.1), "wo.z is -1"),
    (lambda: sr.VisibleNormals((0, 0, 1), 0), "alpha.x is 0"),
    (lambda: sr.AreaLight((1, 1, 0), (1, 0, 0), (0, 1, 0)), "seen_from .* lies in the plane"),
    (lambda: sr.Product([]), "factors has 0"),
    (lambda: sr.Product([sr.UniformSphere()]), r"factors\[0\] is a density of solid angle"),
    (lambda: sr.Mixture([sr.Uniform(), sr.Uniform()], [0.5, 0.6]), "weights sum to 1.1"),
    (lambda: sr.Mixture([sr.Uniform(), sr.Uniform()], [1.5, -0.5]), r"weights\[1\] is -0.5"),
    (lambda: sr.Mixture([sr.Uniform(), sr.Disk()], [0.5, 0.5]), r"components\[1\]"),
    (lambda: sr.Affine(sr.Disk(), [[1, 1], [2, 2]]), "matrix cannot be inverted"),
    (lambda: sr.Affine(sr.Disk(), [[1, NAN], [2, 2]]), r"matrix\[0, 1\] is NaN"),
    (lambda: sr.Affine(sr.Disk(), np.eye(3)), r"matrix has shape \(3, 3\)"),
    (lambda: sr.Affine(sr.UniformSphere(), 2), "solid angle"),
]


@pytest.mark.parametrize(("make", "message"), BAD, ids=[message for _, message in BAD])
def test_bad_parameters_are_named(make, message):
    with pytest.raises(ValueError, match=message):
        make()


def test_sums_are_integrals_over_indices():
    p = sr.Discrete([1, 0, 3])
    estimate = sr.integrate(lambda i: np.where(i == 1, 0.0, i + 1), over=p, n=4096)
    low, high = estimate.interval(0.9999)
    assert low <= 1 + 3 <= high
    with pytest.raises(sr.SupportError):
        sr.integrate(lambda i: i + 1, over=p, n=4096)


@pytest.mark.parametrize("p", DISTRIBUTIONS, ids=name)
def test_samples_follow_their_densities(p):
    sr.testing.chi2(p, n=1 << 16, seed=7).check(level=1e-3 / len(DISTRIBUTIONS))
