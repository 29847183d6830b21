"""``steradian render``."""

from __future__ import annotations

import argparse
import sys
from contextlib import nullcontext
from pathlib import Path

import steradian
from steradian.cli import outputs, report
from steradian.cli.loading import load
from steradian.cli.progress import ProgressBar

FAILED = 1
INTERRUPTED = 130


def render(arguments: argparse.Namespace) -> int:
    """Renders and writes; the exit code."""
    paths = outputs.resolve(arguments.output, arguments.scene)
    scene = load(arguments)
    if scene is None:
        return FAILED
    shown = not (arguments.quiet or (arguments.json and not sys.stderr.isatty()))
    with ProgressBar(arguments.time) if shown else nullcontext() as bar:
        result = steradian.render(
            scene,
            spp=arguments.spp,
            time=arguments.time,
            strategy=arguments.strategy,
            sampler=arguments.sampler,
            max_depth=arguments.max_depth,
            size=arguments.size,
            seed=arguments.seed,
            threads=arguments.threads,
            on_progress=None if bar is None else bar.update,
            on_interrupt="return",
        )
    interrupted = result.stopped == "interrupted"
    if result.spp == 0:
        print("interrupted before every pixel had a sample; nothing was written", file=sys.stderr)
        return INTERRUPTED
    for path in paths:
        result.write(path, exposure=arguments.exposure, tone=arguments.tone)
    if interrupted:
        print(f"interrupted; wrote what was there, {result.spp} spp: {_names(paths)}", file=sys.stderr)
    if arguments.json:
        report.print_json(report.as_json(result, scene.load_seconds, paths))
    elif not arguments.quiet:
        print(report.summary(result, scene.load_seconds, paths))
    return INTERRUPTED if interrupted else 0


def _names(paths: list[Path]) -> str:
    return ", ".join(str(path) for path in paths)
