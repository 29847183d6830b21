"""Runs the race and writes the page; started by ``benches/integrals.py`` in its environment."""

from __future__ import annotations

import datetime
import os
import platform
import statistics
import sys
from pathlib import Path

import vegas

import steradian
from beside.paired import Bar, geometric_mean
from beside.table import paragraph, table
from integrals.families import TWO_PEAKS, Case, cases
from integrals.native import rates
from integrals.race import GOALS, Track, race

RATIO_OF_MEANS, RATIO_OF_EACH, RATIO_OF_PEAKS, RATIO_OF_RATES = 0.5, 1.2, 0.2, 20.0


def main() -> int:
    """1 if a bar is missed."""
    seeds, draws, output = int(sys.argv[1]), int(sys.argv[2]), sys.argv[3]
    raced: list[tuple[Case, dict[str, Track]]] = []
    for case in cases(draws):
        print(f"benches: {case.name}", file=sys.stderr, flush=True)
        raced.append((case, race(case, seeds)))
    rows, ratios = [], {}
    for goal in GOALS:
        for number, (case, tracks) in enumerate(raced):
            own, reached = tracks["ours"].time_to(goal)
            theirs = min(
                (tracks[name].time_to(goal) for name in ("warmed", "plain")), key=lambda t: (not t[1], t[0])
            )
            ratio = own / theirs[0] if reached else float("inf")
            ratios[goal, number] = ratio
            shown = f"{1e3 * theirs[0]:.1f}" if theirs[1] else f"over {1e3 * theirs[0]:.0f}"
            rows.append([case.name, f"{goal:g}", f"{1e3 * own:.1f}", shown, f"{ratio:.3f}"])
    speeds = rates(max(3, seeds // 2))
    families = [ratio for (_, i), ratio in ratios.items() if raced[i][0].name != TWO_PEAKS]
    peaks = [ratio for (_, i), ratio in ratios.items() if raced[i][0].name == TWO_PEAKS]
    bars = [
        Bar(
            "time over vegas's, geometric mean",
            geometric_mean([*families, *peaks]),
            RATIO_OF_MEANS,
            "at most",
        ),
        Bar("time over vegas's, the worst", max(families), RATIO_OF_EACH, "at most"),
        Bar("time over vegas's, two peaks", max(peaks), RATIO_OF_PEAKS, "at most"),
    ]
    rate_rows = []
    for name, pairs in speeds.items():
        own, theirs = (statistics.median(values) for values in zip(*pairs, strict=True))
        ratio = statistics.median(a / b for a, b in pairs)
        rate_rows.append([name, f"{own:.0f}", f"{theirs:.2f}", f"{ratio:.1f}"])
        bars.append(Bar(f"evaluations a second over vegas's, {name}", ratio, RATIO_OF_RATES, "at least"))
    text = "\n".join(page(rows, rate_rows, bars, seeds)) + "\n"
    print(text)
    if output:
        Path(output).write_text(text, encoding="utf-8")
    return 0 if all(bar.passed for bar in bars) else 1


def page(rows: list[list[str]], rate_rows: list[list[str]], bars: list[Bar], seeds: int) -> list[str]:
    """Lines of Markdown."""
    now = datetime.datetime.now(datetime.UTC).strftime("%Y-%m-%d %H:%M UTC")
    return [
        "# Integrals beside vegas",
        "",
        *paragraph("Written by `python3 benches/integrals.py`; `--help` says how it measures."),
        *paragraph(
            f"Steradian {steradian.__version__}, vegas {vegas.__version__}; {platform.machine()}, "
            f"{os.cpu_count()} cores, load {os.getloadavg()[0]:.1f} at the end; {now}; {seeds} seeds."
        ),
        "## Verdicts",
        "",
        *table(
            ["bar", "measured", "asked", ""],
            [
                [
                    bar.name,
                    f"{bar.measured:.3g}",
                    f"{bar.sense} {bar.bound:g}",
                    "kept" if bar.passed else "**missed**",
                ]
                for bar in bars
            ],
        ),
        "",
        "## Time to a relative error",
        "",
        *paragraph(
            "Milliseconds; the same NumPy integrand, five dimensions. *Ratio*: ours over vegas's; below 1, "
            "we are faster."
        ),
        *table(["integrand", "error", "ours", "vegas", "ratio"], rows),
        "",
        "## Evaluations a second",
        "",
        *paragraph(
            "Millions: a native integrand (Numba) of ours on all cores, Sobol' points; vegas with the same "
            "in NumPy."
        ),
        *table(["integrand", "ours", "vegas", "ratio"], rate_rows),
    ]


if __name__ == "__main__":
    sys.exit(main())
