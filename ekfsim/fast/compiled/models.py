"""The classroom's motion and sensor for many runs, by Numba: the extra `fast`.

All arrays have their entries in front and the runs behind: x : (3, N), F : (3, 3, N).
"""

import math

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.geometry.soa import from_soa, soa_zeros, to_soa
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.laser import ALONG, Laser
from ekfsim.raycast.walls import Hit, Walls
from ekfsim.twins import compiled


def move_turn(
    motion: MoveTurn, x: Array, u: Array
) -> tuple[Array, Array, Array, Array, float] | None:
    """Twin of f, F, G, M and Q of `MoveTurn`, for x : (N, 3) and u : (N, 2)"""
    if not (x.ndim == u.ndim == 2 and len(x) == len(u)):
        return None
    N = len(x)
    new = np.empty((3, N)), np.empty((3, 3, N)), np.empty((3, 2, N)), np.empty((2, 2, N))
    x, u = (np.ascontiguousarray(to_soa(each, 1)) for each in (x, u))
    _move_turn(x, u, motion.distance_ratio, motion.angle_ratio, *new)
    f, F, G, M = new
    return from_soa(f, 1), from_soa(F), from_soa(G), from_soa(M), 0.0


def laser(sensor: Laser, x: Array) -> tuple[Array, Array, Array] | None:
    """Twin of h, H and R of `Laser`, for x : (N, 3)"""
    if x.ndim != 2:
        return None
    direction, walls = x[:, 2] + sensor.bearing, sensor.walls
    hit = walls.cast(x[:, :2], direction)
    h, H, R = np.empty(len(x)), soa_zeros((len(x),), 1, 3), np.empty(len(x))
    normals, which = normals_met(walls, hit, x[:, :2].T, direction)
    _beam(direction, hit.range, which, normals, sensor.range_ratio, ALONG, h, to_soa(H)[0], R)
    return h[:, None], H, R[:, None, None]


def normals_met(walls: Walls, hit: Hit, place: Array, heading: Array) -> tuple[Array, Integers]:
    """Normals (n, 2), and which of them is that of the wall that each beam meets : (N,), −1 where
    it meets none. place : (2, N) m, heading : (N,) rad

    Straight walls have one each; among round ones every beam has its own.
    """
    if walls.round is None:
        return walls.normals, hit.wall
    met = place + hit.range * np.stack([np.cos(heading), np.sin(heading)])
    return walls.normal_at(hit.wall, met.T), np.where(hit.wall < 0, -1, np.arange(len(hit.wall)))


@compiled
def _move_turn(
    x: Array,
    u: Array,
    distance_ratio: float,
    angle_ratio: float,
    f: Array,
    F: Array,
    G: Array,
    M: Array,
) -> None:
    for n in range(x.shape[1]):
        θ, d, a = x[2, n], u[0, n], u[1, n]
        c, s = math.cos(θ), math.sin(θ)
        f[0, n], f[1, n] = x[0, n] + d * c, x[1, n] + d * s
        θ += a
        if not -math.pi < θ <= math.pi:
            θ = np.fmod(θ, 2 * math.pi)
            if θ > math.pi:
                θ -= 2 * math.pi
            elif θ <= -math.pi:
                θ += 2 * math.pi
        f[2, n] = θ
        F[0, 2, n], F[1, 2, n] = -d * s, d * c
        G[0, 0, n], G[1, 0, n] = c, s
        M[0, 0, n], M[1, 1, n] = (distance_ratio * d) ** 2, (angle_ratio * a) ** 2
    F[0, 0] = F[1, 1] = F[2, 2] = G[2, 1] = 1.0
    F[0, 1] = F[1, 0] = F[2, 0] = F[2, 1] = G[0, 1] = G[1, 1] = G[2, 0] = M[0, 1] = M[1, 0] = 0.0


@compiled
def _beam(
    direction: Array, r: Array, wall: Integers, normals: Array, range_ratio: float, along: float,
    h: Array, H: Array, R: Array,
) -> None:  # fmt: skip
    for n in range(len(r)):
        h[n] = R[n] = math.nan
        H[0, n] = H[1, n] = H[2, n] = 0.0
        if wall[n] < 0:
            continue
        c, s = math.cos(direction[n]), math.sin(direction[n])
        nx, ny = normals[wall[n]]
        n_d = nx * c + ny * s
        if abs(n_d) <= along:
            continue
        h[n], R[n] = r[n], (range_ratio * r[n]) ** 2
        H[0, n], H[1, n], H[2, n] = -nx / n_d, -ny / n_d, -r[n] * (ny * c - nx * s) / n_d
