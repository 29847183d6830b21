"""Placements: 4×4 matrices that read right to left, as in formulas."""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Generic, ParamSpec

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike

Vector = Sequence[float]
P = ParamSpec("P")


class _chained(Generic[P]):
    """Makes a transform if asked of the class; of an instance, multiplies it from the right."""

    def __init__(self, make: Callable[P, Transform]) -> None:
        self.make = make

    def __get__(self, instance: Transform | None, owner: type) -> Callable[P, Transform]:
        if instance is None:
            return self.make

        @functools.wraps(self.make)
        def times(*args: P.args, **kwargs: P.kwargs) -> Transform:
            return instance @ self.make(*args, **kwargs)

        return times


class Transform:
    """An affine map of space, applied to column vectors.

    ``Transform.translate((0, 1, 0)) @ Transform.scale(2)`` scales first, and so does
    ``Transform.translate((0, 1, 0)).scale(2)``. A placement in a scene dictionary may be a Transform or
    a 4×4 array.

    >>> import steradian as sr
    >>> (sr.Transform.translate((0, 1, 0)) @ sr.Transform.scale(2)).matrix[1]
    array([0., 2., 0., 1.])
    """

    __slots__ = ("matrix",)
    # NumPy leaves ``array @ transform`` to this class.
    __array_ufunc__ = None

    matrix: np.ndarray
    """(4, 4) float64."""

    def __init__(self, matrix: ArrayLike | Transform | None = None) -> None:
        """Raises ValueError unless ``matrix`` is 4×4, finite and affine (last row 0 0 0 1)."""
        import numpy as np

        if isinstance(matrix, Transform):
            matrix = matrix.matrix
        m = np.eye(4) if matrix is None else np.array(matrix, dtype=np.float64)
        if m.shape != (4, 4):
            raise ValueError(f"a transform is a 4 x 4 matrix, not one of shape {m.shape}")
        if not np.isfinite(m).all():
            raise ValueError("a transform has an entry that is not finite")
        if not (m[3] == (0, 0, 0, 1)).all():
            raise ValueError(f"the last row of a transform is 0 0 0 1, not {m[3]}")
        m.setflags(write=False)
        self.matrix = m

    @_chained
    def translate(by: Vector) -> Transform:
        """Moves by a vector."""
        m = Transform().matrix.copy()
        m[:3, 3] = _vector(by, "translation")
        return Transform(m)

    @_chained
    def scale(by: float | Vector) -> Transform:
        """Scales by one factor, or by one for each axis."""
        import numpy as np

        factors = [by] * 3 if isinstance(by, int | float) else _vector(by, "scale")
        return Transform(np.diag([*factors, 1.0]))

    @_chained
    def rotate(axis: Vector, angle_deg: float) -> Transform:
        """Turns about an axis through the origin, counter-clockwise seen from its tip; degrees.

        Rodrigues' formula.
        """
        import numpy as np

        a = np.array(_vector(axis, "axis"))
        length = math.sqrt(float(a @ a))
        if not length > 0.0:
            raise ValueError("the axis of a rotation has no length")
        x, y, z = a / length
        k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
        angle = math.radians(angle_deg)
        m = np.eye(4)
        m[:3, :3] += math.sin(angle) * k + (1 - math.cos(angle)) * (k @ k)
        return Transform(m)

    @_chained
    def look_at(origin: Vector, target: Vector, up: Vector = (0, 1, 0)) -> Transform:
        """Places a camera at ``origin``; its view, +Z, is towards ``target``; ``up`` is up in the image."""
        import numpy as np

        eye = np.array(_vector(origin, "origin"))
        forward = np.array(_vector(target, "target")) - eye
        left = np.cross(_vector(up, "up"), forward)
        if not (np.linalg.norm(forward) > 0 and np.linalg.norm(left) > 0):
            raise ValueError(
                "look_at needs a target away from the origin and an up that is not along the view"
            )
        forward /= np.linalg.norm(forward)
        left /= np.linalg.norm(left)
        m = np.eye(4)
        m[:3] = np.column_stack([left, np.cross(forward, left), forward, eye])
        return Transform(m)

    def __matmul__(self, other: Transform | ArrayLike) -> Transform:
        return Transform(self.matrix @ Transform(other).matrix)

    def __rmatmul__(self, other: ArrayLike) -> Transform:
        return Transform(other) @ self

    def inverse(self) -> Transform:
        """The map back. Raises ValueError if there is none."""
        import numpy as np

        try:
            inverse = np.linalg.inv(self.matrix)
        except np.linalg.LinAlgError:
            raise ValueError("the transform has no inverse") from None
        inverse[3] = (0, 0, 0, 1)
        return Transform(inverse)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Transform):
            return NotImplemented
        return bool((self.matrix == other.matrix).all())

    def __hash__(self) -> int:
        return hash(self.matrix.tobytes())

    def __repr__(self) -> str:
        return f"sr.Transform({self.matrix.tolist()})"


def _vector(values: Vector, what: str) -> list[float]:
    vector = [float(v) for v in values]
    if len(vector) != 3:
        raise ValueError(f"a {what} has 3 components, not {len(vector)}")
    return vector
