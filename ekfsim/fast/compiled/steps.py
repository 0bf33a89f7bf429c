"""What a command of the classroom makes of many runs, compiled by Numba: robot, and EKF, huber or
pdaf.

All arrays have their entries in front and the runs behind: truth, x : (3, N). Of P its upper half
is kept, row after row: (6, N), P_xx P_xy P_xθ P_yy P_yθ P_θθ.
"""

import math

import numpy as np

from ekfsim.fast.compiled.angles import directions, wrapped
from ekfsim.fast.compiled.carlson import carlson
from ekfsim.fast.compiled.trusting import weighed
from ekfsim.geometry import Array, Integers
from ekfsim.twins import compiled


@compiled
def move(
    truth: Array, x: Array, P: Array, way: Array, turn: Array, d: Array, a: Array,
    distance_ratio: float, angle_ratio: float,
) -> None:  # fmt: skip
    """Φ of the truth by what the robot did, of x by its odometry (d, a); P⁻ = F P Fᵀ + G M Gᵀ

    The twin of `MoveTurn` and `EKF.predict`. way, turn, d, a : (N,)
    """
    N = x.shape[1]
    cosine, sine = np.empty(N), np.empty(N)
    directions(truth[2], cosine, sine)
    for n in range(N):
        truth[0, n] += way[n] * cosine[n]
        truth[1, n] += way[n] * sine[n]
        truth[2, n] = wrapped(truth[2, n] + turn[n])
    directions(x[2], cosine, sine)
    for n in range(N):
        c, s = cosine[n], sine[n]
        α, β = -d[n] * s, d[n] * c
        x[0, n] += β
        x[1, n] -= α
        x[2, n] = wrapped(x[2, n] + a[n])
        xθ, yθ, θθ = P[2, n] + α * P[5, n], P[4, n] + β * P[5, n], P[5, n]
        M_d, M_a = (distance_ratio * d[n]) ** 2, (angle_ratio * a[n]) ** 2
        P[0, n] += α * (P[2, n] + xθ) + c * M_d * c
        P[1, n] += β * P[2, n] + α * yθ + c * M_d * s
        P[3, n] += β * (P[4, n] + yθ) + s * M_d * s
        P[2, n], P[4, n], P[5, n] = xθ, yθ, θθ + M_a
        _make_sound(P, n)


@compiled
def read(
    x: Array, P: Array, z: Array, h: Array, wall: Integers, way: Array, normals: Array,
    range_ratio: float, along: float, sharp: float, rounding: float,
    gate: float, limit: float, ln_clutter: float, nis: Array, dof: Integers,
) -> int:  # fmt: skip
    """Revise x and P by readings of walls, add up NIS, and tell how many readings had one.

    The twin of `Laser.linearize` and `update` of EKF, Huber and PDAF. z : (N,), read; h, wall :
    (N,), predicted; way : (2, N), the direction of the beam; normals : (W, 2); limit, ln_clutter :
    which of the filters it is, see `weighed`
    """
    known = 0
    H, L = np.empty(3), np.empty((3, 3))
    for n in range(x.shape[1]):
        if wall[n] < 0 or math.isnan(z[n]):
            continue  # nothing was predicted, or nothing met: refused
        c, s, nx, ny = way[0, n], way[1, n], normals[wall[n], 0], normals[wall[n], 1]
        n_d = nx * c + ny * s
        if abs(n_d) <= along:
            continue
        H0, H1, H2 = -nx / n_d, -ny / n_d, -h[n] * (ny * c - nx * s) / n_d
        R, ν = (range_ratio * h[n]) ** 2, z[n] - h[n]
        noise = sharp * (H0 * H0 * P[0, n] + H1 * H1 * P[3, n] + H2 * H2 * P[5, n])
        if noise < R:
            square = _revise(x, P, n, H0, H1, H2, R, ν, gate, limit, ln_clutter)
        else:
            H[0], H[1], H[2] = H0, H1, H2
            square = carlson(x, P, n, H, R, h[n], ν, gate, limit, ln_clutter, rounding, L)
        if not math.isnan(square):
            nis[n] += square
            dof[n] += 1
            known += 1
    return known


@compiled
def _revise(
    x: Array, P: Array, n: int, H0: float, H1: float, H2: float, R: float, ν: float,
    gate: float, limit: float, ln_clutter: float,
) -> float:  # fmt: skip
    """K = P⁻ Hᵀ/S      x = x⁻ + w K ν      P = P⁻ − v P⁻ Hᵀ H P⁻/S      of run n, and its NIS"""
    PH0 = P[0, n] * H0 + P[1, n] * H1 + P[2, n] * H2
    PH1 = P[1, n] * H0 + P[3, n] * H1 + P[4, n] * H2
    PH2 = P[2, n] * H0 + P[4, n] * H1 + P[5, n] * H2
    S = H0 * PH0 + H1 * PH1 + H2 * PH2 + R
    per_S = 1 / S
    nis: float = ν * ν * per_S
    if nis > gate:
        return nis
    w, v = weighed(nis, S, limit, ln_clutter)
    ν, less = w * ν, v * per_S
    P[0, n] -= PH0 * PH0 * less
    P[1, n] -= PH0 * PH1 * less
    P[2, n] -= PH0 * PH2 * less
    P[3, n] -= PH1 * PH1 * less
    P[4, n] -= PH1 * PH2 * less
    P[5, n] -= PH2 * PH2 * less
    x[0, n] += PH0 * per_S * ν
    x[1, n] += PH1 * per_S * ν
    x[2, n] = wrapped(x[2, n] + PH2 * per_S * ν)
    _make_sound(P, n)
    return nis


@compiled
def _make_sound(P: Array, n: int) -> None:
    """No variance below 0 and no correlation beyond ±1, where rounding made it so: `covariance`."""
    a, d, v, b, c, e = P[0, n], P[3, n], P[5, n], P[1, n], P[2, n], P[4, n]
    fine = (b * b <= a * d) & (c * c <= a * v) & (e * e <= d * v)
    if fine & (a >= 0) & (d >= 0) & (v >= 0):
        return
    P[0, n], P[3, n], P[5, n] = max(a, 0.0), max(d, 0.0), max(v, 0.0)
    σx, σy, σθ = math.sqrt(P[0, n]), math.sqrt(P[3, n]), math.sqrt(P[5, n])
    P[1, n] = min(max(b, -σx * σy), σx * σy)
    P[2, n] = min(max(c, -σx * σθ), σx * σθ)
    P[4, n] = min(max(e, -σy * σθ), σy * σθ)
