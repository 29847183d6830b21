"""The Python API: settings in, arrays and errors out."""

import json
import math
import subprocess
import sys

import numpy as np
import pytest

import steradian as sr

SMALL = {"size": (24, 20), "max_depth": 4}


def same_bits(a, b):
    return all(
        getattr(a, name).tobytes() == getattr(b, name).tobytes()
        for name in ("image", "stderr", "albedo", "normal", "depth", "alpha")
    )


@pytest.mark.parametrize("behind", [False, True])
def test_bitangents_follow_mirrored_texture_coordinates(behind):
    """A bump that is mirrored twice, by v and in its texture, is the same bump; by v alone it is not."""

    def image(mirrored, tilt, follows):
        corners = np.array([[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], np.float32)
        uvs = (corners[:, :2] + 1) / 2 * [1, -1 if mirrored else 1]
        normal = np.full((2, 2, 3), [0.5, 0.5 + tilt, 0.9], np.float32)
        texture = {"type": "bitmap", "data": normal, "raw": True}
        bumpy = {
            "type": "normalmap",
            "normalmap": texture,
            "along_v": follows,
            "inner": {"type": "diffuse"},
        }
        camera = sr.Transform.look_at((0, 0, -5 if behind else 5), (0, 0, 0), (0, 1, 0))
        scene = sr.load(
            {
                "type": "scene",
                "camera": {"type": "perspective", "fov": 10, "to_world": camera},
                "sun": {"type": "directional", "direction": [0, -1, 1 if behind else -1]},
                "quad": {
                    "type": "mesh",
                    "vertices": corners,
                    "faces": [[0, 1, 2], [0, 2, 3]],
                    "uvs": uvs.astype(np.float32),
                    "bsdf": {"type": "twosided", "inner": bumpy},
                },
            }
        )
        return sr.render(scene, spp=4, size=(4, 4)).image.mean()

    upright = image(mirrored=False, tilt=0.3, follows=True)
    assert upright == pytest.approx(image(mirrored=False, tilt=0.3, follows=False), rel=1e-5)
    assert upright == pytest.approx(image(mirrored=True, tilt=-0.3, follows=True), rel=1e-5)
    assert upright != pytest.approx(image(mirrored=True, tilt=-0.3, follows=False), rel=0.2)


def test_what_is_all_hole_is_not_there():
    """Masks of opacity 0 over any model, common or not, alone in the scene."""
    for inner in ({"type": "diffuse"}, {"type": "principled"}, {"type": "metallicroughness"}):
        scene = sr.load(
            {
                "type": "scene",
                "camera": {
                    "type": "perspective",
                    "fov": 40,
                    "to_world": sr.Transform.look_at((0, 0, 5), (0, 0, 0)),
                },
                "sky": {"type": "constant"},
                "ball": {"type": "sphere", "bsdf": {"type": "mask", "opacity": 0.0, "inner": inner}},
            }
        )
        assert np.all(sr.render(scene, spp=4, size=(8, 8)).image == 1)


def test_a_result_has_arrays_errors_and_its_settings(cornell):
    result = sr.render(cornell, spp=16, seed=5, strategy=0.5 * sr.cosine + 0.5 * sr.light, **SMALL)
    for name in ("image", "stderr", "albedo", "normal"):
        array = getattr(result, name)
        assert (array.shape, array.dtype) == ((20, 24, 3), np.float32), name
        assert not array.flags.writeable
    assert result.depth.shape == result.alpha.shape == (20, 24)
    assert (result.spp, result.stopped, result.rejected_samples) == (16, "complete", 0)
    assert result.sample_ranges == [(0, 16)]
    assert result.mean == pytest.approx(result.image.mean(axis=(0, 1)), rel=1e-5)
    assert result.mean_stderr == pytest.approx(
        np.sqrt((result.stderr.astype(float) ** 2).sum(axis=(0, 1))) / result.depth.size, rel=1e-5
    )
    assert 0 < result.mean_relative_error < 10
    assert result.paths_per_second == pytest.approx(24 * 20 * 16 / result.seconds)
    assert result.cpu_seconds > 0
    assert result.settings["strategy"] == "0.5 cosine + 0.5 light"
    assert result.settings["max_depth"] == 4
    assert result.settings["seed"] == 5
    assert json.loads(json.dumps(result.settings)) == result.settings


def test_features_are_those_of_the_first_hit(lit_square):
    result = sr.render(sr.load(lit_square), spp=8)
    assert result.image == pytest.approx(np.broadcast_to([1, 2, 3], (6, 8, 3)), rel=1e-5)
    assert result.stderr == pytest.approx(0, abs=1e-5)
    assert result.albedo == pytest.approx(np.broadcast_to([0.25, 0.5, 0.75], (6, 8, 3)), rel=1e-3)
    assert result.normal == pytest.approx(np.broadcast_to([0, 0, 1], (6, 8, 3)), abs=1e-5)
    assert result.alpha == pytest.approx(1)
    assert result.depth.min() == pytest.approx(5, rel=1e-2)


def test_the_scene_s_own_settings_are_the_defaults(lit_square):
    scene = sr.load(lit_square)
    result = sr.render(scene)
    assert (result.width, result.height, result.spp) == (8, 6, 16)
    assert result.settings["max_depth"] == scene.settings.max_depth == 2
    assert result.settings["strategy"] == "mis(bsdf, light)"
    assert sr.render(scene, max_depth=-1, spp=1).settings["max_depth"] == -1


def test_bits_do_not_depend_on_threads_or_on_how_samples_are_split(cornell):
    whole = sr.render(cornell, spp=32, threads=1, seed=3, **SMALL)
    assert same_bits(whole, sr.render(cornell, spp=32, threads=2, seed=3, **SMALL))
    halves = [sr.render(cornell, spp=16, first_sample=first, seed=3, **SMALL) for first in (0, 16)]
    merged = halves[0].merge(halves[1])
    assert same_bits(whole, merged)
    assert same_bits(whole, halves[1].merge(halves[0]))
    assert merged.spp == 32
    assert merged.sample_ranges == [(0, 32)]
    assert merged.seconds == halves[0].seconds + halves[1].seconds
    assert not same_bits(whole, sr.render(cornell, spp=32, seed=4, **SMALL))
    assert not same_bits(whole, halves[0])


@pytest.mark.parametrize("cut", [1, 7, 24])
def test_any_cut_merges_to_the_same_bits(cornell, cut):
    whole = sr.render(cornell, spp=29, sampler="independent", **SMALL)
    first = sr.render(cornell, spp=cut, sampler="independent", **SMALL)
    rest = sr.render(cornell, spp=29 - cut, first_sample=cut, sampler="independent", **SMALL)
    assert same_bits(whole, first.merge(rest))


def test_merging_what_does_not_fit_is_an_error(cornell):
    result = sr.render(cornell, spp=4, **SMALL)
    with pytest.raises(ValueError, match="in both"):
        result.merge(result)
    with pytest.raises(ValueError, match="different seed"):
        result.merge(sr.render(cornell, spp=4, first_sample=4, seed=1, **SMALL))
    with pytest.raises(ValueError, match="different strategy"):
        result.merge(sr.render(cornell, spp=4, first_sample=4, strategy=sr.bsdf, **SMALL))
    assert result.spp == 4


def test_strategies_and_samplers_agree_within_their_errors(cornell):
    settings = [
        {"strategy": sr.mis(sr.bsdf, sr.light)},
        {"strategy": 0.5 * sr.cosine + 0.5 * sr.light},
        {"strategy": "bsdf"},
        {"sampler": "independent", "seed": 1},
    ]
    results = [sr.render(cornell, spp=256, seed=s.pop("seed", 0), **s, **SMALL) for s in settings]
    base = results[0]
    for result in results[1:]:
        for c in range(3):
            error = math.hypot(base.mean_stderr[c], result.mean_stderr[c])
            # Nine comparisons: a false alarm has a probability below 1e-5; seeds are fixed in any case.
            assert abs(base.mean[c] - result.mean[c]) < 5 * error, result.settings


def test_time_ends_a_render(cornell):
    result = sr.render(cornell, time=0.3, **SMALL)
    assert result.stopped == "time"
    assert result.spp >= 1
    assert result.seconds < 5
    assert sr.render(cornell, spp=2, time=60, **SMALL).stopped == "complete"


def test_progress_is_reported_on_this_thread(cornell):
    seen = []
    result = sr.render(cornell, spp=64, on_progress=seen.append, **SMALL)
    assert seen[-1].samples_done == seen[-1].samples_total == result.spp == 64
    assert seen[-1].mean_relative_error > 0
    assert [p.samples_done for p in seen] == sorted(p.samples_done for p in seen)


def test_an_exception_in_the_callback_comes_out(cornell):
    def fail(progress):
        raise LookupError("mine")

    with pytest.raises(LookupError, match="mine"):
        sr.render(cornell, time=30, on_progress=fail, **SMALL)


def test_what_is_no_scene_and_no_result_is_named(cornell):
    with pytest.raises(TypeError, match="not str; load it first"):
        sr.render("scene.xml")
    with pytest.raises(TypeError, match="not NoneType"):
        sr.render(cornell, spp=1, **SMALL).merge(None)


@pytest.mark.parametrize(
    ("settings", "words"),
    [
        ({"spp": 0}, "spp"),
        ({"spp": -3}, "spp"),
        ({"time": 0.0}, "time"),
        ({"time": math.nan}, "time"),
        ({"strategy": "cosin"}, "cosin"),
        ({"strategy": 0.5 * sr.cosine}, "sum to 0.5"),
        ({"sampler": "halton"}, "halton"),
        ({"max_depth": 0}, "max_depth"),
        ({"max_depth": -2}, "max_depth"),
        ({"size": (0, 5)}, "width"),
        ({"size": "8x8"}, "width, height"),
        ({"size": 8}, "width, height"),
        ({"size": (60_000, 60_000)}, "60000"),
        ({"seed": -1}, "seed"),
        ({"seed": 2**64}, "seed"),
        ({"threads": 0}, "threads"),
        ({"first_sample": -1}, "first_sample"),
        ({"on_interrupt": "ignore"}, "on_interrupt"),
    ],
)
def test_settings_that_make_no_sense_are_value_errors(cornell, settings, words):
    with pytest.raises(ValueError, match=words):
        sr.render(cornell, **settings)


def test_a_film_beyond_memory_is_refused(cornell, monkeypatch):
    monkeypatch.setattr("steradian._memory.physical_bytes", lambda: 2**20)
    with pytest.raises(MemoryError, match=r"64 x 64.*smaller size"):
        sr.render(cornell, size=(64, 64), spp=1)


def test_importing_is_fast_and_leaves_numpy_alone():
    code = (
        "import sys, time; start = time.perf_counter(); import steradian; "
        "print('numpy' in sys.modules, time.perf_counter() - start)"
    )
    runs = [
        subprocess.run(
            [sys.executable, "-c", code], capture_output=True, text=True, check=True
        ).stdout.split()
        for _ in range(3)
    ]
    assert all(numpy == "False" for numpy, _ in runs)
    assert min(float(seconds) for _, seconds in runs) < 0.15
