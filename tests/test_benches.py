"""What the benches work out, without measuring anything: scenes, meshes, tables, medians, verdicts."""

from __future__ import annotations

import argparse
import json
import math
import stat
import sys
from pathlib import Path

import instructions
import numpy as np
import pytest

import steradian as sr
from beside import arguments, llvm, meshes, plain, report, table
from beside.paired import Bar, geometric_mean, ratio, slope
from beside.renderers import ALL, Job, pbrt
from beside.studies import NAMES, rays, study

ROOT = Path(__file__).resolve().parent.parent


def test_ratio_is_the_median_over_pairs() -> None:
    # The machine is four times slower in the second run, which says nothing about either.
    assert ratio([2.0, 8.0, 3.0], [1.0, 4.0, 1.0]) == 2.0
    with pytest.raises(ValueError):
        ratio([1.0], [1.0, 2.0])


def test_slope_is_the_exponent() -> None:
    assert slope([1, 10, 100], [3, 30, 300]) == pytest.approx(1.0)
    assert slope([1, 10, 100], [5, 5, 5]) == pytest.approx(0.0)
    assert geometric_mean([1.0, 4.0]) == pytest.approx(2.0)


@pytest.mark.parametrize(
    ("measured", "sense", "passed"),
    [(1.0, "at least", True), (0.9, "at least", False), (1.0, "at most", True), (1.1, "at most", False)],
)
def test_a_bar_is_kept_at_its_bound(measured: float, sense: str, passed: bool) -> None:
    assert Bar("", measured, 1.0, sense).passed is passed


def test_no_number_keeps_no_bar() -> None:
    assert not Bar("", math.nan, 1.0, "at most").passed
    assert not Bar("", math.nan, 1.0, "at least").passed


def test_verdicts_say_what_was_missed() -> None:
    lines = report.verdicts([Bar("speed", 0.5, 1.0, "at least"), Bar("wait", 3.0, 4.0, "at most", "s")])
    assert "**missed**" in lines[2] and "kept" in lines[3] and "at most 4 s" in lines[3]


def test_tables_are_aligned() -> None:
    lines = table.table(["scene", "×"], [["a", "1"], ["longer", "22,000"]])
    assert len({len(line) for line in lines}) == 1
    assert lines[1].endswith("---: |")


@pytest.mark.parametrize(
    ("value", "text"),
    [(None, "–"), (0.0, "0.0"), (1.0, "1.00"), (0.01234, "0.0123"), (12.34, "12.3"), (12345.6, "12,346")],
)
def test_numbers_have_three_digits_that_matter(value: float | None, text: str) -> None:
    assert table.number(value) == text


@pytest.mark.parametrize(
    ("name", "version"),
    [
        ("libLLVM.so.19.1", (19, 1)),
        ("libLLVM-14.0.6.so.1", (14, 0, 6, 1)),
        ("libLLVM-15.so", (15,)),
        ("libLLVM.so", None),
        ("libLLVMSupport.a", None),
    ],
)
def test_versions_of_llvm(name: str, version: tuple[int, ...] | None) -> None:
    assert llvm.version(name) == version


RAYS = """\
box\ttriangles\tscene\t3.8e1
box\tbuild_cpu\tsteradian\t2.0 4.0
box\tbuild_cpu\tembree\t1.0 2.0
box\tbytes_per_triangle\tsteradian\t54
box\tbytes_per_triangle\tembree\t60
box\tclosest\tsteradian\t100 100
box\tclosest\tsteradian-batches\t50 60
box\tclosest\tembree\t100 120
box\tclosest\tembree-packets\t75 90
box\tany\tsteradian\t30 30
box\tany\tsteradian-batches\t40 40
box\tany\tembree\t30 33
box\tany\tembree-packets\t90 90
"""

BUILD = """\
box\tbuild_wall\tsteradian\t2.0 4.0
box\tbuild_wall\tembree\t1.0 2.0
"""


def test_rays_are_compared_by_the_better_of_each() -> None:
    found = rays.parse(RAYS)
    assert rays.against_default(found["box"]) == (2.0, pytest.approx((30 / 40 + 33 / 40) / 2))
    assert rays.best_of_each(found["box"]) == (1.5, pytest.approx(1.05))
    bars = {bar.name: bar for bar in rays.bars({"scenes": found})}
    assert bars["bytes a triangle: Cornell box, 38 triangles, over Embree's"].measured == pytest.approx(0.9)
    assert all(bar.passed for bar in bars.values())


def test_the_cornell_box_as_plain_triangles(cornell_path: Path, cornell: sr.Scene) -> None:
    scene = plain.read(cornell_path)
    assert sum(len(mesh.triangles) for mesh in scene.meshes) == cornell.info()["triangles"]
    corners = np.concatenate([mesh.positions for mesh in scene.meshes])
    bounds = cornell.info()["bounds"]
    assert np.allclose([corners.min(axis=0), corners.max(axis=0)], bounds, atol=1e-5)
    assert scene.camera.fov == pytest.approx(39.3077)
    [lamp] = [mesh for mesh in scene.meshes if mesh.emission is not None]
    assert lamp.emission == (18.0, 13.5, 6.5)
    assert np.allclose(_normals(lamp.positions, lamp.triangles), (0, -1, 0), atol=1e-6)
    for mesh in scene.meshes:
        if mesh.name.endswith("block"):
            out = mesh.positions[mesh.triangles].mean(axis=1) - mesh.positions.mean(axis=0)
            assert (np.sum(_normals(mesh.positions, mesh.triangles) * out, axis=1) > 0).all()


def _normals(positions: np.ndarray, triangles: np.ndarray) -> np.ndarray:
    a, b, c = (positions[triangles[:, k]] for k in range(3))
    normals = np.cross(b - a, c - a)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def test_what_is_not_plain_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "scene.xml"
    for inside in ('<emitter type="constant"/>', '<bsdf type="conductor" id="x"/>', '<shape type="sphere"/>'):
        path.write_text(f'<scene version="3.0.0"><sensor type="perspective"/>{inside}</scene>')
        with pytest.raises(plain.NotPlain):
            plain.read(path)


def test_bumpy_spheres_are_closed_and_face_outwards() -> None:
    positions, triangles = meshes.bumpy_sphere(1000)
    assert 900 < len(triangles) < 1100
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    assert len(np.unique(edges, axis=0)) == len(edges)
    assert {tuple(edge) for edge in edges} == {(b, a) for a, b in edges}
    assert (
        np.sum(_normals(positions, triangles) * positions[triangles].mean(axis=1), axis=1) > 0
    ).mean() > 0.99
    finer, _ = meshes.bumpy_sphere(100_000)
    assert np.linalg.norm(finer, axis=1).max() == pytest.approx(
        np.linalg.norm(positions, axis=1).max(), rel=0.05
    )


def test_meshes_are_read_as_they_were_written(tmp_path: Path) -> None:
    positions, triangles = meshes.bumpy_sphere(100)
    path = tmp_path / "mesh.ply"
    meshes.write_ply(path, positions, triangles)
    again = meshes.read_ply(path)
    assert np.array_equal(again[0], positions) and np.array_equal(again[1], triangles)
    scene = {
        "type": "scene",
        "camera": {"type": "perspective", "fov": 40.0},
        "mesh": {"type": "ply", "filename": str(path)},
    }
    assert sr.load(scene).info()["triangles"] == len(triangles)


def test_pbrt_is_started_for_each_render(
    tmp_path: Path, cornell_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A stand-in takes what pbrt takes, and writes a gray image."""
    stand_in = tmp_path / "pbrt"
    stand_in.write_text(
        f"#!{sys.executable}\n"
        "import struct, sys\n"
        "given = dict(zip(sys.argv[2:-1:2], sys.argv[3:-1:2]))\n"
        "assert sys.argv[1] == '--quiet' and open(sys.argv[-1]).read().startswith('LookAt')\n"
        "with open(given['--outfile'], 'wb') as file:\n"
        "    file.write(b'PF\\n2 1\\n-1\\n' + struct.pack('<6f', 1, 2, 3, 3, 4, 5))\n"
    )
    stand_in.chmod(stand_in.stat().st_mode | stat.S_IXUSR)
    monkeypatch.setenv("PBRT", str(stand_in))
    assert ALL["pbrt"].missing() is None
    renderer = pbrt.Pbrt(Job(cornell_path, 2, 1, 4, 8, None, 1))
    with renderer.folder:
        _check_pbrt(renderer)


def _check_pbrt(renderer: pbrt.Pbrt) -> None:
    renderer.render(1)
    assert renderer.mean() == [2.0, 3.0, 4.0]
    text = (renderer.path / "scene.pbrt").read_text()
    assert text.count("AreaLightSource") == 1 and text.count('Shape "plymesh"') == 8
    assert '"integer maxdepth" [ 7 ]' in text


def test_a_page_says_what_is_missing_and_what_failed() -> None:
    results = {
        "machine": {"processor": "abacus", "cores": 2, "system": "wood", "load_before": 0.5},
        "date": "today",
        "commit": "abc",
        "quick": True,
        "runs": 3,
        "missing": {"pbrt-v4": "there is no pbrt"},
        "failed": {"large": "out of memory"},
        "studies": {
            "rays": {"embree": "e", "threads": 2, "load": [None, 1.0], "scenes": rays.parse(RAYS + BUILD)}
        },
    }
    page = report.page(results)
    for text in (
        "abacus",
        "load was 0.5",
        "small sizes",
        "pbrt-v4: there is no pbrt",
        "`large` failed: out of",
    ):
        assert text in page
    assert "| Embree, coherent packets of 16 " in page and "2.00 / 0.7" in page


def test_arguments() -> None:
    given = arguments.parser().parse_args(["--only", "rays,growth", "--runs", "3"])
    assert given.only == ("rays", "growth") and given.runs == 3
    for line in (["--only", "raiz"], ["--runs", "0"], ["--also", "nowhere.xml"], ["--peers", "steradian"]):
        with pytest.raises(SystemExit):
            arguments.parser().parse_args(line)
    assert isinstance(given, argparse.Namespace)


def test_every_study_has_what_a_report_needs() -> None:
    for name in NAMES:
        one = study(name)
        assert one.TITLE and callable(one.measure) and callable(one.tables) and callable(one.bars)


CALLGRIND = """\
version: 1
events: Ir
summary: 120

fn=(1) counted
12 120

totals: 120
"""


def test_counts_are_read_from_callgrind() -> None:
    assert instructions.total(CALLGRIND) == 120
    for nothing in ("", "totals: 0\n"):
        with pytest.raises(SystemExit):
            instructions.total(nothing)


@pytest.mark.parametrize(
    ("count", "stored", "verdict", "regressed"),
    [
        (103, 100, "MORE", True),
        (1019, 1000, "same", False),
        (981, 1000, "same", False),
        (90, 100, "less", False),
        (100, None, "new", False),
    ],
)
def test_counts_are_compared(count: int, stored: int | None, verdict: str, regressed: bool) -> None:
    row = instructions.Row("work", count, stored)
    assert row.verdict(0.02).startswith(verdict)
    assert bool(instructions.regressions([row], 0.02)) is regressed
    assert verdict in instructions.line(row, 0.02)


def test_every_stored_count_is_of_a_work() -> None:
    program = (ROOT / "benches" / "instructions" / "src" / "main.rs").read_text()
    stored = json.loads(instructions.STORED.read_text())
    assert stored and all(f'("{work}", ' in program for work in stored)
