"""How far a point is from a way that was to be driven: the outline of a polygon."""

import numpy as np

from ekfsim.geometry import Array


def path_error(points: Array, ring: Array) -> Array:
    """The distance of points (…, 2) to the outline of a polygon (n, 2), closed of itself : (…) m

    To a rectangle along the axes it is document 004's, eq. 11: within the bounds of x or those of y
    the distance to the nearest of the four lines that the sides lie on, beyond both the distance to
    the nearest corner. Far outside, beside a corner, that is less than the distance to the side
    itself, `distance`.
    """
    low, high = ring.min(axis=0), ring.max(axis=0)
    return _to_lines(points, low, high) if _is_box(ring, low, high) else distance(points, ring)


def distance(points: Array, ring: Array) -> Array:
    """The distance of points (…, 2) to the nearest edge of a polygon (n, 2), closed of itself :
    (…)
    """
    a, b = ring, np.roll(ring, -1, axis=0)
    along = b - a
    length = np.vecdot(along, along)
    share = np.vecdot(points[..., None, :] - a, along)
    share = np.clip(np.divide(share, length, out=np.zeros_like(share), where=length > 0), 0.0, 1.0)
    nearest = a + share[..., None] * along
    return np.asarray(
        np.linalg.norm(points[..., None, :] - nearest, axis=-1).min(axis=-1), np.float64
    )


def _to_lines(points: Array, low: Array, high: Array) -> Array:
    """Eq. 11, and the distance to the nearest corner where neither x nor y lies within its
    bounds.
    """
    to_line = np.minimum(np.abs(points - low), np.abs(points - high))
    beyond = (points < low) | (points > high)
    return np.where(
        beyond.all(axis=-1), np.hypot(to_line[..., 0], to_line[..., 1]), to_line.min(axis=-1)
    )


def _is_box(ring: Array, low: Array, high: Array) -> bool:
    """Whether a polygon is a rectangle along the axes."""
    at_a_corner = ((ring == low) | (ring == high)).all()
    sides = np.roll(ring, -1, axis=0) - ring
    return len(ring) == 4 and bool(at_a_corner and (np.count_nonzero(sides, axis=-1) == 1).all())
