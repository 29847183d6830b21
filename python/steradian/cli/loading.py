"""Loading for a command: diagnostics go to standard error."""

from __future__ import annotations

import argparse
import os
import sys

from steradian.scene import Scene, load_with_diagnostics


def load(arguments: argparse.Namespace) -> Scene | None:
    """The scene, or None after its errors were shown."""
    loaded = load_with_diagnostics(
        arguments.scene,
        defines=dict(arguments.define),
        search_paths=arguments.search_path,
        environment=arguments.environment,
        threads=getattr(arguments, "threads", None),
        color=sys.stderr.isatty() and not os.environ.get("NO_COLOR"),
    )
    if loaded.report:
        print(loaded.report.rstrip("\n"), file=sys.stderr)
    return loaded.scene
