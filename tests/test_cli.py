"""The command line, from outside: exit codes, what is printed where, and what is left behind."""

import base64
import json
import math
import os
import signal
import struct
import subprocess
import sys
import time
from pathlib import Path

import OpenEXR
import pytest

FAST = ["--size", "16x12", "--spp", "4"]
WARNED = '<scene version="3.0.0"><shape type="sphere"><float name="raduis" value="2"/></shape></scene>'


def run(*arguments, cwd, check=None, env=None):
    done = subprocess.run(
        [sys.executable, "-m", "steradian", *map(str, arguments)],
        cwd=cwd,
        capture_output=True,
        text=True,
        encoding="utf-8",
        timeout=120,
        env={**os.environ, **(env or {})},
    )
    if check is not None:
        assert done.returncode == check, done.stderr
    return done


def test_one_command_makes_an_image_and_a_summary(cornell_path, tmp_path):
    done = run("render", cornell_path, *FAST, cwd=tmp_path, check=0)
    assert os.listdir(tmp_path) == ["cornell-box.exr"]
    assert done.stderr == ""
    for words in (
        "16 x 12, 4 spp, depth 8, mis(bsdf, light), sobol, seed 0",
        "mean ",
        " ± ",
        "wrote cornell-box.exr",
    ):
        assert words in done.stdout


def test_several_outputs_and_every_option(cornell_path, tmp_path):
    options = ["--strategy", "0.5 cosine + 0.5 light", "--sampler", "independent", "--max-depth", "-1"]
    options += ["--seed", "7", "--threads", "2", "--exposure", "1.5", "--tone", "filmic", "--time", "60"]
    done = run(
        "render",
        cornell_path,
        "-o",
        "a.exr",
        "-o",
        "b.PNG",
        *FAST,
        *options,
        "--quiet",
        cwd=tmp_path,
        check=0,
    )
    assert (done.stdout, done.stderr) == ("", "")
    assert sorted(os.listdir(tmp_path)) == ["a.exr", "b.PNG"]
    with OpenEXR.File(str(tmp_path / "a.exr")) as file:
        header = dict(file.header())
    expected = {
        "strategy": "0.5 cosine + 0.5 light",
        "sampler": "independent",
        "max_depth": -1,
        "seed": 7,
        "spp": 4,
    }
    assert {name: header[f"steradian.{name}"] for name in expected} == expected


def test_json_is_one_object_with_everything(cornell_path, tmp_path):
    done = run("render", cornell_path, *FAST, "--json", cwd=tmp_path, check=0)
    value = json.loads(done.stdout)
    assert done.stderr == ""
    assert value["output"] == ["cornell-box.exr"]
    expected = {
        "width": 16,
        "height": 12,
        "spp": 4,
        "strategy": "mis(bsdf, light)",
        "sampler": "sobol",
        "seed": 0,
        "max_depth": 8,
        "rejected_samples": 0,
        "stopped": "complete",
    }
    assert {name: value[name] for name in expected} == expected
    for name in ("seconds", "load_seconds", "cpu_seconds", "paths_per_second", "mean_relative_error"):
        assert isinstance(value[name], float) and value[name] > 0, name
    for name in ("mean", "mean_stderr"):
        assert len(value[name]) == 3 and all(math.isfinite(v) for v in value[name])


def test_json_has_no_infinities(cornell_path, tmp_path):
    done = run("render", cornell_path, "--size", "4x4", "--spp", "1", "--json", cwd=tmp_path, check=0)
    value = json.loads(done.stdout, parse_constant=lambda name: pytest.fail(name))
    assert value["mean_relative_error"] is None
    assert value["mean_stderr"] == [None] * 3


def test_info_speaks_to_people_and_programs(cornell_path, tmp_path):
    done = run("info", cornell_path, cwd=tmp_path, check=0)
    for words in ("512 x 512 pixels", "36 triangles", "39.31 degrees"):
        assert words in done.stdout
    value = json.loads(
        run("info", cornell_path, "--json", "--define", "res=64", cwd=tmp_path, check=0).stdout
    )
    assert (value["film"]["width"], value["lights"], value["triangles"]) == (64, 1, 36)
    assert value["diagnostics"] == []


def test_warnings_go_to_standard_error_and_the_image_is_written(tmp_path):
    (tmp_path / "scene.xml").write_text(WARNED)
    done = run("render", "scene.xml", *FAST, "--json", cwd=tmp_path, check=0)
    assert 'did you mean "radius"?' in done.stderr
    assert json.loads(done.stdout)["output"] == ["scene.exr"]
    value = json.loads(run("info", "scene.xml", "--json", cwd=tmp_path, check=0).stdout)
    assert "mitsuba::unknown-property" in [d["code"] for d in value["diagnostics"]]


def test_info_tells_what_is_approximated_from_what_is_ignored(tmp_path):
    (tmp_path / "scene.pbrt").write_text(
        'Camera "perspective" Integrator "bdpt" WorldBegin LightSource "infinite"\n'
        'Material "measured" "string filename" "a.bsdf" Shape "sphere" "float raduis" 2\n'
        'Shape "sphere" "float raduis" 2 MakeNamedMedium "fog" "string type" "homogeneous"\n'
    )
    done = run("info", "scene.pbrt", cwd=tmp_path, check=0)
    lines = dict(line.split(maxsplit=1) for line in done.stdout.splitlines() if "::" in line)
    value = json.loads(run("info", "scene.pbrt", "--json", cwd=tmp_path, check=0).stdout)
    effects = {d["consequence"]: d["effect"] for d in value["diagnostics"]}
    assert set(effects.values()) == {"approximated", "ignored"}, effects
    assert effects["it is ignored"] == effects["its inside is rendered as empty space"] == "ignored"
    for effect in ("approximated", "ignored"):
        assert sum(value[effect].values()) == sum(d["effect"] == effect for d in value["diagnostics"]) > 0
        assert all(f"{count} x {code}" in lines[effect] for code, count in value[effect].items())


def test_strict_fails_on_warnings(cornell_path, tmp_path):
    (tmp_path / "scene.xml").write_text(WARNED)
    for command in (["render", *FAST], ["info"], ["convert", "--own-plugins", "out.xml"]):
        name, *rest = command
        done = run(name, "scene.xml", *rest, "--strict", cwd=tmp_path, check=1)
        assert "and --strict takes none" in done.stderr
    assert not (tmp_path / "scene.exr").exists()
    run("info", cornell_path, "--strict", cwd=tmp_path, check=0)


def test_help_and_version(tmp_path):
    assert "0.5 cosine + 0.5 light" in run("render", "--help", cwd=tmp_path, check=0).stdout
    assert run("--version", cwd=tmp_path, check=0).stdout.startswith("steradian ")


def mesh_scene(obj: str) -> dict[str, str]:
    shape = '<shape type="obj"><string name="filename" value="mesh.obj"/></shape>'
    return {"scene.xml": f'<scene version="3.0.0">{shape}</scene>', "mesh.obj": obj}


BAD_SCENES = {
    "truncated XML": ({"scene.xml": '<scene version="3.0.0"><shape type="sphere">'}, ["scene.xml"]),
    "empty file": ({"scene.xml": ""}, ["scene.xml"]),
    "not XML": ({"scene.xml": "\x89PNG\r\n"}, ["scene.xml"]),
    "missing mesh": (
        {"scene.xml": mesh_scene("")["scene.xml"].replace("obj", "ply").replace("mesh.", "no.")},
        ["no.ply"],
    ),
    "NaN vertices": (mesh_scene("v nan 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"), ["mesh.obj"]),
    "only triangles without area": (mesh_scene("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n"), ["area"]),
    "film of 60,000 x 60,000": (
        {
            "scene.xml": '<scene version="3.0.0"><sensor type="perspective"><film type="hdrfilm">'
            '<integer name="width" value="60000"/><integer name="height" value="60000"/>'
            "</film></sensor></scene>"
        },
        ["60000"],
    ),
    "no such file": ({}, ["scene.xml"]),
}


@pytest.mark.parametrize("name", BAD_SCENES)
@pytest.mark.parametrize("command", ["render", "info"])
def test_bad_scenes_end_with_one_clear_error(name, command, tmp_path):
    files, words = BAD_SCENES[name]
    for file, text in files.items():
        (tmp_path / file).write_text(text, encoding="latin-1")
    done = run(command, "scene.xml", cwd=tmp_path, check=1)
    assert_one_clear_error(done, words)
    assert set(os.listdir(tmp_path)) == set(files)


def assert_one_clear_error(done, words):
    assert done.stdout == ""
    assert "Traceback" not in done.stderr and "panicked" not in done.stderr
    assert done.stderr.count("error") >= 1
    assert sum(line.startswith("error") for line in done.stderr.splitlines()) == 1, done.stderr
    for word in words:
        assert word in done.stderr


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--size", "60000x60000"], ["60000"]),
        (["-o", "no/such/a.exr"], ["no/such"]),
        (["-o", "a.jpg"], [".exr or .png"]),
        (["-o", "folder.exr"], ["folder.exr", "directory"]),
        (["-o", "a.exr", "-o", "no/b.exr"], ["no/b.exr"]),
    ],
)
def test_outputs_and_sizes_are_checked_before_rendering(cornell_path, tmp_path, arguments, words):
    (tmp_path / "folder.exr").mkdir()
    done = run("render", cornell_path, "--spp", "1000000", *arguments, cwd=tmp_path, check=1)
    assert_one_clear_error(done, words)
    assert os.listdir(tmp_path) == ["folder.exr"]


def test_a_folder_is_no_scene(tmp_path):
    (tmp_path / "folder").mkdir()
    assert_one_clear_error(run("render", "folder", cwd=tmp_path, check=1), ["folder", "directory"])


@pytest.mark.skipif(sys.platform != "linux", reason="needs /proc")
def test_a_folder_that_takes_no_files_is_found_before_rendering(cornell_path, tmp_path):
    done = run("render", cornell_path, "-o", "/proc/a.exr", "--spp", "1000000", cwd=tmp_path, check=1)
    assert_one_clear_error(done, ["/proc/a.exr"])


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], ["COMMAND"]),
        (["paint"], ["paint"]),
        (["render"], ["SCENE"]),
        (["render", "s.xml", "--size", "64"], ["'64'", "640x360"]),
        (["render", "s.xml", "--size=-4x4"], ["-4x4"]),
        (["render", "s.xml", "--spp", "0"], ["--spp"]),
        (["render", "s.xml", "--spp", "many"], ["many"]),
        (["render", "s.xml", "--time", "-1"], ["--time"]),
        (["render", "s.xml", "--time", "nan"], ["nan"]),
        (["render", "s.xml", "--max-depth", "0"], ["--max-depth", "-1"]),
        (["render", "s.xml", "--strategy", "0.5 cosine + 0.7 ligth"], ["ligth", "column 18"]),
        (["render", "s.xml", "--strategy", "cosine + light"], ["sum to 2"]),
        (["render", "s.xml", "--sampler", "halton"], ["halton", "sobol"]),
        (["render", "s.xml", "--seed", "-1"], ["--seed"]),
        (["render", "s.xml", "--threads", "0"], ["--threads"]),
        (["render", "s.xml", "--tone", "sepia"], ["sepia", "filmic"]),
        (["render", "s.xml", "--exposure", "inf"], ["--exposure"]),
        (["render", "s.xml", "--define", "spp"], ["NAME=VALUE"]),
        (["render", "s.xml", "--sp", "3"], ["--sp"]),
        (["info", "s.xml", "--limit", "texels=5"], ["texels", "image_texels"]),
        (["info", "s.xml", "--limit", "image_texels"], ["NAME=VALUE"]),
        (["info", "s.xml", "--limit", "image_texels=2T"], ["'image_texels=2T'", "NAME=VALUE"]),
        (["info", "s.xml", "--limit", "image_texels=-1K"], ["image_texels", "above 0"]),
    ],
)
def test_command_lines_that_make_no_sense_exit_with_2(tmp_path, arguments, words):
    assert_one_clear_error(run(*arguments, cwd=tmp_path, check=2), words)


def heed_interrupts():
    """Shells start background jobs with SIGINT ignored, and children inherit that."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)


def start(*arguments, cwd):
    return subprocess.Popen(
        [sys.executable, "-m", "steradian", *map(str, arguments)],
        cwd=cwd,
        preexec_fn=heed_interrupts,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        encoding="utf-8",
    )


@pytest.mark.skipif(os.name != "posix", reason="sends SIGINT")
def test_ctrl_c_writes_what_is_there(cornell_path, tmp_path):
    with start("render", cornell_path, "--size", "32x32", "--time", "100", "--json", cwd=tmp_path) as process:
        time.sleep(3)
        process.send_signal(signal.SIGINT)
        stdout, stderr = process.communicate(timeout=30)
    assert process.returncode == 130, stderr
    assert "interrupted" in stderr and "cornell-box.exr" in stderr and "Traceback" not in stderr
    value = json.loads(stdout)
    assert value["stopped"] == "interrupted"
    assert value["seconds"] < 60
    with OpenEXR.File(str(tmp_path / "cornell-box.exr")) as file:
        header = dict(file.header())
    assert header["steradian.stopped"] == "interrupted"
    assert header["steradian.spp"] == value["spp"] > 0


@pytest.mark.skipif(os.name != "posix", reason="sends SIGINT")
def test_ctrl_c_before_the_first_sample_writes_nothing(cornell_path, tmp_path):
    with start("render", cornell_path, "--size", "6000x6000", "--threads", "1", cwd=tmp_path) as process:
        time.sleep(2)
        process.send_signal(signal.SIGINT)
        stdout, stderr = process.communicate(timeout=30)
    assert process.returncode == 130, stderr
    assert "nothing was written" in stderr and "Traceback" not in stderr
    assert stdout == ""
    assert os.listdir(tmp_path) == []


@pytest.mark.skipif(os.name != "posix", reason="sends SIGINT")
@pytest.mark.parametrize(
    ("on_interrupt", "output"), [("raise", "raised\n"), ("return", "interrupted True\n")]
)
def test_ctrl_c_in_the_api(cornell_path, tmp_path, on_interrupt, output):
    code = f"""
import os, signal, threading
import steradian as sr
scene = sr.load({str(cornell_path)!r})
threading.Timer(1.5, lambda: os.kill(os.getpid(), signal.SIGINT)).start()
try:
    result = sr.render(scene, size=(16, 16), time=60, on_interrupt={on_interrupt!r})
    print(result.stopped, result.spp > 0)
except KeyboardInterrupt:
    print("raised")
"""
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        capture_output=True,
        text=True,
        timeout=30,
        preexec_fn=heed_interrupts,
    )
    assert (done.stdout, done.stderr) == (output, "")


@pytest.mark.skipif(os.name != "posix", reason="closes a pipe")
def test_a_reader_that_leaves_is_no_error(cornell_path, tmp_path):
    with start("info", cornell_path, cwd=tmp_path) as process:
        process.stdout.close()
        assert process.stderr.read() == ""
        assert process.wait(timeout=30) == 141


def test_progress_is_plain_lines_without_a_terminal_and_one_line_with():
    import io

    from steradian.cli.progress import ProgressBar, bar, describe, duration
    from steradian.render import Progress

    progress = Progress(samples_done=16, samples_total=64, seconds=2.0, mean_relative_error=0.0416)
    assert describe(progress, 2.0, None) == "16 / 64 spp · 2.0 s · 6.0 s left · error 4.2 %"
    timed = Progress(samples_done=16, samples_total=None, seconds=2.0, mean_relative_error=None)
    assert describe(timed, 2.0, 10.0) == "16 spp · 2.0 s · 8.0 s left"
    assert [duration(s) for s in (0.04, 125, 4200)] == ["0.0 s", "2 min 05 s", "1 h 10 min"]
    assert all(len(bar("x" * 30, 0.5, width)) <= width for width in range(5, 120))

    quiet = io.StringIO()
    with ProgressBar(None, quiet) as shown:
        shown.update(progress)
    assert quiet.getvalue() == ""
    terminal = io.StringIO()
    terminal.isatty = lambda: True
    with ProgressBar(None, terminal) as shown:
        shown.update(progress)
    assert "16 / 64 spp" in terminal.getvalue()
    assert terminal.getvalue().endswith("\r\x1b[K")


def test_every_file_of_the_package_has_a_docstring():
    import ast

    import steradian

    files = list(Path(steradian.__file__).parent.rglob("*.py"))
    assert len(files) > 10, "no files, no evidence"
    for file in files:
        assert ast.get_docstring(ast.parse(file.read_text(encoding="utf-8"))), file


def test_variants_of_a_model(tmp_path, cornell_path):
    positions = struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)
    mappings = {"KHR_materials_variants": {"mappings": [{"material": 1, "variants": [1]}]}}
    emitting = {"KHR_materials_emissive_strength": {"emissiveStrength": 2}}
    model = {
        "asset": {"version": "2.0"},
        "buffers": [{"byteLength": 36, "uri": "data:;base64," + base64.b64encode(positions).decode()}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3"}],
        "materials": [{}, {"emissiveFactor": [1, 1, 1], "extensions": emitting}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0, "extensions": mappings}]}],
        "nodes": [{"mesh": 0}],
        "extensions": {"KHR_materials_variants": {"variants": [{"name": "off"}, {"name": "on"}]}},
    }
    (tmp_path / "lamp.gltf").write_text(json.dumps(model))
    listed = run("info", "lamp.gltf", cwd=tmp_path, check=0)
    assert "variants     off, on" in listed.stdout
    lit = json.loads(run("info", "lamp.gltf", "--variant", "on", "--json", cwd=tmp_path, check=0).stdout)
    assert lit["variants"] == ["off", "on"]
    assert "scene::no-light" not in [d["code"] for d in lit["diagnostics"]]
    done = run("convert", "lamp.gltf", "lamp.xml", "--variant", "on", "--quiet", cwd=tmp_path, check=0)
    assert "the one that is shown is written" in done.stderr
    assert '<emitter type="area"' in (tmp_path / "lamp.xml").read_text()
    wrong = run("render", "lamp.gltf", "--variant", "out", cwd=tmp_path, check=1)
    assert 'there are "off", "on"' in wrong.stderr
    wrong = run("info", str(cornell_path), "--variant", "on", cwd=tmp_path, check=1)
    assert "the scene has no variants" in wrong.stderr


def test_limits_are_options(tmp_path):
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + "f 1 2 3\n" * 1025)
    for command in (["render", *FAST], ["info"], ["convert", "out.xml"]):
        name, *rest = command
        limited = [name, "a.obj", *rest, "--limit", "file_bytes=1G", "--limit", "mesh_elements=1k"]
        assert "--limit mesh_elements=N" in run(*limited, cwd=tmp_path, check=1).stderr
        run(*limited[:-1], "mesh_elements=2K", cwd=tmp_path, check=0)


def test_files_are_looked_for_in_search_paths(tmp_path):
    (tmp_path / "meshes").mkdir()
    (tmp_path / "meshes" / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    (tmp_path / "scene.xml").write_text(
        '<scene version="3.0.0"><shape type="obj"><string name="filename" value="a.obj"/></shape></scene>'
    )
    assert "a.obj" in run("info", "scene.xml", cwd=tmp_path, check=1).stderr
    found = run("info", "scene.xml", "--search-path", ".", "--search-path", "meshes", cwd=tmp_path, check=0)
    assert "1 triangles" in found.stdout
    wrong = run("render", "scene.xml", "--search-path", "mashes", cwd=tmp_path, check=2)
    assert "'mashes' is not a folder" in wrong.stderr
