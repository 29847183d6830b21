"""Loading for a command: diagnostics go to standard error."""

from __future__ import annotations

import argparse
import os
import sys

from steradian.diagnostics import Diagnostic
from steradian.scene import Scene, load_with_diagnostics


def load(arguments: argparse.Namespace) -> Scene | None:
    """The scene, or None after its errors were shown."""
    loaded = load_with_diagnostics(
        arguments.scene,
        defines=dict(arguments.define),
        search_paths=arguments.search_path,
        limits=dict(arguments.limit),
        environment=arguments.environment,
        variant=arguments.variant,
        threads=getattr(arguments, "threads", None),
        color=sys.stderr.isatty() and not os.environ.get("NO_COLOR"),
    )
    if loaded.report:
        print(loaded.report.rstrip("\n"), file=sys.stderr)
    return None if fails_strictly(arguments, loaded.diagnostics) else loaded.scene


def fails_strictly(arguments: argparse.Namespace, diagnostics: tuple[Diagnostic, ...]) -> bool:
    """Are there warnings, and does ``--strict`` take them for errors? Says so."""
    warnings = sum(diagnostic.severity == "warning" for diagnostic in diagnostics)
    if not (arguments.strict and warnings):
        return False
    count = "1 warning" if warnings == 1 else f"{warnings} warnings"
    print(f"{count}, and --strict takes none", file=sys.stderr)
    return True
