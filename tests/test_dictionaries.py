"""Whatever a file can say, a dictionary can say: every block of the gallery as both."""

import xml.etree.ElementTree as ElementTree
from pathlib import Path

import numpy as np
import pytest

import steradian as sr

GALLERY = Path(__file__).parents[1] / "scenes/gallery"
SIZE = (24, 16)


def numbers(text: str) -> list[float]:
    return [float(word) for word in text.replace(",", " ").split()]


def vector(element: ElementTree.Element, default: float = 0.0) -> list[float]:
    if element.get("value") is not None:
        given = numbers(element.get("value"))
        return given * 3 if len(given) == 1 else given
    return [float(element.get(axis, default)) for axis in "xyz"]


def placement(element: ElementTree.Element) -> sr.Transform:
    """The steps of a file are applied one after the other; a dictionary's chain reads right to left."""
    whole = sr.Transform()
    for step in element:
        if step.tag == "lookat":
            made = sr.Transform.look_at(*(numbers(step.get(name)) for name in ("origin", "target", "up")))
        elif step.tag == "rotate":
            made = sr.Transform.rotate(vector(step), float(step.get("angle")))
        elif step.tag == "scale":
            made = sr.Transform.scale(vector(step, 1.0))
        else:
            assert step.tag == "translate"
            made = sr.Transform.translate(vector(step))
        whole = made @ whole
    return whole


def value(element: ElementTree.Element, defaults: dict[str, str]) -> object:
    text = element.get("value", "")
    text = defaults.get(text.removeprefix("$"), text)
    match element.tag:
        case "float":
            return float(text)
        case "integer":
            return int(text)
        case "boolean":
            return text == "true"
        case "string":
            return text
        case "rgb":
            given = numbers(text)
            return {"type": "rgb", "value": given * 3 if len(given) == 1 else given}
        case "point" | "vector":
            return vector(element)
        case "transform":
            return placement(element)
        case "ref":
            return {"type": "ref", "id": element.get("id")}
    return dictionary(element, defaults)


def dictionary(element: ElementTree.Element, defaults: dict[str, str]) -> dict[str, object]:
    made: dict[str, object] = {"type": element.get("type", "scene")}
    for i, child in enumerate(element):
        if child.tag != "default":
            made[child.get("name", child.get("id", f"nameless-{i}"))] = value(child, defaults)
    return made


@pytest.mark.parametrize("path", sorted(GALLERY.glob("*.xml")), ids=lambda path: path.stem)
def test_dictionaries_are_as_good_as_files(path, monkeypatch):
    monkeypatch.chdir(GALLERY)
    root = ElementTree.parse(path).getroot()
    defaults = {d.get("name"): d.get("value") for d in root.iter("default")}
    scenes = [sr.load(path), sr.load(dictionary(root, defaults))]
    assert all(scene.diagnostics == () for scene in scenes)
    from_file, from_dictionary = (sr.render(scene, spp=2, size=SIZE).image for scene in scenes)
    # to what a chain of matrices is rounded differently
    assert np.abs(from_file - from_dictionary).mean() <= 1e-3 * np.abs(from_file).mean()


def test_every_gallery_scene_is_there():
    assert len(list(GALLERY.glob("*.xml"))) >= 56
