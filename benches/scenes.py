"""Paths per second on any scenes, side by side with Mitsuba 3 in one run.

    python benches/scenes.py SCENE.xml... [--runs 3] [--depth 8] [--roulette 5] [--threads 2] [--json FILE]

Every scene is rendered at its own proportions, scaled to about a quarter of a million pixels, 16 samples
each, with the same depth, Russian roulette, strategy and kind of samples in both. Prints a row for each
scene, and the geometric mean of the ratios. ``--variant scalar_rgb`` compares with another variant of
Mitsuba.

Needs what ``cornell_box.py`` needs.
"""

from __future__ import annotations

import argparse
import json
import math
import statistics
from pathlib import Path

from peers import Work, in_turn, mitsuba_run, mitsuba_version, native_size, steradian_run

PIXELS = 1 << 18


def main() -> None:
    """Times both on every scene and prints the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="+", type=Path, metavar="SCENE.xml")
    defaults = (("runs", 3), ("spp", 16), ("depth", 8), ("roulette", 5), ("threads", 2), ("pixels", PIXELS))
    for name, default in defaults:
        parser.add_argument(f"--{name}", type=int, default=default)
    parser.add_argument("--variant", default="llvm_ad_rgb", help="Mitsuba's variant")
    parser.add_argument("--json", type=Path, metavar="FILE", help="write the table there, too")
    given = parser.parse_args()
    played = f"depth {given.depth}, roulette from {given.roulette}"
    print(f"millions of paths a second; {given.threads} threads, {played}")
    print(f"{'scene':>24}  {'steradian':>9}  {'mitsuba ' + mitsuba_version():>14}  ratio")
    rows = []
    for scene in given.scenes:
        width, height = native_size(scene)
        scale = math.sqrt(given.pixels / (width * height))
        size = (max(1, round(width * scale)), max(1, round(height * scale)))
        work = Work(scene, *size, given.spp, given.depth, given.roulette, given.threads)
        compared = in_turn(work, steradian_run(work), mitsuba_run(work, given.variant), given.runs)
        name = scene.parent.name if scene.stem == "scene" else scene.stem
        ours, theirs = statistics.median(compared.ours), statistics.median(compared.theirs)
        row = {"scene": name, "size": size, "steradian": ours, "mitsuba": theirs}
        rows.append({**row, "ratio": compared.ratio})
        print(f"{name:>24}  {ours:9.3f}  {theirs:14.3f}  {compared.ratio:5.2f}", flush=True)
    mean = statistics.geometric_mean(row["ratio"] for row in rows)
    print(f"{'geometric mean':>24}  {'':9}  {'':14}  {mean:5.2f}")
    if given.json:
        settings = {key: value for key, value in vars(given).items() if key not in ("scenes", "json")}
        table = {**settings, "mitsuba": mitsuba_version(), "scenes": rows, "geometric_mean": mean}
        given.json.write_text(json.dumps(table, indent=1) + "\n")


if __name__ == "__main__":
    main()
