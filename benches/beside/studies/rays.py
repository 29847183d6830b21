"""Rays per second, build times and bytes per triangle beside Embree, by the program ``bench_rays``.

Both sides are native code in one process, with the same meshes and rays in turn, on one thread in processor
time.
"""

from __future__ import annotations

import os
import statistics
import subprocess
from typing import Any

from beside import machine
from beside.options import Options
from beside.paired import Bar, ratio
from beside.say import say
from beside.table import number, paragraph, table

TITLE = "Rays per second"
SCENES = {
    "box": "Cornell box, 38 triangles",
    "scattered:1000000": "a million scattered triangles",
    "mesh:1000000": "a mesh of a million",
    "primary:1000000": "the mesh, primary rays",
    "forest:1000x100000": "forest of 1,000 × 100,000",
}
QUICK = ("box", "scattered:10000", "mesh:10000", "primary:10000", "forest:100x1000")
OURS = ("steradian", "steradian-batches")
RIVAL = "embree"
"""Embree as it is by default: medium quality, not watertight."""
COHERENT = "embree-packets"
LABELS = {
    "steradian": "Steradian, single rays",
    "steradian-batches": "Steradian, batches",
    "embree": "Embree",
    "embree-robust": "Embree, robust",
    "embree-high": "Embree, high quality",
    "embree-packets": "Embree, coherent packets of 16",
}

Found = dict[str, dict[str, dict[str, list[float]]]]
"""Scene, quantity, contender: values."""


def measure(options: Options) -> dict[str, Any]:
    """Runs the program."""
    if options.ray_bench is None:
        raise RuntimeError("bench_rays was not built")
    scenes = QUICK if options.quick else tuple(SCENES)
    command = [
        str(options.ray_bench),
        *scenes,
        "--runs",
        str(options.runs),
        "--threads",
        str(options.threads),
    ]
    environment = dict(os.environ)
    if options.embree is not None:
        command += ["--embree", str(options.embree)]
        # Embree's scheduler lies beside it.
        environment["LD_LIBRARY_PATH"] = str(options.embree.parent)
    say(f"rays: {', '.join(scenes)}")
    before = machine.load()
    done = subprocess.run(command, env=environment, stdout=subprocess.PIPE, text=True, check=True)
    return {
        "embree": None if options.embree is None else options.embree.name,
        "threads": options.threads,
        "load": [before, machine.load()],
        "scenes": parse(done.stdout),
    }


def parse(output: str) -> Found:
    """The program's lines: scene, quantity, contender and values, with tabs between them."""
    found: Found = {}
    for line in output.splitlines():
        scene, quantity, contender, values = line.split("\t")
        found.setdefault(scene, {}).setdefault(quantity, {})[contender] = [float(v) for v in values.split()]
    return found


def tables(found: dict[str, Any]) -> list[str]:
    """Rays, then builds and bytes."""
    scenes: Found = found["scenes"]
    contenders = [name for name in LABELS if any(name in q["closest"] for q in scenes.values())]
    low, high = ("unknown" if v is None else f"{v:.1f}" for v in found["load"])
    lines = [
        *paragraph(
            "Processor nanoseconds a ray on one core, closest hit / any hit; medians of runs in turn. Rays "
            "leave surfaces as those of a path tracer do, any-hit rays aim at a lamp; primary rays go row by "
            f"row. Load of the machine {low} to {high}."
        ),
        *table(
            ["", *(SCENES.get(name, name) for name in scenes)],
            [[LABELS[who], *(_pair(q, who) for q in scenes.values())] for who in contenders],
        ),
        "",
    ]
    if RIVAL not in contenders:
        return [*lines, "Embree was not there.", ""]
    contests = [
        ["Embree's time to that of our batches", *(_cell(against_default(q)) for q in scenes.values())],
        ["the better of its ways to the better of ours", *(_cell(best_of_each(q)) for q in scenes.values())],
    ]
    lines += [*table(["ratio, closest / any", *(SCENES.get(name, name) for name in scenes)], contests), ""]
    builds = [
        [SCENES.get(name, name), LABELS[who].removesuffix(", single rays"), *_build(quantities, who)]
        for name, quantities in scenes.items()
        for who in quantities["build_cpu"]
    ]
    return [
        *lines,
        f"Builds on {found['threads']} threads, and bytes per stored triangle without the mesh's own arrays:",
        "",
        *table(["scene", "builder", "ms, clock", "ms, processor", "bytes a triangle"], builds),
        "",
    ]


def against_default(quantities: dict[str, dict[str, list[float]]]) -> tuple[float, float]:
    """For closest and any hit: Embree's default to our batches, by pairs of runs."""
    closest, occluded = (
        ratio(quantities[kind][RIVAL], quantities[kind]["steradian-batches"]) for kind in ("closest", "any")
    )
    return closest, occluded


def best_of_each(quantities: dict[str, dict[str, list[float]]]) -> tuple[float, float]:
    """For closest and any hit: Embree's single rays or packets to our single rays or batches."""

    def best(kind: str, names: tuple[str, ...]) -> list[float]:
        return min((quantities[kind][name] for name in names), key=statistics.median)

    closest, occluded = (
        ratio(best(kind, (RIVAL, COHERENT)), best(kind, OURS)) for kind in ("closest", "any")
    )
    return closest, occluded


def _pair(quantities: dict[str, dict[str, list[float]]], who: str) -> str:
    return " / ".join(number(statistics.median(quantities[kind][who])) for kind in ("closest", "any"))


def _cell(ratios: tuple[float, float]) -> str:
    return " / ".join(f"{value:.2f}" for value in ratios)


def _build(quantities: dict[str, dict[str, list[float]]], who: str) -> list[str]:
    wall, cpu = (statistics.median(quantities[kind][who]) for kind in ("build_wall", "build_cpu"))
    return [number(1e3 * wall), number(1e3 * cpu), number(quantities["bytes_per_triangle"][who][0])]


def bars(found: dict[str, Any]) -> list[Bar]:
    """As fast as Embree at its best, built nearly as fast, and no larger."""
    out = []
    for name, quantities in found["scenes"].items():
        if RIVAL not in quantities["closest"]:
            continue
        label = SCENES.get(name, name)
        for kind, value in zip(("closest", "any"), best_of_each(quantities), strict=True):
            out.append(Bar(f"rays: {label}, {kind} hit, ratio to Embree", value, 1.0, "at least"))
        cpu = quantities["build_cpu"]
        if name != "box":
            slower = 1.0 / ratio(cpu[RIVAL], cpu["steradian"])
            out.append(Bar(f"build: {label}, time over Embree's", slower, 1.2, "at most"))
        each = quantities["bytes_per_triangle"]
        larger = each["steradian"][0] / each[RIVAL][0]
        out.append(Bar(f"bytes a triangle: {label}, over Embree's", larger, 1.0, "at most"))
    return out
