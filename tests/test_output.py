"""Files: what is in them, and that there is never half of one."""

import os

import numpy as np
import OpenEXR
import pytest
from PIL import Image

import steradian as sr


@pytest.fixture(scope="module")
def result():
    scene = {
        "type": "scene",
        "camera": {
            "type": "perspective",
            "fov": 40.0,
            "to_world": sr.Transform.look_at((0, 0, 5), (0, 0, 0)),
            "film": {"type": "hdrfilm", "width": 9, "height": 7},
        },
        "ball": {"type": "sphere"},
        "sky": {"type": "constant", "radiance": {"type": "rgb", "value": [0.5, 0.25, 2.0]}},
    }
    return sr.render(sr.load(scene), spp=16, seed=2**40, max_depth=3)


def test_exr_has_every_layer_and_the_settings(result, tmp_path):
    path = tmp_path / "größe.exr"
    result.write(path)
    with OpenEXR.File(str(path), separate_channels=True) as file:
        header, channels = dict(file.header()), {n: c.pixels for n, c in file.channels().items()}
    for prefix, names, array in [
        ("", "RGB", result.image),
        ("stderr.", "RGB", result.stderr),
        ("albedo.", "RGB", result.albedo),
        ("normal.", "XYZ", result.normal),
    ]:
        for c, name in enumerate(names):
            plane = channels.pop(prefix + name)
            assert plane.dtype == np.float32
            assert (plane == array[..., c]).all(), prefix + name
    assert (channels.pop("depth.Z") == result.depth).all()
    assert (channels.pop("alpha.A") == result.alpha).all()
    assert not channels
    assert np.isinf(result.depth[0, 0])
    assert header["steradian.spp"] == 16
    assert header["steradian.max_depth"] == 3
    assert header["steradian.seed"] == str(2**40)
    assert header["steradian.strategy"] == "mis(bsdf, light)"
    assert header["steradian.mean_relative_error"] == pytest.approx(result.mean_relative_error)
    assert header["software"].startswith("Steradian ")


def test_png_is_encoded_for_display_and_has_the_settings(result, tmp_path):
    path = tmp_path / "a.png"
    result.write(path, exposure=-1.0)
    with Image.open(path) as file:
        codes, text = np.asarray(file), file.text
    # The background, half as bright: 0.25, 0.125 and 1 in sRGB (IEC 61966-2-1).
    assert codes[0, 0].tolist() == [137, 99, 255]
    assert codes.shape == (7, 9, 3)
    assert text["steradian.spp"] == "16"
    assert text["steradian.exposure"] == "-1"
    for tone in ("reinhard", "filmic"):
        result.write(path, tone=tone)
        with Image.open(path) as file:
            assert (np.asarray(file) != codes).any(), tone


def test_notebooks_show_the_image(result):
    assert result._repr_png_().startswith(b"\x89PNG")


@pytest.mark.parametrize(
    ("name", "options", "error", "words"),
    [
        ("a.jpg", {}, ValueError, ".exr or .png"),
        ("a", {}, ValueError, ".exr or .png"),
        ("none/a.exr", {}, FileNotFoundError, "a.exr"),
        ("folder.exr", {}, OSError, "folder.exr"),
        ("a.png", {"tone": "sepia"}, ValueError, "sepia"),
        ("a.png", {"exposure": float("nan")}, ValueError, "stops"),
    ],
)
def test_what_cannot_be_written_leaves_nothing(result, tmp_path, name, options, error, words):
    (tmp_path / "folder.exr").mkdir()
    with pytest.raises(error, match=words):
        result.write(tmp_path / name, **options)
    assert os.listdir(tmp_path) == ["folder.exr"]


def test_a_file_is_replaced_as_a_whole(result, tmp_path):
    path = tmp_path / "a.exr"
    path.write_bytes(b"old")
    result.write(path)
    with OpenEXR.File(str(path)) as file:
        assert file.header()["steradian.spp"] == 16
    assert os.listdir(tmp_path) == ["a.exr"]
