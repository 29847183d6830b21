"""The command line."""

from __future__ import annotations

import argparse
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]


def parse() -> argparse.Namespace:
    """What is asked for."""
    parser = argparse.ArgumentParser(
        prog="benches/gallery.py",
        description="Renders the scenes of scenes/gallery with Steradian and, where it has the block, with "
        "Mitsuba 3, tests whether both show the same, and writes pictures side by side and a table. Fails if "
        "any pair differs by more than chance explains.",
    )
    add = parser.add_argument
    add("scene", nargs="*", help="names, without .xml (default: all)")
    add("--spp", type=int, default=1024, help="samples per pixel, in all (default: 1024)")
    add("--output", type=Path, default=ROOT / "docs" / "gallery", help="the folder (default: docs/gallery)")
    add("--scenes", type=Path, default=ROOT / "scenes" / "gallery", help=argparse.SUPPRESS)
    return parser.parse_args()
