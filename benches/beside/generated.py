"""Scenes that benches make, as Mitsuba XML beside a PLY file: both Steradian and Mitsuba load them.

A bumpy sphere stands in an open box under a square lamp; everything is diffuse. Only the number of the
sphere's triangles changes. The files go to ``benches/generated``, which git ignores, and are made once.

    python -m beside.generated 1000000 10000000 [--smooth]     (in benches/, with NumPy)
"""

from __future__ import annotations

import argparse
from pathlib import Path

from beside import meshes

FOLDER = Path(__file__).resolve().parent.parent / "generated"
GROWTH = tuple(10**k for k in range(3, 8))
"""Numbers of triangles for the measurement of how time grows."""

SCENE = """<?xml version="1.0" encoding="utf-8"?>
<scene version="3.0.0">
    <integrator type="path">
        <integer name="max_depth" value="8"/>
    </integrator>
    <sensor type="perspective">
        <float name="fov" value="40"/>
        <transform name="to_world">
            <lookat origin="0, 0.2, 6.4" target="0, 0, 0" up="0, 1, 0"/>
        </transform>
        <sampler type="independent">
            <integer name="sample_count" value="16"/>
        </sampler>
        <film type="hdrfilm">
            <integer name="width" value="512"/>
            <integer name="height" value="512"/>
            <rfilter type="box"/>
        </film>
    </sensor>
    <bsdf type="diffuse" id="stone">
        <rgb name="reflectance" value="0.7, 0.6, 0.5"/>
    </bsdf>
    <bsdf type="diffuse" id="wall">
        <rgb name="reflectance" value="0.6, 0.6, 0.65"/>
    </bsdf>
    <bsdf type="diffuse" id="lamp">
        <rgb name="reflectance" value="0.5, 0.5, 0.5"/>
    </bsdf>
    <shape type="ply" id="sphere">
        <string name="filename" value="{mesh}"/>
        <boolean name="face_normals" value="{flat}"/>
        <ref id="stone"/>
    </shape>
{walls}
    <shape type="rectangle" id="light">
        <transform name="to_world">
            <scale x="0.6" y="0.6"/>
            <rotate x="1" angle="90"/>
            <translate y="1.99"/>
        </transform>
        <ref id="lamp"/>
        <emitter type="area">
            <rgb name="radiance" value="15, 14, 12"/>
        </emitter>
    </shape>
</scene>
"""

WALL = """    <shape type="rectangle" id="{name}">
        <transform name="to_world">
            <scale x="2" y="2"/>
            <rotate {axis}="1" angle="{angle}"/>
            <translate {along}="{at}"/>
        </transform>
        <ref id="wall"/>
    </shape>"""

WALLS = (
    ("floor", "x", -90, "y", -2),
    ("ceiling", "x", 90, "y", 2),
    ("back", "x", 0, "z", -2),
    ("left", "y", 90, "x", -2),
    ("right", "y", -90, "x", 2),
)


def scene(triangles: int, *, smooth: bool = False) -> Path:
    """The file of the scene with about so many triangles, made if it is not there.

    ``smooth``: with vertex normals, which whoever loads the scene has to work out.
    """
    FOLDER.mkdir(exist_ok=True)
    mesh = FOLDER / f"sphere-{triangles}.ply"
    if not mesh.exists():
        meshes.write_ply(mesh, *meshes.bumpy_sphere(triangles))
    path = FOLDER / f"sphere-{triangles}{'-smooth' if smooth else ''}.xml"
    names = ("name", "axis", "angle", "along", "at")
    walls = "\n".join(WALL.format(**dict(zip(names, wall, strict=True))) for wall in WALLS)
    path.write_text(SCENE.format(mesh=mesh.name, flat=str(not smooth).lower(), walls=walls))
    return path


def main() -> None:
    """Makes the scenes that are asked for and prints their paths."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument(
        "triangles", nargs="*", type=int, default=list(GROWTH), help="for each scene; default: 10³ to 10⁷"
    )
    parser.add_argument("--smooth", action="store_true", help="with vertex normals")
    given = parser.parse_args()
    for triangles in given.triangles:
        print(scene(triangles, smooth=given.smooth))


if __name__ == "__main__":
    main()
