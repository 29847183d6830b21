"""How a render's processor time grows: with samples and pixels as they do, with triangles hardly."""

from __future__ import annotations

import statistics
from pathlib import Path
from typing import Any

from beside import generated
from beside.options import CORNELL_BOX, Options
from beside.paired import Bar, slope
from beside.pool import Worker
from beside.renderers import OURS, Job
from beside.say import say
from beside.table import number, paragraph, table

TITLE = "Growth"
DEPTH = 8
SAMPLES = (8, 16, 32, 64, 128)
SIDES = (64, 128, 256, 512)
MOST_RUNS = 5
LABELS = {"samples": "samples per pixel", "pixels": "pixels", "triangles": "triangles"}


def measure(options: Options) -> dict[str, Any]:
    """Three series of renders; each series' renders take turns."""
    side = 32 if options.quick else 128
    sides = SIDES[:2] if options.quick else SIDES
    triangles = generated.GROWTH[:2] if options.quick else generated.GROWTH

    def job(scene: Path, side: int, spp: int) -> Job:
        return Job(scene, side, side, spp, DEPTH, None, options.threads)

    series = {
        "samples": [(spp, job(CORNELL_BOX, side, spp)) for spp in SAMPLES],
        "pixels": [(side * side, job(CORNELL_BOX, side, 16)) for side in sides],
        "triangles": [(count, job(generated.scene(count), side, 16)) for count in triangles],
    }
    runs = min(options.runs, MOST_RUNS)
    return {name: _series(name, jobs, runs) for name, jobs in series.items()}


def _series(name: str, jobs: list[tuple[int, Job]], runs: int) -> dict[str, Any]:
    say(f"growth: {LABELS[name]}")
    workers: list[Worker] = []
    try:
        for _, job in jobs:
            workers.append(Worker(OURS, job))
            workers[-1].render(0)
        rounds = [[worker.render(run).cpu or 0.0 for worker in workers] for run in range(1, runs + 1)]
    finally:
        for worker in workers:
            worker.close()
    x = [at for at, _ in jobs]
    y = [statistics.median(column) for column in zip(*rounds, strict=True)]
    return {"x": x, "cpu_seconds": y, "exponent": slope(x, y)}


def tables(found: dict[str, Any]) -> list[str]:
    """A row for each series."""
    rows = [
        [
            LABELS[name],
            f"{series['x'][0]:,} to {series['x'][-1]:,}",
            " ".join(number(seconds) for seconds in series["cpu_seconds"]),
            f"{series['exponent']:.3f}",
        ]
        for name, series in found.items()
    ]
    return [
        *paragraph(
            "Processor seconds of a render, and the exponent k of the fitted power law, seconds ∝ x^k: 1 is "
            "linear; a logarithm has 0.09 over four decades from 10³ on."
        ),
        *table(["with", "from", "seconds", "exponent"], rows),
        "",
    ]


def plot(found: dict[str, Any], path: Path) -> None:
    """Draws the series on logarithmic axes, with their exponents."""
    import matplotlib

    matplotlib.use("svg")
    from matplotlib import pyplot

    # Text stays text, and the same figures are the same file.
    pyplot.rcParams.update({"svg.fonttype": "none", "svg.hashsalt": "steradian", "font.size": 9})
    figure, axes = pyplot.subplots(1, len(found), figsize=(9, 2.8), layout="constrained")
    for axis, (name, series) in zip(axes, found.items(), strict=True):
        x, y = series["x"], series["cpu_seconds"]
        axis.loglog(x, y, "o-", color="#205080")
        if name != "triangles":
            axis.loglog(x, [y[0] * v / x[0] for v in x], ":", color="gray", label="linear")
            axis.legend(frameon=False)
        else:
            axis.set_ylim(min(y) / 3, max(y) * 3)
        axis.set_xlabel(LABELS[name])
        axis.set_title(f"∝ x^{series['exponent']:.2f}")
    axes[0].set_ylabel("processor seconds")
    figure.savefig(path, metadata={"Date": None})
    pyplot.close(figure)


def bars(found: dict[str, Any]) -> list[Bar]:
    """Linear within 5 %; triangles far from it."""
    out = [
        Bar(f"growth: exponent with {LABELS[name]}", found[name]["exponent"], 1.05, "at most")
        for name in ("samples", "pixels")
    ]
    exponent = found["triangles"]["exponent"]
    return [*out, Bar("growth: exponent with triangles, 10³ to 10⁷", exponent, 0.2, "at most")]
