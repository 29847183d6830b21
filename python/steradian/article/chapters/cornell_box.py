"""The rendering equation on the Cornell box: one picture per strategy, at equal samples."""

from __future__ import annotations

import math
import tempfile
from pathlib import Path
from typing import Any

import steradian as sr
from steradian.article.chapter import Chapter

TITLE = "The rendering equation"

SIZE = 192
LENGTH_OF_REFERENCE = 16
"""The reference takes so many times the samples of a picture."""


def cornell_box() -> dict[str, Any]:
    """The box of ``scenes/cornell-box.xml``, as a dictionary. Metres; colours are linear RGB."""
    place = sr.Transform

    def matte(r: float, g: float, b: float) -> dict[str, Any]:
        return {
            "type": "diffuse",
            "reflectance": {"type": "rgb", "value": [r, g, b]},
        }

    white = matte(0.725, 0.71, 0.68)

    def wall(
        width: float,
        height: float,
        turn: Any,
        at: tuple[float, float, float],
        bsdf: Any,
    ) -> dict[str, Any]:
        to_world = (
            place.translate(at) @ turn @ place.scale((width / 2, height / 2, 1))
        )
        return {"type": "rectangle", "to_world": to_world, "bsdf": bsdf}

    def block(
        size: tuple[float, float, float], turn: float, x: float, z: float
    ) -> dict[str, Any]:
        half = (size[0] / 2, size[1] / 2, size[2] / 2)
        to_world = (
            place.translate((x, half[1], z))
            @ place.rotate((0, 1, 0), turn)
            @ place.scale(half)
        )
        return {"type": "cube", "to_world": to_world, "bsdf": white}

    def x(angle: float) -> Any:
        return place.rotate((1, 0, 0), angle)

    def y(angle: float) -> Any:
        return place.rotate((0, 1, 0), angle)

    lamp = wall(1.3, 1.05, x(90), (2.78, 5.48, 2.795), matte(0.78, 0.78, 0.78))
    lamp["emitter"] = {
        "type": "area",
        "radiance": {"type": "rgb", "value": [18, 13.5, 6.5]},
    }
    return {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": 8, "rr_depth": 8},
        "camera": {
            "type": "perspective",
            "fov": 39.3077,
            "to_world": place.look_at(
                (2.78, 2.73, -8), (2.78, 2.73, 0), (0, 1, 0)
            ),
            "film": {
                "type": "hdrfilm",
                "width": 512,
                "height": 512,
                "rfilter": {"type": "tent"},
            },
            "sampler": {"type": "independent", "sample_count": 64},
        },
        "floor": wall(5.56, 5.592, x(-90), (2.78, 0, 2.796), white),
        "ceiling": wall(5.56, 5.592, x(90), (2.78, 5.488, 2.796), white),
        "back wall": wall(5.56, 5.488, y(180), (2.78, 2.744, 5.592), white),
        "left wall": wall(
            5.592, 5.488, y(-90), (5.56, 2.744, 2.796), matte(0.63, 0.065, 0.05)
        ),
        "right wall": wall(
            5.592, 5.488, y(90), (0, 2.744, 2.796), matte(0.14, 0.45, 0.091)
        ),
        "short block": block((1.674, 1.65, 1.67), -17.03, 1.855, 1.69),
        "tall block": block((1.654, 3.3, 1.674), 17.23, 3.685, 3.5125),
        "light": lamp,
    }


def furnace(strategy: str, spp: int, seed: int) -> sr.Estimate:
    """Green radiance, from inside of a glowing ball."""
    inside = {
        "type": "scene",
        "integrator": {"type": "path", "max_depth": -1},
        "camera": {"type": "perspective", "fov": 60},
        "ball": {
            "type": "sphere",
            "radius": 3,
            "flip_normals": True,
            "emitter": {
                "type": "area",
                "radiance": {"type": "rgb", "value": [1, 1, 1]},
            },
            "bsdf": {
                "type": "diffuse",
                "reflectance": {"type": "rgb", "value": [0.5, 0.5, 0.5]},
            },
        },
    }
    result = sr.render(
        sr.load(inside), size=(32, 32), spp=spp, strategy=strategy, seed=seed
    )
    return sr.Estimate(
        result.mean[1], result.mean_stderr[1], n=32 * 32 * spp, dof=32 * 32
    )


def picture(strategy: str, spp: int, size: int, seed: int) -> sr.Result:
    """The box, by one strategy."""
    from steradian.article.chapters.cornell_box import cornell_box

    scene = sr.load(cornell_box())
    return sr.render(
        scene, strategy=strategy, spp=spp, size=(size, size), seed=seed
    )


def tell(page: Chapter) -> None:
    """A furnace whose answer is known, and the box."""
    page.text("""
        The light that leaves a point is what it emits, plus what arrives from every direction, each
        weighed by the material and the cosine. What arrives from a direction left another point, so the
        equation contains itself:

        <span class="formula"><i>L</i><sub>o</sub> = <i>L</i><sub>e</sub> + ∫ <i>f</i><sub>r</sub>
        <i>L</i><sub>i</sub> cos θ dω = <i>L</i><sub>e</sub> + E[ <i>f</i><sub>r</sub>
        <i>L</i><sub>i</sub> cos θ / <i>P</i>(ω) ]</span>

        The remedy is the one from the beginning. Choose one direction with a known density, look what
        comes from there, divide. That look asks the same question elsewhere, so it goes on, and a path
        grows.

        There is a room whose answer is known. Inside a closed ball that glows with radiance 1
        everywhere and reflects half of what it receives, each bounce adds half of the one before: 1 + ½
        + ¼ + … = 2, wherever one looks.
    """)
    for strategy in ("uniform", "0.5 cosine + 0.5 light"):
        spp = page.n(256)
        estimate = (
            page.run(furnace, strategy=strategy, spp=spp)
            if strategy == "uniform"
            else furnace(strategy, spp, page.next_seed())
        )
        page.measure(
            f"radiance in a furnace, {strategy}",
            estimate,
            2.0,
            formula="1 / (1 − ½)",
        )
    page.text("""
        And a room whose answer is not known: the Cornell box, rendered with each strategy at the same
        number of samples.
        They all solve the same equation; the table compares the mean of each image with a long run of
        the default, whose own error is counted as well. <em>Light</em> looks at the lamp at every
        bounce, and goes on by the material.
    """)
    _box(page)


STRATEGIES = (
    "uniform",
    "cosine",
    "light",
    "0.5 cosine + 0.5 light",
    "mis(bsdf, light)",
)


def _box(page: Chapter) -> None:
    spp = page.n(32)
    size = SIZE // 2 if page.quick else SIZE
    reference = picture(
        "mis(bsdf, light)", LENGTH_OF_REFERENCE * spp, size, page.next_seed()
    )
    pictures = []
    for strategy in STRATEGIES:
        if strategy == STRATEGIES[0]:
            result = page.run(picture, strategy=strategy, spp=spp, size=size)
        else:
            result = picture(strategy, spp, size, page.next_seed())
        error = math.hypot(result.mean_stderr[1], reference.mean_stderr[1])
        estimate = sr.Estimate(
            result.mean[1], error, n=size * size * spp, dof=size * size
        )
        page.measure(
            f"Cornell box, {strategy}",
            estimate,
            reference.mean[1],
            claimed="E[<i>f</i><sub>r</sub> <i>L</i><sub>i</sub> cos θ / <i>P</i>]",
            formula="a long run",
        )
        noise = 100 * result.mean_relative_error
        caption = f"{strategy}: {noise:.2g} % error, {result.seconds:.1f} s"
        pictures.append((_png(result), caption))
    noise = 100 * reference.mean_relative_error
    caption = f"the long run, {reference.spp} samples a pixel: {noise:.2g} %"
    page.pictures(
        *pictures,
        (_png(reference), caption),
        caption=f"{spp} samples a pixel each. The error is the standard error of a typical pixel, over the "
        "image’s mean.",
    )


def _png(result: sr.Result) -> bytes:
    """The picture, a stop brighter."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "picture.png"
        result.write(path, exposure=1)
        return path.read_bytes()
