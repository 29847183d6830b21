"""A scene file as plain triangles, for renderers that do not read Mitsuba's XML.

In: an XML file of diffuse rectangles, cubes and PLY meshes with area lights, such as our Cornell box and
the scenes that :mod:`beside.generated` makes. Out: :class:`PlainScene`. Whatever else a file holds raises
:class:`NotPlain`: no renderer is timed on half a scene.
"""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from beside.meshes import Positions, Triangles, read_ply

Rgb = tuple[float, float, float]
Matrix = npt.NDArray[np.float64]


class NotPlain(ValueError):
    """The scene has something that plain triangles cannot say."""


@dataclass(frozen=True)
class PlainMesh:
    """Triangles in world space with one diffuse material; ``emission`` is radiance from their front."""

    name: str
    positions: Positions
    triangles: Triangles
    reflectance: Rgb
    emission: Rgb | None


@dataclass(frozen=True)
class Camera:
    """A pinhole; ``fov`` is across the image, in degrees."""

    origin: Rgb
    target: Rgb
    up: Rgb
    fov: float


@dataclass(frozen=True)
class PlainScene:
    """All that is rendered."""

    camera: Camera
    meshes: tuple[PlainMesh, ...]


def read(path: Path) -> PlainScene:
    """Reads a scene file."""
    root = ElementTree.parse(path).getroot()
    materials = {node.get("id", ""): _reflectance(node) for node in root.iterfind("bsdf")}
    sensor = root.find("sensor")
    if sensor is None:
        raise NotPlain(f"{path} has no sensor")
    beyond = {node.tag for node in root} - {"default", "integrator", "sensor", "bsdf", "shape"}
    if beyond:
        raise NotPlain(f"{path} has {', '.join(sorted(beyond))}")
    shapes = tuple(_shape(node, materials, path.parent) for node in root.iterfind("shape"))
    return PlainScene(_camera(sensor), shapes)


def _camera(sensor: ElementTree.Element) -> Camera:
    look, fov = sensor.find("transform/lookat"), sensor.find("float[@name='fov']")
    if sensor.get("type") != "perspective" or look is None or fov is None:
        raise NotPlain("the camera is no perspective one with a lookat and a fov")
    origin, target, up = (_numbers(look.get(name, "")) for name in ("origin", "target", "up"))
    return Camera(origin, target, up, float(fov.get("value", "")))


def _shape(node: ElementTree.Element, materials: dict[str, Rgb], folder: Path) -> PlainMesh:
    kind, name = node.get("type", ""), node.get("id", "").replace(" ", "_")
    if kind == "ply":
        file = node.find("string[@name='filename']")
        assert file is not None
        positions, triangles = read_ply(folder / file.get("value", ""))
    elif kind in ("rectangle", "cube"):
        positions, triangles = RECTANGLE if kind == "rectangle" else _cube()
    else:
        raise NotPlain(f"a {kind} is no mesh")
    placed = positions
    transform = node.find("transform")
    if transform is not None:
        matrix = _matrix(transform)
        placed = (positions @ matrix[:3, :3].T + matrix[:3, 3]).astype(np.float32)
    reference, emission = node.find("ref"), node.find("emitter[@type='area']/rgb")
    if reference is None or reference.get("id", "") not in materials:
        raise NotPlain(f"the {kind} {name} has no diffuse material by name")
    radiance = None if emission is None else _numbers(emission.get("value", ""))
    return PlainMesh(name, placed, triangles, materials[reference.get("id", "")], radiance)


def _reflectance(node: ElementTree.Element) -> Rgb:
    color = node.find("rgb[@name='reflectance']")
    if node.get("type") != "diffuse" or color is None:
        raise NotPlain(f"the material {node.get('id')} is not diffuse")
    return _numbers(color.get("value", ""))


def _matrix(transform: ElementTree.Element) -> Matrix:
    """Its steps; the first one in the file is applied first."""
    matrix = np.eye(4)
    for step in transform:
        one = 1.0 if step.tag == "scale" else 0.0
        x, y, z = (float(step.get(axis, one)) for axis in "xyz")
        if step.tag == "scale":
            matrix = np.diag([x, y, z, 1.0]) @ matrix
        elif step.tag == "translate":
            move = np.eye(4)
            move[:3, 3] = (x, y, z)
            matrix = move @ matrix
        elif step.tag == "rotate":
            matrix = _rotation(np.array([x, y, z]), float(step.get("angle", "0"))) @ matrix
        else:
            raise NotPlain(f"a transform has {step.tag}")
    return matrix


def _rotation(axis: npt.NDArray[np.float64], degrees: float) -> Matrix:
    """About an axis, by Rodrigues' formula."""
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    angle = np.radians(degrees)
    matrix = np.eye(4)
    matrix[:3, :3] += np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
    return matrix


RECTANGLE: tuple[Positions, Triangles] = (
    np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32),
    np.array([[0, 1, 2], [0, 2, 3]], np.uint32),
)


def _cube() -> tuple[Positions, Triangles]:
    """The cube [-1, 1]³, normals outwards: each face is the rectangle, turned and moved."""
    positions, triangles = [], []
    turns = [("x", 0), ("x", 90), ("x", 180), ("x", 270), ("y", 90), ("y", 270)]
    for k, (axis, angle) in enumerate(turns):
        turn = _rotation(np.array([axis == "x", axis == "y", 0], float), angle)[:3, :3]
        face = RECTANGLE[0] + np.array([0, 0, 1], np.float32)
        positions.append(np.rint(face @ turn.T).astype(np.float32))
        triangles.append(RECTANGLE[1] + np.uint32(4 * k))
    return np.concatenate(positions), np.concatenate(triangles)


def _numbers(text: str) -> Rgb:
    """Three numbers, with commas or spaces between them."""
    x, y, z = (float(part) for part in text.replace(",", " ").split())
    return x, y, z
