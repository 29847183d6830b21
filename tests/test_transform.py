"""Placements."""

import numpy as np
import pytest

import steradian as sr


def point(transform, p):
    return (transform.matrix @ [*p, 1.0])[:3]


def test_products_read_right_to_left():
    both = sr.Transform.translate((1, 2, 3)) @ sr.Transform.scale(2)
    assert point(both, (1, 1, 1)) == pytest.approx([3, 4, 5])
    assert sr.Transform.translate((1, 2, 3)) @ np.diag([2, 2, 2, 1]) == both
    assert sr.Transform.translate((1, 2, 3)).matrix @ sr.Transform.scale(2) == both


def test_chains_multiply_from_the_right():
    chained = sr.Transform().translate((1, 2, 3)).rotate((0, 0, 1), 90).scale(2)
    product = sr.Transform.translate((1, 2, 3)) @ sr.Transform.rotate((0, 0, 1), 90) @ sr.Transform.scale(2)
    assert chained == product
    assert point(chained, (1, 0, 0)) == pytest.approx([1, 4, 3])


def test_rotations_are_counter_clockwise_in_degrees():
    assert point(sr.Transform.rotate((0, 0, 2), 90), (1, 0, 0)) == pytest.approx([0, 1, 0])
    assert point(sr.Transform.rotate((0, 1, 0), 90), (0, 0, 1)) == pytest.approx([1, 0, 0])


def test_cameras_look_along_their_z():
    camera = sr.Transform.look_at((1, 2, 3), (1, 2, 8))
    assert point(camera, (0, 0, 5)) == pytest.approx([1, 2, 8])
    assert camera.matrix[:3, 1] == pytest.approx([0, 1, 0])
    assert np.linalg.det(camera.matrix) == pytest.approx(1)


def test_inverses():
    transform = sr.Transform.translate((1, 2, 3)) @ sr.Transform.rotate((1, 1, 0), 30)
    assert (transform @ transform.inverse()).matrix == pytest.approx(np.eye(4))
    with pytest.raises(ValueError, match="no inverse"):
        sr.Transform.scale((1, 0, 1)).inverse()


@pytest.mark.parametrize(
    "make",
    [
        lambda: sr.Transform(np.eye(3)),
        lambda: sr.Transform(np.full((4, 4), np.nan)),
        lambda: sr.Transform(np.ones((4, 4))),
        lambda: sr.Transform.translate((1, 2)),
        lambda: sr.Transform.rotate((0, 0, 0), 10),
        lambda: sr.Transform.look_at((0, 0, 0), (0, 1, 0), up=(0, 1, 0)),
    ],
)
def test_what_is_no_placement_is_a_value_error(make):
    with pytest.raises(ValueError):
        make()


def test_matrices_do_not_change():
    with pytest.raises(ValueError):
        sr.Transform().matrix[0, 0] = 2
