#!/usr/bin/env python3
"""Measures Steradian beside other renderers: ``python3 benches/run.py --help``."""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
from pathlib import Path

BENCHES = Path(__file__).resolve().parent
sys.path[:0] = [str(BENCHES), str(BENCHES.parent)]

from beside import arguments, environment  # noqa: E402 (after its folder is on the path)


def main() -> int:
    """Prepares, then measures with the environment's own Python."""
    arguments.parser().parse_args()
    prepared = environment.prepare()
    with tempfile.NamedTemporaryFile("w", suffix=".json") as file:
        file.write(prepared.as_json())
        file.flush()
        command = [str(environment.PYTHON), "-m", "beside", "--prepared", file.name, *sys.argv[1:]]
        paths = [str(BENCHES), *filter(None, [os.environ.get("PYTHONPATH")])]
        done = subprocess.run(command, env={**os.environ, "PYTHONPATH": os.pathsep.join(paths)})
    return done.returncode


if __name__ == "__main__":
    sys.exit(main())
