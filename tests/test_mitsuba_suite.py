"""Mitsuba's own statistical tests, against Mitsuba's own references.

They are in ``mitsuba-suite/tests`` of the folder that ``test_references`` describes. Each reference is an
image and the variance of *one sample* of each of its pixels. The number of samples behind it is not stated;
it is in the thousands, so that, as in Mitsuba's own test, the reference counts as exact. Also as there, a
sample's variance is taken as at least 1e-4: constant pixels are rounded in the references. The tests are
those of ``test_references``, with their failure rate.

Left out are the scenes with media, and ``various_shapes``, of which three meshes are not in the suite.
"""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from test_references import (
    SCENES,
    Comparison,
    by_blocks,
    largest_around,
    mean_differs,
    read_exr,
    require,
    worst_z,
    z_limit,
)

import steradian as sr

SUITE = SCENES / "mitsuba-suite"
SPP = 256
LEAST_VARIANCE = 1e-4

# A scene, and its references without "_ref_rgb.exr".
CASES = {
    "floating_sphere/test_directional_direct": "test_directional",
    "orthographic_sensor/test_orthographic_path": "test_orthographic",
    "texture_interp/test_texture_interp_direct": "test_texture_interp",
    "participating_media/test_surf_area_light_volpath": "test_surf_area_light",
}

# Its references show the white sky as 1.0011, 0.9997, 0.9997, which Mitsuba 3.9 no longer does.
WITH_A_ROUNDED_SKY = "orthographic_sensor/test_orthographic_path"


def compare(name: str) -> Comparison:
    """Renders a scene at the size of its reference."""
    require(SUITE)
    scene_path = SUITE / "tests" / f"{name}.xml"
    references = scene_path.parent / "refs"
    reference = read_exr(references / f"{CASES[name]}_ref_rgb.exr")
    if name == WITH_A_ROUNDED_SKY:
        reference /= reference[0, 0]
    of_one_sample = read_exr(references / f"{CASES[name]}_ref_rgb_var.exr")
    with warnings.catch_warnings():
        # that moments are not written, and that <path> leads nowhere in the suite as it is here
        warnings.simplefilter("ignore", sr.SceneWarning)
        scene = sr.load(scene_path, search_paths=[SUITE / "common"])
    height, width = reference.shape[:2]
    result = sr.render(scene, spp=SPP, size=(width, height), seed=1)
    assert result.rejected_samples == 0, "NaN or infinity"
    our_variance = result.stderr.astype(np.float64) ** 2
    predicted = np.maximum(of_one_sample, LEAST_VARIANCE) / SPP
    return Comparison(
        result.image.astype(np.float64),
        our_variance,
        largest_around(np.maximum(our_variance, predicted)),
        reference,
        np.zeros_like(reference),
    )


@pytest.fixture(scope="module", params=CASES)
def comparison(request: pytest.FixtureRequest) -> Comparison:
    """One of the scenes, rendered once for all tests."""
    return compare(request.param)


def test_image_mean(comparison: Comparison) -> None:
    assert mean_differs(comparison) is None


def test_every_pixel(comparison: Comparison) -> None:
    z, report = worst_z(comparison)
    assert z < z_limit(comparison.ours.size), report


def test_every_block(comparison: Comparison) -> None:
    blocks = by_blocks(comparison)
    z, report = worst_z(blocks)
    assert z < z_limit(blocks.ours.size), report


def test_what_is_wrong_is_noticed() -> None:
    c = compare("floating_sphere/test_directional_direct")
    assert mean_differs(c._replace(ours=1.01 * c.ours)) is not None
    shifted = by_blocks(c._replace(ours=np.roll(c.ours, 1, axis=1)))
    assert worst_z(shifted)[0] > z_limit(shifted.ours.size)
