"""Curves and hair, rendered: what is known without another renderer."""

from pathlib import Path

import numpy as np
import pytest

import steradian as sr

TUFT = Path(__file__).parents[1] / "scenes/gallery/data/tuft.txt"


def scene(shape: dict[str, object]) -> sr.Scene:
    """A shape in light from everywhere."""
    return sr.load(
        {
            "type": "scene",
            "sensor": {
                "type": "perspective",
                "fov": 40.0,
                "to_world": sr.Transform.look_at((0, -3, 1.2), (0, 0, 0.5), (0, 0, 1)),
            },
            "light": {"type": "constant"},
            "shape": shape,
        }
    )


@pytest.mark.parametrize("roughness", [0.1, 0.3, 0.9])
def test_hair_that_absorbs_nothing_is_not_seen(roughness: float) -> None:
    """A white furnace: every path ends in light of 1, and has lost nothing."""
    hair = {
        "type": "hair",
        "sigma_a": {"type": "rgb", "value": 0.0},
        "longitudinal_roughness": roughness,
        "azimuthal_roughness": roughness,
    }
    shape = {"type": "bsplinecurve", "filename": str(TUFT), "bsdf": hair}
    result = sr.render(scene(shape), spp=16, size=(48, 32), max_depth=-1, strategy="bsdf")
    assert result.depth[np.isfinite(result.depth)].size > 100
    assert result.rejected_samples == 0
    # What is left to chance is the roulette; beyond four standard errors in one of 16,000 runs.
    error = np.abs(result.image.mean(axis=(0, 1), dtype=np.float64) - 1)
    allowed = np.sqrt((result.stderr.astype(np.float64) ** 2).sum(axis=(0, 1))) / result.image[..., 0].size
    assert (error < 4 * allowed).all() and allowed.max() < 1e-3


def test_a_chain_of_one_place_is_a_sphere(tmp_path: Path) -> None:
    """Both meet the same rays at the same places: the images differ by rounding."""
    path = tmp_path / "place.txt"
    path.write_text("0 0 0.5 0.4\n0 0 0.5 0.4\n")
    curve = {"type": "linearcurve", "filename": str(path)}
    sphere = {"type": "sphere", "center": (0, 0, 0.5), "radius": 0.4}
    images = [sr.render(scene(shape), spp=16, size=(32, 32), seed=3).image for shape in (curve, sphere)]
    assert np.abs(images[0] - images[1]).mean() < 1e-3
    assert images[0].min() < 0.8
