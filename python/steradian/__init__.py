"""Steradian: images and integrals by Monte Carlo, with their errors.

    import steradian as sr

    scene = sr.load("scenes/cornell-box.xml")
    result = sr.render(scene, spp=64, strategy=sr.mis(sr.bsdf, sr.light))
    result.image        # (height, width, 3) float32, linear RGB radiance
    result.stderr       # its standard error, same shape
    result.write("cornell-box.exr")

    print(sr.integrate(lambda x: 2 * x, over=sr.Uniform(0, 5)))         # a mean with its error

Every sample is drawn in compiled code; NumPy is loaded when the first array is asked for.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from steradian._internal import __version__
from steradian.convert import Converted, convert
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

if TYPE_CHECKING:
    from steradian import testing as testing
    from steradian.distributions import (
        Affine as Affine,
        Alias as Alias,
        AreaLight as AreaLight,
        Cone as Cone,
        CosineHemisphere as CosineHemisphere,
        Discrete as Discrete,
        Disk as Disk,
        Distribution as Distribution,
        Exponential as Exponential,
        FromPdf as FromPdf,
        Learned as Learned,
        Linear as Linear,
        Mixture as Mixture,
        Normal as Normal,
        PiecewiseConstant as PiecewiseConstant,
        PiecewiseLinear as PiecewiseLinear,
        Power as Power,
        Product as Product,
        Samples as Samples,
        SphericalRectangle as SphericalRectangle,
        SphericalTriangle as SphericalTriangle,
        Tabulated2D as Tabulated2D,
        Tent as Tent,
        Truncated as Truncated,
        Uniform as Uniform,
        UniformHemisphere as UniformHemisphere,
        UniformSphere as UniformSphere,
        VisibleNormals as VisibleNormals,
        VonMisesFisher as VonMisesFisher,
    )
    from steradian.integration import (
        Adapted as Adapted,
        Estimate as Estimate,
        IntegrandError as IntegrandError,
        IntegrationProgress as IntegrationProgress,
        IntegrationWarning as IntegrationWarning,
        SupportError as SupportError,
        adapt as adapt,
        integrate as integrate,
        mis_integrate as mis_integrate,
        ris_integrate as ris_integrate,
    )

# Modules that need NumPy, which takes as long to load as everything else: loaded when a name is used.
_LAZY = ("steradian.distributions", "steradian.integration")

__all__ = [
    "Adapted",
    "Affine",
    "Alias",
    "AreaLight",
    "Cone",
    "Converted",
    "CosineHemisphere",
    "Density",
    "Diagnostic",
    "Discrete",
    "Disk",
    "Distribution",
    "Estimate",
    "Exponential",
    "FromPdf",
    "IntegrandError",
    "IntegrationProgress",
    "IntegrationWarning",
    "Learned",
    "Linear",
    "Mixture",
    "Normal",
    "PiecewiseConstant",
    "PiecewiseLinear",
    "Power",
    "Product",
    "Progress",
    "Result",
    "Samples",
    "Scene",
    "SceneError",
    "SceneWarning",
    "SphericalRectangle",
    "SphericalTriangle",
    "Strategy",
    "SupportError",
    "Tabulated2D",
    "Tent",
    "Transform",
    "Truncated",
    "Uniform",
    "UniformHemisphere",
    "UniformSphere",
    "VisibleNormals",
    "VonMisesFisher",
    "__version__",
    "adapt",
    "bsdf",
    "convert",
    "cosine",
    "integrate",
    "light",
    "load",
    "mis",
    "mis_integrate",
    "render",
    "ris_integrate",
    "strategy",
    "testing",
    "uniform",
]


def __getattr__(name: str) -> Any:
    if name == "testing":
        return import_module("steradian.testing")
    if name in __all__:
        for module in map(import_module, _LAZY):
            if name in module.__all__:
                value = globals()[name] = getattr(module, name)
                return value
    raise AttributeError(f"module 'steradian' has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted(__all__)
