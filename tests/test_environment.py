"""An environment that is put around a scene from outside."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import steradian as sr
from steradian.cli.arguments import parse

CUBE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


@pytest.fixture
def grey(tmp_path: Path) -> Path:
    """A sky of radiance 0.25 as a portable float map."""
    path = tmp_path / "grey.pfm"
    path.write_bytes(b"PF\n4 2\n-1.0\n" + np.full((2, 4, 3), 0.25, "<f4").tobytes())
    return path


def test_the_background_is_the_image(tmp_path: Path, grey: Path) -> None:
    mesh = tmp_path / "triangle.obj"
    mesh.write_text(CUBE)
    with pytest.warns(sr.SceneWarning, match="no camera"):
        scene = sr.load(mesh, environment=grey)
    image = sr.render(scene, spp=1, size=(16, 16)).image
    assert np.allclose(image[0, 0], 0.25, rtol=1e-5)
    assert [d.code for d in scene.diagnostics] == ["scene::no-camera"]


def test_dictionaries_take_one_too(grey: Path) -> None:
    scene = {"type": "scene", "camera": {"type": "perspective", "fov": 45}, "a": {"type": "point"}}
    assert sr.load(scene, environment=grey).info()["lights"] == 2
    with pytest.warns(sr.SceneWarning, match="an environment of its own"):
        sr.load({**scene, "sky": {"type": "constant"}}, environment=grey)


def test_the_command_takes_it() -> None:
    assert parse(["render", "a.glb", "--environment", "sky.hdr"]).environment == "sky.hdr"
    assert parse(["info", "a.glb"]).environment is None
