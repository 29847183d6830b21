"""Steradian: images by Monte Carlo, with the error of every pixel.

    import steradian as sr

    scene = sr.load("scenes/cornell-box.xml")
    result = sr.render(scene, spp=64, strategy=sr.mis(sr.bsdf, sr.light))
    result.image        # (height, width, 3) float32, linear RGB radiance
    result.stderr       # its standard error, same shape
    result.write("cornell-box.exr")

Every sample is drawn in compiled code; NumPy is loaded when the first array is asked for.
"""

from steradian._internal import __version__
from steradian.diagnostics import Diagnostic, SceneError, SceneWarning
from steradian.render import Progress, render
from steradian.result import Result
from steradian.scene import Scene, load
from steradian.strategy import (
    Density,
    Strategy,
    bsdf,
    cosine,
    light,
    mis,
    strategy,
    uniform,
)
from steradian.transform import Transform

__all__ = [
    "Density",
    "Diagnostic",
    "Progress",
    "Result",
    "Scene",
    "SceneError",
    "SceneWarning",
    "Strategy",
    "Transform",
    "__version__",
    "bsdf",
    "cosine",
    "light",
    "load",
    "mis",
    "render",
    "strategy",
    "uniform",
]
