"""Arguments that make no sense are one clear exception, which names argument and value."""

import copy
import pickle

import numpy as np
import pytest

import steradian as sr

N, U = sr.Normal(), sr.Uniform()


@pytest.mark.parametrize(
    ("call", "error", "message"),
    [
        (lambda: sr.Mixture([N, 3]), TypeError, r"components\[1\] must be a distribution, not 3"),
        (lambda: sr.Product([N, 3]), TypeError, r"factors\[1\] must be a distribution, not 3"),
        (lambda: sr.Truncated(3, 0, 1), TypeError, "of must be a distribution, not 3"),
        (lambda: sr.Affine(3, 1), TypeError, "of must be a distribution, not 3"),
        (lambda: sr.Learned(3, [], []), TypeError, "over must be a distribution, not 3"),
        (
            lambda: sr.integrate(np.cos, over=U, threads=1.5),
            TypeError,
            "threads must be a whole number, not 1.5",
        ),
        (lambda: sr.integrate(np.cos, over=U, threads=None), TypeError, "threads must be a whole number"),
        (
            lambda: sr.integrate(np.cos, over=U, sequence=None),
            TypeError,
            'sequence must be "independent", "str',
        ),
        (lambda: sr.integrate(np.cos, over=U, replicates=1 << 40), ValueError, "replicates is 1099511627776"),
        (
            lambda: sr.integrate(np.cos, over=U, on_progress=3),
            TypeError,
            "on_progress must be a function, not 3",
        ),
        (lambda: sr.integrate(np.cos, over=U, rtol="a"), TypeError, "rtol must be a number, not 'a'"),
        (lambda: sr.integrate(np.cos, over=U, seconds="1"), TypeError, "seconds must be a number, not '1'"),
        (lambda: sr.integrate(np.cos, over=U, seed=1.5), TypeError, "seed must be a whole number, not 1.5"),
        (
            lambda: sr.integrate(np.cos, over=[(0, np.inf)]),
            ValueError,
            r"over\[0\] is \(0, inf\).* Exponential",
        ),
        (lambda: sr.mis_integrate(np.cos, [U], heuristic=None), TypeError, 'heuristic must be "balance"'),
        (lambda: sr.Uniform("a", 1), TypeError, "low must be real numbers, not 'a'"),
        (lambda: sr.Uniform([0, 0], [1, 1, 1]), ValueError, r"low and high have shapes \(2,\) and \(3,\)"),
        (lambda: sr.Normal(None, 1), TypeError, "mean must be a number, not None"),
        (lambda: sr.FromPdf(3, 0, 1), TypeError, "f must be a function, not 3"),
        (
            lambda: sr.FromPdf(lambda x: x + 1j, 0, 1),
            TypeError,
            "f returned ndarray, which is no array of real",
        ),
        (lambda: sr.testing.chi2(N, n=1.5), TypeError, "n must be a whole number, not 1.5"),
        (
            lambda: sr.testing.chi2(sr.Product([U] * 201)),
            ValueError,
            "over has 201 coordinates; .* up to 200",
        ),
        (lambda: N.draw(0), ValueError, "n is 0; it must be positive"),
        (lambda: N.draw(9, -1), ValueError, "seed is -1; it must be from 0 to 2\\^64 - 1"),
        (lambda: sr.Truncated(N, 0, 0), ValueError, "either may be infinite"),
        (lambda: sr.Affine(N * N, [[1, 1], [1, 1 + 1e-12]]), ValueError, "matrix can hardly be inverted"),
        (lambda: sr.Tabulated2D([[1, -1]]), ValueError, r"values\[0, 1\] is -1.0; it must be"),
    ],
)
def test_bad_arguments_are_named(call, error, message):
    with pytest.raises(error, match=message):
        call()


@pytest.mark.parametrize(
    "text",
    [
        '{"type": "Mixture", "components": [3]}',
        '{"type": "Truncated", "of": 3, "low": 0, "high": 1}',
        '{"type": "Learned", "over": {"type": "Uniform"}, '
        '"components": [[[[0, 1]], [], []]], "shares": [-64]}',
    ],
)
def test_bad_files_are_named(tmp_path, text):
    path = tmp_path / "p.json"
    path.write_text(text)
    with pytest.raises(ValueError, match=r"p\.json holds no distribution: "):
        sr.Distribution.load(path)


def test_advice_for_functions_of_single_points():
    for f in (lambda x: 1 if x > 0.5 else 0, lambda x: __import__("math").exp(x)):
        for call in (lambda f=f: sr.integrate(f, over=U), lambda f=f: sr.FromPdf(f, 0, 1)):
            with pytest.raises((TypeError, ValueError)) as caught:
                call()
            assert "numpy.vectorize" in "".join(caught.value.__notes__)


def test_nobody_else_can_change_a_distribution():
    counts, low, values = np.array([1.0, 2.0]), [0.0, 0.0], np.array([[1.0, 3.0]])
    made = [sr.PiecewiseConstant([0, 1, 2], counts), sr.Uniform(low, [1, 1]), sr.Tabulated2D(values)]
    texts, at = [repr(p) for p in made], [0.5, [0.5, 0.5], [0.5, 0.2]]
    counts[0], low[0], values[0, 0] = 100, -9, 100
    for p, text, x in zip(made, texts, at, strict=True):
        assert repr(p) == text
        for again in (
            pickle.loads(pickle.dumps(p)),
            copy.deepcopy(p),
            sr.Distribution.from_dict(p.to_dict()),
        ):
            assert again.pdf(x) == p.pdf(x)


def test_a_weighted_sum_is_a_mixture():
    p = 0.25 * N + 0.75 * U
    assert isinstance(p, sr.Mixture) and p.weights == [0.25, 0.75] and p.components == [N, U]
    assert np.array_equal(p.pdf([0.3, 2.0]), sr.Mixture([N, U], [0.25, 0.75]).pdf([0.3, 2.0]))
    again = eval(repr(p), vars(sr))
    assert repr(again) == repr(p) and again.pdf(0.3) == p.pdf(0.3)
    assert type(sr.Distribution.from_dict(p.to_dict())) is type(p)
    many = sum(0.25 * sr.Uniform(k, k + 1) for k in range(4))
    assert many.pdf(3.5) == 0.25 and len(many.components) == 4
    assert sum(w * q for w, q in [(1.0, N), (0.0, U)]).weights == [1.0, 0.0]


def test_an_unfinished_mixture_says_so():
    part = 0.3 * N
    assert repr(part) == "0.3 * Normal(mean=0.0, sd=1.0)"
    for ask in (
        lambda: part.pdf(0.0),
        lambda: part.draw(3),
        lambda: part.uniforms,
        lambda: part.to_dict(),
        lambda: sr.integrate(np.cos, over=part),
        lambda: (part + 0.9 * U).mean,
    ):
        with pytest.raises(
            ValueError, match=r"the weights of 0\.3 \* Normal\(.* sum to (0\.3|1\.2), not to 1"
        ):
            ask()
    with pytest.raises(TypeError):
        part + N


def test_estimates_compare():
    one, two = (sr.integrate(np.cos, over=U, n=256) for _ in range(2))
    assert one == two and hash(one) == hash(two)
    assert one != sr.integrate(np.cos, over=U, n=256, seed=1)
    both = sr.integrate(lambda x: np.stack([x, x * x], axis=1), over=U, n=256)
    assert both == both and both != one and len({both, one}) == 2
    assert str(sr.integrate(lambda x: 0 * x + 1e-200, over=U, n=256)).startswith("1e-200 ± 0 ")
