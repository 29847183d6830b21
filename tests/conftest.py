"""Scenes that tests share."""

from __future__ import annotations

from pathlib import Path

import pytest

import steradian as sr

ROOT = Path(__file__).resolve().parent.parent
CORNELL_BOX = ROOT / "scenes" / "cornell-box.xml"


@pytest.fixture(scope="session")
def cornell_path() -> Path:
    """The file of our Cornell box."""
    return CORNELL_BOX


@pytest.fixture(scope="session")
def cornell() -> sr.Scene:
    """Our Cornell box, loaded."""
    return sr.load(CORNELL_BOX)


@pytest.fixture
def lit_square() -> dict:
    """A camera before a square that glows with radiance (1, 2, 3), and nothing else."""
    return {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 2},
        "camera": {
            "type": "perspective",
            "fov": 10.0,
            "to_world": sr.Transform.look_at((0, 0, 5), (0, 0, 0)),
            "film": {"type": "hdrfilm", "width": 8, "height": 6, "rfilter": {"type": "box"}},
            "sampler": {"type": "independent", "sample_count": 16},
        },
        "square": {
            "type": "rectangle",
            "to_world": sr.Transform.scale(10),
            "emitter": {"type": "area", "radiance": {"type": "rgb", "value": [1.0, 2.0, 3.0]}},
            "bsdf": {"type": "diffuse", "reflectance": {"type": "rgb", "value": [0.25, 0.5, 0.75]}},
        },
    }
