"""Which walls a beam may meet within a belief, and the range to each of them."""

from functools import cache, partial
from statistics import NormalDist
from typing import TypeVar

import numpy as np
from numpy.typing import NDArray

from ekfsim.geometry import Array, Integers
from ekfsim.models.protocols import Alternatives
from ekfsim.raycast.walls import Walls

T = TypeVar("T", bound=np.generic)

CLOUD = 16  # pairs of poses that stand for the belief
REACH = 3.0  # standard deviations to the outermost poses, as in the test of ambiguous beams
OTHERS = 3  # walls at most besides the one that the mean sees
RARE = 1e-3  # the share of a wall that is seen from an outermost pose alone
ALONG = 1e-9  # as the laser's: a beam this close to its wall's direction has no usable derivative


def other_walls(
    walls: Walls,
    bearing: float,
    range_ratio: float,
    own_line: tuple[Array, Array, Array],
    x: Array,
    P: Array,
) -> Alternatives:
    """A laser's own line h, H, R at x : (…, 3), and those of the walls that it would meet from
    other poses of N(x, P), each wall taken as a straight line without an end:

        r = n·(a − p) / n·d      ∂r/∂p = −n / n·d      ∂r/∂θ = −r n·d⊥ / n·d

    The share of a wall is that of the poses from which it is the first. P : (…, 3, 3)
    """
    axes = x.shape[:-1]
    x, P = x.reshape(-1, 3), P.reshape(-1, 3, 3)
    h, H, R = (part.reshape(len(x), *part.shape[len(axes) :]) for part in own_line)
    λ, V = np.linalg.eigh(P)
    root = V * np.sqrt(np.maximum(λ, 0.0))[..., None, :]
    points, weights = scattered()
    poses = x[..., None, :] + points @ root.mT  # (m, q, 3)
    hit = walls.cast(poses[..., :2], poses[..., 2] + bearing)
    plane = _plane(walls, hit.wall)
    left = np.where((plane != plane[..., :1]) & (plane >= 0), weights, 0.0)
    own: tuple[Array | Integers, ...] = h, H, R, 1.0 - left.sum(axis=-1), hit.wall[..., 0]
    found = [own]
    for _ in range(OTHERS):
        rows = np.flatnonzero(left.any(axis=-1))  # the beliefs within which there are more
        if not len(rows):
            break
        shares = _shares(plane[rows], left[rows])
        most = np.argmax(shares, axis=-1)
        share = shares[np.arange(len(rows)), most]
        seen_from, wall = poses[rows, most], hit.wall[rows, most]
        there = seen_from[:, 2] + bearing
        ahead = np.stack([np.cos(there), np.sin(there)], axis=-1)
        place = seen_from[:, :2] + hit.range[rows, most][:, None] * ahead
        seen = x[rows], x[rows, 2] + bearing
        h_wall, H_wall = _to_line(*seen, place, walls.normal_at(wall, place))
        share = np.where(np.isnan(h_wall[:, 0]), 0.0, share)
        R_wall = np.square(range_ratio * h_wall)[..., None]
        line = h_wall, H_wall, R_wall, share, np.where(share > 0, wall, -1)
        nothing = h, H, R, np.zeros(len(x)), np.full(len(x), -1)
        found.append(tuple(map(partial(_put, rows), nothing, line)))
        left[rows] = np.where(plane[rows] == plane[rows, most][:, None], 0.0, left[rows])
    each = (np.stack(parts, axis=1) for parts in zip(*found, strict=True))
    return Alternatives(*(part.reshape((*axes, *part.shape[1:])) for part in each))


def _put(rows: Integers, all: NDArray[T], some: NDArray[T]) -> NDArray[T]:
    """All, with some in their rows."""
    changed = all.copy()
    changed[rows] = some
    return changed


def _shares(plane: Integers, left: Array) -> Array:
    """What all poses that see the same line count for : (m, q), where one counts itself; else 0"""
    m, planes = len(plane), int(plane.max()) + 1
    place = np.arange(m)[:, None] * planes + plane
    counted = left > 0
    shares = np.zeros(left.shape)
    of_line = np.bincount(place[counted], left[counted], m * planes)
    shares[counted] = of_line[place[counted]]
    return shares


@cache
def scattered() -> tuple[Array, Array]:
    """Points that stand for N(0, I), the mean first : (q, 3), and what each counts for : (q,), 1 in
    all.

    The mean and pairs of points on either side of it, spread by the fractions of n α, α the powers
    of the root of x⁴ = x + 1 (Roberts, 2018), and the six at 3σ on the axes, which hardly count.
    All together have the mean 0 and the covariance I.
    """
    g = 1.2207440846057596  # x⁴ = x + 1
    uniform = (0.5 + np.arange(1, CLOUD + 1)[:, None] * g ** -np.arange(1.0, 4.0)) % 1.0
    normal = np.vectorize(NormalDist().inv_cdf)(uniform)
    arms = REACH * np.vstack([np.eye(3), -np.eye(3)])
    usual = (1 - 6 * RARE) / (1 + 2 * CLOUD)  # what each but an arm counts for
    left = (1 - 2 * RARE * REACH**2) * np.eye(3)  # what the arms leave of the covariance
    spread = 2 * usual * normal.T @ normal
    normal = normal @ np.linalg.inv(np.linalg.cholesky(spread)).T @ np.linalg.cholesky(left).T
    points = np.vstack([np.zeros((1, 3)), normal, -normal, arms])
    weights = np.full(len(points), usual)
    weights[-6:] = RARE
    return points, weights


def _plane(walls: Walls, wall: Integers) -> Integers:
    """The straight line that each wall lies on, −1 where there is no wall."""
    planes = walls.plane
    return np.where(wall >= 0, planes[wall], -1) if len(planes) else wall


def _to_line(x: Array, heading: Array, a: Array, n: Array) -> tuple[Array, Array]:
    """h : (…, 1) and H : (…, 1, 3) of the straight line through a with the normal n : (…, 2) each;
    nan and 0 where the beam does not meet it.
    """
    d = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
    aside = np.stack([-d[..., 1], d[..., 0]], axis=-1)
    n_d = np.vecdot(n, d)
    usable = np.abs(n_d) > ALONG
    with np.errstate(invalid="ignore"):
        r = np.vecdot(n, a - x[..., :2]) / np.where(usable, n_d, 1.0)
        met = usable & (r > 0)
    r = np.where(met, r, np.nan)
    rows = np.stack([n[..., 0], n[..., 1], r * np.vecdot(n, aside)], axis=-1)
    H = np.where(met[..., None], -rows / np.where(met, n_d, 1.0)[..., None], 0.0)
    return r[..., None], H[..., None, :]
