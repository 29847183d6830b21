#!/usr/bin/env python3
"""Looks for files that break the importers: ``python3 fuzz/run.py [--seconds N] [FORMAT ...]``.

Needs a nightly Rust and cargo-fuzz (``rustup toolchain install nightly``, ``cargo install cargo-fuzz``).
Starts from the project's own scenes, the strings in the importers' tests, and what ``fuzz/corpus`` has kept;
words come from the importers' own sources. A file that panics, takes ten seconds or a gigabyte is written to
``fuzz/artifacts`` and ends the run. With ``--keep``, what is new and small goes to ``fuzz/corpus``, all of
which every run of the tests loads.
"""

from __future__ import annotations

import argparse
import base64
import json
import re
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib
from pathlib import Path

FUZZ = Path(__file__).resolve().parent
ROOT = FUZZ.parent
IMPORT = ROOT / "crates/sr_import"
SOURCES = {
    "mitsuba": "src/mitsuba",
    "pbrt": "src/pbrt",
    "gltf": "src/gltf",
    "ply": "src/mesh/ply",
    "obj": "src/mesh/obj.rs src/mesh_file/mtl.rs src/mesh_file/cover.rs",
    "stl": "src/mesh/stl.rs",
    "referenced": "src/ies.rs",
}
"""The files and folders where the words of a format are."""

TOO_LARGE_TO_KEEP = 1500
"""Bytes: larger files are not kept."""
KEPT = 120
"""At most so many files of a format are kept, the largest."""
BUFFER = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0) + bytes([0, 1, 2]) + bytes(45)
"""A triangle's corners and indices, and what else the glTF seeds read."""

CURVES = b"\4" + b"0 0 0 .1\n1 0 0 .1\n2 0 0 .2\n3 1 0 .1\n\n0 1 0 1\n1 1 0 1\n1 1 1 1\n2 2 2 1e-3 5\n"
"""Two curves, for ``it.txt``."""
HAIR = """<scene version="3.0.0"><sensor type="perspective"/><emitter type="constant"/>
<shape type="cylinder"><bsdf type="hair"><float name="eumelanin" value="1.3"/>
<float name="pheomelanin" value=".2"/>
<float name="longitudinal_roughness" value=".3"/><float name="azimuthal_roughness" value=".3"/>
<float name="scale_tilt" value="2"/><float name="int_ior" value="1.55"/></bsdf></shape>
<shape type="linearcurve"><string name="filename" value="curves.txt"/></shape></scene>
"""
PBRT_HAIR = """Camera "perspective" WorldBegin LightSource "infinite"
Material "hair" "float eumelanin" 1.3 "float beta_m" 0.3 "float beta_n" 0.3 "float alpha" 2 "float eta" 1.55
Attribute "shape" "float width0" 0.1
Shape "curve" "string type" "ribbon" "point3 P" [ 0 0 0 1 0 0 1 1 0 2 1 0 ] "normal N" [ 0 0 1 0 1 0 ]
Shape "curve" "string basis" "bspline" "integer degree" 2 "integer splitdepth" 1 "float width1" 0
  "point3 P" [ 0 0 0 1 0 0 1 1 0 2 1 0 3 0 0 ]
Material "hair" "rgb color" [ 0.5 0.3 0.1 ]
Shape "curve" "string type" "flat" "point3 P" [ 0 0 0 1 0 0 1 1 0 2 1 0 ]
"""
MTL = """newmtl b
Kd 0.5 0.4 0.3
Ks 1 1 1
Ns 200
Ni 1.5
d 0.5
Ke 0 0 2
illum 7
Tf 0.9 1 1
Pr 0.3
Pm 1
map_Kd -s 2 2 1 -o 0.1 0 0 -clamp on a.png
map_bump -bm 0.5 a.png
"""
STL = """solid a
facet normal 0 0 1
outer loop
vertex 0 0 0
vertex 1 0 0
vertex 0 1 0
endloop
endfacet
endsolid a
"""


def main() -> int:
    """Runs the formats one after the other; 1 if one broke."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("formats", nargs="*", metavar="FORMAT", help=f"{', '.join(SOURCES)} (default: all)")
    parser.add_argument("--seconds", type=int, default=1200, help="for each format (default: 1200)")
    parser.add_argument("--keep", action="store_true", help="renew fuzz/corpus by what was found")
    arguments = parser.parse_args()
    if unknown := set(arguments.formats) - set(SOURCES):
        parser.error(f"there is no format {', '.join(sorted(unknown))}")
    broken = [name for name in arguments.formats or SOURCES if not run(name, arguments)]
    print("\n".join([f"{name}: broken, see fuzz/artifacts/{name}" for name in broken] or ["nothing broke"]))
    return 1 if broken else 0


def run(name: str, arguments: argparse.Namespace) -> bool:
    """Fuzzes a format; was it sound?"""
    found = FUZZ / "target/found" / name
    found.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        seeds, words = Path(folder, "seeds"), Path(folder, "words")
        seeds.mkdir()
        for number, content in enumerate(seeds_of(name)):
            (seeds / str(number)).write_bytes(content)
        words.write_text("".join(f'"{word}"\n' for word in words_of(name)))
        limits = [
            "-timeout=10",
            "-rss_limit_mb=1024",
            "-max_len=8192",
            f"-max_total_time={arguments.seconds}",
        ]
        command = ["cargo", "+nightly", "fuzz", "run", name, str(found), str(seeds), str(kept(name)), "--"]
        sound = subprocess.run([*command, *limits, f"-dict={words}"], cwd=ROOT).returncode == 0
    if sound and arguments.keep:
        keep(name, found)
    return sound


def kept(name: str) -> Path:
    """The folder of what was kept."""
    folder = FUZZ / "corpus" / name
    folder.mkdir(parents=True, exist_ok=True)
    return folder


def keep(name: str, found: Path) -> None:
    """Renews what is kept by a small set of files that reaches as much as all that were found."""
    with tempfile.TemporaryDirectory() as folder:
        small = Path(folder)
        for file in [*found.iterdir(), *kept(name).iterdir()]:
            if file.stat().st_size <= TOO_LARGE_TO_KEEP:
                shutil.copy(file, small / file.name)
        subprocess.run(["cargo", "+nightly", "fuzz", "cmin", name, str(small)], cwd=ROOT, check=True)
        shutil.rmtree(kept(name))
        for file in sorted(small.iterdir(), key=lambda file: (-file.stat().st_size, file.name))[:KEPT]:
            shutil.copy(file, kept(name) / file.name[:12])


def words_of(name: str) -> list[str]:
    """The strings in the sources of a format that can be keywords."""
    paths = [IMPORT / path for path in SOURCES[name].split()]
    files = [file for path in paths for file in ([path] if path.is_file() else sorted(path.rglob("*.rs")))]
    found = {word for file in files for word in re.findall(r'"([\w:./-]{2,40})"', file.read_text())}
    numbers = ["1e39", "-1", "0", "nan", "inf", "4294967295", "9223372036854775807", "1e-320"]
    return sorted(found) + numbers


def seeds_of(name: str) -> list[bytes]:
    """Files to start from."""
    data = IMPORT / "tests/data"
    match name:
        case "mitsuba":
            files = [*ROOT.glob("scenes/*.xml"), *ROOT.glob("scenes/gallery/*.xml"), *data.glob("*.xml")]
            return [file.read_bytes() for file in files] + snippets("golden.rs", "<") + [HAIR.encode()]
        case "pbrt":
            files = [*data.glob("pbrt/*.pbrt")]
            return [file.read_bytes() for file in files] + snippets("pbrt.rs", "") + [PBRT_HAIR.encode()]
        case "gltf":
            return [*snippets("gltf.rs", "{"), gltf(), glb()]
        case "ply":
            return [(data / "pbrt/square.ply").read_bytes(), binary_ply("little"), binary_ply("big")]
        case "obj":
            vertices = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 1\nvn 0 0 1\n"
            mesh = vertices + b"f 1/1/1 2//1 -1/1\ng a\nusemtl b\nf 1 2 3 1\n"
            materials = [(data / "mesh/covered.mtl").read_bytes(), MTL.encode()]
            return [mesh, *(b"mtllib a.mtl\n" + mesh + b"\0" + mtl for mtl in materials)]
        case "stl":
            return [(data / "mesh/box.stl").read_bytes(), STL.encode(), binary_stl()]
        case _:
            ies = (ROOT / "scenes/gallery/data/downlight.ies").read_bytes()
            pfm = (data / "pbrt/octahedral.pfm").read_bytes()
            serialized = struct.pack("<HH", 0x041C, 4) + bytes(40) + struct.pack("<QI", 0, 1)
            spd = b"\3400 0.1\n500 0.5\n# end\n"
            return [b"\0" + serialized, b"\1" + ies, b"\2" + pfm[:2000], spd, CURVES]


def snippets(test: str, start: str) -> list[bytes]:
    """The long strings in a test of the importers."""
    text = (IMPORT / "tests" / test).read_text()
    raw = re.findall(r'r#"(.*?)"#', text, re.DOTALL)
    escaped = re.findall(r'(?<![#\\])"((?:[^"\\]|\\.)*)"', re.sub(r'r#".*?"#', "", text, flags=re.DOTALL))
    plain = [re.sub(r"\\\n\s*", "", text).replace('\\"', '"').replace("\\n", "\n") for text in escaped]
    return [text.encode() for text in raw + plain if len(text) > 40 and text.strip().startswith(start)]


def binary_ply(order: str) -> bytes:
    """A square with normals, texture coordinates and colors."""
    names = ["x", "y", "z", "nx", "ny", "nz", "u", "v"]
    header = ["ply", f"format binary_{order}_endian 1.0", "element vertex 4"]
    header += [f"property float {name}" for name in names] + ["property uchar red"]
    header += ["element face 2", "property list uchar int vertex_indices", "end_header", ""]
    mark = "<" if order == "little" else ">"
    corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
    body = b"".join(struct.pack(mark + "8fB", x, y, 0, 0, 0, 1, x, y, 9) for x, y in corners)
    faces = struct.pack(mark + "B3i", 3, 0, 1, 2) + struct.pack(mark + "B3i", 3, 0, 2, 3)
    return "\n".join(header).encode() + body + faces


def binary_stl() -> bytes:
    """Two facets, one with a color."""
    facets = [(0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0), (0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 1, 0, 5)]
    return bytes(80) + struct.pack("<I", 2) + b"".join(struct.pack("<12fH", *facet) for facet in facets)


def gltf(uri: str | None = "data:;base64," + base64.b64encode(BUFFER).decode()) -> bytes:
    """A triangle with every kind of thing in it."""
    views = [{"buffer": 0, "byteLength": 36}, {"buffer": 0, "byteOffset": 36, "byteLength": 48}]
    accessors = [
        {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"},
        {"bufferView": 1, "componentType": 5121, "count": 3, "type": "SCALAR"},
        {"bufferView": 1, "componentType": 5126, "count": 3, "type": "VEC2", "normalized": False},
        {"componentType": 5126, "count": 3, "type": "VEC3", "sparse": sparse()},
    ]
    lights = {
        "lights": [{"type": "spot", "intensity": 3, "spot": {"outerConeAngle": 0.5}}, {"type": "point"}]
    }
    material = {
        "pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.2, 1], "baseColorTexture": {"index": 0}},
        "alphaMode": "MASK",
        "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}},
    }
    attributes = {"POSITION": 0, "TEXCOORD_0": 2, "NORMAL": 3}
    primitive = {"attributes": attributes, "indices": 1, "material": 0, "targets": [{"POSITION": 3}]}
    nodes: list[dict[str, object]] = [
        {"mesh": 0, "skin": 0, "rotation": [0, 0, 0, 1], "children": [1]},
        {"camera": 0, "matrix": [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 3, 1]},
        {"extensions": {"KHR_lights_punctual": {"light": 0}}},
    ]
    document = {
        "asset": {"version": "2.0"},
        "extensionsUsed": ["KHR_lights_punctual"],
        "extensions": {"KHR_lights_punctual": lights},
        "scene": 0,
        "scenes": [{"nodes": [0, 2]}],
        "nodes": nodes,
        "cameras": [{"type": "perspective", "perspective": {"yfov": 0.7, "znear": 0.1}}],
        "meshes": [{"primitives": [primitive], "weights": [0.5]}],
        "skins": [{"joints": [0, 1]}],
        "materials": [material],
        "textures": [{"source": 0, "sampler": 0}],
        "samplers": [{"wrapS": 33071}],
        "images": [{"uri": f"data:image/png;base64,{base64.b64encode(png()).decode()}"}],
        "buffers": [{"byteLength": 84} | ({"uri": uri} if uri else {})],
        "bufferViews": views,
        "accessors": accessors,
    }
    return json.dumps(document).encode()


def png() -> bytes:
    """A grey pixel."""

    def chunk(kind: bytes, content: bytes) -> bytes:
        body = kind + content
        return struct.pack(">I", len(content)) + body + struct.pack(">I", zlib.crc32(body))

    header = struct.pack(">IIBBBBB", 1, 1, 8, 0, 0, 0, 0)
    parts = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(b"\0\x80")) + chunk(b"IEND", b"")
    return b"\x89PNG\r\n\x1a\n" + parts


def sparse() -> dict[str, object]:
    """One changed element."""
    return {"count": 1, "indices": {"bufferView": 1, "componentType": 5121}, "values": {"bufferView": 0}}


def glb() -> bytes:
    """The same, its buffer in the file."""
    text = gltf(None)
    text += b" " * (-len(text) % 4)
    chunks = struct.pack("<I4s", len(text), b"JSON") + text + struct.pack("<I4s", 84, b"BIN\0") + BUFFER
    return struct.pack("<4sII", b"glTF", 2, 12 + len(chunks)) + chunks


if __name__ == "__main__":
    sys.exit(main())
