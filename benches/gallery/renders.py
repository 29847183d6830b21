"""A scene, rendered by either."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from gallery.compare import Render

REPLICATES = 16
"""Mitsuba tells no errors: they come from renders with different seeds."""


def ours(path: Path, spp: int) -> Render:
    """By Steradian, whose errors are part of the answer."""
    import steradian as sr

    result = sr.render(sr.load(path), spp=spp, seed=5)
    return Render(np.asarray(result.image, dtype=np.float64), np.asarray(result.stderr, dtype=np.float64))


def mitsubas(path: Path, spp: int) -> Render | str:
    """By Mitsuba 3, or why it does not."""
    import mitsuba as mi

    try:
        # Optimised, Mitsuba 3.9.1 joins shapes of the same material and forgets the extent of all but one:
        # light from a constant sky then passes through what is far away.
        scene = mi.load_file(str(path), optimize=False)
    except RuntimeError as error:
        return str(error).strip().splitlines()[-1]
    each = max(spp // REPLICATES, 4)
    images = [
        np.asarray(mi.render(scene, spp=each, seed=seed), dtype=np.float64)[..., :3]
        for seed in range(REPLICATES)
    ]
    return Render(np.mean(images, axis=0), np.std(images, axis=0, ddof=1) / np.sqrt(REPLICATES))
