"""Many beams close together, as those of a study's runs are: only the walls before all of them are
tried.

Seen from the middle of the beams, along their middle direction, none leaves the wedge

    |across| ≤ ρ + (along + ρ) tan δ
    ρ: how far the origins lie from the middle, δ: how far the directions part

which is convex: a wall with both ends beyond one of its sides is met by none. And where a wall bars
the whole wedge, none that lies wholly behind it is met either. Often a single wall is left.
"""

from functools import reduce
from math import cos, hypot, inf, sqrt
from typing import NamedTuple, Self

import numpy as np

from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.raycast.rules import TIE
from ekfsim.raycast.searches.candidates import crossing, seen
from ekfsim.raycast.searches.few_walls import few_walls

SPREAD = 0.35  # rad; a beam that parts more from the others is left to itself
APART = 0.05  # of the walls' extent: and so is one that begins farther from them
LONE = 0.25  # share of such beams from which on the others do not count as close
FEWEST = 128  # beams that are worth a look
FEW = 6  # walls before them, that are sooner measured right away than in broad strokes first
MANY = 150  # and that are sooner searched for than all tried
ASKED = 64  # beams whose median tells where most are
SAFE = 1e-6  # of the coordinates' size: by so much the wedge is wider than it need be


class Wedge(NamedTuple):
    """What beams do not leave."""

    x: float  # m, its middle
    y: float
    dx: float  # its direction, of length 1
    dy: float
    wide: float  # m: no beam begins farther from the middle by x or by y
    ρ: float  # m: nor farther than this
    sin_δ: float  # inf where not all go its way

    @classmethod
    def of(cls, low: Array, high: Array) -> Self:
        """The wedge of all beams whose x, y, dx, dy are between low and high, (4,) each."""
        x, y, dx, dy = ((low + high) / 2).tolist()
        about_x, about_y, about_dx, about_dy = ((high - low) / 2).tolist()
        length = hypot(dx, dy) or inf
        dx, dy = dx / length, dy / length
        part = about_dx * abs(dy) + about_dy * abs(dx)
        back = about_dx * abs(dx) + about_dy * abs(dy)
        sin_δ = part if back < length < inf else inf
        return cls(x, y, dx, dy, max(about_x, about_y), hypot(about_x, about_y), sin_δ)


def nearby_beams(
    ends: Array, beams: Array, low: Array, high: Array, span: Array
) -> tuple[Array, Integers, Integers] | None:
    """Ranges and walls of many beams, all (n,), and which are left in doubt; None where they lie
    too far apart.

    ends : (W, 4) m, x, y of the first and of the second end of each wall; beams : (4, n), x, y in m
    and the unit direction; low, high : (4,), the least and the greatest of each; span : (n,) m, the
    coordinates' size
    """
    if beams.shape[1] < FEWEST:
        return None
    apart, wedge = APART * float(ends.max() - ends.min()), Wedge.of(low, high)
    lone = None
    if wedge.wide > apart or wedge.sin_δ > SPREAD:
        close = _close(beams, apart)
        if close is None or np.count_nonzero(close) < (1 - LONE) * len(close):
            return None
        lone = np.flatnonzero(~close)
        low = beams.min(axis=1, where=close, initial=inf)
        high = beams.max(axis=1, where=close, initial=-inf)
        wedge = Wedge.of(low, high)
        if wedge.sin_δ >= 1:
            return None
    before = _before(ends, wedge, SAFE * float(span.max()))
    if len(before) > MANY:
        return None
    ranges, walls, doubtful = _first_of(ends, before, beams, span)
    return ranges, walls, doubtful if lone is None else np.union1d(doubtful, lone)


def _close(beams: Array, apart: float) -> Booleans | None:
    """Which beams are close to most : (n,); None where even of a few beams hardly any are.

    Some that stray far move a mean, but not a median; that of every so many beams will do.
    """
    few = beams[:, :: beams.shape[1] // ASKED]
    mx, my, ux, uy = np.median(few, axis=1).tolist()
    aligned = cos(SPREAD) * hypot(ux, uy)
    close: Booleans
    for x, y, dx, dy in (few, beams):
        close = (np.abs(x - mx) <= apart) & (np.abs(y - my) <= apart)
        close &= dx * ux + dy * uy >= aligned
        if np.count_nonzero(close) < len(close) / 2:
            return None
    return close


def _before(ends: Array, wedge: Wedge, safe: float) -> Integers:
    """The walls that beams may meet, in their order. ends : (W, 4) m"""
    x, y, dx, dy, _, ρ, sin_δ = wedge
    ρ, tan_δ = ρ + safe, sin_δ / sqrt(1 - sin_δ**2) + SAFE
    # in the plane of complex numbers: both ends of each wall, turned so that the wedge lies ahead
    turned = (ends.view(complex).T - complex(x, y)) * complex(dx, -dy)  # (2, W)
    along, across = turned.real, -turned.imag
    half = ρ + (along + ρ) * tan_δ
    right, left = across > half, across < -half
    nearest, farthest = np.minimum(*along), np.maximum(*along)
    maybe = (farthest >= -ρ) & ~(right[0] & right[1]) & ~(left[0] & left[1])
    bars = (nearest > ρ) & (right[0] & left[1] | left[0] & right[1])
    limit = farthest.min(where=bars, initial=inf)
    return np.flatnonzero(maybe & (nearest <= limit))


def _first_of(
    ends: Array, before: Integers, beams: Array, span: Array
) -> tuple[Array, Integers, Integers]:
    """What of the walls before them beams meet first, and which beams are left in doubt."""
    x, y, dx, dy = beams
    if len(before) > FEW:
        ranges, walls, doubtful = few_walls(ends[before], x, y, dx, dy, span)
        return ranges, np.append(before, -1)[walls], doubtful
    r = _measured(ends[before], beams, span)
    nearest = np.full(len(x), inf) if not r else reduce(np.minimum, r)
    met = nearest < inf
    limit, walls = np.where(met, nearest + TIE * span, -1.0), np.full(len(x), -1)
    for wall, each in zip(reversed(before.tolist()), reversed(r), strict=True):
        np.copyto(walls, wall, where=each <= limit)
    return np.where(met, nearest, np.nan), walls, before[:0]


def _measured(ends: Array, beams: Array, span: Array) -> list[Array]:
    """The ranges at which beams meet each of a few walls : (n,) m, inf where not

    Wall by wall, since arrays for all of them would be larger than a processor's nearest cache; and
    a corner is looked at once for both its walls.
    """
    ranges, corners = [], dict[tuple[float, float], tuple[Array, Array]]()
    for ax, ay, bx, by in ends.tolist():
        for corner in ((ax, ay), (bx, by)):
            if corner not in corners:
                corners[corner] = seen(*corner, *beams)
        ranges.append(crossing(corners[ax, ay], corners[bx, by], span))
    return ranges
