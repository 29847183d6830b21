"""Renders and their difference, side by side."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from gallery.compare import Render, Verdict

GAP = 4


def write(path: Path, ours: Render, theirs: Render | None, verdict: Verdict | None) -> None:
    """Ours; and beside it theirs, and where they differ: red where ours is brighter, blue where darker."""
    import mitsuba as mi

    exposure = 1 / max(float(np.quantile(ours.image.mean(axis=-1), 0.98)), 1e-6)
    panels = [_tone(ours.image * exposure)]
    if theirs is not None and verdict is not None:
        panels += [_tone(theirs.image * exposure), _signed(verdict.z)]
    gap = np.full((panels[0].shape[0], GAP, 3), 255, dtype=np.uint8)
    row = [part for panel in panels for part in (panel, gap)][:-1]
    mi.Bitmap(np.ascontiguousarray(np.hstack(row))).write(str(path))


def _tone(linear: NDArray[np.float64]) -> NDArray[np.uint8]:
    """sRGB, clipped at 1."""
    x = np.clip(linear, 0, 1)
    encoded = np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)
    return np.asarray(np.round(255 * encoded), dtype=np.uint8)


def _signed(z: NDArray[np.float64]) -> NDArray[np.uint8]:
    strength = np.clip(np.abs(z) / 6, 0, 1)[..., None]
    colour = np.where((z > 0)[..., None], [178, 24, 43], [33, 102, 172])
    return np.asarray(np.round(255 + strength * (colour - 255)), dtype=np.uint8)
