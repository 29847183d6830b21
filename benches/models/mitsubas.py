"""Mitsuba's scalar models, called from Python.

A call from Python costs more than most models do. It costs the same for a model that does nothing, ``null``,
so that is subtracted. The fastest of many turns counts, and turns of both alternate.
"""

from __future__ import annotations

import math
import time
from collections.abc import Callable
from typing import Any

TURNS = 60
CALLS = 400

HALF = {"type": "rgb", "value": [0.5, 0.5, 0.5]}
MODELS: dict[str, dict[str, Any]] = {
    "diffuse": {"type": "diffuse", "reflectance": HALF},
    "mask": {"type": "mask", "opacity": 0.5, "inner": {"type": "diffuse", "reflectance": HALF}},
    "dielectric": {"type": "dielectric", "int_ior": 1.5, "ext_ior": 1.0},
    "thindielectric": {"type": "thindielectric", "int_ior": 1.5, "ext_ior": 1.0},
    "roughdielectric, ggx": {
        "type": "roughdielectric",
        "alpha": 0.3,
        "distribution": "ggx",
        "int_ior": 1.5,
        "ext_ior": 1.0,
    },
    "roughdielectric, beckmann": {"type": "roughdielectric", "alpha": 0.3, "int_ior": 1.5, "ext_ior": 1.0},
    "conductor": {"type": "conductor", "material": "Cu"},
    "roughconductor, ggx": {"type": "roughconductor", "alpha": 0.3, "distribution": "ggx", "material": "Cu"},
    "roughconductor, beckmann": {"type": "roughconductor", "alpha": 0.3, "material": "Cu"},
    "plastic": {"type": "plastic", "diffuse_reflectance": HALF, "int_ior": 1.5, "ext_ior": 1.0},
    "roughplastic, ggx": {
        "type": "roughplastic",
        "alpha": 0.3,
        "distribution": "ggx",
        "diffuse_reflectance": HALF,
        "int_ior": 1.5,
        "ext_ior": 1.0,
    },
    "principled": {"type": "principled", "base_color": HALF, "metallic": 1.0, "roughness": 0.5},
    "principled, all lobes": {
        "type": "principled",
        "base_color": HALF,
        "metallic": 0.3,
        "roughness": 0.5,
        "spec_trans": 0.5,
        "sheen": 0.5,
        "clearcoat": 0.5,
    },
    "principledthin": {"type": "principledthin", "base_color": HALF, "spec_trans": 0.5},
    "blendbsdf": {
        "type": "blendbsdf",
        "weight": 0.6,
        "first": {"type": "diffuse", "reflectance": HALF},
        "second": {"type": "roughconductor", "alpha": 0.3, "distribution": "ggx", "material": "Cu"},
    },
}


def measure(name: str, angle: float) -> dict[str, float]:
    """Nanoseconds of ``sample``, ``eval`` and ``pdf``."""
    import mitsuba as mi

    mi.set_variant("scalar_rgb")
    context = mi.BSDFContext()
    hit = mi.SurfaceInteraction3f()
    hit.wi = mi.Vector3f(math.sin(math.radians(angle)), 0, math.cos(math.radians(angle)))
    points = [mi.Point2f((i + 0.5) / CALLS, (i * 0.618034) % 1) for i in range(CALLS)]
    lobes = [(i * 0.754878) % 1 for i in range(CALLS)]
    directions = [mi.warp.square_to_uniform_sphere(point) for point in points]

    def calls(bsdf: Any) -> dict[str, Callable[[], None]]:
        def sample() -> None:
            for lobe, point in zip(lobes, points, strict=True):
                bsdf.sample(context, hit, lobe, point)

        def evaluate() -> None:
            for direction in directions:
                bsdf.eval(context, hit, direction)

        def pdf() -> None:
            for direction in directions:
                bsdf.pdf(context, hit, direction)

        return {"sample": sample, "eval": evaluate, "pdf": pdf}

    nothing, model = calls(mi.load_dict({"type": "null"})), calls(mi.load_dict(MODELS[name]))
    found = {}
    for function in model:
        fastest = [math.inf, math.inf]
        for _ in range(TURNS):
            for i, call in enumerate((nothing[function], model[function])):
                began = time.perf_counter()
                call()
                fastest[i] = min(fastest[i], time.perf_counter() - began)
        found[function] = (fastest[1] - fastest[0]) / CALLS * 1e9
    return found
