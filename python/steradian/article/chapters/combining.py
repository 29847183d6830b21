"""What the article leaves for later: multiple importance sampling, and resampling."""

from __future__ import annotations

import numpy as np

import steradian as sr
from steradian.article import plots
from steradian.article.chapter import Chapter
from steradian.article.chapters import mixture

TITLE = "Several densities at once"


def by_mis(heuristic: str, n: int, seed: int) -> sr.Estimate:
    """A sample from each density, weighted by a heuristic."""
    lamp = sr.AreaLight(
        corner=(-0.2, -0.6, 1.2),
        edge1=(1, 0, 0.3),
        edge2=(0, 1, 0),
        seen_from=(0, 0, 0),
    )
    return sr.mis_integrate(
        lambda w: w[:, 2] * np.where(lamp.pdf(w) > 0, 5.0, 0.2),
        over=[sr.CosineHemisphere(), lamp],
        heuristic=heuristic,
        n=n,
        sequence="independent",
        seed=seed,
    )


def by_resampling(candidates: int, n: int, seed: int) -> sr.Estimate:
    """The brightest of some candidates, more or less."""
    lamp = sr.AreaLight(
        corner=(-0.2, -0.6, 1.2),
        edge1=(1, 0, 0.3),
        edge2=(0, 1, 0),
        seen_from=(0, 0, 0),
    )
    return sr.ris_integrate(
        lambda w: w[:, 2] * np.where(lamp.pdf(w) > 0, 5.0, 0.2),
        over=sr.CosineHemisphere(),
        # Brightness alone, without the cosine.
        target=lambda w: np.where(lamp.pdf(w) > 0, 5.0, 0.2),
        candidates=candidates,
        n=n,
        sequence="independent",
        seed=seed,
    )


def line_by_mis(n: int, seed: int) -> sr.Estimate:
    """Both densities of the earlier chapter."""
    both = [sr.Uniform(0, 5), sr.Linear(0, 5)]
    return sr.mis_integrate(
        lambda x: 2 * x, over=both, n=n, sequence="independent", seed=seed
    )


def line_by_resampling(n: int, seed: int) -> sr.Estimate:
    """Uniform candidates, chosen in proportion to x."""
    return sr.ris_integrate(
        lambda x: 2 * x,
        over=sr.Uniform(0, 5),
        target=lambda x: x,
        candidates=16,
        n=n,
        sequence="independent",
        seed=seed,
    )


def tell(page: Chapter) -> None:
    """MIS and RIS on the integrals of earlier chapters."""
    page.text("""
        A mixture tosses a coin for each sample. <em>Multiple importance sampling</em> draws from every
        density, and lets each sample count by how much its own density is to be trusted at that place:
        weights that sum to 1 wherever the integrand is not 0. The balance heuristic weighs by
        <i>P</i><sub>i</sub>/Σ<i>P</i><sub>j</sub>, the power heuristic by the squares; cutoff and
        maximum are sharper still. None of them can be wrong, only noisier, as long as one of the densities is
        positive wherever f is not 0.
    """)
    exact = mixture.exact_integral()
    n = page.n(500_000)
    estimates: list[tuple[str, sr.Estimate]] = [
        ("mixture ½ + ½", mixture.sky_and_lamp(0.5, n, page.next_seed()))
    ]
    for heuristic in ("balance", "power", "cutoff", "maximum"):
        estimate = (
            page.run(by_mis, heuristic=heuristic, n=n)
            if heuristic == "balance"
            else by_mis(heuristic, n, page.next_seed())
        )
        page.measure(
            f"sky and lamp, MIS, {heuristic}",
            estimate,
            exact,
            claimed="open",
            formula="π<i>S</i> + Lambert’s",
        )
        estimates.append((f"MIS, {heuristic}", estimate))
    page.measure(
        "∫₀⁵ 2<i>x</i> d<i>x</i>, MIS of 1/5 and ∝ <i>x</i>",
        page.run(line_by_mis, n=page.n(100_000)),
        25.0,
        formula="25",
    )
    page.text("""
        <em>Resampled importance sampling</em> goes another way. Draw several cheap candidates, give
        each a weight, target/<i>P</i>, choose one in proportion, and evaluate the integrand only for
        the winner. The mean of all weights puts right what the choice distorts. With more candidates
        the winner comes ever nearer to a sample of the target, of which one need not know how to draw
        samples, nor its integral. Renderers choose among thousands of lamps so, and ReSTIR shares the
        winners between neighbouring pixels.
    """)
    for candidates in (4, 32):
        estimate = (
            page.run(by_resampling, candidates=candidates, n=n // 4)
            if candidates == 4
            else by_resampling(candidates, n // 4, page.next_seed())
        )
        page.measure(
            f"sky and lamp, {candidates} candidates",
            estimate,
            exact,
            claimed="open",
            formula="π<i>S</i> + Lambert’s",
        )
        estimates.append((f"RIS, {candidates} candidates", estimate))
    line = page.run(line_by_resampling, n=page.n(100_000))
    page.measure(
        "∫₀⁵ 2<i>x</i> d<i>x</i>, 16 candidates for 2<i>x</i>",
        line,
        25.0,
        formula="25",
    )
    page.plot(
        _bars(estimates),
        caption="Variance for each evaluation of the integrand, on the integral with sky and lamp; "
        "candidates are not counted. Resampling never draws from the lamp’s density, it only asks how bright "
        "a direction is: four candidates by the cosine seldom meet the lamp, of thirty-two nearly always one "
        "does. Where a lamp can be sampled directly, multiple importance sampling is better and cheaper.",
    )


def _bars(estimates: list[tuple[str, sr.Estimate]]) -> plots.Plot:
    names = [name for name, _ in estimates]
    variances = [float(e.stderr) ** 2 * e.n for _, e in estimates]
    made, axes = plots.figure(6.0, 3.0, xlabel="variance × evaluations")
    colours = [plots.BLUE] + [plots.GREEN] * 4 + [plots.ORANGE] * 2
    axes.barh(names, variances, color=colours, height=0.62)
    for place, variance in enumerate(variances):
        axes.text(
            variance, place, f" {variance:.2g}", va="center", fontsize=9.5
        )
    axes.set_xlim(0, 1.12 * max(variances))
    axes.invert_yaxis()
    return made, "; ".join(
        f"{name}: {variance:.2g}"
        for name, variance in zip(names, variances, strict=True)
    )
