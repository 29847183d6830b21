"""Deliberate mistakes, each with the check that finds it."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

import steradian as sr
from steradian.article import plots
from steradian.article.chapter import Chapter

TITLE = "A gallery of mistakes"


class WrongDensity(sr.Distribution):
    """Samples go by the cosine, and are divided by another density."""

    dim, uniforms, space = 3, 2, "solid angle"

    def sample(self, u):
        """Directions by the cosine."""
        w = sr.CosineHemisphere().sample(u).value
        return sr.Samples(w, self.pdf(w))

    def pdf(self, x):
        """Of other directions."""
        return np.where(x[..., 2] > 0, 1 / (2 * np.pi), 0.0)


class ForgottenJacobian(sr.Distribution):
    """Even angles θ and φ, as if they made even directions."""

    dim, uniforms, space = 3, 2, "solid angle"

    def sample(self, u):
        """θ and φ, each uniform."""
        theta, phi = np.pi * u[:, 0], 2 * np.pi * u[:, 1]
        w = np.stack(
            [
                np.sin(theta) * np.cos(phi),
                np.sin(theta) * np.sin(phi),
                np.cos(theta),
            ],
            axis=1,
        )
        return sr.Samples(w, self.pdf(w))

    def pdf(self, x):
        """One over the area of the sphere."""
        return np.full(x.shape[:-1], 1 / (4 * np.pi))


class PdfOfTheWinner(sr.Distribution):
    """A mixture that divides by the density of the component that was drawn."""

    support = np.array([[0.0, 5.0]])

    def sample(self, u):
        """Half from everywhere, half from where the integrand is large."""
        everywhere, end = sr.Uniform(0, 5), sr.Uniform(3, 5)
        x = np.where(
            u < 0.5, everywhere.icdf((2 * u) % 1), end.icdf((2 * u) % 1)
        )
        return sr.Samples(x, np.where(u < 0.5, everywhere.pdf(x), end.pdf(x)))

    def pdf(self, x):
        """Of the whole mixture."""
        return 0.5 * sr.Uniform(0, 5).pdf(x) + 0.5 * sr.Uniform(3, 5).pdf(x)


def cosine_with_the_wrong_density(n: int, seed: int) -> sr.Estimate:
    """∫ cos θ over the hemisphere."""
    return sr.integrate(
        lambda w: w[:, 2],
        over=WrongDensity(),
        n=n,
        sequence="independent",
        seed=seed,
    )


def square_with_even_angles(n: int, seed: int) -> sr.Estimate:
    """∫ z² over the sphere."""
    return sr.integrate(
        lambda w: w[:, 2] ** 2,
        over=ForgottenJacobian(),
        n=n,
        sequence="independent",
        seed=seed,
    )


def line_with_the_winner(n: int, seed: int) -> sr.Estimate:
    """∫ 2x from 0 to 5."""
    return sr.integrate(
        lambda x: 2 * x,
        over=PdfOfTheWinner(),
        n=n,
        sequence="independent",
        seed=seed,
    )


def an_empty_bin(n: int, seed: int) -> sr.Estimate:
    """∫ 2x from 0 to 5, by a histogram of what was seen."""
    seen = sr.PiecewiseConstant(
        edges=[0, 1, 2, 3, 4, 5], counts=[3, 5, 0, 4, 2]
    )
    x, p = seen.draw(n, seed)
    return sr.Estimate.of(2 * x / p)


def the_empty_bin_checked() -> sr.Estimate:
    """The same, asked of the library."""
    seen = sr.PiecewiseConstant(
        edges=[0, 1, 2, 3, 4, 5], counts=[3, 5, 0, 4, 2]
    )
    return sr.integrate(lambda x: 2 * x, over=seen)


def weights_of_eleven_tenths(n: int, seed: int) -> sr.Estimate:
    """∫ 2x from 0 to 5, by two densities."""
    x = sr.Uniform(0, 5).draw(n, seed).value
    y = sr.Linear(0, 5).draw(n, seed + 1).value
    return sr.Estimate.of(
        0.5 * 2 * x / 0.2 + 0.6 * 2 * y / sr.Linear(0, 5).pdf(y)
    )


def naive_error_of_sobol_points(n: int, seed: int) -> sr.Estimate:
    """The formula for independent numbers, applied to numbers that are not."""
    x, p = sr.Uniform(0, 5).draw(n, seed, "sobol")
    return sr.Estimate.of(2 * x / p)


def tell(page: Chapter) -> None:
    """Seven ways to be wrong, and what says so."""
    page.text("""
        A wrong density does not crash, and it does not look noisy either. It gives a steady answer with
        a small error about the wrong number. So it is worth knowing what each mistake looks like, and
        which check finds it. Everything in this chapter is wrong on purpose.

        <code>sr.testing.chi2(p)</code> draws samples from a distribution, counts them in many cells,
        and compares each count with the integral of the density over the cell. It takes any
        distribution, also one that you wrote.
    """)
    n = page.n(1_000_000)
    _show(
        page,
        "Cosine samples, uniform density",
        """Directions follow the cosine, and are divided by 1/2π. The error bar is tiny, and the answer is a
        third too large.""",
        cosine_with_the_wrong_density,
        (WrongDensity,),
        math.pi,
        n,
        "sr.testing.chi2(WrongDensity()).check()",
        lambda: sr.testing.chi2(WrongDensity()).check(),
    )
    _show(
        page,
        "A forgotten Jacobian",
        """Even angles are not even directions: a step in φ is short near the poles. The factor sin θ between
        the two is missing.""",
        square_with_even_angles,
        (ForgottenJacobian,),
        4 * math.pi / 3,
        n,
        "sr.testing.chi2(ForgottenJacobian()).check()",
        lambda: sr.testing.chi2(ForgottenJacobian()).check(),
    )
    _show(
        page,
        "The density of the winner",
        """Half of the samples come from everywhere, half from the end where the integrand is large; and each
        is divided by the density of the component that drew it, instead of by that of the mixture. What
        only one of them can draw then counts but half.""",
        line_with_the_winner,
        (PdfOfTheWinner,),
        25.0,
        n,
        "sr.testing.chi2(PdfOfTheWinner()).check()",
        lambda: sr.testing.chi2(PdfOfTheWinner()).check(),
    )
    _show(
        page,
        "A hole in the support",
        """Nobody was counted between 2 and 3, so nothing is ever drawn there, and that part of the integral
        is missing. No sample can show it; the library looks into the holes that it knows of before it
        starts.""",
        an_empty_bin,
        (),
        25.0,
        n,
        "sr.integrate(lambda x: 2 * x, over=seen)",
        the_empty_bin_checked,
    )
    _show(
        page,
        "Weights that do not sum to 1",
        """Half of one density and six tenths of another: every sample counts a tenth too much.""",
        weights_of_eleven_tenths,
        (),
        25.0,
        n,
        "sr.Mixture([sr.Uniform(0, 5), sr.Linear(0, 5)], weights=[0.5, 0.6])",
        lambda: sr.Mixture(
            [sr.Uniform(0, 5), sr.Linear(0, 5)], weights=[0.5, 0.6]
        ),
    )
    _not_a_number(page)
    _naive_errors(page)


def _show(
    page: Chapter,
    what: str,
    words: str,
    function: Callable[..., sr.Estimate],
    helpers: tuple[Callable[..., object], ...],
    exact: float,
    n: int,
    check: str,
    test: Callable[[], object],
) -> None:
    """One mistake: what it is, the code, the wrong answer, and what finds it."""
    page.text(f"<h3>{what}</h3>\n\n{words}")
    answer = page.run(function, *helpers, n=n)
    page.mistake(what, answer, exact, check, test)


def _not_a_number(page: Chapter) -> None:
    page.text("""
        <h3>Something that is not a number</h3>

        One undefined value among a million, and their mean is gone; skip it silently, and the answer is off.
        The library stops and says where, or, asked with <code>nan="zero"</code>, counts.
    """)
    page.mistake(
        "a value that is not a number",
        None,
        math.nan,
        "sr.integrate(lambda x: np.log(x - 1), over=sr.Uniform(0, 5))",
        _logarithm_of_negatives,
    )


def _logarithm_of_negatives() -> sr.Estimate:
    with np.errstate(invalid="ignore"):
        return sr.integrate(lambda x: np.log(x - 1), over=sr.Uniform(0, 5))


def _naive_errors(page: Chapter) -> None:
    page.text("""
        <h3>Error bars for points that are not independent</h3>

        Sobol’ points keep out of one another’s way, and that is why they do better than independent
        ones. The formula σ/√<i>n</i> knows nothing of it, and overstates their error, here a
        thousandfold; with other points it may as well understate it. An honest error comes from
        independent scramblings of the points, and that is what <code>sr.integrate</code> returns.
    """)
    n = 4096
    naive = page.run(naive_error_of_sobol_points, n=n)
    claimed = float(naive.stderr)
    answers = [
        float(naive_error_of_sobol_points(n, page.next_seed()))
        for _ in range(16 if page.quick else 64)
    ]
    honest = sr.integrate(
        lambda x: 2 * x,
        over=sr.Uniform(0, 5),
        n=32 * n,
        replicates=32,
        seed=page.next_seed(),
    )
    one = float(honest.stderr) * math.sqrt(
        32
    )  # of one replicate, not of the mean of all
    page.mistake(
        "σ/√n for Sobol’ points",
        naive,
        25.0,
        "sr.integrate(f, over, replicates=32).stderr",
        lambda: _compare(claimed, one),
    )
    page.plot(
        _claims(claimed, float(np.std(answers, ddof=1)), one),
        caption=f"Three errors of ∫₀⁵ 2<i>x</i> d<i>x</i> from {n:,} Sobol’ points.",
    )


def _compare(claimed: float, honest: float) -> None:
    """Raises AssertionError if two errors of the same estimate disagree by more than a factor of two."""
    if not 0.5 < claimed / honest < 2:
        raise AssertionError(
            f"the formula says {claimed:.2g}, 32 scramblings differ by {honest:.2g}"
        )


def _claims(claimed: float, real: float, honest: float) -> plots.Plot:
    made, axes = plots.figure(6.0, 2.1, xscale="log", xlabel="standard error")
    names = ["σ/√n", "real spread", "sr.integrate"]
    axes.barh(
        names,
        [claimed, real, honest],
        color=[plots.ORANGE, plots.BLUE, plots.GREEN],
        height=0.6,
    )
    axes.set_xlim(min(real, honest) / 10, claimed * 10)
    axes.invert_yaxis()
    return (
        made,
        f"The formula says {claimed:.2g}, the real spread is {real:.2g}, replicates say {honest:.2g}.",
    )
