"""Learned densities, from Python."""

import math
import pickle

import numpy as np
import pytest

import steradian as sr

CUBE = [(0.0, 1.0)] * 3


def gauss(scale, centre):
    """∫₀¹ exp(−scale (x − centre)²) dx."""
    root = math.sqrt(scale)
    return math.sqrt(math.pi) / (2 * root) * (math.erf(root * (1 - centre)) + math.erf(root * centre))


def peaks(x):
    return np.exp(-200 * ((x - 0.3) ** 2).sum(axis=1)) + 0.5 * np.exp(-200 * ((x - 0.7) ** 2).sum(axis=1))


PEAKS = gauss(200, 0.3) ** 3 + 0.5 * gauss(200, 0.7) ** 3


def within(estimate, exact, level=0.9999):
    low, high = estimate.interval(level)
    return low <= exact <= high


def test_several_peaks_are_found():
    found = sr.adapt(peaks, over=CUBE, rtol=1e-3, seed=1)
    assert within(found.estimate, PEAKS)
    assert found.estimate.relative_error <= 1e-3
    plain = sr.integrate(peaks, over=CUBE, n=found.n, sequence="independent")
    assert found.estimate.stderr < 0.1 * plain.stderr
    assert found.n >= found.estimate.n > 0 and found.q > 1e-3 and len(found.iterations) >= 1


def test_the_density_is_a_distribution_like_any_other(tmp_path):
    density = sr.adapt(peaks, over=CUBE, n=1 << 14).density
    value, pdf = density.draw(1000, seed=3)
    assert value.shape == (1000, 3) and np.allclose(density.pdf(value), pdf)
    mixed = 0.5 * density + 0.5 * sr.Uniform([0] * 3, [1] * 3)
    assert within(sr.integrate(peaks, over=mixed, n=1 << 14), PEAKS)
    density.save(tmp_path / "density.json")
    for again in [sr.Distribution.load(tmp_path / "density.json"), pickle.loads(pickle.dumps(density))]:
        assert np.array_equal(again.pdf(value), density.pdf(value))
    total = sr.integrate(lambda x: density.pdf(x), over=CUBE, n=1 << 18)
    assert total.mean == pytest.approx(1, abs=5 * total.stderr + 1e-3)


def test_it_learns_over_any_distribution():
    found = sr.adapt(lambda x: np.exp(-0.5 * (x - 2) ** 2), over=sr.Normal(0, 1), n=1 << 14)
    assert within(found.estimate, math.sqrt(2 * math.pi))


def test_it_learns_for_several_outputs():
    found = sr.adapt(lambda x: np.stack([peaks(x), x[:, 0] * peaks(x)], axis=1), over=CUBE, n=1 << 15)
    assert found.estimate.mean.shape == (2,)
    low, high = found.estimate.interval(0.9999)
    assert low[0] < PEAKS < high[0]


def test_the_same_call_gives_the_same_bits():
    runs = [
        sr.adapt(peaks, over=CUBE, n=1 << 15, seed=5, threads=threads).estimate.mean for threads in (1, 3)
    ]
    assert runs[0] == runs[1] != sr.adapt(peaks, over=CUBE, n=1 << 15, seed=6).estimate.mean


def test_limits_and_progress():
    told = []
    found = sr.adapt(peaks, over=CUBE, n=20_000, on_progress=told.append)
    assert found.n <= 22_000
    assert [p.n for p in told] == sorted(p.n for p in told)
    assert sr.adapt(peaks, over=CUBE, seconds=0.2).estimate.seconds < 3


def test_bad_integrands_are_errors():
    with pytest.raises(sr.IntegrandError, match="f returned NaN at x = "):
        sr.adapt(lambda x: np.full(len(x), np.nan), over=CUBE)
    with pytest.raises(ValueError, match="f returned shape"):
        sr.adapt(lambda x: x[:-1, 0], over=CUBE)
    with pytest.raises(ZeroDivisionError):
        sr.adapt(lambda x: 1 / 0, over=CUBE)


def test_nothing_to_learn_from_is_no_error():
    with pytest.warns(sr.IntegrationWarning, match="f was 0 at all"):
        found = sr.adapt(lambda x: np.zeros(len(x)), over=CUBE, n=4096)
    assert found.estimate.mean == 0 and found.estimate.stderr == 0


@pytest.mark.parametrize(
    ("components", "shares", "message"),
    [
        ([], [], "0 components have 0 shares"),
        ([([[0.0, 1.0]], [], [])], [63], "the shares sum to 63"),
        ([([[0.0, 1.0], [0.0, 1.0]], [], [])], [64], "component 0 has 2 axes"),
        ([([[0.0, 0.5, 0.5, 0.7, 1.0]], [], [])], [64], "each knot must be above"),
        ([([[0.0, 0.5, 0.6, 1.0]], [], [])], [64], "not a power of two"),
        ([([[0.1, 1.0]], [], [])], [64], "ends of the unit cube"),
        ([([[0.0, float("nan"), 1.0]], [], [])], [64], "each knot must be above"),
        ([([[0.0, 1.0]], [0.5], [0.5])], [64], "not orthonormal"),
    ],
)
def test_densities_from_elsewhere_are_checked(components, shares, message):
    with pytest.raises(ValueError, match=message):
        sr.Learned(sr.Uniform(), components, shares)


def test_files_that_hold_no_distribution(tmp_path):
    for text in [
        "",
        "3",
        "[]",
        '{"type": "Nothing"}',
        '{"type": "Uniform", "high": -1}',
        '{"type": "Uniform", "x": 1}',
    ]:
        (tmp_path / "bad.json").write_text(text)
        with pytest.raises(ValueError, match=r"bad\.json holds no distribution"):
            sr.Distribution.load(tmp_path / "bad.json")
    with pytest.raises(TypeError, match="of your own"):

        class Own(sr.Distribution):
            def sample(self, u):
                return sr.Samples(u, np.ones_like(u))

            def pdf(self, x):
                return np.ones_like(x)

        Own().save(tmp_path / "own.json")


def test_edges_are_stratified(tmp_path):
    def disk(x):
        return ((x**2).sum(axis=1) < 1).astype(float)

    found = sr.adapt(disk, over=[(0, 1)] * 2, n=1 << 18)
    assert found.iterations[-1].strata > 10
    assert float(found.estimate.stderr) < 1e-4
    assert abs(float(found.estimate) - np.pi / 4) < 5 * float(found.estimate.stderr)
    assert "strata" in repr(found.density)
    found.density.save(tmp_path / "disk.json")
    again = sr.Distribution.load(tmp_path / "disk.json")
    x = np.array([[0.2, 0.3], [0.6, 0.8], [1.5, 0.0]])
    assert np.array_equal(again.pdf(x), found.density.pdf(x))
    assert again.pdf(x)[1] > 2 * again.pdf(x)[0] > again.pdf(x)[2] == 0
    u = again.invert(x[:2])
    assert np.allclose(again.sample(u).value, x[:2], atol=1e-12)
    with pytest.raises(ValueError, match="strata"):
        sr.Learned(sr.Uniform(), [([[0.0, 1.0]], [], [])], [64], [(1, 0.5), None, None])
