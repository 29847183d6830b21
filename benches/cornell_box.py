"""Paths per second on a Cornell box, side by side with Mitsuba 3 in one run.

    python benches/cornell_box.py [--size 512] [--spp 16] [--runs 7] [--depth 8] [--threads 2]

Prints one table: each renderer's median, and the median of the ratios of runs that were taken in turn. The
same scene, depth, strategy (BSDF and light sampling, power heuristic), independent samples, no Russian
roulette. Mitsuba gets a box filter, with which it is fastest; to us the filter makes no difference.

Needs ``steradian`` and ``mitsuba`` (``pip install mitsuba==3.9.1``) in one environment, and LLVM for
Mitsuba's vectorised variant (Debian: ``libllvm19``; elsewhere set ``DRJIT_LIBLLVM_PATH``).
"""

from __future__ import annotations

import argparse
import json
import statistics
from pathlib import Path
from typing import Any

from peers import Work, in_turn, mitsuba_run, mitsuba_version, steradian_run

SCENE = Path(__file__).resolve().parent.parent / "scenes" / "cornell-box.xml"


def sensor(mi: Any) -> dict[str, Any]:
    """The scene's camera with a box filter."""
    return {
        "type": "perspective",
        "fov": 39.3077,
        "to_world": mi.ScalarTransform4f().translate([2.78, 2.73, -8]),
        "film": {"type": "hdrfilm", "rfilter": {"type": "box"}},
        "sampler": {"type": "independent"},
    }


def main() -> None:
    """Times both in turn and prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    for name, default in (("size", 512), ("spp", 16), ("runs", 7), ("depth", 8), ("threads", 2)):
        parser.add_argument(f"--{name}", type=int, default=default)
    parser.add_argument("--json", action="store_true", help="print one JSON object instead of the table")
    given = parser.parse_args()
    work = Work(SCENE, given.size, given.size, given.spp, given.depth, None, given.threads)
    compared = in_turn(work, steradian_run(work), mitsuba_run(work, sensor=sensor), given.runs)
    table = {
        "scene": SCENE.stem,
        **vars(given),
        "steradian_mpaths_per_second": statistics.median(compared.ours),
        "mitsuba_mpaths_per_second": statistics.median(compared.theirs),
        "ratio": compared.ratio,
        "mitsuba": mitsuba_version(),
    }
    if given.json:
        print(json.dumps(table))
        return
    print(f"{SCENE.stem}, {given.size}², {given.spp} spp, depth {given.depth}, {given.threads} threads")
    rows = (("steradian", compared.ours), (f"mitsuba {table['mitsuba']} llvm", compared.theirs))
    for name, rates in rows:
        low, middle, high = min(rates), statistics.median(rates), max(rates)
        print(f"  {name:22} {middle:6.3f} million paths/s   ({low:.3f} to {high:.3f})")
    print(f"  ratio                  {compared.ratio:6.3f}   (median of {given.runs} pairs)")


if __name__ == "__main__":
    main()
