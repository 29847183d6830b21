"""The irradiance of an area light, through P(ω) = distance² / (A cos θ), against Lambert's closed form."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

import steradian as sr
from steradian.article import plots
from steradian.article.chapter import Chapter

TITLE = "Straight at the light"

CORNERS = np.array(
    [[-0.2, -0.6, 1.2], [0.8, -0.6, 1.5], [0.8, 0.4, 1.5], [-0.2, 0.4, 1.2]]
)
"""Of the lamp, in turn. The surface is at the origin and looks along +z."""


def lamp() -> sr.AreaLight:
    """A tilted square lamp above the origin."""
    return sr.AreaLight(
        corner=(-0.2, -0.6, 1.2),
        edge1=(1, 0, 0.3),
        edge2=(0, 1, 0),
        seen_from=(0, 0, 0),
    )


def irradiance(density: str, n: int, seed: int) -> sr.Estimate:
    """By directions of one of three densities."""
    densities = {
        "uniform": sr.UniformHemisphere(),
        "cosine": sr.CosineHemisphere(),
        "lamp": lamp(),
    }
    return sr.integrate(
        lambda w: w[:, 2] * (lamp().pdf(w) > 0),  # cos θ on the lamp
        over=densities[density],
        n=n,
        sequence="independent",
        seed=seed,
    )


def points_on_the_lamp(n: int, seed: int) -> sr.Estimate:
    """By places on the lamp, each with its density per solid angle."""
    u = sr.Uniform([0, 0], [1, 1]).draw(n, seed).value
    edge1, edge2 = np.array([1, 0, 0.3]), np.array([0, 1, 0])
    q = np.array([-0.2, -0.6, 1.2]) + u[:, :1] * edge1 + u[:, 1:] * edge2
    cross = np.cross(edge1, edge2)
    area = np.linalg.norm(cross)
    distance = np.linalg.norm(q, axis=1)
    w = q / distance[:, None]
    p = distance**2 / (area * np.abs(w @ (cross / area)))  # P(ω)
    return sr.Estimate.of(w[:, 2] / p)


def lambert(corners: NDArray[np.float64] = CORNERS) -> float:
    """The irradiance of a polygon of radiance 1: half the sum of each edge's angle times the "
    "cosine of its plane's normal."""
    total = 0.0
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        across = np.cross(a, b)
        angle = np.arctan2(np.linalg.norm(across), a @ b)
        total += float(angle * across[2] / np.linalg.norm(across))
    return abs(total) / 2


def tell(page: Chapter) -> None:
    """Three densities for one lamp."""
    page.text("""
        A lamp is small and bright. Directions chosen blindly, or by the cosine, seldom meet it; those
        that do carry all of its light, and the answer is noisy. Better to choose a point <i>q</i> on
        the lamp, and look there.

        But points on a lamp are spread per <em>area</em>, and the integral is per <em>solid angle</em>.
        A patch d<i>A</i> of the lamp covers less of the view the farther it is, by the square of the
        distance, and the more it is turned away, by a cosine: dω = d<i>A</i> cos θ/distance². The
        probability of a patch is the same in both ways of counting, so with <i>P</i>(<i>q</i>) =
        1/<i>A</i>

        <span class="formula"><i>P</i>(ω) = distance² / (<i>A</i> cos θ)</span>
    """)
    exact = lambert()
    n = page.n(1_000_000)
    page.text("By hand, for a tilted lamp of radiance 1 above a table:")
    page.measure(
        "irradiance, points on the lamp, by hand",
        page.run(points_on_the_lamp, n=n),
        exact,
        claimed="<i>P</i>(ω) = d²/(<i>A</i> cos θ)",
        formula="Lambert’s formula",
    )
    page.text("""
        The exact value comes from Lambert, 1760: for a polygon, add up over its edges the angle under
        which each is seen, times the cosine between the surface’s normal and the normal of the plane
        through edge and eye, and halve. The same with three densities:
    """)
    for density in ("uniform", "cosine", "lamp"):
        if density == "uniform":
            estimate = page.run(irradiance, lamp, density=density, n=n)
        else:
            estimate = irradiance(density, n, page.next_seed())
        page.measure(
            f"irradiance, <i>P</i> {density}",
            estimate,
            exact,
            formula="Lambert’s formula",
        )
    seed = page.next_seed()
    page.plot(
        _from_above("uniform", sr.UniformHemisphere(), plots.BLUE, seed),
        _from_above("cosine", sr.CosineHemisphere(), plots.GREEN, seed),
        _from_above("lamp", lamp(), plots.ORANGE, seed),
        _errors(page),
        caption="Where 300 directions of each density go, from above, with the outline of the lamp; and the"
        " error that each leaves.",
    )


def _outline() -> NDArray[np.float64]:
    """The lamp's outline on the disk of directions seen from above; (n, 2)."""
    steps = np.linspace(0, 1, 30)[:, None]
    edges = [
        a + steps * (b - a)
        for a, b in zip(CORNERS, np.roll(CORNERS, -1, axis=0), strict=True)
    ]
    points = np.concatenate(edges)
    directions: NDArray[np.float64] = (
        points / np.linalg.norm(points, axis=1)[:, None]
    )
    return directions[:, :2]


def _from_above(
    title: str, density: sr.Distribution, colour: str, seed: int
) -> plots.Plot:
    w = density.draw(300, seed).value
    hits = int(np.sum(lamp().pdf(w) > 0))
    made, axes = plots.disk(f"{title}: {hits} of 300 hit")
    axes.scatter(w[:, 0], w[:, 1], s=6, color=colour, linewidths=0)
    axes.plot(*_outline().T, color=plots.INK, linewidth=1)
    return (
        made,
        f"Directions of the density {title}; {hits} of 300 meet the lamp.",
    )


def _errors(page: Chapter) -> plots.Plot:
    rows = [block for block in page.findings if "<i>P</i> " in block.what]
    names = [row.what.rsplit(" ", 1)[-1] for row in rows]
    errors = [100 * float(row.estimate.stderr) / row.exact for row in rows]
    made, axes = plots.figure(3.0, 3.3, title="standard error, %", xscale="log")
    axes.barh(
        names, errors, color=[plots.BLUE, plots.GREEN, plots.ORANGE], height=0.6
    )
    for place, error in enumerate(errors):
        axes.text(error, place, f" {error:.2g}", va="center", fontsize=9.5)
    axes.set_xlim(min(errors) / 6, max(errors) * 3)
    axes.invert_yaxis()
    return (
        made,
        "Standard errors: uniform is worst, the lamp’s own density by far the best.",
    )
