"""Brute force: every beam tries every wall. Each of searches/ must find what this finds."""

from collections.abc import Callable

import numpy as np

from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.raycast.rules import REACH, TIE, meet, meet_round, see

PORTION = 1 << 18  # beams × walls that are held in memory at a time

Trial = Callable[[Array, Array, Array, Array, Array], tuple[Array, Integers]]


def brute_force(
    segments: Array, x: Array, y: Array, dx: Array, dy: Array
) -> tuple[Array, Integers]:
    """`try_all`, of however many beams and walls."""
    return in_portions(try_all, segments, x, y, dx, dy)


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
    return _first(r, TIE * span, np.isfinite(span + dx + dy))


def try_all_round(
    size: float, circles: Array, x: Array, y: Array, dx: Array, dy: Array
) -> tuple[Array, Integers]:
    """The same of round walls. circles : (C, 3) m, centre and radius of each; size : m, the largest
    coordinate of any circle of the map
    """
    span = size + np.abs(x) + np.abs(y)
    beams = (each[..., None] for each in (x, y, dx, dy, REACH * span))
    with np.errstate(invalid="ignore"):
        r = meet_round(circles, *beams)  # (…, C)
    return _first(r, TIE * span, np.isfinite(span + dx + dy))


def extent(circles: Array) -> float:
    """The largest coordinate of any circle, in m."""
    return float((np.abs(circles[:, :2]).max(axis=1, initial=0.0) + circles[:, 2]).max(initial=0.0))


def nearer(
    straight: tuple[Array, Integers], round_: tuple[Array, Integers], first: int, tie: Array
) -> tuple[Array, Integers]:
    """What beams meet of the first straight and the first round wall : (…) both, the round ones
    counted from `first` on. At the same range, within the tie, the straight one is hit.
    """
    (r, wall), (r_round, circle) = straight, round_
    nearer = (circle >= 0) & ~(r <= r_round + tie)
    return np.fmin(r, r_round), np.where(nearer, first + circle, wall)


def in_portions(
    trial: Trial, walls: Array, x: Array, y: Array, dx: Array, dy: Array
) -> tuple[Array, Integers]:
    """A trial of however many beams and walls: in portions that fit the memory."""
    beams = np.stack([x, y, dx, dy])
    portions = np.array_split(beams.reshape(4, -1), 1 + x.size * len(walls) // PORTION, axis=-1)
    ranges, met = zip(*(trial(walls, *some) for some in portions), strict=True)
    return np.concatenate(ranges).reshape(x.shape), np.concatenate(met).reshape(x.shape)


def _first(r: Array, tie: Array, finite: Booleans) -> tuple[Array, Integers]:
    """The least of the ranges (…, W), and the lowest wall at it : (…) both"""
    nearest, walls = r.min(axis=-1, initial=np.inf), r.shape[-1]
    equal = r <= (nearest + tie)[..., None]
    lowest = np.where(equal, np.arange(walls), walls).min(axis=-1, initial=walls)
    met = (nearest < np.inf) & finite
    return np.where(met, nearest, np.nan), np.where(met, lowest, -1)
