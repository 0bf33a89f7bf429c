import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as some

from ekfsim.geometry.outline import distance, path_error

SQUARE = np.array([[0.0, 0], [10, 0], [10, -10], [0, -10]])
KITE = np.array([[0.0, 0], [4, 1], [5, 5], [1, 3]])
BENT = np.array([[0.0, 0], [4, 0], [4, 4], [2, 1], [0, 4]])

places = some.tuples(some.floats(-20, 20), some.floats(-20, 20))


@given(some.lists(places, min_size=1, max_size=20), some.sampled_from([SQUARE, KITE, BENT]))
def test_the_distance_is_shapelys(points, ring):
    outline = shapely.LinearRing(ring)
    expected = [outline.distance(shapely.Point(point)) for point in points]
    np.testing.assert_allclose(distance(np.array(points), ring), expected, atol=1e-12)


@given(some.lists(places, min_size=1, max_size=20), some.sampled_from([KITE, BENT]))
def test_any_other_outline_is_held_against_its_edges(points, ring):
    np.testing.assert_array_equal(
        path_error(np.array(points), ring), distance(np.array(points), ring)
    )


@given(some.lists(places, min_size=1, max_size=20), some.integers(0, 3), some.booleans())
def test_a_rectangle_is_held_against_its_lines_as_the_document_has_it(points, first, backwards):
    def eq_11(x, y):
        if 0 <= x <= 10 or -10 <= y <= 0:
            return min(abs(x - 10), abs(x), abs(y + 10), abs(y))
        return min(np.hypot(x - cx, y - cy) for cx in (0, 10) for cy in (-10, 0))

    ring = np.roll(SQUARE[::-1] if backwards else SQUARE, first, axis=0)
    np.testing.assert_allclose(
        path_error(np.array(points), ring), [eq_11(*point) for point in points], atol=1e-14
    )


@pytest.mark.parametrize(
    ("point", "error"),
    [
        ((5, 1), 1),
        ((5, -1), 1),
        ((5, -5), 5),
        ((-3, 4), 5),
        ((13, -14), 5),
        ((9.5, 3), 0.5),
        ((0, 0), 0),
    ],
)
def test_points_about_the_square(point, error):
    assert float(path_error(np.array(point, float), SQUARE)) == pytest.approx(error)


def test_a_rectangle_that_is_turned_is_no_box():
    turned = np.array([[0.0, 5], [5, 0], [10, 5], [5, 10]])
    assert float(path_error(np.array([5.0, 5.0]), turned)) == pytest.approx(np.sqrt(12.5))


def test_many_points_at_once():
    points = np.arange(24.0).reshape(2, 3, 4)[..., :2]
    each = [[float(path_error(point, KITE)) for point in row] for row in points]
    np.testing.assert_allclose(path_error(points, KITE), each)
