"""Ten million triangles at 1920 × 1080: seconds to one sample per pixel, and the most memory."""

from __future__ import annotations

import statistics
import time
from typing import Any

from beside import generated
from beside.options import Options
from beside.paired import Bar
from beside.pool import Worker, WorkerFailed
from beside.renderers import ALL, OURS, Job
from beside.say import say
from beside.table import number, paragraph, table

TITLE = "Ten million triangles"
TRIANGLES = 10_000_000
DEPTH = 8
RENDERERS = (OURS, "mitsuba-llvm")
MOST_RUNS = 3


def measure(options: Options) -> dict[str, Any]:
    """Ours and Mitsuba's, in turn; the mesh is smooth, so that loading works out vertex normals."""
    say("large: making the mesh, the first time")
    scene = generated.scene(100_000 if options.quick else TRIANGLES, smooth=True)
    size = (192, 108) if options.quick else (1920, 1080)
    found: dict[str, Any] = {}
    failed = {}
    for run in range(min(options.runs, MOST_RUNS)):
        for name in (name for name in RENDERERS if name in options.renderers and name not in failed):
            say(f"large: {ALL[name].label}, run {run + 1}")
            start = time.perf_counter()
            try:
                with Worker(name, Job(scene, *size, 1, DEPTH, None, options.threads)) as worker:
                    render = worker.render(0).wall
                    total = time.perf_counter() - start
                    peak = worker.finish()
            except WorkerFailed as error:
                failed[name] = str(error)
                continue
            rows = found.setdefault(name, {"load": [], "render": [], "total": [], "peak_mib": []})
            measured = (worker.load_seconds, render, total, peak)
            for key, value in zip(("load", "render", "total", "peak_mib"), measured, strict=True):
                rows[key].append(value)
    return {"size": size, "depth": DEPTH, "threads": options.threads, "renderers": found, "failed": failed}


def tables(found: dict[str, Any]) -> list[str]:
    """One row a renderer."""
    width, height = found["size"]
    rows = [
        [
            ALL[name].label,
            *(number(statistics.median(row[key])) for key in ("load", "render", "total", "peak_mib")),
        ]
        for name, row in found["renderers"].items()
    ]
    return [
        *paragraph(
            f"{width} × {height} pixels, one sample each, depth {found['depth']}, {found['threads']} "
            "threads; seconds, medians. *Load* is reading the PLY file, vertex normals and building the "
            "tree; *total* is from the start of the process."
        ),
        *table(["renderer", "load", "render", "total", "peak MiB"], rows),
        "",
        *(f"{ALL[name].label} failed: {why}" for name, why in found["failed"].items()),
    ]


def bars(found: dict[str, Any]) -> list[Bar]:
    """Seconds and gigabytes."""
    ours = found["renderers"].get(OURS)
    if ours is None:
        return []
    peak = statistics.median(ours["peak_mib"]) / 1024
    total = statistics.median(ours["total"])
    return [
        Bar("10 million triangles: load, build and a sample at 1080p", total, 30.0, "at most", "s"),
        Bar("10 million triangles: peak memory", peak, 3.0, "at most", "GiB"),
    ]
