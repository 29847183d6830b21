"""Distributions of directions, per solid angle. Points are unit vectors (n, 3), densities are in sr⁻¹."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from steradian import _internal
from steradian.distributions.arguments import number, vector
from steradian.distributions.base import Compiled

UP = (0.0, 0.0, 1.0)


class UniformSphere(Compiled):
    """Every direction equally likely: p = 1 / 4π.

    >>> import numpy as np, steradian as sr
    >>> print(sr.integrate(lambda w: np.ones(len(w)) / (4 * np.pi), over=sr.UniformSphere(), n=1024))
    1 ± 0 (n = 1024)
    """

    def __init__(self) -> None:
        super().__init__(_internal.uniform_sphere())


class UniformHemisphere(Compiled):
    """Directions on one side of a plane, all equally likely: p = 1 / 2π (Shirley & Chiu 1997).

    ``axis``: (3,), the normal, of any length. Raises ValueError if it is 0 or not finite.

    >>> import numpy as np, steradian as sr
    >>> estimate = sr.integrate(lambda w: w[:, 2], over=sr.UniformHemisphere())
    >>> abs(float(estimate) - np.pi) < 1e-3
    True
    """

    def __init__(self, axis: ArrayLike = UP) -> None:
        super().__init__(_internal.uniform_hemisphere(vector("axis", axis)), axis=axis)


class CosineHemisphere(Compiled):
    """Directions on one side of a plane, as likely as the cosine to its normal: p = cos θ / π.

    Malley's method over the concentric map of Shirley & Chiu 1997. ``axis``: (3,), the normal, of any
    length. Raises ValueError if it is 0 or not finite.

    >>> import numpy as np, steradian as sr
    >>> print(sr.integrate(lambda w: w[:, 2] / np.pi, over=sr.CosineHemisphere(), n=1024))
    1 ± ... (n = 1024)
    """

    def __init__(self, axis: ArrayLike = UP) -> None:
        super().__init__(_internal.cosine_hemisphere(vector("axis", axis)), axis=axis)


class Cone(Compiled):
    """Directions within an angle of an axis, all equally likely: p = 1 / 2π(1 − cos angle).

    ``axis``: (3,), of any length. ``angle``: half the opening, in radians, from 1e-7 to π. Raises ValueError
    naming the argument that is wrong.

    >>> import numpy as np, steradian as sr
    >>> float((1 / sr.Cone((1, 0, 0), np.pi / 2).pdf((1, 0, 0)) / np.pi).round(12))
    2.0
    """

    def __init__(self, axis: ArrayLike, angle: float) -> None:
        super().__init__(_internal.cone(vector("axis", axis), number("angle", angle)), axis=axis, angle=angle)


class VonMisesFisher(Compiled):
    """A lobe about a direction, p ∝ exp(kappa cos θ): what the normal distribution is among directions.

    ``mean_direction``: (3,), of any length. ``kappa``: concentration, from 0 (uniform) to 1e12; the width is
    about 1 / √kappa radians. Raises ValueError naming the argument that is wrong. Stable for every kappa:
    Wenzel Jakob, "Numerically stable sampling of the von Mises Fisher distribution on S²", 2012.

    >>> import steradian as sr
    >>> sr.VonMisesFisher((0, 0, 1), kappa=100).mean.round(2)
    array([0.  , 0.  , 0.99])
    """

    def __init__(self, mean_direction: ArrayLike, kappa: float) -> None:
        core = _internal.von_mises_fisher(vector("mean_direction", mean_direction), number("kappa", kappa))
        super().__init__(core, mean_direction=mean_direction, kappa=kappa)


class SphericalTriangle(Compiled):
    """Directions from the origin to a triangle, all equally likely: p = 1 / solid angle.

    ``a``, ``b``, ``c``: (3,), the vertices. Directions have the seven digits of single precision. Raises
    ValueError if a coordinate is not finite, or the origin sees nothing of the triangle. James Arvo,
    "Stratified Sampling of Spherical Triangles", 1995.

    >>> import numpy as np, steradian as sr
    >>> octant = sr.SphericalTriangle((1, 0, 0), (0, 1, 0), (0, 0, 1))
    >>> float((octant.pdf(np.full(3, 3**-0.5)) * np.pi / 2).round(6))
    1.0
    """

    def __init__(self, a: ArrayLike, b: ArrayLike, c: ArrayLike) -> None:
        core = _internal.spherical_triangle(vector("a", a), vector("b", b), vector("c", c))
        super().__init__(core, a=a, b=b, c=c)


class SphericalRectangle(Compiled):
    """Directions from a point to a rectangle, all equally likely: p = 1 / solid angle.

    ``corner``, ``edge1``, ``edge2``: (3,), of the rectangle; the edges are perpendicular. ``seen_from``:
    (3,), the point. Directions have the seven digits of single precision. Raises ValueError if they are no
    rectangle, or it is seen edge-on. Ureña, Fajardo & King, "An Area-Preserving Parametrization for
    Spherical Rectangles", 2013.

    >>> import numpy as np, steradian as sr
    >>> side = sr.SphericalRectangle((-1, -1, 1), (2, 0, 0), (0, 2, 0))  # of a cube about the origin
    >>> float((side.pdf((0, 0, 1)) * 4 * np.pi / 6).round(6))
    1.0
    """

    def __init__(
        self, corner: ArrayLike, edge1: ArrayLike, edge2: ArrayLike, seen_from: ArrayLike = (0.0, 0.0, 0.0)
    ) -> None:
        core = _internal.spherical_rectangle(
            vector("corner", corner),
            vector("edge1", edge1),
            vector("edge2", edge2),
            vector("seen_from", seen_from),
        )
        super().__init__(core, corner=corner, edge1=edge1, edge2=edge2, seen_from=seen_from)


class AreaLight(Compiled):
    """Directions from a point to a flat light, uniform by the light's area: p = distance² / (A |cos θ|).

    θ is the angle between the direction and the light's normal. Its sign does not matter: the light is seen
    from both sides, and whether it shines on both is for the integrand to say. ``corner``, ``edge1``,
    ``edge2``: (3,), of the parallelogram. ``seen_from``: (3,), the point. Raises ValueError if the light has
    no area, or is seen edge-on.

    >>> import steradian as sr
    >>> light = sr.AreaLight((-1, -1, 2), (2, 0, 0), (0, 2, 0))
    >>> light.pdf((0, 0, 1))  # 2² / (4 · 1)
    np.float64(1.0)
    """

    def __init__(
        self, corner: ArrayLike, edge1: ArrayLike, edge2: ArrayLike, seen_from: ArrayLike = (0.0, 0.0, 0.0)
    ) -> None:
        core = _internal.area_light(
            vector("corner", corner),
            vector("edge1", edge1),
            vector("edge2", edge2),
            vector("seen_from", seen_from),
        )
        super().__init__(core, corner=corner, edge1=edge1, edge2=edge2, seen_from=seen_from)


class VisibleNormals(Compiled):
    """Normals of a rough surface about +Z (GGX), as often as they are seen from a direction.

    p = max(0, wo · m) D(m) / σ(wo) (Heitz & d'Eon 2014), drawn by spherical caps (Dupuy & Benyoub 2023).
    ``wo``: (3,), towards the viewer, of any length, z > 0. ``alpha``: roughness, one number or one for x and
    one for y, from 1e-6 to 1000. Raises ValueError naming the argument that is wrong.

    >>> import steradian as sr
    >>> m = sr.VisibleNormals((0.6, 0, 0.8), alpha=0.5).draw(1000).value
    >>> bool((m @ [0.6, 0, 0.8] > 0).all())
    True
    """

    def __init__(self, wo: ArrayLike, alpha: ArrayLike) -> None:
        both = np.broadcast_to(np.asarray(alpha, float), (2,)) if np.ndim(alpha) == 0 else alpha
        core = _internal.visible_normals(vector("wo", wo), vector("alpha", both, 2))
        super().__init__(core, wo=wo, alpha=alpha)
