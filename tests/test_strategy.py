"""Strategies as values."""

import pytest

import steradian as sr


@pytest.mark.parametrize(
    ("composed", "expression"),
    [
        (sr.uniform, "uniform"),
        (sr.cosine, "cosine"),
        (sr.bsdf, "bsdf"),
        (sr.light, "light"),
        (0.5 * sr.cosine + 0.5 * sr.light, "0.5 cosine + 0.5 light"),
        (sum([0.5 * sr.cosine, 0.5 * sr.light]), "0.5 cosine + 0.5 light"),
        (sr.light * 0.75 + 0.25 * sr.bsdf, "0.25 bsdf + 0.75 light"),
        (0.5 * (0.5 * sr.bsdf + 0.5 * sr.light) + 0.5 * sr.light, "0.25 bsdf + 0.75 light"),
        (sr.mis(sr.bsdf, sr.light), "mis(bsdf, light)"),
        (sr.mis(sr.bsdf, sr.light, heuristic="balance"), "mis(bsdf, light, heuristic=balance)"),
        (sr.mis(0.5 * sr.uniform + 0.5 * sr.bsdf, sr.light), "mis(0.5 uniform + 0.5 bsdf, light)"),
    ],
)
def test_composed_strategies_print_as_expressions_that_read_back(composed, expression):
    assert str(composed) == expression
    assert sr.strategy(expression) == composed
    assert sr.strategy(composed) == composed
    assert hash(sr.strategy(expression)) == hash(composed)


def test_equality_is_of_meaning():
    assert 0.5 * sr.cosine + 0.5 * sr.light == 0.5 * sr.light + 0.5 * sr.cosine
    assert sr.mis(sr.bsdf, sr.light) == sr.mis(sr.bsdf, sr.light, heuristic="power")
    assert sr.bsdf != sr.light
    assert sr.mis(sr.bsdf, sr.light) != sr.mis(sr.bsdf, sr.light, heuristic="balance")
    assert 0.5 * sr.bsdf != sr.bsdf
    assert sr.bsdf != "bsdf"


@pytest.mark.parametrize(
    ("make", "words"),
    [
        (lambda: str(sr.cosine + sr.light), ["sum to 2", "0.5 cosine + 0.5 light"]),
        (lambda: str(0.5 * sr.cosine), ["sum to 0.5"]),
        (lambda: str(-1 * sr.cosine + 2 * sr.light), ["negative"]),
        (lambda: sr.strategy("0.5 cosine + 0.5 ligth"), ["ligth", "column 18", "light"]),
        (lambda: sr.strategy("mis(bsdf light)"), ["`,` or `)`"]),
        (lambda: sr.strategy(""), ["at least one density"]),
        (lambda: sr.mis(), ["at least one density"]),
        (lambda: sr.mis(*[sr.bsdf] * 5), ["at most 4"]),
        (lambda: sr.mis(sr.bsdf, sr.light, heuristic="best"), ["best", "balance"]),
    ],
)
def test_what_is_no_strategy_is_a_value_error_with_the_remedy(make, words):
    with pytest.raises(ValueError) as caught:
        make()
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    "make",
    [
        lambda: sr.bsdf + 1,
        lambda: sr.bsdf * sr.light,
        lambda: sr.bsdf + "light",
        lambda: sr.mis("bsdf", sr.light),
        lambda: sr.mis(sr.mis(sr.bsdf, sr.light), sr.light),
        lambda: sr.strategy(3),
    ],
)
def test_other_types_do_not_combine(make):
    with pytest.raises(TypeError):
        make()


def test_reprs_are_code():
    for strategy in (0.25 * sr.bsdf + 0.75 * sr.light, sr.mis(sr.bsdf, sr.light)):
        assert eval(repr(strategy), {"sr": sr}) == strategy
