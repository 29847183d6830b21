#!/usr/bin/env python3
"""Nanoseconds of every scattering model, beside Mitsuba's scalar ones: ``python3 benches/models.py``."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

BENCHES = Path(__file__).resolve().parent
sys.path[:0] = [str(BENCHES), str(BENCHES.parent)]

from beside import environment  # noqa: E402 (after its folder is on the path)


def main() -> int:
    """Measures ours, then theirs with the environment's own Python, and prints both."""
    environment.prepare()
    command = [str(environment.PYTHON), "-m", "models", *sys.argv[1:]]
    return subprocess.run(command, env={**os.environ, "PYTHONPATH": str(BENCHES)}).returncode


if __name__ == "__main__":
    sys.exit(main())
