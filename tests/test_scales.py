"""The unit of length is nobody's business: scenes of any size look the same."""

import numpy as np
import pytest

import steradian as sr

SHAPES = ["sphere", "disk", "cylinder", "rectangle", "cube", "bilinearpatch"]
LIGHTS = ["constant", "sphere", "rectangle", "disk", "cylinder", "shape"]


def scene(kind: str, light: str, unit: float) -> dict[str, object]:
    """A shape over a floor under a light, everything `unit` times as large."""
    all_larger = sr.Transform.scale(unit)
    shape = {"type": kind, "to_world": all_larger, "bsdf": {"type": "twosided", "bsdf": {"type": "diffuse"}}}
    lit = {
        "type": "scene",
        "sensor": {
            "type": "perspective",
            "fov": 50.0,
            "near_clip": 1e-2 * unit,
            "far_clip": 1e3 * unit,
            "to_world": sr.Transform.look_at(np.multiply((0.5, 0.7, 4), unit), (0, 0, 0)),
        },
        "shape": shape,
        "floor": {
            "type": "rectangle",
            "to_world": all_larger.translate((0, -1.5, 0)).rotate((1, 0, 0), -90).scale(5),
        },
    }
    if light == "constant":
        lit["light"] = {"type": "constant"}
    elif light == "shape":
        shape["emitter"] = {"type": "area"}
    else:
        above = all_larger.look_at((0, 3, 3), (0, 0, 0)).scale(0.5)
        bright = {"type": "area", "radiance": {"type": "rgb", "value": 100.0}}
        lit["light"] = {"type": light, "to_world": above, "emitter": bright}
    return lit


@pytest.mark.parametrize(
    ("kind", "light"),
    [
        (kind, light)
        for kind in SHAPES
        for light in LIGHTS
        if (kind, light) != ("bilinearpatch", "shape")  # which cannot emit
    ],
)
def test_size_does_not_matter(kind, light):
    images = [
        sr.render(sr.load(scene(kind, light, unit)), spp=4, size=(24, 24)).image for unit in (1, 1e-14, 1e14)
    ]
    assert images[0].mean() > 0.01
    for image in images[1:]:
        # a few rays fall to the other side of an edge
        assert np.abs(image - images[0]).mean() < 0.01 * images[0].mean()
