"""A mixture of densities at several weights, and its variance as a function of the weight."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import steradian as sr
from steradian.article import plots
from steradian.article.chapter import Chapter
from steradian.article.chapters.area_light import lambert

TITLE = "Mixing densities"

SKY, LAMP = 0.2, 5.0
"""Radiances."""


def sky_and_lamp(share: float, n: int, seed: int) -> sr.Estimate:
    """Some directions by the cosine, the others at the lamp."""
    cosine = sr.CosineHemisphere()
    lamp = sr.AreaLight(
        corner=(-0.2, -0.6, 1.2),
        edge1=(1, 0, 0.3),
        edge2=(0, 1, 0),
        seen_from=(0, 0, 0),
    )
    mixed = sr.Mixture([cosine, lamp], weights=[share, 1 - share])
    return sr.integrate(
        lambda w: w[:, 2] * np.where(lamp.pdf(w) > 0, 5.0, 0.2),  # lamp and sky
        over=mixed,
        n=n,
        sequence="independent",
        seed=seed,
    )


def variance_of_a_sample(share: float, n: int, seed: int) -> sr.Estimate:
    """In a hundred batches."""
    cosine = sr.CosineHemisphere()
    lamp = sr.AreaLight(
        corner=(-0.2, -0.6, 1.2),
        edge1=(1, 0, 0.3),
        edge2=(0, 1, 0),
        seen_from=(0, 0, 0),
    )
    mixed = sr.Mixture([cosine, lamp], weights=[share, 1 - share])
    w, p = mixed.draw(n, seed)
    quotients = w[:, 2] * np.where(lamp.pdf(w) > 0, 5.0, 0.2) / p
    return sr.Estimate.of(quotients.reshape(100, -1).var(axis=1, ddof=1))


def exact_integral() -> float:
    """The sky everywhere, and the lamp's surplus where it is."""
    return float(SKY * np.pi + (LAMP - SKY) * lambert())


def exact_variance(share: float) -> float:
    """∫ f²/p − (∫ f)²: in closed form beside the lamp, by Gauss's rule with 40 × 40 nodes on it."""
    beside = SKY**2 * np.pi / share * (np.pi - lambert())
    nodes, weights = np.polynomial.legendre.leggauss(40)
    u = (nodes + 1) / 2
    corner, edge1, edge2 = (
        np.array([-0.2, -0.6, 1.2]),
        np.array([1, 0, 0.3]),
        np.array([0, 1, 0]),
    )
    q = corner + u[:, None, None] * edge1 + u[None, :, None] * edge2
    distance = np.linalg.norm(q, axis=2)
    w = q / distance[..., None]
    p_lamp = distance**2 / np.abs(w @ np.cross(edge1, edge2))
    square = (LAMP * w[..., 2]) ** 2 / (
        share * w[..., 2] / np.pi + (1 - share) * p_lamp
    )
    on_it = weights @ (square / p_lamp) @ weights / 4
    return float(beside + on_it - exact_integral() ** 2)


def tell(page: Chapter) -> None:
    """Sky and lamp, by mixtures of their two densities."""
    page.text("""
        Now the table has a dim sky above it, and the lamp. Cosine-weighted directions suit the sky,
        directions at the lamp suit the lamp; and aiming only at the lamp would be plainly wrong, as the
        sky would never be seen. A mixture does both: toss a weighted coin, draw from the density that
        wins, and divide by the density of the whole,

        <span class="formula"><i>P</i>(ω) = <i>a</i> <i>P</i><sub>cosine</sub>(ω) + (1 − <i>a</i>)
        <i>P</i><sub>lamp</sub>(ω)</span>

        not by that of the winner. As long as the weights sum to 1 this is a density like any other, and
        every weight gives the same answer:
    """)
    exact = exact_integral()
    n = page.n(500_000)
    for share, name in ((0.25, "¼"), (0.5, "½"), (0.75, "¾")):
        estimate = (
            page.run(sky_and_lamp, share=share, n=n)
            if share == 0.25
            else sky_and_lamp(share, n, page.next_seed())
        )
        page.measure(
            f"sky and lamp, <i>a</i> = {name}",
            estimate,
            exact,
            claimed="Σ <i>a</i><sub>i</sub> = 1",
            formula="π<i>S</i> + Lambert’s",
        )
    page.text("""
        What differs is the noise. Too little for the sky, and the rare direction that goes there counts
        far too much; too little for the lamp, and most samples miss it. In between there is a broad
        valley, which is the good news: a mixture need not be tuned to be safe.
    """)
    measured = []
    shares = np.array([0.05, 0.1, 0.25, 0.5, 0.75, 0.9, 1.0])
    for share in shares:
        n = page.n(1_600_000)
        if share == shares[0]:
            estimate = page.run(variance_of_a_sample, share=float(share), n=n)
        else:
            estimate = variance_of_a_sample(float(share), n, page.next_seed())
        measured.append(estimate)
        if share in (0.05, 0.25, 0.9):
            page.measure(
                f"variance of a sample, <i>a</i> = {share:g}",
                estimate,
                exact_variance(float(share)),
                formula="∫ <i>f</i>²/<i>P</i> − (∫ <i>f</i>)²",
            )
    page.plot(
        _valley(shares, measured),
        caption="Variance of one sample against the weight of the cosine density: curve exact, dots "
        "measured.",
    )


def _valley(
    shares: NDArray[np.float64], measured: list[sr.Estimate]
) -> plots.Plot:
    made, axes = plots.figure(
        6.0,
        3.2,
        yscale="log",
        xlabel="weight a of the cosine density",
        ylabel="variance of a sample",
    )
    fine = np.linspace(0.03, 1, 200)
    axes.plot(
        fine,
        [exact_variance(float(share)) for share in fine],
        color=plots.BLUE,
        label="exact",
    )
    means, errors = (
        [float(e.mean) for e in measured],
        [3 * float(e.stderr) for e in measured],
    )
    axes.errorbar(
        shares,
        means,
        errors,
        fmt="o",
        color=plots.ORANGE,
        markersize=5,
        label="measured, ± 3 standard errors",
    )
    axes.legend(loc="upper center")
    return (
        made,
        "The variance is high at both ends and low in a broad valley between.",
    )
