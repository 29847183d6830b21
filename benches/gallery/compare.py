"""Do two renders with known errors show the same?"""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import NormalDist

import numpy as np
from numpy.typing import NDArray

LEVEL = 1e-3
"""A pair of equal pictures is called different this often."""

BLOCK = 8
"""Pixels along each side of the blocks whose means are compared: means of many samples are nearly normal."""

FLOOR = 1e-3
"""Differences below this share of the picture's mean are not told apart: errors are uncertain themselves."""


@dataclass(frozen=True)
class Render:
    """Linear RGB and its standard error, (height, width, 3)."""

    image: NDArray[np.float64]
    stderr: NDArray[np.float64]

    def blocks(self) -> Render:
        """Means of blocks of pixels."""
        height, width = (side // BLOCK * BLOCK for side in self.image.shape[:2])

        def mean(values: NDArray[np.float64]) -> NDArray[np.float64]:
            cut = values[:height, :width].reshape(height // BLOCK, BLOCK, width // BLOCK, BLOCK, 3)
            return cut.mean(axis=(1, 3))

        return Render(mean(self.image), np.sqrt(mean(self.stderr**2)) / BLOCK)


@dataclass(frozen=True)
class Verdict:
    """How far two renders are apart."""

    mean_ratio: float
    """The mean of the first over that of the second."""
    mean_z: float
    """Their difference in standard errors, of the channel where it is largest."""
    worst_z: float
    """The largest difference of a block, in standard errors."""
    worst_at: tuple[int, int]
    """The pixel in the middle of that block: row, column."""
    share_beyond_3: float
    """Of pixels that differ by more than three standard errors: by chance 0.27 %."""
    z: NDArray[np.float64]
    """Per pixel."""
    limit: float
    """What chance allows of ``worst_z``."""

    @property
    def same(self) -> bool:
        """Is all of it explained by chance?"""
        return self.worst_z < self.limit and (abs(self.mean_z) < 4 or abs(self.mean_ratio - 1) < 0.005)


def compare(ours: Render, theirs: Render) -> Verdict:
    """Per pixel, per block of pixels, and as a whole."""
    scale = max(float(theirs.image.mean()), 1e-9)
    z = _z(ours, theirs, scale)
    blocks = _z(ours.blocks(), theirs.blocks(), 0.1 * scale)
    at = np.unravel_index(int(np.argmax(np.abs(blocks))), blocks.shape)
    means = [render.image.mean(axis=(0, 1)) for render in (ours, theirs)]
    errors = [
        np.sqrt((render.stderr**2).sum(axis=(0, 1))) / render.image[..., 0].size for render in (ours, theirs)
    ]
    mean_z = (means[0] - means[1]) / np.maximum(np.hypot(*errors), 1e-12)
    tests = blocks.size
    return Verdict(
        mean_ratio=float(means[0].sum() / max(means[1].sum(), 1e-12)),
        mean_z=float(mean_z[np.argmax(np.abs(mean_z))]),
        worst_z=float(np.abs(blocks).max()),
        worst_at=(int(at[0]) * BLOCK + BLOCK // 2, int(at[1]) * BLOCK + BLOCK // 2),
        share_beyond_3=float((np.abs(z) > 3).mean()),
        z=np.abs(z).max(axis=-1) * np.sign(z.sum(axis=-1)),
        limit=_limit(tests),
    )


def _z(a: Render, b: Render, scale: float) -> NDArray[np.float64]:
    error = np.sqrt(a.stderr**2 + b.stderr**2 + (FLOOR * scale) ** 2)
    return np.asarray((a.image - b.image) / error)


def _limit(tests: int) -> float:
    """The largest of so many normal numbers stays below this with probability 1 − LEVEL (Šidák)."""
    each = -math.expm1(math.log1p(-LEVEL) / tests)
    return -NormalDist().inv_cdf(each / 2)
