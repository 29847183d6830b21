"""Both, in a table."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from models import mitsubas

ROOT = Path(__file__).resolve().parents[2]
RESOLUTION = 1.0
"""Nanoseconds: differences of calls from Python tell no more. Mitsuba's models are not taken to be faster."""


def main() -> int:
    """Prints a line for each model, angle and function; 1 if any of ours is slower."""
    command = ["cargo", "bench", "-q", "-p", "sr_bsdf", "--bench", "models"]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=True)
    slower = 0
    theirs: dict[str, float] = {}
    print("| model | angle | function | Steradian, ns | Mitsuba scalar, ns | ratio |")
    print("| --- | ---: | --- | ---: | ---: | ---: |")
    for line in done.stdout.splitlines():
        name, angle, function, ours = line.split("\t")
        if name not in mitsubas.MODELS:
            print(f"| {name} | {angle}° | {function} | {float(ours):.1f} | | |")
            continue
        if function == "sample":
            theirs = mitsubas.measure(name, float(angle))
        ratio = max(theirs[function], RESOLUTION) / float(ours)
        slower += ratio < 1
        print(
            f"| {name} | {angle}° | {function} | {float(ours):.1f} | {theirs[function]:.1f} | {ratio:.1f} |"
        )
    print(f"\n{slower} slower", file=sys.stderr)
    return 1 if slower else 0


if __name__ == "__main__":
    sys.exit(main())
