"""All materials under each light: no sample is NaN or infinite."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from pathlib import Path

import numpy as np
import pytest

import steradian as sr

GALLERY = Path(__file__).resolve().parent.parent / "scenes" / "gallery"
"""Has every material and every light at least once."""

COLUMNS = 12
EXTREMES = [
    *(
        f'<bsdf type="{kind}"><string name="distribution" value="{distribution}"/>'
        f'<float name="alpha" value="{alpha}"/>{index}</bsdf>'
        for kind, distribution, indices in (
            ("roughdielectric", "beckmann", (1, 1.00001, 1.5, 0.3)),
            ("roughdielectric", "ggx", (1, 1.00001, 1.5, 0.3)),
            ("roughplastic", "ggx", (1.00001, 1.5, 3)),
            ("roughconductor", "beckmann", (None,)),
            ("roughconductor", "ggx", (None,)),
        )
        for alpha in ("1e-8", "1e-4", "1")
        for index in (
            f'<float name="int_ior" value="{eta}"/><float name="ext_ior" value="1"/>' if eta else ""
            for eta in indices
        )
    ),
    *(
        f'<bsdf type="principled"><float name="roughness" value="{roughness}"/>'
        f'<float name="anisotropic" value="1"/><float name="{what}" value="1"/></bsdf>'
        for roughness in ("0", "1")
        for what in ("metallic", "spec_trans", "clearcoat", "sheen", "flatness")
    ),
    '<bsdf type="dielectric"><float name="int_ior" value="1"/><float name="ext_ior" value="1"/></bsdf>',
    '<bsdf type="thindielectric"><float name="int_ior" value="1"/><float name="ext_ior" value="1"/></bsdf>',
    '<bsdf type="diffuse"><rgb name="reflectance" value="0, 0, 0"/></bsdf>',
    '<bsdf type="diffuse"><rgb name="reflectance" value="1, 1, 1"/></bsdf>',
]
"""Roughness that is all but 0, and 1, and media that are alike or nearly so."""


def found(path: str) -> list[str]:
    """The different elements at a path in all scenes of the gallery, with files where they are."""
    texts = []
    for file in sorted(GALLERY.glob("*.xml")):
        root = ET.parse(file).getroot()
        referred = {element.get("id") for element in root.iter() if element.get("id")}
        for element in root.findall(path):
            if any(ref.get("id") in referred for ref in element.iter("ref")) or element.get("id"):
                continue
            for name in element.iterfind(".//string[@name='filename']"):
                name.set("value", str(file.parent / name.get("value", "")))
            element.tail = None
            texts.append(ET.tostring(element, encoding="unicode"))
    return list(dict.fromkeys(texts))


LIGHTS = [
    *found("emitter"),
    *(
        f'<shape type="{shape}"><transform name="to_world"><scale value="0.5"/>'
        f'<rotate x="1" angle="{angle}"/><translate x="1" y="-1" z="3"/></transform>{emitter}</shape>'
        for shape, angle in (("rectangle", 180), ("disk", 180), ("sphere", 0), ("cylinder", 90), ("cube", 10))
        for emitter in found("shape/emitter")[:1]
    ),
]


def scene(light: str) -> tuple[str, int]:
    """A ball of each material on a floor, under a light; and how many balls there are."""
    materials = found("shape/bsdf") + EXTREMES
    balls = [
        f'<shape type="sphere"><float name="radius" value="0.4"/>'
        f'<point name="center" x="{k % COLUMNS - 5.5}" y="{k // COLUMNS - 3.5}" z="0.45"/>'
        f"{material}</shape>"
        for k, material in enumerate(materials)
    ]
    text = f"""<scene version="3.0.0">
        <integrator type="path"><integer name="max_depth" value="8"/></integrator>
        <sensor type="perspective"><float name="fov" value="60"/>
            <transform name="to_world">
                <lookat origin="0, -2, 12" target="0, 0.3, 0" up="0, 1, 0"/>
            </transform>
            <film type="hdrfilm"><integer name="width" value="96"/><integer name="height" value="80"/></film>
        </sensor>
        <shape type="rectangle"><transform name="to_world"><scale value="20"/></transform></shape>
        {light}{"".join(balls)}</scene>"""
    return text, len(materials)


def name_of(light: str) -> str:
    root = ET.fromstring(light)
    return root.get("type", "") + (" area" if root.tag == "shape" else "")


@pytest.mark.parametrize("light", LIGHTS, ids=name_of)
def test_no_sample_is_not_a_number(light, tmp_path):
    text, materials = scene(light)
    assert materials > 60
    (tmp_path / "all.xml").write_text(text, encoding="utf-8")
    result = sr.render(sr.load(tmp_path / "all.xml"), spp=24, seed=3)
    assert result.rejected_samples == 0
    assert np.isfinite(result.image).all() and np.isfinite(result.stderr).all()
    assert result.image.mean() > 1e-4, "the light lights something"


def test_every_light_is_among_them():
    kinds = {name_of(light) for light in LIGHTS}
    assert kinds >= {
        *("constant", "directional", "envmap", "goniometric", "ies", "point", "projector", "spot", "sunsky"),
        *("rectangle area", "disk area", "sphere area", "cylinder area", "cube area"),
    }
