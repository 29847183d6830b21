"""Loading: files, dictionaries, and what they have to say."""

import numpy as np
import pytest

import steradian as sr


def test_info_says_what_is_there(cornell):
    info = cornell.info()
    assert (info["triangles"], info["lights"], info["textures"]) == (36, 1, 0)
    assert info["film"]["width"] == info["film"]["height"] == 512
    assert info["camera"]["position"] == pytest.approx([2.78, 2.73, -8])
    assert info["camera"]["fov_x_deg"] == pytest.approx(39.3077)
    assert info["bounds"] == pytest.approx(np.array([[0, 0, 0], [5.56, 5.488, 5.592]]), abs=1e-3)
    assert info["memory_bytes"] > 0
    assert info["diagnostics"] == []


def test_defines_override_the_file_s_defaults(cornell_path):
    scene = sr.load(cornell_path, defines={"res": 32, "spp": 7})
    assert (scene.settings.width, scene.settings.height, scene.settings.spp) == (32, 32, 7)


def test_warnings_are_python_warnings_and_diagnostics(tmp_path):
    file = tmp_path / "scene.xml"
    file.write_text(
        '<scene version="3.0.0">\n  <shape type="sphere"><float name="raduis" value="2"/></shape>\n</scene>'
    )
    with pytest.warns(sr.SceneWarning) as caught:
        scene = sr.load(file)
    assert len(caught) == len(scene.diagnostics) > 0
    [unknown] = [d for d in scene.diagnostics if d.code == "mitsuba::unknown-property"]
    assert "raduis" in unknown.message
    assert unknown.line == 2
    assert unknown.source == str(file)
    assert unknown.hint == 'did you mean "radius"?'
    assert str(unknown) in [str(w.message) for w in caught]


def test_errors_show_the_place(tmp_path):
    file = tmp_path / "scene.xml"
    file.write_text('<scene version="3.0.0">\n  <shape type="sphere"><ref id="gold"/></shape>\n</scene>')
    with pytest.raises(sr.SceneError) as caught:
        sr.load(file)
    assert "gold" in str(caught.value)
    assert "scene.xml:2" in str(caught.value)
    assert [d.severity for d in caught.value.diagnostics] == ["error", "warning"]


def test_dictionaries_and_files_are_the_same_scene(tmp_path, lit_square):
    file = tmp_path / "scene.xml"
    file.write_text("""<scene version="3.0.0">
        <integrator type="path"><integer name="max_depth" value="2"/></integrator>
        <sensor type="perspective">
            <float name="fov" value="10"/>
            <transform name="to_world"><lookat origin="0, 0, 5" target="0, 0, 0" up="0, 1, 0"/></transform>
            <film type="hdrfilm">
                <integer name="width" value="8"/><integer name="height" value="6"/><rfilter type="box"/>
            </film>
            <sampler type="independent"><integer name="sample_count" value="16"/></sampler>
        </sensor>
        <shape type="rectangle">
            <transform name="to_world"><scale value="10"/></transform>
            <emitter type="area"><rgb name="radiance" value="1, 2, 3"/></emitter>
            <bsdf type="diffuse"><rgb name="reflectance" value="0.25, 0.5, 0.75"/></bsdf>
        </shape>
    </scene>""")
    a, b = (sr.render(sr.load(source)) for source in (file, lit_square))
    for name in ("image", "stderr", "albedo", "normal", "depth"):
        assert getattr(a, name).tobytes() == getattr(b, name).tobytes(), name


def square_mesh(**changes):
    mesh = {
        "type": "mesh",
        "vertices": np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], dtype=np.float32),
        "faces": np.array([[0, 1, 2], [0, 2, 3]]),
        "uvs": [[0, 1], [1, 1], [1, 0], [0, 0]],
    }
    return {k: v for k, v in {**mesh, **changes}.items() if v is not None}


def test_meshes_and_textures_from_arrays(lit_square):
    pixels = np.array([[[1, 0, 0], [0, 1, 0]], [[0, 0, 1], [1, 1, 1]]], dtype=np.float32)
    square = lit_square["square"]
    texture = {"type": "bitmap", "data": pixels, "filter_type": "nearest", "raw": True}
    lit_square["square"] = {
        **square_mesh(),
        "to_world": sr.Transform.scale(10),
        "emitter": {"type": "area", "radiance": {"type": "rgb", "value": 1.0}},
        "bsdf": {"type": "diffuse", "reflectance": texture},
    }
    assert square["type"] == "rectangle"
    # The camera sees the middle of the square: each corner of the image is one texel.
    albedo = sr.render(sr.load(lit_square), spp=4).albedo
    assert albedo[0, 0] == pytest.approx(pixels[0, 0], abs=1e-3)
    assert albedo[0, -1] == pytest.approx(pixels[0, 1], abs=1e-3)
    assert albedo[-1, 0] == pytest.approx(pixels[1, 0], abs=1e-3)
    assert albedo[-1, -1] == pytest.approx(pixels[1, 1], abs=1e-3)


def test_references_reach_objects_by_their_key(lit_square):
    lit_square["paint"] = {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.125}}
    lit_square["square"]["bsdf"] = {"type": "ref", "id": "paint"}
    assert sr.render(sr.load(lit_square), spp=2).albedo == pytest.approx(0.125, rel=1e-3)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"type": "sphere"}, ['"scene"']),
        ({"ball": {"type": "sphre"}}, ["sphre", "sphere", 'scene["ball"]']),
        ({"ball": {"radius": 1.0}}, ["type", 'scene["ball"]']),
        ({"ball": {"type": "sphere", "radius": None}}, ["None", 'scene["ball"]["radius"]']),
        ({"ball": {"type": "sphere", "to_world": np.eye(3)}}, ["[3, 3]", "to_world"]),
        ({"ball": {"type": "sphere", "bsdf": {"type": "ref"}}}, ["id"]),
        ({"ball": {"type": "sphere", "bsdf": {"type": "ref", "id": "gold"}}}, ["gold"]),
        ({"m": square_mesh(faces=[[0, 1, 4]])}, ["index 4", "0 to 3"]),
        ({"m": square_mesh(faces=[[0, 1, -1]])}, ["index -1"]),
        ({"m": square_mesh(faces=None)}, ["faces"]),
        ({"m": square_mesh(vertices=[[0, 0]])}, ["vertices", "(n, 3)"]),
        ({"m": square_mesh(normals=[[0, 0, 1]])}, ["normals"]),
        ({"m": square_mesh(vertices=[[np.nan] * 3] * 4)}, ["NaN"]),
        ({1: {"type": "sphere"}}, ["text"]),
    ],
)
def test_dictionaries_that_are_no_scene_are_scene_errors(lit_square, change, words):
    with pytest.raises(sr.SceneError) as caught:
        sr.load({**lit_square, **change})
    for word in words:
        assert word in str(caught.value)


def test_a_dictionary_inside_itself_is_an_error(lit_square):
    bsdf = {"type": "twosided"}
    bsdf["inner"] = bsdf
    lit_square["square"]["bsdf"] = bsdf
    with pytest.raises(sr.SceneError, match="inside one another"):
        sr.load(lit_square)


def test_dictionaries_take_no_defines(lit_square):
    with pytest.raises(ValueError, match="defines"):
        sr.load(lit_square, defines={"spp": 3})


SQUARE = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"


def test_files_are_looked_for_in_search_paths(tmp_path, lit_square):
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "steradian-test.obj").write_text(SQUARE)
    file = tmp_path / "scene.xml"
    file.write_text(
        '<scene version="3.0.0"><sensor type="orthographic"/><shape type="obj">'
        '<string name="filename" value="steradian-test.obj"/></shape></scene>'
    )
    lit_square["more"] = {"type": "obj", "filename": "steradian-test.obj"}
    for source, triangles in ((file, 1), (lit_square, 3)):
        with pytest.raises(sr.SceneError, match="there is no such file"):
            sr.load(source)
        scene = sr.load(source, search_paths=[tmp_path, tmp_path / "elsewhere"])
        assert scene.info()["triangles"] == triangles


def test_search_paths_are_folders(tmp_path, cornell_path):
    with pytest.raises(NotADirectoryError, match="absent is not a folder"):
        sr.load(cornell_path, search_paths=[tmp_path / "absent"])
    with pytest.raises(TypeError, match="list of folders"):
        sr.load(cornell_path, search_paths=str(tmp_path))


def test_limits_are_raised_and_lowered(tmp_path, lit_square):
    file = tmp_path / "a.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 4 3\n")
    with pytest.raises(sr.SceneError, match=r"more than 3 elements .*mesh_elements=N or limits="):
        sr.load(file, limits={"mesh_elements": 3})
    with pytest.warns(sr.SceneWarning):
        assert (
            sr.load(file, limits={"mesh_elements": np.int64(4), "file_bytes": 1e10}).info()["triangles"] == 2
        )
    scene = lit_square | {"mesh": {"type": "obj", "filename": str(file)}}
    with pytest.raises(sr.SceneError, match="it has 48 bytes; at most 47 are read"):
        sr.load(scene, limits={"file_bytes": 47})
    with pytest.raises(sr.SceneError, match="at most 47 are read"):
        sr.convert(scene, tmp_path / "out.xml", limits={"file_bytes": 47})


@pytest.mark.parametrize(
    ("limits", "error", "words"),
    [
        ({"texels": 5}, ValueError, 'no limit "texels"; there are file_bytes, '),
        ({"file_bytes": 0}, ValueError, "file_bytes is a whole number above 0, not 0"),
        ({"file_bytes": -1}, ValueError, "not -1"),
        ({"file_bytes": 1.5}, ValueError, "not 1.5"),
        ({"file_bytes": float("nan")}, ValueError, "not nan"),
        ({"file_bytes": float("inf")}, ValueError, "not inf"),
        ({"file_bytes": 2**64}, ValueError, "a whole number"),
        ({"mesh_elements": 2**32}, ValueError, "from 1 to 4294967295"),
        ({"file_bytes": "8G"}, TypeError, "is a number, not '8G'"),
        ({"file_bytes": True}, TypeError, "is a number, not True"),
    ],
)
def test_limits_that_make_no_sense_are_named(cornell_path, limits, error, words):
    with pytest.raises(error, match=words):
        sr.load(cornell_path, limits=limits)
