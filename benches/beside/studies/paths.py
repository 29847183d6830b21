"""Paths per second of whole renders, renderers in turn.

Equal in all: geometry, materials, light, camera, pixels, depth, box filter or none, threads; light and BSDF
sampling under multiple importance sampling; no clamping, no denoiser, no adaptive sampling. The mean of
every image is compared with ours: a renderer that did other work shows there.
"""

from __future__ import annotations

import statistics
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from beside import generated, machine
from beside.options import CORNELL_BOX, Options
from beside.paired import Bar, geometric_mean, ratio
from beside.pool import Worker, WorkerFailed
from beside.renderers import ALL, OURS, Job, Timed
from beside.say import say
from beside.table import number, paragraph, table

TITLE = "Paths per second"
DEPTH = 8
PIXELS = 1 << 17
SLOW = ("mitsuba-scalar", "luxcore", "cycles", "pbrt")
"""These get a quarter of the samples; rates are per path."""
FOREIGN = ("veach-mis", "veach-ajar", "living-room", "staircase")
"""Scenes that others made; only for who reads Mitsuba's files."""
SAME_MEAN = 0.05
"""Images whose means (over all runs) differ by more, relatively, are not the same work."""


@dataclass(frozen=True)
class Case:
    """A scene to render; ``plain``: all renderers can have it."""

    name: str
    scene: Path
    roulette: int | None
    spp: int
    plain: bool


def cases(options: Options) -> tuple[list[Case], list[str]]:
    """The scenes that are there, and the names of those that are not."""
    million = generated.scene(10_000 if options.quick else 1_000_000)
    out = [
        Case("cornell-box", CORNELL_BOX, None, 32, True),
        Case("million-triangles", million, None, 8, True),
    ]
    missing = []
    for name in FOREIGN:
        path = options.scenes / name / "scene.xml"
        if path.exists():
            out.append(Case(name, path, 5, 8, False))
        else:
            missing.append(name)
    out += [Case(_title(path), path, 5, 8, False) for path in options.also]
    return out, missing


def _title(path: Path) -> str:
    """Scenes of others are mostly called ``scene.xml``, in a folder with their name."""
    return path.resolve().parent.name if path.stem == "scene" else path.stem


def measure(options: Options) -> dict[str, Any]:
    """Every renderer on every scene that it can have."""
    chosen, missing = cases(options)
    scenes = []
    for case in chosen:
        names = [name for name in options.renderers if case.plain or not ALL[name].plain]
        scenes.append(_measure_scene(case, names, options))
    return {"depth": DEPTH, "threads": options.threads, "missing_scenes": missing, "scenes": scenes}


def _measure_scene(case: Case, names: list[str], options: Options) -> dict[str, Any]:
    width, height = (64, 64) if options.quick else _size(case, options)
    job = Job(
        case.scene, width, height, 4 if options.quick else case.spp, DEPTH, case.roulette, options.threads
    )
    before = machine.load()
    workers, failed = [], {}
    try:
        for name in names:
            say(f"paths: {case.name}: {ALL[name].label} loads")
            few = replace(job, spp=max(1, job.spp // 4)) if name in SLOW else job
            try:
                workers.append(Worker(name, few))
                workers[-1].render(0)  # warm up: threads, caches, compiled kernels
            except WorkerFailed as error:
                failed[name] = str(error)
        workers = [worker for worker in workers if worker.name not in failed]
        times: dict[str, list[Timed]] = {worker.name: [] for worker in workers}
        means: dict[str, list[list[float]]] = {worker.name: [] for worker in workers}
        for run in range(1, options.runs + 1):
            say(f"paths: {case.name}: run {run} of {options.runs}")
            for worker in workers:
                times[worker.name].append(worker.render(run))
                means[worker.name].append(worker.mean())
        rows = {worker.name: _row(worker, times[worker.name], means[worker.name]) for worker in workers}
    finally:
        for worker in workers:
            worker.close()
    ours = rows[OURS]
    for row in rows.values():
        row["ratio"] = ratio(row["wall_per_path"], ours["wall_per_path"])
        row["cpu_ratio"] = ratio(row["cpu_per_path"], ours["cpu_per_path"]) if row["cpu_per_path"] else None
        row["mean_over_ours"] = sum(row["mean"]) / sum(ours["mean"])
    return {
        "scene": case.name,
        "size": [width, height],
        "spp": job.spp,
        "roulette": case.roulette,
        "load": [before, machine.load()],
        "failed": failed,
        "renderers": rows,
    }


def _size(case: Case, options: Options) -> tuple[int, int]:
    """The scene's own proportions with about ``PIXELS`` pixels."""
    import steradian as sr

    settings = sr.load(case.scene, threads=options.threads).settings
    scale = float((PIXELS / (settings.width * settings.height)) ** 0.5)
    return max(1, round(settings.width * scale)), max(1, round(settings.height * scale))


def _row(worker: Worker, times: list[Timed], means: list[list[float]]) -> dict[str, Any]:
    peak = worker.finish()
    paths = worker.job.paths
    cpu = [timed.cpu for timed in times if timed.cpu is not None]
    return {
        "version": worker.version,
        "load_seconds": worker.load_seconds,
        "wall_per_path": [timed.wall / paths for timed in times],
        "cpu_per_path": [seconds / paths for seconds in cpu] if cpu else None,
        "mpaths_per_second": paths / statistics.median(timed.wall for timed in times) / 1e6,
        "peak_mib": peak,
        "mean": [statistics.mean(channel) for channel in zip(*means, strict=True)],
    }


def tables(found: dict[str, Any]) -> list[str]:
    """A table for each scene."""
    lines = [
        *paragraph(
            f"Million paths a second at depth {found['depth']}, {found['threads']} threads, light and BSDF "
            "sampling; medians of runs in turn. *Ratio*: the median over runs of their time to ours, by the "
            "clock and by processor time; above 1, we are faster. *Mean*: of their images over ours."
        ),
    ]
    for scene in found["scenes"]:
        width, height = scene["size"]
        roulette = "none" if scene["roulette"] is None else f"from edge {scene['roulette']}"
        lines += [
            *paragraph(
                f"**{scene['scene']}**, {width} × {height}, {scene['spp']} samples per pixel, Russian "
                f"roulette: {roulette}; load of the machine {_load(scene['load'])}"
            ),
            *table(
                ["renderer", "Mpaths/s", "ratio", "CPU ratio", "mean", "load, s", "peak MiB"],
                [_cells(name, row) for name, row in scene["renderers"].items()],
            ),
            "",
        ]
        lines += [f"{ALL[name].label} failed: {why}" for name, why in scene["failed"].items()]
    if found["missing_scenes"]:
        lines += [f"Not there: {', '.join(found['missing_scenes'])} (name their folder with `--scenes`).", ""]
    return lines


def _load(pair: list[float | None]) -> str:
    return " to ".join("unknown" if value is None else f"{value:.1f}" for value in pair)


def _cells(name: str, row: dict[str, Any]) -> list[str]:
    ours = name == OURS
    return [
        f"{ALL[name].label} {row['version']}",
        number(row["mpaths_per_second"]),
        "1" if ours else number(row["ratio"]),
        "1" if ours else number(row["cpu_ratio"]),
        "1" if ours else f"{row['mean_over_ours']:.3f}",
        number(row["load_seconds"]),
        number(row["peak_mib"]),
    ]


def bars(found: dict[str, Any]) -> list[Bar]:
    """Ahead of the fastest peer on every scene, and more so on average; all on the same work."""
    out, ratios = [], []
    for scene in found["scenes"]:
        peers = {name: row for name, row in scene["renderers"].items() if name != OURS}
        if not peers:
            continue
        least = min(row["ratio"] for row in peers.values())
        ratios.append(least)
        out.append(Bar(f"paths: {scene['scene']}, ratio to the fastest peer", least, 1.2, "at least"))
        off = max(abs(row["mean_over_ours"] - 1.0) for row in peers.values())
        out.append(Bar(f"paths: {scene['scene']}, difference of means", off, SAME_MEAN, "at most"))
    if ratios:
        mean = geometric_mean(ratios)
        out.append(Bar("paths: geometric mean of the ratios", mean, 1.5, "at least"))
    return out
