"""How the beliefs of many runs stand to the truth, compiled by Numba.

The twin of `nees` and of what study/counting.py counts of a step. All arrays have their entries in
front and the runs behind; of P its upper half is kept, row after row: (6, N).

Where P is singular its range is known in closed form. Of the correlation matrix of rank 2 the
second-order minors say which two entries span it, and a cross product what it makes nothing of;
one of rank 1 is ± 1 throughout. What is neither clearly of a rank nor clearly not is left to the
text.
"""

import math

from ekfsim.fast.compiled.angles import wrapped
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.twins import compiled

ODD = -1  # in place of a rank: left to the text
PLANE = 1e-4  # of the second-order minors of the correlation matrix; with less it is no clear plane
NONE = 1e-13  # a smaller eigenvalue of it is rounding, one between this and `counts` is not clear


@compiled
def judge(
    x: Array, P: Array, truth: Array,
    rounding: float, clear: float, counts: float, outside: float,
    e: Array, value: Array, rank: Integers, impossible: Booleans, odd: Integers,
) -> int:  # fmt: skip
    """Errors, NEES, ranks, whether beliefs are impossible; how many are left, and which, in `odd`.

    rounding, clear, counts, outside : ROUNDING, CLEAR, RANK and OUTSIDE of the text
    """
    left = 0
    tiny = rounding * rounding
    for n in range(x.shape[1]):
        e0, e1 = x[0, n] - truth[0, n], x[1, n] - truth[1, n]
        e2 = wrapped(x[2, n] - truth[2, n])
        e[0, n], e[1, n], e[2, n] = e0, e1, e2
        a, b, c, d, f, v = P[0, n], P[1, n], P[2, n], P[3, n], P[4, n], P[5, n]
        D = d - b / a * b
        y1 = e1 - b / a * e0
        f_rest = f - c / a * b
        o = f_rest / D
        D3 = v - c / a * c - o * f_rest
        y2 = e2 - c / a * e0 - o * y1
        full = (clear * d < D) & (clear * d * v < D * D3)
        rest = 0.0
        if (a > tiny) & (d > tiny) & (v > tiny) & full:
            value[n], rank[n] = e0 * e0 / a + y1 * y1 / D + y2 * y2 / D3, 3
        else:
            value[n], rank[n], rest = _square(e0, e1, e2, a, b, c, d, f, v, tiny, counts)
        if rank[n] == ODD:
            odd[left] = n
            left += 1
        number = math.isfinite(x[0, n] + x[1, n] + x[2, n])
        impossible[n] = rest > outside or not number
        if impossible[n]:
            value[n] = math.nan
    return left


@compiled
def _square(
    e0: float, e1: float, e2: float, a: float, b: float, c: float, d: float, f: float, v: float,
    tiny: float, counts: float,
) -> tuple[float, int, float]:  # fmt: skip
    """eᵀ P⁺ e, the rank of P = [a b c; b d f; c f v], and how long a part of e is outside it."""
    if not v > tiny:
        value, rank, rest = _square_2(e0, e1, a, b, d, tiny, counts)
        return value, rank, math.hypot(rest, e2)
    if not d > tiny:
        value, rank, rest = _square_2(e0, e2, a, c, v, tiny, counts)
        return value, rank, math.hypot(rest, e1)
    if not a > tiny:
        value, rank, rest = _square_2(e1, e2, d, f, v, tiny, counts)
        return value, rank, math.hypot(rest, e0)
    σ0, σ1, σ2 = math.sqrt(a), math.sqrt(d), math.sqrt(v)
    ρ01, ρ02, ρ12 = b / (σ0 * σ1), c / (σ0 * σ2), f / (σ1 * σ2)
    m01, m02, m12 = 1 - ρ01 * ρ01, 1 - ρ02 * ρ02, 1 - ρ12 * ρ12
    minors = m01 + m02 + m12  # λ₁λ₂ + λ₁λ₃ + λ₂λ₃
    if minors < NONE:
        return _square_line(e0, e1, e2, σ0, math.copysign(σ1, b), math.copysign(σ2, c))
    if not minors > PLANE:
        return math.nan, ODD, 0.0
    if m01 >= m02 and m01 >= m12:
        value, rank, rest = _square_plane(e0, e1, e2, σ0, σ1, σ2, ρ01, ρ02, ρ12, counts)
    elif m02 >= m12:
        value, rank, rest = _square_plane(e0, e2, e1, σ0, σ2, σ1, ρ02, ρ01, ρ12, counts)
    else:
        value, rank, rest = _square_plane(e1, e2, e0, σ1, σ2, σ0, ρ12, ρ01, ρ02, counts)
    return value, rank, rest


@compiled
def _square_line(
    e0: float, e1: float, e2: float, B0: float, B1: float, B2: float
) -> tuple[float, int, float]:
    """The same of P = B Bᵀ."""
    y = (B0 * e0 + B1 * e1 + B2 * e2) / (B0 * B0 + B1 * B1 + B2 * B2)
    rest0, rest1, rest2 = e0 - y * B0, e1 - y * B1, e2 - y * B2
    return y * y, 1, math.sqrt(rest0 * rest0 + rest1 * rest1 + rest2 * rest2)


@compiled
def _square_plane(
    e0: float, e1: float, e2: float, σ0: float, σ1: float, σ2: float,
    ρ01: float, ρ02: float, ρ12: float, counts: float,
) -> tuple[float, int, float]:  # fmt: skip
    """The same of a P of rank 2 or 3, of whose entries the first two have the least in common.

    Of a correlation matrix of rank 2 nothing is left of (v₀, v₁, 1 − ρ₀₁²).
    """
    D = 1 - ρ01 * ρ01
    v0, v1 = ρ01 * ρ12 - ρ02, ρ01 * ρ02 - ρ12
    m02, m12 = 1 - ρ02 * ρ02, 1 - ρ12 * ρ12
    D3 = m02 - v1 * v1 / D
    least = D * D3 / (D + m02 + m12)  # λ₃ = λ₁λ₂λ₃ / λ₁λ₂
    if least >= 2 * counts:
        y0, y1 = e0 / σ0, e1 / σ1 - ρ01 * e0 / σ0
        y2 = e2 / σ2 - ρ02 * y0 + v1 / D * y1
        return y0 * y0 + y1 * y1 / D + y2 * y2 / D3, 3, 0.0
    if not least < NONE:
        return math.nan, ODD, 0.0
    n0, n1, n2 = v0 / σ0, v1 / σ1, D / σ2  # outside the range of P
    square = n0 * n0 + n1 * n1 + n2 * n2
    rest = (n0 * e0 + n1 * e1 + n2 * e2) / square
    y0 = (e0 - rest * n0) / σ0
    y1 = (e1 - rest * n1) / σ1 - ρ01 * y0
    return y0 * y0 + y1 * y1 / D, 2, abs(rest) * math.sqrt(square)


@compiled
def _square_2(
    e0: float, e1: float, a: float, b: float, d: float, tiny: float, counts: float
) -> tuple[float, int, float]:
    """The same of P = [a b; b d]."""
    if not (a > tiny and d > tiny):
        if a > tiny:
            return e0 * e0 / a, 1, abs(e1)
        if d > tiny:
            return e1 * e1 / d, 1, abs(e0)
        return 0.0, 0, math.hypot(e0, e1)
    σ0, σ1 = math.sqrt(a), math.sqrt(d)
    ρ = b / (σ0 * σ1)
    if 1 - abs(ρ) > counts:
        y = e1 / σ1 - ρ * e0 / σ0
        return e0 * e0 / a + y * y / ((1 - ρ) * (1 + ρ)), 2, 0.0
    B1 = math.copysign(σ1, ρ)
    y = (σ0 * e0 + B1 * e1) / (a + d)
    return 2 * y * y / (1 + abs(ρ)), 1, math.hypot(e0 - y * σ0, e1 - y * B1)


@compiled
def count(
    e: Array, P: Array, value: Array, rank: Integers, impossible: Booleans, step: int, told: bool,
    quantiles: Array, rounding: float, counts: float, outside: float, ellipse: float, cone: float,
    lost_from: Integers, row: Array,
    inside: Booleans, drawn: Booleans, in_cone: Booleans, unsure: Booleans,
) -> None:  # fmt: skip
    """From which step on each run is lost, and of a step that is told `Ends` and `AtSteps`.

    quantiles : (3, 4), of χ² at three probabilities for each rank; ellipse, cone : the squares of
    their factors; lost_from : (N,), row : (14,)
    """
    tiny = rounding * rounding
    judged = off_runs = above_50 = above_95 = above_999 = 0
    inside_runs = drawn_runs = in_cone_runs = unsure_runs = known_runs = dof = 0
    nees = position = heading = 0.0
    for n in range(e.shape[1]):
        off = impossible[n]
        if not (off or value[n] > quantiles[2, rank[n]]):
            lost_from[n] = -1
        elif lost_from[n] < 0:
            lost_from[n] = step
        if not told:
            continue
        known = rank[n] > 0 and not off
        judged += known or off
        off_runs += off
        above_50 += off or value[n] > quantiles[0, rank[n]]
        above_95 += off or value[n] > quantiles[1, rank[n]]
        above_999 += off or value[n] > quantiles[2, rank[n]]
        e0, e1, e2, v = e[0, n], e[1, n], e[2, n], P[5, n]
        square, area, rest = _square_2(e0, e1, P[0, n], P[1, n], P[3, n], tiny, counts)
        astray = rest > outside or not math.isfinite(square) or not math.isfinite(e0 + e1)
        inside[n] = area == 2 and not astray and square <= ellipse
        drawn[n] = area == 2 or astray
        unsure[n] = v > tiny or not abs(e2) <= outside
        in_cone[n] = unsure[n] and (e2 * e2 <= cone * v or (v <= 0 and abs(e2) <= outside))
        inside_runs += inside[n]
        drawn_runs += drawn[n]
        in_cone_runs += in_cone[n]
        unsure_runs += unsure[n]
        if known:
            known_runs += 1
            dof += rank[n]
            nees += value[n]
        position += e0 * e0 + e1 * e1
        heading += e2 * e2
    row[0], row[1], row[2], row[3], row[4] = judged, off_runs, above_50, above_95, above_999
    row[5], row[6], row[7], row[8] = inside_runs, drawn_runs, in_cone_runs, unsure_runs
    row[9], row[10], row[11], row[12], row[13] = known_runs, dof, nees, position, heading
