"""Which walls a beam may meet within a belief, and the range to each of them."""

from functools import cache
from statistics import NormalDist

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.models.protocols import Alternatives
from ekfsim.raycast.walls import Walls

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
    h, H, R = own_line
    λ, V = np.linalg.eigh(P)
    root = V * np.sqrt(np.maximum(λ, 0.0))[..., None, :]
    points, weights = scattered()
    poses = x[..., None, :] + points @ root.mT  # (…, q, 3)
    heading = poses[..., 2] + bearing
    hit = walls.cast(poses[..., :2], heading)
    plane = _plane(walls, hit.wall)
    own = plane[..., 0]
    left = np.where((plane != own[..., None]) & (plane >= 0), weights, 0.0)
    found = [(h, H, R, 1.0 - left.sum(axis=-1), hit.wall[..., 0])]
    for _ in range(OTHERS):
        if not left.any():
            break
        shares = np.sum(
            np.where(plane[..., :, None] == plane[..., None, :], left[..., None, :], 0.0), axis=-1
        )
        shares = np.where(left > 0, shares, 0.0)
        most = np.argmax(shares, axis=-1)[..., None]
        share = np.take_along_axis(shares, most, axis=-1)[..., 0]
        wall = np.take_along_axis(hit.wall, most, axis=-1)[..., 0]
        seen_from = np.take_along_axis(poses, most[..., None], axis=-2)[..., 0, :]
        r_there = np.take_along_axis(hit.range, most, axis=-1)
        there = np.take_along_axis(heading, most, axis=-1)
        place = seen_from[..., :2] + r_there * np.concatenate(
            [np.cos(there), np.sin(there)], axis=-1
        )
        h_wall, H_wall = _to_line(x, x[..., 2] + bearing, place, walls.normal_at(wall, place))
        R_wall = np.square(range_ratio * h_wall)[..., None]
        share = np.where(np.isnan(h_wall[..., 0]), 0.0, share)
        found.append((h_wall, H_wall, R_wall, share, np.where(share > 0, wall, -1)))
        gone = np.take_along_axis(plane, most, axis=-1)
        left = np.where(plane == gone, 0.0, left)
    hs, Hs, Rs, shares, met = zip(*found, strict=True)
    return Alternatives(
        np.stack(hs, -2), np.stack(Hs, -3), np.stack(Rs, -3),
        np.stack(shares, -1), np.stack(met, -1),
    )  # fmt: skip


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
