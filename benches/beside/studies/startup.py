"""Start-up: imports, the first image of the Cornell box, and a second render of a loaded scene."""

from __future__ import annotations

import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

from beside.options import CORNELL_BOX, Options
from beside.paired import Bar
from beside.pool import Worker, WorkerFailed
from beside.renderers import ALL, OURS, Job
from beside.say import say
from beside.table import number, paragraph, table

TITLE = "Start-up"
NOTHING = "pass"
RERENDER = """
import sys, time
import steradian as sr
scene = sr.load(sys.argv[1])
sr.render(scene, spp=1, size=(16, 16))
start = time.perf_counter()
result = sr.render(scene, spp=2, size=(16, 16), max_depth=5)
print(time.perf_counter() - start)
"""
"""A second render of a loaded scene, with other settings and next to no samples: what is left is overhead."""


def measure(options: Options) -> dict[str, Any]:
    """Every step in processes of their own, in turn."""
    say("start-up")
    packages = [ALL[name].needs for name in options.renderers]
    imports: dict[str, list[float]] = {package: [] for package in packages if package is not None}
    images: dict[str, list[float]] = {name: [] for name in options.renderers}
    own: dict[str, list[float]] = {"command": [], "rerender": []}
    failed = {}
    for _ in range(options.runs + 1):  # the first one reads files from the disk and is not counted
        nothing = _process_seconds(["-c", NOTHING])
        for package, seconds in imports.items():
            seconds.append(_process_seconds(["-c", f"import {package}"]) - nothing)
        for name in images:
            if name in failed:
                continue
            try:
                images[name].append(_first_image(name, options))
            except WorkerFailed as error:
                failed[name] = str(error)
        own["command"].append(_command())
        own["rerender"].append(float(_output(["-c", RERENDER, str(CORNELL_BOX)])))
    return {
        "import": {package: seconds[1:] for package, seconds in imports.items()},
        "first_image": {name: seconds[1:] for name, seconds in images.items() if name not in failed},
        "failed": failed,
        **{name: seconds[1:] for name, seconds in own.items()},
    }


def _first_image(name: str, options: Options) -> float:
    """From the start of a process to the end of one sample per pixel."""
    start = time.perf_counter()
    with Worker(name, Job(CORNELL_BOX, 512, 512, 1, 8, None, options.threads)) as worker:
        worker.render(0)
        return time.perf_counter() - start


def _command() -> float:
    """The command that renders a first image and writes it."""
    with tempfile.TemporaryDirectory() as folder:
        image = Path(folder) / "image.png"
        return _process_seconds(
            ["-m", "steradian", "render", str(CORNELL_BOX), "--spp", "1", "-o", str(image), "--quiet"]
        )


def _process_seconds(arguments: list[str]) -> float:
    start = time.perf_counter()
    subprocess.run([sys.executable, *arguments], check=True, capture_output=True)
    return time.perf_counter() - start


def _output(arguments: list[str]) -> str:
    done = subprocess.run([sys.executable, *arguments], check=True, capture_output=True, text=True)
    return done.stdout


def tables(found: dict[str, Any]) -> list[str]:
    """One row a renderer."""
    rows = []
    for name, seconds in found["first_image"].items():
        package = ALL[name].needs
        imported = found["import"].get(package)
        rows.append([ALL[name].label, number(_ms(imported)) if imported else "–", number(_ms(seconds))])
    return [
        *paragraph(
            "Milliseconds, medians. *Import*: of the Python package, beyond the interpreter's own start. "
            "*First image*: from the start of a process to the Cornell box at 512 × 512 with one sample per "
            "pixel in memory."
        ),
        *table(["renderer", "import", "first image"], rows),
        "",
        *(f"{ALL[name].label} failed: {why}" for name, why in found["failed"].items()),
        *paragraph(
            "`steradian render cornell-box.xml --spp 1 -o image.png`, from start to end: "
            f"{_ms(found['command']):.0f} ms. A second `sr.render` of a loaded scene, 16 × 16 pixels with "
            f"other settings: {_ms(found['rerender']):.1f} ms."
        ),
    ]


def _ms(seconds: list[float]) -> float:
    return 1e3 * statistics.median(seconds)


def bars(found: dict[str, Any]) -> list[Bar]:
    """What a person does not wait for."""
    out = [
        Bar("start-up: import steradian", _ms(found["import"]["steradian"]), 150.0, "at most", "ms"),
        Bar("start-up: the command's first image, written", _ms(found["command"]), 300.0, "at most", "ms"),
        Bar("start-up: second render of a loaded scene", _ms(found["rerender"]), 20.0, "at most", "ms"),
    ]
    if OURS in found["first_image"]:
        first = _ms(found["first_image"][OURS])
        out.append(Bar("start-up: first image in memory", first, 300.0, "at most", "ms"))
    return out
