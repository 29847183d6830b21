"""The command line of ``benches/run.py``; needs nothing but Python itself."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from beside.options import scenes_folder
from beside.renderers import ALL, OURS
from beside.studies import NAMES

DESCRIPTION = """\
Measures Steradian beside other renderers in one run, and prints and stores a table.

Studies:
  paths     whole renders: Mitsuba 3, LuxCore, Cycles; pbrt-v4 if PBRT names it
  rays      closest and any hits, build times, bytes per triangle: Embree
  startup   imports, the first image, a second render
  large     ten million triangles at 1920 x 1080
  growth    time by samples, pixels, triangles; with a plot

The first run installs the peers into .venv-bench, some 2 GB, and makes scenes in benches/generated; git
ignores both. What is missing is said, and the rest is measured. A full run takes about 20 minutes on two
cores and writes docs/beside.md, docs/beside.json and docs/growth.svg; anything less writes to
benches/generated. Other work on the machine spoils the figures."""


def parser() -> argparse.ArgumentParser:
    """For ``run.py`` and the process that it starts."""
    out = argparse.ArgumentParser(
        prog="benches/run.py", description=DESCRIPTION, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    out.add_argument(
        "--quick", action="store_true", help="small sizes, to see that everything works: 2 minutes"
    )
    out.add_argument("--only", type=_names(NAMES), metavar="STUDY,...", help=f"of {', '.join(NAMES)}")
    peers = tuple(name for name in ALL if name != OURS)
    out.add_argument("--peers", type=_names(peers), metavar="PEER,...", help=f"of {', '.join(peers)}")
    out.add_argument("--runs", type=_positive, help="turns that all take; 7, with --quick 2")
    out.add_argument("--threads", type=_positive, default=os.cpu_count() or 1, help="all cores unless given")
    out.add_argument(
        "--scenes",
        type=Path,
        default=scenes_folder(),
        metavar="DIR",
        help="scenes that others made: DIR/*/scene.xml",
    )
    out.add_argument(
        "--also", type=_scene, nargs="+", default=[], metavar="SCENE.xml", help="more scenes for `paths`"
    )
    out.add_argument("--output", type=Path, metavar="DIR", help="where the table goes")
    out.add_argument("--json", action="store_true", help="print JSON instead of Markdown")
    return out


def _positive(text: str) -> int:
    value = int(text)
    if value < 1:
        raise argparse.ArgumentTypeError(f"{text} is no positive number")
    return value


def _scene(text: str) -> Path:
    path = Path(text)
    if not path.is_file():
        raise argparse.ArgumentTypeError(f"there is no file {text}")
    return path.resolve()


class _names:
    """A list of known names with commas between them."""

    def __init__(self, known: tuple[str, ...]) -> None:
        self.known = known

    def __call__(self, text: str) -> tuple[str, ...]:
        names = tuple(text.split(","))
        unknown = [name for name in names if name not in self.known]
        if unknown:
            raise argparse.ArgumentTypeError(f"{', '.join(unknown)}: choose from {', '.join(self.known)}")
        return names
