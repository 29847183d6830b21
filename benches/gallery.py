#!/usr/bin/env python3
"""A small scene for every block, by Steradian and Mitsuba 3: ``python3 benches/gallery.py --help``."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

BENCHES = Path(__file__).resolve().parent
sys.path[:0] = [str(BENCHES), str(BENCHES.parent)]

from gallery import arguments  # noqa: E402 (after its folder is on the path)

from beside import environment  # noqa: E402 (after its folder is on the path)


def main() -> int:
    """Prepares, then renders with the environment's own Python."""
    arguments.parse()
    environment.prepare()
    command = [str(environment.PYTHON), "-m", "gallery", *sys.argv[1:]]
    paths = [str(BENCHES), *filter(None, [os.environ.get("PYTHONPATH")])]
    return subprocess.run(command, env={**os.environ, "PYTHONPATH": os.pathsep.join(paths)}).returncode


if __name__ == "__main__":
    sys.exit(main())
