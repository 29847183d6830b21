"""Scenes in other formats: what is converted, and read again, looks the same.

Gallery scenes go to a format and back. Means over blocks are compared by z, Šidák-corrected over all blocks,
channels and scenes of a format: a format's test fails by chance once in ten thousand times; seeds are fixed.
What a format says in other words, such as triangles for spheres, may differ by half a percent (glTF: one
percent) of the picture's mean besides.
"""

from __future__ import annotations

import base64
import json
import re
import struct
import warnings
from pathlib import Path
from statistics import NormalDist

import numpy as np
import pytest

import steradian as sr
from steradian.cli import main

ROOT = Path(__file__).resolve().parent.parent
GALLERY = sorted((ROOT / "scenes" / "gallery").glob("*.xml"))
FAMILY_LEVEL = 1e-4
BLOCK = 8
WIDTH = 48

# What pbrt says only nearly, each with a diagnostic.
NOT_IN_PBRT = {
    "area-textured": "texture",
    "bumpmap": "tilted-normals",
    "coatedconductor": "microfacets",
    "coateddiffuse": "microfacets",
    "curves": "curves",
    "envmap": "resampled",
    "envmap-compensated": "resampled",
    "envmap-portal": "resampled",
    "eon": "approximated",
    "goniometric": "light",
    "hair": "curves",
    "metallicroughness": "approximated",
    "multiscatter": "microfacets",
    "multiscatter-dielectric": "microfacets",
    "perspective": "camera",
    "principled": "approximated",
    "principled-cloth": "approximated",
    "principledthin": "approximated",
    "projector": "light",
    "roughconductor": "microfacets",
    "roughdielectric": "microfacets",
    "roughdiffuse": "approximated",
    "spot-textured": "light",
}
# What glTF says, besides lights around the scene, which it has none of.
IN_GLTF = [
    "area-cube",
    "area-rectangle",
    "area-sphere",
    "bilinearpatch",
    "catmullrom",
    "curves",
    "cylinder",
    "diffuse",
    "groups",
    "metallicroughness",
    "orthographic",
    "scale_mix",
]


def rendered(path: Path, seed: int, spp: int = 64) -> tuple[np.ndarray, np.ndarray]:
    """Means over blocks, and their variances."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sr.SceneWarning)
        scene = sr.load(path)
    # Of the scene's own shape: formats differ in what they keep of the view if it becomes another.
    height = round(WIDTH * scene.settings.height / scene.settings.width)
    result = sr.render(scene, spp=spp, size=(WIDTH, height), seed=seed, max_depth=scene.settings.max_depth)
    assert result.rejected_samples == 0
    image, variance = result.image.astype(np.float64), result.stderr.astype(np.float64) ** 2
    return blocks(image), blocks(variance) / BLOCK**2


def blocks(image: np.ndarray) -> np.ndarray:
    height, width = (n // BLOCK for n in image.shape[:2])
    whole = image[: height * BLOCK, : width * BLOCK]
    return whole.reshape(height, BLOCK, width, BLOCK, 3).mean(axis=(1, 3))


def converted(source: Path, out: Path, **arguments: object) -> sr.Converted:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sr.SceneWarning)
        return sr.convert(source, out, **arguments)


def differs(source: Path, out: Path, tests: int, tolerance: float) -> str | None:
    """Words about the worst block, if it is too far off."""
    (ours, our_variance), (other, other_variance) = rendered(source, 1), rendered(out, 2)
    limit = NormalDist().inv_cdf(1 - (1 - (1 - FAMILY_LEVEL) ** (1 / (tests * ours.size))) / 2)
    allowed = limit * np.sqrt(our_variance + other_variance) + tolerance * ours.mean()
    over = np.abs(other - ours) / np.maximum(allowed, 1e-12)
    at = np.unravel_index(np.argmax(over), over.shape)
    return None if over[at] < 1 else f"{source.stem}, block {at}: {other[at]} against {ours[at]}"


@pytest.mark.parametrize("source", GALLERY, ids=lambda path: path.stem)
def test_xml_comes_back(source: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.xml"
    assert converted(source, out, own_plugins=True).approximations == ()
    assert differs(source, out, len(GALLERY), 1e-4) is None


@pytest.mark.parametrize("source", GALLERY, ids=lambda path: path.stem)
def test_pbrt_comes_back(source: Path, tmp_path: Path) -> None:
    out = tmp_path / "out.pbrt"
    codes = {d.code.removeprefix("convert::") for d in converted(source, out).approximations}
    expected = NOT_IN_PBRT.get(source.stem)
    if expected is None:
        assert differs(source, out, len(GALLERY), 0.005) is None
    else:
        assert expected in codes


@pytest.mark.parametrize("name", IN_GLTF)
@pytest.mark.parametrize("extension", ["gltf", "glb"])
def test_gltf_comes_back(name: str, extension: str, tmp_path: Path) -> None:
    text = (ROOT / "scenes" / "gallery" / f"{name}.xml").read_text()
    # There is neither light around a scene in glTF, nor are there filters and depths.
    text = re.sub(r'<emitter type="constant">.*?</emitter>', "", text, flags=re.S)
    text = re.sub(r'<integer name="max_depth" value="\d+"/>', '<integer name="max_depth" value="-1"/>', text)
    text = re.sub(r'<rfilter type="\w+"/>', '<rfilter type="gaussian"/>', text)
    text = text.replace('value="data/', f'value="{ROOT}/scenes/gallery/data/')
    source = tmp_path / "in.xml"
    source.write_text(text)
    out = tmp_path / f"out.{extension}"
    converted(source, out)
    assert differs(source, out, 2 * len(IN_GLTF), 0.01) is None


def test_further_texture_coordinates_come_back(tmp_path: Path) -> None:
    """A square whose texture takes its second coordinates: written with both, and shown alike."""
    corners = [(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)]
    first, second = [(0, 0)] * 4, [(0, 1), (1, 1), (1, 0), (0, 0)]
    rows = [
        struct.pack(f"<{n}f", *row) for n, table in ((3, corners), (2, first), (2, second)) for row in table
    ]
    data = b"".join(rows) + struct.pack("<6H", 0, 1, 2, 0, 2, 3)
    image = b"P6 2 2 255\n" + bytes([255, 0, 0, 0, 255, 0, 0, 0, 255, 255, 255, 255])

    def uri(content: bytes) -> str:
        return "data:;base64," + base64.b64encode(content).decode()

    sizes = [(0, 48), (48, 32), (80, 32), (112, 12)]
    kinds = [(5126, 4, "VEC3"), (5126, 4, "VEC2"), (5126, 4, "VEC2"), (5123, 6, "SCALAR")]
    attributes = {"POSITION": 0, "TEXCOORD_0": 1, "TEXCOORD_1": 2}
    # Tangents follow the first set, which the normals take.
    material = {
        "pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 1}, "metallicFactor": 0},
        "normalTexture": {"index": 1},
    }
    model = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": len(data), "uri": uri(data)}],
        "bufferViews": [{"buffer": 0, "byteOffset": start, "byteLength": size} for start, size in sizes],
        "accessors": [
            {"bufferView": at, "componentType": component, "count": count, "type": kind}
            for at, (component, count, kind) in enumerate(kinds)
        ],
        "images": [{"uri": uri(image)}, {"uri": uri(b"P6 1 1 255\n" + bytes([128, 128, 255]))}],
        "textures": [{"source": 0}, {"source": 1}],
        "materials": [material],
        "meshes": [{"primitives": [{"attributes": attributes, "indices": 3, "material": 0}]}],
        "nodes": [{"mesh": 0}],
    }
    source = tmp_path / "square.gltf"
    source.write_text(json.dumps(model))
    out = tmp_path / "again.gltf"
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", sr.SceneWarning)
        sr.convert(source, out)
        said = sr.convert(source, tmp_path / "square.xml").approximations
        scenes = [sr.load(path) for path in (source, out)]
    assert "convert::texture-coordinates" in [note.code for note in said]
    written = json.loads(out.read_text())
    assert {"TEXCOORD_0", "TEXCOORD_1"} <= set(written["meshes"][0]["primitives"][0]["attributes"])
    base = written["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]
    assert base["texCoord"] == 1
    images = [sr.render(scene, size=(48, 32), spp=64).image for scene in scenes]
    assert abs(images[0] - images[1]).mean() < 0.03 * images[0].mean()


def test_mirrors_of_pbrt_come_back_from_gltf(tmp_path: Path) -> None:
    """pbrt's views are mirrors of ours, unless they are scaled by -1; what is seen is not symmetric."""
    source, out = tmp_path / "in.pbrt", tmp_path / "out.gltf"
    lights = 'LightSource "point" "point3 from" [ 3 5 4 ] "rgb I" [ 60 50 40 ]'
    shapes = 'Shape "sphere" "float radius" 0.7 Translate 1.5 0 0 Shape "sphere" "float radius" 0.3'
    material = 'Material "diffuse" "rgb reflectance" [ 0.7 0.5 0.3 ]'
    for scale in ["", "Scale -1 1 1"]:
        view = f'{scale} LookAt 3 4 5 0 0 0 0 1 0 Camera "perspective" "float fov" 30'
        film = 'Film "rgb" "integer xresolution" 48 "integer yresolution" 32 PixelFilter "gaussian"'
        source.write_text(f"{film} {view} WorldBegin {lights} {material} {shapes}")
        converted(source, out, overwrite=True)
        assert differs(source, out, 2, 0.02) is None


def test_a_room_in_gltf_follows_the_rules_of_the_format(cornell_path: Path, tmp_path: Path) -> None:
    """What the specification asks of accessors, views and chunks, for want of its validator."""
    for name in ["room.gltf", "room.glb"]:
        out = converted(cornell_path, tmp_path / name)
        data = out.scene.read_bytes()
        if name.endswith("glb"):
            magic, version, length, chunk, kind = struct.unpack_from("<4sIII4s", data)
            assert (magic, version, length, kind) == (b"glTF", 2, len(data), b"JSON")
            root = json.loads(data[20 : 20 + chunk])
            size, kind = struct.unpack_from("<I4s", data, 20 + chunk)
            assert kind == b"BIN\0" and chunk % 4 == size % 4 == 0
            binary = data[28 + chunk :]
            assert len(binary) == size
        else:
            root = json.loads(data)
            binary = (tmp_path / root["buffers"][0]["uri"]).read_bytes()
        assert root["asset"]["version"] == "2.0"
        assert len(root["buffers"]) == 1 and root["buffers"][0]["byteLength"] == len(binary)
        check_accessors(root, binary)
        used = set(re.findall(r'"(KHR_\w+)"', json.dumps([root["materials"], root["nodes"]])))
        assert used <= set(root.get("extensionsUsed", []))


def check_accessors(root: dict, binary: bytes) -> None:
    """Alignment, bounds, counts, targets, indices that are in range, normals of unit length."""
    width = {"SCALAR": 1, "VEC2": 2, "VEC3": 3}
    dtype = {5126: "<f4", 5125: "<u4"}

    def values(index: int) -> np.ndarray:
        accessor = root["accessors"][index]
        view = root["bufferViews"][accessor["bufferView"]]
        count = accessor["count"] * width[accessor["type"]]
        assert view["byteOffset"] % 4 == 0 and view["byteLength"] == 4 * count > 0
        assert view["byteOffset"] + view["byteLength"] <= len(binary)
        found = np.frombuffer(binary, dtype[accessor["componentType"]], count, view["byteOffset"])
        return found.reshape(accessor["count"], -1)

    for mesh in root["meshes"]:
        for primitive in mesh["primitives"]:
            attributes = primitive["attributes"]
            positions = values(attributes["POSITION"])
            accessor = root["accessors"][attributes["POSITION"]]
            assert np.array_equal(positions.min(axis=0), np.float32(accessor["min"]))
            assert np.array_equal(positions.max(axis=0), np.float32(accessor["max"]))
            assert all(len(values(index)) == len(positions) for index in attributes.values())
            if "NORMAL" in attributes:
                assert np.allclose(np.linalg.norm(values(attributes["NORMAL"]), axis=1), 1, atol=1e-4)
            indices = values(primitive["indices"])
            assert len(indices) % 3 == 0 and indices.max() < len(positions)
            assert (
                root["bufferViews"][root["accessors"][primitive["indices"]]["bufferView"]]["target"] == 34963
            )
            assert primitive["material"] < len(root["materials"])


def test_a_dictionary_is_converted_too(lit_square: dict, tmp_path: Path) -> None:
    out = converted(lit_square, tmp_path / "square.pbrt")
    assert out.scene.read_text().count("AreaLightSource") == 1
    assert [file.name for file in out.files] == ["mesh0001-rectangle.ply", "square.pbrt"]


def test_depths_are_one_less_in_pbrt(lit_square: dict, tmp_path: Path) -> None:
    text = converted(lit_square, tmp_path / "square.pbrt").scene.read_text()
    assert '"integer maxdepth" 1\n' in text


def test_mitsubas_own_plugins_alone_are_named_by_default(tmp_path: Path) -> None:
    source = ROOT / "scenes" / "gallery" / "eon.xml"
    out = converted(source, tmp_path / "a.xml")
    assert any('"eon"' in d.message for d in out.approximations)
    assert 'type="eon"' not in out.scene.read_text()
    out = converted(source, tmp_path / "b.xml", own_plugins=True)
    assert 'type="eon"' in out.scene.read_text()


def test_the_command_line(cornell_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    out = tmp_path / "room.pbrt"
    assert main(["convert", str(cornell_path), str(out)]) == 0
    assert "wrote" in capsys.readouterr().out
    assert main(["convert", str(cornell_path), str(out)]) == 1
    assert "--force" in capsys.readouterr().err
    assert main(["convert", str(cornell_path), str(out), "--force", "--json"]) == 0
    values = json.loads(capsys.readouterr().out)
    assert values["files"][-1] == str(out) and values["bytes"] > 0
    assert values["approximations"] == sum(d["code"].startswith("convert::") for d in values["diagnostics"])


@pytest.mark.parametrize(
    ("name", "words"),
    [("room.obj", "must end in .xml, .pbrt, .gltf or .glb"), ("none/room.xml", "there is no folder")],
)
def test_what_cannot_be_written_is_said_before_loading(
    name: str, words: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["convert", "no-such-scene.xml", str(tmp_path / name)]) == 1
    assert words in capsys.readouterr().err


def test_what_a_scene_is_made_from_is_never_overwritten(
    cornell_path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    copy = tmp_path / "room.xml"
    copy.write_bytes(cornell_path.read_bytes())
    assert main(["convert", str(copy), str(copy), "--force"]) == 1
    assert "is the scene itself" in capsys.readouterr().err
    with pytest.raises(ValueError, match="the scene is made from it"):
        converted(copy, copy, overwrite=True)
    assert copy.read_bytes() == cornell_path.read_bytes()


def test_files_of_others_stay_unless_forced(cornell_path: Path, tmp_path: Path) -> None:
    converted(cornell_path, tmp_path / "room.xml")
    (tmp_path / "room.xml").unlink()
    with pytest.raises(FileExistsError, match="mesh0001"):
        converted(cornell_path, tmp_path / "room.xml")
    assert not (tmp_path / "room.xml").exists()
