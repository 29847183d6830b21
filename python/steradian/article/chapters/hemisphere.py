"""∫ cos over the hemisphere, with uniform and with cosine densities."""

from __future__ import annotations

import math

import steradian as sr
from steradian.article import plots
from steradian.article.chapter import Chapter

TITLE = "The cosine at a surface"


def cosine_uniformly(n: int, seed: int) -> sr.Estimate:
    """Every direction alike."""
    return sr.integrate(
        lambda w: w[:, 2],
        over=sr.UniformHemisphere(),
        n=n,
        sequence="independent",
        seed=seed,
    )


def cosine_by_cosine(n: int, seed: int) -> sr.Estimate:
    """Each direction as likely as it counts."""
    return sr.integrate(
        lambda w: w[:, 2],
        over=sr.CosineHemisphere(),
        n=n,
        sequence="independent",
        seed=seed,
    )


def overcast_sky(density: str, n: int, seed: int) -> sr.Estimate:
    """A sky that is brighter overhead."""
    hemispheres = {
        "uniform": sr.UniformHemisphere(),
        "cosine": sr.CosineHemisphere(),
    }
    return sr.integrate(
        lambda w: w[:, 2] * w[:, 2],
        over=hemispheres[density],
        n=n,
        sequence="independent",
        seed=seed,
    )


def ratio_of_variances(n: int, seed: int) -> sr.Estimate:
    """How many more samples the uniform density needs."""
    uniform, cosine = sr.UniformHemisphere(), sr.CosineHemisphere()
    variances = []
    for over in (uniform, cosine):
        drawn = over.draw(n, seed).value
        quotients = drawn[:, 2] ** 2 / over.pdf(drawn)
        batches = quotients.reshape(100, -1)
        variances.append(batches.var(axis=1, ddof=1))
    return sr.Estimate.of(variances[0] / variances[1])


def tell(page: Chapter) -> None:
    """f = cos θ and f = cos² θ."""
    page.text("""
        Light that grazes a surface spreads over more of it, so a surface weighs each direction with the
        cosine of its angle to the normal. The integral of that cosine over all directions above is π,
        which is where the π in the reflectance ρ/π of a matte surface comes from.

        Taking all directions alike wastes samples on grazing ones, which hardly count. Make directions
        as likely as they count instead, <i>P</i>(ω) = cos θ/π, and the cosine cancels: every sample
        says π.
    """)
    n = page.n(1_000_000)
    page.measure(
        "∫ cos θ dω, <i>P</i> = 1/2π",
        page.run(cosine_uniformly, n=n),
        math.pi,
        claimed="2ρ E[<i>L</i> cos θ]",
        formula="π",
    )
    page.measure(
        "∫ cos θ dω, <i>P</i> = cos θ/π",
        page.run(cosine_by_cosine, n=n),
        math.pi,
        claimed="ρ E[<i>L</i>]",
        formula="π",
        exactly=True,
    )
    page.text("""
        The ratio of the two variances is infinite, then: π²/3 against none. A fairer comparison has
        light in it that varies, such as a sky that is brighter overhead, <i>L</i> = cos θ. Now <i>f</i>
        = cos² θ, the integral is 2π/3, and the variances of one sample are 16π²/45 and π²/18: cosine
        sampling needs 6.4 times fewer samples.
    """)
    for density in ("uniform", "cosine"):
        if density == "uniform":
            estimate = page.run(overcast_sky, density=density, n=n)
        else:
            estimate = overcast_sky(density, n, page.next_seed())
        page.measure(
            f"∫ cos² θ dω, {density}",
            estimate,
            2 * math.pi / 3,
            claimed="2ρ E[<i>L</i> cos θ]"
            if density == "uniform"
            else "ρ E[<i>L</i>]",
            formula="2π/3",
        )
    page.text("Measured, in a hundred batches:")
    page.measure(
        "ratio of variances, uniform/cosine",
        page.run(ratio_of_variances, n=page.n(1_600_000)),
        6.4,
        claimed="cosine is better",
        formula="32/5",
    )
    seed = page.next_seed()
    page.plot(
        _from_above(
            "every direction alike", sr.UniformHemisphere(), plots.BLUE, seed
        ),
        _from_above("by the cosine", sr.CosineHemisphere(), plots.GREEN, seed),
        caption="Six hundred directions, seen from above the surface. Seen so, cosine-weighted directions "
        "are even: the disk is the "
        "hemisphere’s shadow, and the cosine is what the shadow shrinks areas by.",
    )


def _from_above(
    title: str, density: sr.Distribution, colour: str, seed: int
) -> plots.Plot:
    w = density.draw(600, seed, "independent").value
    made, axes = plots.disk(title)
    axes.scatter(w[:, 0], w[:, 1], s=7, color=colour, linewidths=0)
    return made, f"Directions of the hemisphere, {title}."
