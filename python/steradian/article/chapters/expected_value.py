"""Expected values, and why an estimate is right on average with any number of samples."""

from __future__ import annotations

import numpy as np

import steradian as sr
from steradian.article import plots
from steradian.article.chapter import Chapter

TITLE = "Expected value"


def expected_square(n: int, seed: int) -> sr.Estimate:
    """The mean of squared waiting times."""
    x = sr.Exponential(rate=1).draw(n, seed).value
    return sr.Estimate.of(x**2)


def four_at_a_time(repeats: int, seed: int) -> sr.Estimate:
    """Many answers, of four samples each."""
    x = sr.Uniform(0, np.pi).draw(4 * repeats, seed).value.reshape(repeats, 4)
    answers = (np.pi - 0) / 4 * np.sin(x).sum(axis=1)  # F₄, once in each row
    return sr.Estimate.of(answers)


def four_at_a_time_from_a_tent(repeats: int, seed: int) -> sr.Estimate:
    """The same with a density that favours the middle."""
    drawn = sr.Tent(0, np.pi / 2, np.pi).draw(4 * repeats, seed)
    quotients = np.sin(drawn.value) / drawn.pdf  # f(X) / P(X)
    return sr.Estimate.of(quotients.reshape(repeats, 4).mean(axis=1))


def tell(page: Chapter) -> None:
    """E[f(X)] by averaging, and E[F_n] = ∫ f for small n."""
    page.text("""
        The expected value of <i>f</i>(<i>X</i>) is the average of <i>f</i> over all places, each
        weighted by how likely it is:

        <span class="formula">E[<i>f</i>(<i>X</i>)] = ∫ <i>f</i>(<i>x</i>) <i>P</i>(<i>x</i>)
        d<i>x</i></span>

        Waiting times for a bus that comes at random follow <i>P</i>(<i>x</i>) = e<sup>−<i>x</i></sup>.
        The expected square of one is 2, and to measure it, one waits for many buses and averages.
    """)
    square = page.run(expected_square, n=page.n(1_000_000))
    page.measure(
        "E[<i>X</i>²], <i>P</i> = e<sup>−<i>x</i></sup>",
        square,
        2.0,
        claimed="∫ <i>f P</i> d<i>x</i>",
        formula="2",
    )
    page.text("""
        Read backwards this is a recipe for integrals: to get ∫<i>f</i>, average <i>f</i>/<i>P</i>, and
        the <i>P</i> cancels. The recipe is right on average with <em>any</em> number of samples. Four
        points give a poor answer, but the mean of many such poor answers is the integral; nothing is
        off in one direction. That is what <em>unbiased</em> means, and it is why images of few samples
        may be added up.
    """)
    repeats = page.n(400_000)
    page.measure(
        "mean of many <i>F</i>₄ for ∫ sin, uniform",
        page.run(four_at_a_time, repeats=repeats),
        2.0,
        claimed="∫ <i>f</i> d<i>x</i>",
        formula="2",
    )
    page.measure(
        "the same, <i>P</i> a tent",
        page.run(four_at_a_time_from_a_tent, repeats=repeats),
        2.0,
        claimed="∫ <i>f</i> d<i>x</i>",
        formula="2",
    )
    page.plot(
        _answers("uniform", sr.Uniform(0, np.pi), page.next_seed()),
        _answers("a tent", sr.Tent(0, np.pi / 2, np.pi), page.next_seed()),
        caption="How answers for ∫ sin <i>x</i> d<i>x</i> from 0 to π spread with one, four, sixteen "
        "and sixty-four samples. All have the same mean, 2; each step halves the width.",
    )


def _answers(name: str, density: sr.Distribution, seed: int) -> plots.Plot:
    made, axes = plots.figure(
        title=f"P = {name}",
        xlabel="answer",
        ylabel="density of answers",
        yscale="log",
        ylim=(0.1, 60),
    )
    colours = (plots.ORANGE, plots.PURPLE, plots.GREEN, plots.BLUE)
    for n, colour in zip((1, 4, 16, 64), colours, strict=True):
        drawn = density.draw(20_000 * n, seed + n)
        answers = (
            (np.sin(drawn.value) / drawn.pdf).reshape(20_000, n).mean(axis=1)
        )
        bins = np.linspace(0, np.pi, 91).tolist()
        axes.hist(
            answers,
            bins,
            density=True,
            histtype="step",
            color=colour,
            linewidth=1.4,
            label=f"n = {n}",
        )
    axes.axvline(2, color=plots.INK, linewidth=0.8, linestyle="--")
    axes.legend(loc="upper left")
    return (
        made,
        f"With P {name}, answers gather ever more closely around 2 as n grows.",
    )
