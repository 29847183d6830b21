"""π from points that are thrown at a square."""

from __future__ import annotations

import math

import numpy as np

import steradian as sr
from steradian.article import plots
from steradian.article.chapter import Chapter

TITLE = "π from thrown points"


def pi_from_points(n: int, seed: int) -> sr.Estimate:
    """The integral of 1 inside the circle, and 0 outside."""
    square = [(-1, 1), (-1, 1)]
    return sr.integrate(
        lambda p: p[:, 0] ** 2 + p[:, 1] ** 2 <= 1,
        over=square,
        n=n,
        sequence="independent",
        seed=seed,
    )


def slope_of_the_error(groups: int, seed: int) -> sr.Estimate:
    """The slope of log error against log n, in groups."""
    square = sr.Uniform([-1, -1], [1, 1])
    counts = [2**k for k in range(4, 15)]
    slopes = []
    for group in range(groups):
        errors = []
        for n in counts:
            p = square.draw(32 * n, seed=seed + 100_000 * group + n).value
            inside = (p**2).sum(axis=1) <= 1
            answers = 4 * inside.reshape(32, n).mean(axis=1)
            errors.append(np.sqrt(np.mean((answers - np.pi) ** 2)))
        slopes.append(np.polyfit(np.log(counts), np.log(errors), 1)[0])
    return sr.Estimate.of(slopes)


def tell(page: Chapter) -> None:
    """How many points are in the circle, and how the error falls."""
    page.text("""
        Throw points at a square, blindly. The circle that just fits into it covers π/4 of its area, so
        that is the share of points that should end up inside. Count them, multiply by four, and there
        is π: not exactly, but as nearly as there are points.

        Said as an integral: a function is 1 inside the circle and 0 outside, and its integral over the
        square of area 4 is π. Nothing below is more than this idea, with better functions and better
        points.
    """)
    estimate = page.run(pi_from_points, n=page.n(10_000_000))
    page.measure(
        "π from points", estimate, math.pi, claimed="tends to π", formula="π"
    )
    page.text("""
        How good is it? One point says little: inside or outside. The mean of <i>N</i> independent ones
        has an error that falls as 1/√<i>N</i>, whatever is integrated, in any number of dimensions:
        four times the points for half of the error. On a plot with logarithmic axes that is a line of
        slope −½, and its slope can be measured.
    """)
    slope = page.run(slope_of_the_error, groups=6 if page.quick else 24)
    page.measure(
        "slope of error against <i>N</i>",
        slope,
        -0.5,
        claimed="better with more",
        formula="−½",
    )
    page.plot(
        _thrown(page.next_seed()),
        _error_against_points(page.next_seed(), page.quick),
        caption="First: a thousand points. Second: the error of π against the number of points. Independent"
        " points keep to the "
        "line; Sobol’ points, which fill the square evenly, leave it behind, and their error is "
        "measured as "
        "well, from independent scramblings.",
    )


def _thrown(seed: int) -> plots.Plot:
    p = sr.Uniform([-1, -1], [1, 1]).draw(1000, seed).value
    inside = (p**2).sum(axis=1) <= 1
    made, axes = plots.figure(
        3.4, 3.4, aspect="equal", title=f"{inside.sum()} of 1,000 inside"
    )
    for chosen, colour in ((inside, plots.BLUE), (~inside, plots.ORANGE)):
        axes.scatter(
            p[chosen, 0], p[chosen, 1], s=5, color=colour, linewidths=0
        )
    turn = np.linspace(0, 2 * np.pi, 200)
    axes.plot(np.cos(turn), np.sin(turn), color=plots.INK, linewidth=1)
    axes.set(
        xticks=[-1, 0, 1],
        yticks=[-1, 0, 1],
        xlim=(-1.02, 1.02),
        ylim=(-1.02, 1.02),
    )
    return (
        made,
        "Points in a square; those inside the circle are blue, the others orange.",
    )


def _error_against_points(seed: int, quick: bool) -> plots.Plot:
    counts = 2 ** np.arange(8, 15 if quick else 21, 2)
    made, axes = plots.figure(
        4.3,
        3.4,
        xscale="log",
        yscale="log",
        xlabel="points N",
        ylabel="error of π",
    )
    for sequence, colour in (
        ("independent", plots.BLUE),
        ("sobol", plots.GREEN),
    ):
        errors = []
        for n in counts:
            answer = sr.integrate(
                lambda p: (p**2).sum(axis=1) <= 1,
                over=[(-1, 1), (-1, 1)],
                n=int(n),
                sequence=sequence,
                seed=seed,
            )
            errors.append(float(answer.stderr))
        label = {"independent": "independent", "sobol": "Sobol’"}[sequence]
        axes.plot(counts, errors, "o-", color=colour, markersize=4, label=label)
    axes.plot(
        counts,
        1.64 / np.sqrt(counts),
        "--",
        color=plots.INK,
        linewidth=1,
        label="1.64 / √N",
    )
    axes.legend(loc="lower left")
    return (
        made,
        "The error of independent points falls as one over the square root of their number; that of"
        " Sobol’ points faster.",
    )
