#!/usr/bin/env python3
"""Measures integrals beside vegas: ``python3 benches/integrals.py --help``."""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
from pathlib import Path

BENCHES = Path(__file__).resolve().parent
ROOT = BENCHES.parent
sys.path[:0] = [str(BENCHES), str(ROOT)]

import dev  # noqa: E402 (after its folder is on the path)

VENV = ROOT / ".venv-bench"
NEEDED = ("numpy", "vegas==6.4.1", "numba>=0.60")
DESCRIPTION = """\
Time to reach a relative error, ours (sr.adapt) and vegas's, for the same NumPy integrands in five
dimensions: Genz's six families with random parameters, and two peaks on a diagonal. And evaluations a
second of a native integrand, beside vegas with the same in NumPy.

The error is the root of the mean square of the true one over seeds, at budgets that double; the time to a
goal is read off between two of them. vegas is given its better time of two: with its first iterations thrown
away, as its manual advises, and without. Both take turns. The first run installs vegas and Numba into
.venv-bench. A full run takes about ten minutes and writes docs/integrals.md; anything less prints only.
Other work spoils the figures."""


def main() -> int:
    """Prepares, then measures with the environment's own Python."""
    parser = argparse.ArgumentParser(
        prog="benches/integrals.py",
        description=DESCRIPTION,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("--quick", action="store_true", help="few seeds, one set of parameters: a minute")
    parser.add_argument("--seeds", type=int, default=12, help="runs at each budget; 12")
    parser.add_argument("--draws", type=int, default=3, help="sets of random parameters of each family; 3")
    parser.add_argument("--output", type=Path, metavar="FILE.md", help="where the page goes")
    given = parser.parse_args()
    dev.check_tools()
    dev.make_venv(VENV)
    python = dev.python_of(VENV)
    dev.once(VENV / "integrals.txt", "\n".join(NEEDED), "installing vegas and Numba", list(NEEDED), python)
    dev.once(VENV / "steradian.txt", dev.source_hash(), "building steradian", [str(ROOT)], python)
    output = given.output or (None if given.quick else ROOT / "docs" / "integrals.md")
    seeds, draws = (4, 1) if given.quick else (given.seeds, given.draws)
    command = [str(python), "-m", "integrals", str(seeds), str(draws), str(output or "")]
    paths = [str(BENCHES), *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(paths)}
    return subprocess.run(command, env=environment).returncode


if __name__ == "__main__":
    sys.exit(main())
