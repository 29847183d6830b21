"""Functions over the sphere with P = 1/4π."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

import steradian as sr
from steradian.article import plots
from steradian.article.chapter import Chapter

TITLE = "Over the sphere"


def area_of_the_sphere(n: int, seed: int) -> sr.Estimate:
    """The integral of 1."""
    return sr.integrate(
        lambda w: np.ones(len(w)),
        over=sr.UniformSphere(),
        n=n,
        sequence="independent",
        seed=seed,
    )


def by_angles(n: int, seed: int) -> sr.Estimate:
    """x², from angles."""
    u = sr.Uniform([0, 0], [1, 1]).draw(n, seed).value
    # cos θ is uniform: bands of equal height have equal area.
    theta = np.arccos(1 - 2 * u[:, 0])
    phi = 2 * np.pi * u[:, 1]
    f = (np.sin(theta) * np.cos(phi)) ** 2  # x²
    p = 1 / (4 * np.pi)
    return sr.Estimate.of(f / p)


def by_directions(n: int, seed: int) -> sr.Estimate:
    """exp z, from directions."""
    return sr.integrate(
        lambda w: np.exp(w[:, 2]),
        over=sr.UniformSphere(),
        n=n,
        sequence="independent",
        seed=seed,
    )


def tell(page: Chapter) -> None:
    """1, x² and exp z over all directions."""
    page.text("""
        Directions are points of the unit sphere, and its area is 4π. If every direction is equally
        likely, the density is 1/4π <em>per steradian</em>, the unit of area on that sphere (and this
        project’s name). Integrating 1 gives the area itself, without any variance:
    """)
    page.measure(
        "∫ 1 dω",
        page.run(area_of_the_sphere, n=10_000),
        4 * math.pi,
        claimed="4π",
        formula="4π",
        exactly=True,
    )
    page.text("""
        How does one pick a direction evenly? Not by picking both angles evenly: circles of latitude
        shrink towards the poles, and directions would crowd there. Slices of a sphere of equal
        <em>height</em> have equal area, as Archimedes knew, so it is cos θ that has to be uniform.
    """)
    n = page.n(1_000_000)
    squares = page.run(by_angles, n=n)
    page.measure(
        "∫ <i>x</i>² dω, <i>P</i> = 1/4π",
        squares,
        4 * math.pi / 3,
        claimed="<i>P</i> = 1/4π",
        formula="4π/3",
    )
    peak = page.run(by_directions, n=n)
    page.measure(
        "∫ e<sup><i>z</i></sup> dω, <i>P</i> = 1/4π",
        peak,
        4 * math.pi * math.sinh(1),
        claimed="<i>P</i> = 1/4π",
        formula="4π sinh 1",
    )
    seed = page.next_seed()
    page.plot(
        _from_above("cos θ uniform: even", np.arccos, seed),
        _from_above("θ uniform: crowded", lambda z: np.pi * (1 - z) / 2, seed),
        caption="The upper hemisphere from above, 800 directions on each: they thin out towards the middle,"
        " where the surface "
        "faces us, only if they are even. Taking θ itself uniform crowds the pole.",
    )


def _from_above(
    title: str, theta_of: Callable[..., Any], seed: int
) -> plots.Plot:
    u = sr.Uniform([-1, 0], [1, 1]).draw(1600, seed).value
    theta, phi = theta_of(u[:, 0]), 2 * np.pi * u[:, 1]
    up = theta < np.pi / 2
    made, axes = plots.disk(title)
    axes.scatter(
        np.sin(theta[up]) * np.cos(phi[up]),
        np.sin(theta[up]) * np.sin(phi[up]),
        s=6,
        color=plots.BLUE,
        linewidths=0,
    )
    return made, f"Directions on the upper hemisphere; {title}."
