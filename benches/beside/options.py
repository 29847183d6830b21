"""What is measured, and how often; the same for every study."""

from __future__ import annotations

import os
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent.parent
CORNELL_BOX = ROOT / "scenes" / "cornell-box.xml"


@dataclass(frozen=True)
class Options:
    """``quick``: small sizes, to see that everything works; its figures say little."""

    quick: bool
    runs: int
    threads: int
    renderers: tuple[str, ...]
    """Those that are there, ours first."""
    scenes: Path
    """Scenes that others made, a folder each with a ``scene.xml``; they are no part of the project."""
    also: tuple[Path, ...]
    """More scene files for whole renders."""
    ray_bench: Path | None
    embree: Path | None


def scenes_folder() -> Path:
    """As the tests look for it."""
    return Path(os.environ.get("STERADIAN_SCENES", ROOT.parent / "shared" / "scenes"))
