"""Brute force: every beam tries every wall. Each of searches/ must find what this finds."""

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.raycast.rules import REACH, TIE, meet, see

PORTION = 1 << 18  # beams × walls that are held in memory at a time


def try_all(segments: Array, x: Array, y: Array, dx: Array, dy: Array) -> tuple[Array, Integers]:
    """Range in m and index of the first wall of each beam : (…) both; nan and −1 where there is
    none.

    segments : (W, 2, 2) m, the ends of each wall; beams from (x, y) m in the unit directions
    (dx, dy), all (…). What is not finite meets nothing.
    """
    span = np.abs(segments).max(initial=0.0) + np.abs(x) + np.abs(y)  # rounding grows with it
    with np.errstate(invalid="ignore"):
        seen = see(segments, x[..., None], y[..., None], dx[..., None], dy[..., None])
        r = meet(seen, REACH * span[..., None])  # (…, W)
    nearest = r.min(axis=-1, initial=np.inf)
    walls = len(segments)
    equal = r <= (nearest + TIE * span)[..., None]
    lowest = np.where(equal, np.arange(walls), walls).min(axis=-1, initial=walls)
    met = (nearest < np.inf) & np.isfinite(span + dx + dy)
    return np.where(met, nearest, np.nan), np.where(met, lowest, -1)


def brute_force(
    segments: Array, x: Array, y: Array, dx: Array, dy: Array
) -> tuple[Array, Integers]:
    """`try_all`, of however many beams and walls: in portions that fit the memory."""
    beams = np.stack([x, y, dx, dy])
    portions = np.array_split(beams.reshape(4, -1), 1 + x.size * len(segments) // PORTION, axis=-1)
    ranges, walls = zip(*(try_all(segments, *some) for some in portions), strict=True)
    return np.concatenate(ranges).reshape(x.shape), np.concatenate(walls).reshape(x.shape)
