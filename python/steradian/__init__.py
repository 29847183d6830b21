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
    )
    from steradian.distributions import (
        Alias as Alias,
    )
    from steradian.distributions import (
        AreaLight as AreaLight,
    )
    from steradian.distributions import (
        Cone as Cone,
    )
    from steradian.distributions import (
        CosineHemisphere as CosineHemisphere,
    )
    from steradian.distributions import (
        Discrete as Discrete,
    )
    from steradian.distributions import (
        Disk as Disk,
    )
    from steradian.distributions import (
        Distribution as Distribution,
    )
    from steradian.distributions import (
        Exponential as Exponential,
    )
    from steradian.distributions import (
        FromPdf as FromPdf,
    )
    from steradian.distributions import (
        Linear as Linear,
    )
    from steradian.distributions import (
        Mixture as Mixture,
    )
    from steradian.distributions import (
        Normal as Normal,
    )
    from steradian.distributions import (
        PiecewiseConstant as PiecewiseConstant,
    )
    from steradian.distributions import (
        PiecewiseLinear as PiecewiseLinear,
    )
    from steradian.distributions import (
        Power as Power,
    )
    from steradian.distributions import (
        Product as Product,
    )
    from steradian.distributions import (
        Samples as Samples,
    )
    from steradian.distributions import (
        SphericalRectangle as SphericalRectangle,
    )
    from steradian.distributions import (
        SphericalTriangle as SphericalTriangle,
    )
    from steradian.distributions import (
        Tabulated2D as Tabulated2D,
    )
    from steradian.distributions import (
        Tent as Tent,
    )
    from steradian.distributions import (
        Truncated as Truncated,
    )
    from steradian.distributions import (
        Uniform as Uniform,
    )
    from steradian.distributions import (
        UniformHemisphere as UniformHemisphere,
    )
    from steradian.distributions import (
        UniformSphere as UniformSphere,
    )
    from steradian.distributions import (
        VisibleNormals as VisibleNormals,
    )
    from steradian.distributions import (
        VonMisesFisher as VonMisesFisher,
    )
    from steradian.integration import (
        Estimate as Estimate,
    )
    from steradian.integration import (
        IntegrandError as IntegrandError,
    )
    from steradian.integration import (
        IntegrationProgress as IntegrationProgress,
    )
    from steradian.integration import (
        IntegrationWarning as IntegrationWarning,
    )
    from steradian.integration import (
        SupportError as SupportError,
    )
    from steradian.integration import (
        integrate as integrate,
    )
    from steradian.integration import (
        mis_integrate as mis_integrate,
    )
    from steradian.integration import (
        ris_integrate as ris_integrate,
    )

# Modules that need NumPy, which takes as long to load as everything else: loaded when a name is used.
_LAZY = ("steradian.distributions", "steradian.integration")

__all__ = [
    "Affine",
    "Alias",
    "AreaLight",
    "Cone",
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
    "bsdf",
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
