"""Images with values that no picture can show, and arrays that are no images: said, and never a NaN."""

import numpy as np
import pytest

import steradian as sr

TOWARDS = sr.Transform.look_at((0, 3, 3), (0, 0, 0))


def bitmap(value: float, shape: tuple[int, ...] = (2, 2, 3)) -> dict[str, object]:
    return {"type": "bitmap", "raw": True, "data": np.full(shape, value)}


def scene(bsdf: dict[str, object] | None = None, **others: object) -> dict[str, object]:
    return {
        "type": "scene",
        "camera": {
            "type": "perspective",
            "fov": 40.0,
            "to_world": sr.Transform.look_at((0, 0, 5), (0, 0, 0)),
        },
        "ball": {"type": "sphere", "bsdf": bsdf or {"type": "diffuse"}},
        "sky": {"type": "constant"},
        **others,
    }


PLACES = {
    "reflectance": lambda b: scene({"type": "diffuse", "reflectance": b}),
    "alpha": lambda b: scene({"type": "roughconductor", "alpha": b}),
    "opacity": lambda b: scene({"type": "mask", "opacity": b, "bsdf": {"type": "diffuse"}}),
    "eta": lambda b: scene({"type": "conductor", "eta": b, "k": 1.0}),
    "radiance": lambda b: scene(lamp={"type": "rectangle", "emitter": {"type": "area", "radiance": b}}),
    "spot": lambda b: scene(lamp={"type": "spot", "texture": b, "to_world": TOWARDS}),
    "projector": lambda b: scene(
        lamp={"type": "projector", "irradiance": b, "fov": 50.0, "to_world": TOWARDS}
    ),
}


@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf, -np.inf, 1e300])
@pytest.mark.parametrize("place", PLACES)
def test_bad_texels_are_said_and_shown_as_numbers(place, value):
    with pytest.warns(sr.SceneWarning, match="bad-texels"):
        loaded = sr.load(PLACES[place](bitmap(value)))
    result = sr.render(loaded, spp=4, size=(16, 12))
    assert np.isfinite(result.image).all() and result.image.min() >= 0.0
    assert result.rejected_samples == 0 or value > 0, "only what is infinite may be more than can be added up"


def test_environments_of_arrays():
    pixels = np.full((8, 16, 3), 0.25, dtype=np.float32)
    for key in ("bitmap", "data"):
        lit = {**scene(), "sky": {"type": "envmap", key: pixels}}
        assert sr.render(sr.load(lit), spp=4, size=(16, 12)).image.max() == pytest.approx(0.25, rel=0.01)
    with pytest.warns(sr.SceneWarning, match="all black"):
        sr.load({**scene(), "sky": {"type": "envmap", "data": 0 * pixels}})


@pytest.mark.parametrize("kind", ["u2", "i8", "?", "c16"])
def test_pixels_are_bytes_or_floating_point(kind):
    with pytest.raises(sr.SceneError, match="uint8 or floating point"):
        sr.load(
            scene({"type": "diffuse", "reflectance": {"type": "bitmap", "data": np.ones((2, 2, 3), kind)}})
        )


def test_placements_are_affine():
    for row in [(0, 0, 0.5, 1), (0, 0, 0, 0), (0, 0, 0, 2)]:
        matrix = np.eye(4)
        matrix[3] = row
        with pytest.raises(sr.SceneError, match="last row"):
            sr.load(scene(cube={"type": "cube", "to_world": matrix}))


def test_dictionaries_in_dictionaries_come_to_an_end():
    shared: dict[str, object] = {"type": "checkerboard"}
    for _ in range(40):
        shared = {"type": "checkerboard", "color0": shared, "color1": shared}
    with pytest.raises(sr.SceneError, match="more than 131072 objects"):
        sr.load(scene({"type": "diffuse", "reflectance": shared}))
    nested = scene()
    nested["self"] = nested
    with pytest.raises(sr.SceneError, match="inside a scene"):
        sr.load(nested)


def test_a_spot_has_its_constant_texture():
    def mean(**options: object) -> float:
        spot = {"type": "spot", "to_world": TOWARDS, "intensity": {"type": "rgb", "value": 50.0}, **options}
        lit = scene(lamp=spot)
        del lit["sky"]
        return float(sr.render(sr.load(lit), spp=16, size=(16, 12)).image.mean())

    assert mean(texture={"type": "rgb", "value": 0.1}) == pytest.approx(0.1 * mean(), rel=1e-3)


def test_a_mirrored_rectangle_keeps_its_front():
    """As in Mitsuba 3.9.1, whose shading frame decides."""
    mirror = sr.Transform.scale((-1, 1, 1))
    square = {"type": "rectangle", "to_world": mirror, "emitter": {"type": "area"}}
    image = sr.render(sr.load({**scene(), "ball": square}), spp=4, size=(16, 12)).image
    assert image[6, 8] == pytest.approx(1.0)
