"""``steradian convert``."""

from __future__ import annotations

import argparse
import os
import sys
from pathlib import Path

from steradian import _internal
from steradian.cli import outputs
from steradian.cli.loading import fails_strictly
from steradian.cli.report import print_json
from steradian.convert import Converted, convert_with_diagnostics

FAILED = 1


def convert(arguments: argparse.Namespace) -> int:
    """Writes a scene in another format; the exit code."""
    out = Path(arguments.output)
    outputs.check_writable(out, _internal.check_target)
    if out.exists():
        if Path(arguments.scene).exists() and out.samefile(arguments.scene):
            raise ValueError(f"{out} is the scene itself: choose another name")
        if not arguments.force:
            raise ValueError(f"{out} exists; --force overwrites it")
    try:
        converted, diagnostics, report = convert_with_diagnostics(
            arguments.scene,
            out,
            defines=dict(arguments.define),
            search_paths=arguments.search_path,
            variant=arguments.variant,
            limits=dict(arguments.limit),
            own_plugins=arguments.own_plugins,
            overwrite=arguments.force,
            threads=arguments.threads,
            color=sys.stderr.isatty() and not os.environ.get("NO_COLOR"),
        )
    except FileExistsError as error:
        raise ValueError(f"{error} with --force") from None
    if report:
        print(report.rstrip("\n"), file=sys.stderr)
    if converted is None or fails_strictly(arguments, diagnostics):
        return FAILED
    if arguments.json:
        values = {
            "scene": str(converted.scene),
            "files": [str(file) for file in converted.files],
            "bytes": _size(converted),
            "seconds": converted.seconds,
            "approximations": len(converted.approximations),
            "diagnostics": [vars(d) for d in diagnostics],
        }
        print_json(values)
    elif not arguments.quiet:
        print(_summary(converted))
    return 0


def _summary(converted: Converted) -> str:
    others = len(converted.files) - 1
    size = _size(converted) / 2**20
    files = {0: ""}.get(others, f" and {others} file{'s' * (others > 1)} of meshes and images")
    said = len(converted.approximations)
    approximated = {0: "nothing approximated", 1: "1 approximation"}.get(said, f"{said} approximations")
    return f"wrote {converted.scene}{files}: {size:.1f} MiB in {converted.seconds:.2f} s, {approximated}"


def _size(converted: Converted) -> int:
    return sum(file.stat().st_size for file in converted.files)
