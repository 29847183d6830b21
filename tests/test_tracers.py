"""The default tracer, which follows many paths at a time, against the general one, which follows one.

Every kind of light and of material, and scenes in which many rays hit nothing.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

import steradian as sr

BATCHES = "mis(bsdf, light)"
ONE_BY_ONE = "mis(light, bsdf)"
# Two-sided, for 28 scenes of 3 channels at a family failure rate of 1 %: Šidák gives 1.2e-4 each. Of eight
# replicates, errors are known to a quarter: this is the quantile of Student's t with 14 degrees of freedom.
T_LIMIT = 5.27

Part = dict[str, Any]
RANDOM = np.random.default_rng(3)


def rgb(*values: float) -> Part:
    return {"type": "rgb", "value": list(values)}


def shining(radiance: Part) -> Part:
    return {"type": "area", "radiance": radiance}


def quad(*corners: tuple[float, float, float], bsdf: Part) -> Part:
    return {
        "type": "mesh",
        "vertices": np.array(corners, float),
        "faces": np.array([[0, 1, 2], [0, 2, 3]]),
        "uvs": np.array([[0, 0], [0, 1], [1, 1], [1, 0]], float),
        "bsdf": bsdf,
    }


WHITE: Part = {"type": "diffuse", "reflectance": rgb(0.7, 0.6, 0.5)}
BITMAP: Part = {"type": "bitmap", "data": RANDOM.random((8, 8, 3)).astype(np.float32)}
BUMPS: Part = {"type": "bitmap", "raw": True, "data": RANDOM.random((8, 8, 3)).astype(np.float32)}
SKY: Part = {"type": "constant", "radiance": rgb(0.2, 0.3, 0.4)}
GROUND = quad((-3, -1, -3), (-3, -1, 3), (3, -1, 3), (3, -1, -3), bsdf={"type": "twosided", "b": WHITE})
WALL = quad((-3, -1, -3), (3, -1, -3), (3, 4, -3), (-3, 4, -3), bsdf=WHITE)
TETRAHEDRON = np.array([[1, 2, 0], [2, 2, 0], [1.5, 2, 1], [1.5, 2.7, 0.5]], float)


def towards(x: float, y: float, z: float) -> sr.Transform:
    return sr.Transform.look_at((x, y, z), (0, 0, 0))


LIGHTS: dict[str, Part] = {
    "rectangle": {"type": "rectangle", "to_world": towards(-1, 3, 0), "emitter": shining(rgb(3, 2, 1))},
    "mesh": {
        "type": "mesh",
        "vertices": TETRAHEDRON,
        "faces": np.array([[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]]),
        "emitter": shining(rgb(1, 2, 3)),
    },
    "lamp": {"type": "sphere", "center": [-2, 0, -1], "radius": 0.4, "emitter": shining(rgb(4, 1, 1))},
    "room": {
        "type": "sphere",
        "center": [0.1, 0.2, 0.3],
        "radius": 9,
        "flip_normals": True,
        "emitter": shining(rgb(0.1, 0.1, 0.2)),
    },
    "disk": {"type": "disk", "to_world": towards(2, 1, -1), "emitter": shining(rgb(1, 3, 1))},
    "picture": {"type": "rectangle", "to_world": towards(0, 3.5, -2), "emitter": shining(BITMAP)},
    "planet": {"type": "sphere", "center": [1.5, 0, 1.5], "radius": 0.3, "emitter": shining(BITMAP)},
    "point": {"type": "point", "position": [0, 2, 2], "intensity": rgb(2, 2, 2)},
    "spot": {"type": "spot", "to_world": towards(0, 3, 3), "cutoff_angle": 30, "intensity": rgb(5, 5, 1)},
    "sun": {"type": "directional", "direction": [0.3, -1, -0.2], "irradiance": rgb(0.5, 0.5, 0.5)},
    "sky": SKY,
}

MATERIALS: dict[str, Part] = {
    "dielectric": {"type": "dielectric"},
    "thindielectric": {"type": "thindielectric"},
    "roughdielectric": {"type": "roughdielectric", "alpha": 0.2},
    "conductor": {"type": "conductor", "material": "Au"},
    "roughconductor": {"type": "roughconductor", "alpha": 0.2},
    "brushed": {"type": "roughconductor", "alpha_u": 0.05, "alpha_v": 0.4},
    "plastic": {"type": "plastic"},
    "roughplastic": {"type": "roughplastic", "alpha": 0.2},
    "holes": {"type": "mask", "opacity": BITMAP, "b": {"type": "twosided", "b": WHITE}},
    "bumps": {"type": "bumpmap", "t": BUMPS, "scale": 0.5, "b": {"type": "twosided", "b": WHITE}},
    "two sides": {"type": "twosided", "a": WHITE, "b": {"type": "roughconductor", "alpha": 0.3}},
    "textured": {"type": "twosided", "b": {"type": "diffuse", "reflectance": BITMAP}},
}


def scene(**parts: Part) -> Part:
    return {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 6, "rr_depth": 4},
        "camera": {
            "type": "perspective",
            "fov": 50,
            "to_world": sr.Transform.look_at((0, 1, 5), (0, 0, 0)),
            "film": {"type": "hdrfilm", "width": 24, "height": 18, "rfilter": {"type": "box"}},
        },
        **parts,
    }


def ball(bsdf: Part) -> Part:
    return {"type": "sphere", "center": [0, -0.3, 0], "radius": 0.6, "bsdf": bsdf}


def panel(bsdf: Part) -> Part:
    return quad((-2, -0.9, 1), (2, -0.9, 0.5), (2, 1.2, -0.5), (-2, 1.2, 0), bsdf=bsdf)


# What is left over of a vertex, or of none, must not count where a ray hits nothing: lights at the origin and
# facing away from it, lights that emit nothing, scenes without a triangle.
LAMP_AT_ORIGIN: Part = {"type": "sphere", "radius": 0.5, "emitter": shining(rgb(5, 5, 5))}
SPARSE: dict[str, Part] = {
    "lamp at the origin, spheres only": scene(
        lamp=LAMP_AT_ORIGIN,
        ball={"type": "sphere", "center": [2, 0, 0], "radius": 0.7, "bsdf": WHITE},
        sky=SKY,
    ),
    "lamp at the origin": scene(lamp=LAMP_AT_ORIGIN, ground=GROUND),
    "lamp that faces away": scene(
        lamp={
            "type": "disk",
            "to_world": sr.Transform.look_at((0, 2, 0), (0, 5, 0), (0, 0, 1)),
            "emitter": shining(rgb(5, 5, 5)),
        },
        ground=GROUND,
        sky=SKY,
    ),
    "lamp that is off": scene(
        lamp={"type": "sphere", "radius": 0.5, "emitter": shining(rgb(0, 0, 0))},
        ground=GROUND,
        point=LIGHTS["point"],
    ),
}

SCENES: dict[str, Part] = {
    **SPARSE,
    **{
        f"light: {name}": scene(ground=GROUND, wall=WALL, ball=ball(WHITE), light=light)
        for name, light in LIGHTS.items()
    },
    "all lights": scene(
        ground=GROUND, wall=WALL, ball=ball(WHITE), **{k: v for k, v in LIGHTS.items() if k != "room"}
    ),
    **{
        f"material: {name}": scene(
            ground=GROUND,
            wall=WALL,
            ball=ball(bsdf),
            panel=panel(bsdf),
            rectangle=LIGHTS["rectangle"],
            sun=LIGHTS["sun"],
            sky=SKY,
        )
        for name, bsdf in MATERIALS.items()
    },
}


@pytest.mark.parametrize("name", SCENES)
def test_both_tracers_agree(name: str) -> None:
    loaded = sr.load(SCENES[name])
    batches = sr.render(loaded, spp=256, strategy=BATCHES, seed=1)
    one_by_one = sr.render(loaded, spp=256, strategy=ONE_BY_ONE, seed=2)
    assert batches.rejected_samples == one_by_one.rejected_samples == 0
    for channel in range(3):
        difference = batches.mean[channel] - one_by_one.mean[channel]
        error = math.hypot(batches.mean_stderr[channel], one_by_one.mean_stderr[channel])
        assert error < 0.05 * one_by_one.mean[channel], "too noisy to tell"
        assert abs(difference) <= T_LIMIT * error, f"channel {channel}: {difference} ± {error}"
    for feature in ("albedo", "normal", "alpha"):
        a, b = getattr(batches, feature), getattr(one_by_one, feature)
        assert np.abs(a - b).mean() < 0.02, feature


@pytest.mark.parametrize("name", SPARSE)
def test_leftovers_make_no_difference(name: str) -> None:
    loaded = sr.load(SPARSE[name])
    whole = sr.render(loaded, spp=21, threads=1)
    parts = sr.render(loaded, spp=14, first_sample=7, threads=2).merge(sr.render(loaded, spp=7, threads=2))
    assert np.array_equal(whole.image, parts.image)
    assert np.array_equal(whole.stderr, parts.stderr)
