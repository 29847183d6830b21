"""Scenes that others made, against references that another renderer made, pixel by pixel.

The scenes are not part of the project. They are looked for in ``$STERADIAN_SCENES``, else beside the
repository in ``shared/scenes``; a test that does not find them fails if ``CI=true`` and is skipped otherwise.

Each reference is the mean radiance and the variance of that mean, per pixel, from independent seeds. Three
tests:

- the image's mean in each channel, within 3 combined standard errors or 0.3 %, whichever is larger;
- every pixel, by z, Šidák-corrected over pixels and channels;
- means of 8 × 8 blocks, the same way: less noise, so smaller differences show.

A pixel with a rare bright path has most of its variance in samples that eight replicates may not have met.
Some of its neighbours have met them, and the reference has met more: the largest of the variances that we
estimate in the 3 × 3 pixels around it, and that the reference predicts for as many samples, counts. The mean
of an image needs no such care: there, our own variances are used as they are.
"""

from __future__ import annotations

import json
import os
import warnings
from pathlib import Path
from typing import NamedTuple

import numpy as np
import OpenEXR
import pytest

import steradian as sr

ROOT = Path(__file__).resolve().parent.parent
SCENES = Path(os.environ.get("STERADIAN_SCENES", ROOT.parent / "shared" / "scenes"))
FAMILY_LEVEL = 0.01
BLOCK = 8

# Samples per pixel: what a minute or so on two cores allows.
SAMPLES = {
    "cornell-box": 256,
    "veach-mis": 512,
    "veach-bidir": 256,
    "veach-ajar": 256,
    "living-room": 128,
    "staircase": 128,
    "classroom": 128,
    "kitchenette": 128,
    "torus": 256,
}

# Light that glass gathers, and a sun: most of a pixel's variance is in paths that neither picture has met.
# Their means and blocks are compared.
HEAVY_TAILS = {"torus"}


class Comparison(NamedTuple):
    """Our image and the reference, with variances of the means; (height, width, 3) each.

    ``cautious_variance`` is ``our_variance`` made safe against rare bright paths, for tests of single pixels.
    """

    ours: np.ndarray
    our_variance: np.ndarray
    cautious_variance: np.ndarray
    reference: np.ndarray
    reference_variance: np.ndarray


def read_exr(path: Path) -> np.ndarray:
    """The RGB channels as float64."""
    with OpenEXR.File(str(path)) as file:
        return np.asarray(file.channels()["RGB"].pixels, dtype=np.float64)


def require(folder: Path) -> None:
    """Fails under CI without a folder of reference scenes; skips elsewhere: the project has none."""
    if not folder.is_dir():
        message = f"{folder} is not there; set STERADIAN_SCENES to the folder with the reference scenes"
        if os.environ.get("CI") == "true":
            pytest.fail(message)
        pytest.skip(message)


def compare(name: str) -> Comparison:
    """Renders a scene at the size of its reference."""
    folder = SCENES / name
    require(folder)
    facts = json.loads((folder / "reference.mitsuba.json").read_text())
    with warnings.catch_warnings():
        # meshes with triangles of no area, said once for each scene
        warnings.simplefilter("ignore", sr.SceneWarning)
        scene = sr.load(folder / "scene.xml")
    spp = SAMPLES[name]
    result = sr.render(scene, spp=spp, size=(facts["width"], facts["height"]), seed=1)
    assert result.rejected_samples == 0, "NaN or infinity"
    variance = read_exr(folder / "reference.mitsuba.var.exr")
    predicted = variance * (facts["seeds"] * facts["spp_per_seed"] / spp)
    our_variance = result.stderr.astype(np.float64) ** 2
    return Comparison(
        result.image.astype(np.float64),
        our_variance,
        largest_around(np.maximum(our_variance, predicted)),
        read_exr(folder / "reference.mitsuba.exr"),
        variance,
    )


def largest_around(image: np.ndarray) -> np.ndarray:
    """The largest of the 3 × 3 values around each pixel, per channel."""
    padded = np.pad(image, ((1, 1), (1, 1), (0, 0)), mode="edge")
    windows = np.lib.stride_tricks.sliding_window_view(padded, (3, 3), axis=(0, 1))
    return windows.max(axis=(-2, -1))


@pytest.fixture(scope="module", params=SAMPLES)
def comparison(request: pytest.FixtureRequest) -> Comparison:
    """One of the scenes, rendered once for all tests."""
    return compare(request.param)


def z_limit(tests: int) -> float:
    """The |z| that ``tests`` independent tests exceed anywhere with probability ``FAMILY_LEVEL``."""
    from statistics import NormalDist

    return NormalDist().inv_cdf(1 - (1 - (1 - FAMILY_LEVEL) ** (1 / tests)) / 2)


def block_means(image: np.ndarray) -> np.ndarray:
    """Means over BLOCK × BLOCK pixels; what does not fill a block is left out."""
    height, width = (n // BLOCK for n in image.shape[:2])
    cut = image[: height * BLOCK, : width * BLOCK]
    return cut.reshape(height, BLOCK, width, BLOCK, 3).mean(axis=(1, 3))


def worst_z(c: Comparison) -> tuple[float, str]:
    """The largest |z| of all pixels and channels, and words about it."""
    error = np.sqrt(c.cautious_variance + c.reference_variance)
    difference = c.ours - c.reference
    # rounding of the files: half-precision would be 5e-4, single precision is 6e-8
    z = np.abs(difference) / np.maximum(error, 1e-6 * np.abs(c.reference) + 1e-12)
    at = np.unravel_index(np.argmax(z), z.shape)
    return float(
        z[at]
    ), f"(row, column, channel) {at}: {c.ours[at]} against {c.reference[at]}, z = {z[at]:.2f}"


def by_blocks(c: Comparison) -> Comparison:
    """The same comparison of block means."""
    return Comparison(
        block_means(c.ours),
        block_means(c.our_variance) / BLOCK**2,
        block_means(c.cautious_variance) / BLOCK**2,
        block_means(c.reference),
        block_means(c.reference_variance) / BLOCK**2,
    )


def mean_differs(c: Comparison) -> str | None:
    """Words about the first channel whose mean is off; ``None`` if all are right."""
    pixels = c.ours[..., 0].size
    for channel in range(3):
        ours, reference = c.ours[..., channel].mean(), c.reference[..., channel].mean()
        variance = (c.our_variance + c.reference_variance)[..., channel].sum() / pixels**2
        if abs(ours - reference) > max(3 * np.sqrt(variance), 0.003 * reference):
            return f"channel {channel}: {ours} against {reference} ± {np.sqrt(variance)}"
    return None


def test_image_mean(comparison: Comparison) -> None:
    assert mean_differs(comparison) is None


@pytest.mark.parametrize("comparison", [name for name in SAMPLES if name not in HEAVY_TAILS], indirect=True)
def test_every_pixel(comparison: Comparison) -> None:
    z, report = worst_z(comparison)
    assert z < z_limit(comparison.ours.size), report


def test_every_block(comparison: Comparison) -> None:
    blocks = by_blocks(comparison)
    z, report = worst_z(blocks)
    assert z < z_limit(blocks.ours.size), report


def test_what_is_wrong_is_noticed() -> None:
    c = compare("cornell-box")
    assert mean_differs(c._replace(ours=1.01 * c.ours)) is not None
    brighter_corner = c.ours.copy()
    brighter_corner[:16, :16] += 0.1 * brighter_corner.mean()
    blocks = by_blocks(c._replace(ours=brighter_corner))
    assert worst_z(blocks)[0] > z_limit(blocks.ours.size)
    one_pixel = c.ours.copy()
    one_pixel[100, 100] += 10 * np.sqrt(c.cautious_variance[100, 100])
    assert worst_z(c._replace(ours=one_pixel))[0] > z_limit(c.ours.size)
