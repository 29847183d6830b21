"""Counts, their density, its integral, and that integral run backwards."""

from __future__ import annotations

import numpy as np

import steradian as sr
from steradian.article import plots
from steradian.article.chapter import Chapter

TITLE = "From counts to samples"

EDGES = [0.0, 0.5, 1.0, 2.0, 3.5, 4.0, 6.0]
COUNTS = [4, 9, 16, 12, 7, 2]


def share_between(low: float, high: float, n: int, seed: int) -> sr.Estimate:
    """How many samples land in an interval."""
    data = sr.PiecewiseConstant(
        edges=[0, 0.5, 1, 2, 3.5, 4, 6], counts=[4, 9, 16, 12, 7, 2]
    )
    x = data.draw(n, seed).value
    return sr.Estimate.of((low <= x) & (x < high))


def mean_of_samples(n: int, seed: int) -> sr.Estimate:
    """Where they land on average."""
    data = sr.PiecewiseConstant(
        edges=[0, 0.5, 1, 2, 3.5, 4, 6], counts=[4, 9, 16, 12, 7, 2]
    )
    return sr.Estimate.of(data.draw(n, seed).value)


def by_hand(n: int, seed: int) -> sr.Estimate:
    """The same samples, without the library; the difference."""
    edges = np.array([0, 0.5, 1, 2, 3.5, 4, 6])
    counts = np.array([4, 9, 16, 12, 7, 2])
    # The share of each bin, per unit of width.
    density = counts / counts.sum() / np.diff(edges)
    cdf = np.concatenate([[0], np.cumsum(density * np.diff(edges))])
    u = sr.Uniform().draw(n, seed).value
    # The cdf is made of straight pieces; here they run backwards.
    x = np.interp(u, cdf, edges)
    return sr.Estimate.of(x - sr.PiecewiseConstant(edges, counts).icdf(u))


def there_and_back(n: int, seed: int) -> sr.Estimate:
    """How far a value moves."""
    data = sr.PiecewiseConstant(
        edges=[0, 0.5, 1, 2, 3.5, 4, 6], counts=[4, 9, 16, 12, 7, 2]
    )
    x = data.draw(n, seed).value
    return sr.Estimate.of(data.icdf(data.cdf(x)) - x)


def tell(page: Chapter) -> None:
    """The article's bins, with unequal widths."""
    page.text("""
        Somebody measured something fifty times and sorted the values into six bins of unequal widths. A
        wide bin catches more only because it is wide, so counts say little about places. Divide each
        bin’s share of all by its width, and what is left is a <em>density</em>: probability per unit of
        length. Its area is 1, whatever the bins are. As there are more and narrower bins, the steps
        turn into a curve.

        A density answers questions about intervals: the probability of one is the area above it. A
        single point has none. The area up to <i>x</i> is the cumulative distribution
        <i>C</i>(<i>x</i>), which climbs from 0 to 1; where the density is high, it is steep.
    """)
    page.plot(
        _counts(),
        _density(),
        _more_bins(),
        caption="Counts, and the density they make. Dashed: the mean. Below, "
        "the same done to a known curve with more and more bins.",
    )
    page.text("""
        Now turn the plot of <i>C</i> on its side. Choose a height between 0 and 1 blindly, walk across
        to the curve, and drop down: where the curve is steep, many heights land in a short stretch. So
        a uniform number becomes a sample of the density. That is all there is to inverting a cdf, and
        nearly every sampler in a renderer is made this way.
    """)
    page.plot(
        _cdf(),
        _landing(page.next_seed()),
        caption="First: twenty even heights go across to the curve and land. Second: 5,000 "
        "samples that landed, as a histogram over the density.",
    )
    n = page.n(1_000_000)
    share = page.run(share_between, low=1, high=3.5, n=n)
    page.measure(
        "probability of 1 ≤ <i>x</i> &lt; 3.5",
        share,
        28 / 50,
        claimed="area under <i>P</i>",
        formula="28/50",
    )
    mean = page.run(mean_of_samples, n=n)
    middles, counts = (np.array(EDGES[1:]) + EDGES[:-1]) / 2, np.array(COUNTS)
    page.measure(
        "mean of samples",
        mean,
        float(middles @ counts / 50),
        formula="Σ share × middle",
    )
    page.text(
        "By hand it takes five lines, and the result is the same to the last digits:"
    )
    page.measure(
        "difference to NumPy by hand",
        page.run(by_hand, n=1000),
        0.0,
        formula="0",
        exactly=True,
    )
    page.measure(
        "<i>I</i>(<i>C</i>(<i>x</i>)) − <i>x</i>",
        page.run(there_and_back, n=1000),
        0.0,
        claimed="<i>I</i> undoes <i>C</i>",
        formula="0",
        exactly=True,
    )


def _data() -> sr.PiecewiseConstant:
    return sr.PiecewiseConstant(EDGES, COUNTS)


def _counts() -> plots.Plot:
    made, axes = plots.figure(title="counts", xlabel="x", ylabel="how many")
    axes.bar(
        EDGES[:-1],
        COUNTS,
        np.diff(EDGES),
        align="edge",
        color=plots.ORANGE,
        edgecolor=plots.INK,
        linewidth=0.8,
    )
    for low, high, count in zip(EDGES[:-1], EDGES[1:], COUNTS, strict=True):
        axes.text(
            (low + high) / 2, count + 0.3, str(count), ha="center", fontsize=9.5
        )
    axes.set_ylim(0, 18.5)
    return made, "Bars of the counts in six bins of unequal widths."


def _density() -> plots.Plot:
    data = _data()
    middles = (np.array(EDGES[1:]) + EDGES[:-1]) / 2
    made, axes = plots.figure(
        title="density: share / width", xlabel="x", ylabel="P(x)"
    )
    axes.bar(
        EDGES[:-1],
        data.pdf(middles),
        np.diff(EDGES),
        align="edge",
        color=plots.BLUE,
        edgecolor=plots.INK,
        linewidth=0.8,
    )
    axes.axvline(
        float(np.asarray(data.mean)),
        color=plots.INK,
        linestyle="--",
        linewidth=1,
    )
    return (
        made,
        "The density: the tallest bar of the counts is not the tallest any more.",
    )


def _more_bins() -> plots.Plot:
    curve = sr.Normal(0, 1)
    x = curve.draw(200_000, 7).value
    made, axes = plots.figure(
        5.4,
        2.9,
        title="200,000 values in ever narrower bins",
        xlabel="x",
        ylabel="share / width",
    )
    for bins, colour in (
        (6, plots.ORANGE),
        (16, plots.GREEN),
        (60, plots.BLUE),
    ):
        edges = np.linspace(-3.5, 3.5, bins + 1)
        counts, _ = np.histogram(x, edges)
        axes.stairs(
            counts / len(x) / np.diff(edges),
            edges,
            color=colour,
            linewidth=1.5,
            label=f"{bins} bins",
        )
    fine = np.linspace(-3.5, 3.5, 200)
    axes.plot(
        fine, curve.pdf(fine), color=plots.INK, linewidth=0.8, label="limit"
    )
    axes.legend()
    return (
        made,
        "Histograms with 6, 16 and 60 bins come ever nearer to the curve.",
    )


def _cdf() -> plots.Plot:
    data = _data()
    made, axes = plots.figure(
        title="C(x), and heights that land",
        xlabel="x",
        ylabel="u",
        ylim=(0, 1.02),
        xlim=(0, 6),
    )
    x = np.linspace(0, 6, 241)
    for u in (np.arange(20) + 0.5) / 20:
        at = float(data.icdf(u))
        axes.plot([0, at, at], [u, u, 0], color=plots.ORANGE, linewidth=0.8)
    axes.plot(x, data.cdf(x), color=plots.BLUE)
    return (
        made,
        "The cumulative distribution rises from 0 to 1; even heights land densely where it is steep.",
    )


def _landing(seed: int) -> plots.Plot:
    data = _data()
    x = data.draw(5000, seed).value
    made, axes = plots.figure(
        title="where they landed", xlabel="x", ylabel="P(x)", xlim=(0, 6)
    )
    axes.hist(
        x,
        np.linspace(0, 6, 49).tolist(),
        density=True,
        color=plots.ORANGE,
        alpha=0.55,
        label="samples",
    )
    axes.stairs(
        data.pdf((np.array(EDGES[1:]) + EDGES[:-1]) / 2),
        EDGES,
        color=plots.BLUE,
        linewidth=1.8,
        label="P(x)",
    )
    axes.legend()
    return made, "The histogram of samples follows the density."
