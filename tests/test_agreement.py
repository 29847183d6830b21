"""Strategies, sequences and samplers against one another, on our Cornell box."""

from __future__ import annotations

import itertools
import math

import pytest

import steradian as sr

# Samples per pixel, by how noisy each strategy is: pairs can then be told apart at 0.1 %.
SAMPLES = {
    "uniform": 24_576,
    "cosine": 16_384,
    "bsdf": 16_384,
    "light": 1536,
    "0.5 cosine + 0.5 light": 3072,
    "mis(bsdf, light)": 1536,
    "mis(light, bsdf)": 1536,  # the default in another order: the general integrator instead of the fast one
}
SIZE = (48, 48)
DEPTH = 4
RESOLUTION = 1e-3
# Two-sided, for the 21 pairs and 3 channels at a family failure rate of 1 %: Šidák gives 1.6e-4.
Z_LIMIT = 3.77


@pytest.fixture(scope="module")
def results(cornell: sr.Scene) -> dict[str, sr.Result]:
    """Every strategy's render, each with its own seed."""
    return {
        name: sr.render(cornell, spp=spp, strategy=name, size=SIZE, max_depth=DEPTH, seed=seed)
        for seed, (name, spp) in enumerate(SAMPLES.items())
    }


def test_strategies_agree_pairwise(results: dict[str, sr.Result]) -> None:
    pairs = list(itertools.combinations(results, 2))
    assert len(pairs) == 21
    for a, b in pairs:
        for channel in range(3):
            difference = results[a].mean[channel] - results[b].mean[channel]
            error = math.hypot(results[a].mean_stderr[channel], results[b].mean_stderr[channel])
            relative = error / results["mis(bsdf, light)"].mean[channel]
            report = f"{a} and {b}, channel {channel}: {difference} ± {error} ({100 * relative:.3f} %)"
            assert relative <= RESOLUTION, f"too noisy to tell: {report}"
            assert abs(difference) <= Z_LIMIT * error, report


def test_errors_rank_as_theory_says(cornell: sr.Scene) -> None:
    def error(strategy: str) -> float:
        result = sr.render(cornell, spp=64, strategy=strategy, size=SIZE, max_depth=DEPTH, seed=3)
        return result.mean_relative_error

    uniform, cosine, bsdf = error("uniform"), error("cosine"), error("bsdf")
    mixture, light, mis = error("0.5 cosine + 0.5 light"), error("light"), error("mis(bsdf, light)")
    # On Lambertian walls a cosine is the BSDF's own density, and better than none.
    assert uniform > cosine
    assert bsdf == pytest.approx(cosine, rel=0.05)
    # The lamp is small: half of the directions towards it are worth a lot, all of them more.
    assert cosine > 2 * mixture
    assert mixture > 1.5 * light
    # Veach: never much worse than its best technique.
    assert mis < 1.1 * light


def test_sequences_agree_and_sobol_is_better(cornell: sr.Scene) -> None:
    runs = {
        name: sr.render(cornell, spp=512, sampler=name, size=SIZE, max_depth=DEPTH, seed=5)
        for name in ("independent", "sobol")
    }
    for channel in range(3):
        a, b = (runs[name] for name in ("independent", "sobol"))
        error = math.hypot(a.mean_stderr[channel], b.mean_stderr[channel])
        assert abs(a.mean[channel] - b.mean[channel]) <= Z_LIMIT * error
    assert runs["sobol"].mean_relative_error < 0.8 * runs["independent"].mean_relative_error
