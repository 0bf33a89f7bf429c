"""A scan, many beams from one place: every wall is asked which beams its two ends enclose.

Seen from the origin a wall covers an angle, and of the sorted headings a contiguous piece lies within it. Only these
pairs of a wall and a beam are tried; the beams need not be evenly spaced. As in broad.py the ranges are rough at first,

    r = area / (e × d)     with the wall's edge e and the beam's direction d

and the nearest are looked at closely.
"""

import numpy as np

from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.geometry.broad import BLUR, FINE
from ekfsim.geometry.grid import spread
from ekfsim.geometry.pairs import first_of, measure

PAD = 1e-9  # of the coordinates' size: how far beside a wall's end a beam still belongs to it
HALF = 3.0  # rad: a wall that covers more lies at the origin's feet, and its sides are not to be told apart
TURN = 2 * np.pi


def fan(
    ends: Array, x: float, y: float, heading: Array, dx: Array, dy: Array, span: float
) -> tuple[Array, Integers, Integers]:
    """Ranges and walls of beams from (x, y) m towards `heading` (n,) rad, and which beams are left in doubt.

    ends : (W, 4) m: x, y of the first and of the second end of each wall; dx, dy : (n,), the unit directions;
    span : m, the coordinates' size
    """
    ax, ay, bx, by = (ends - [x, y, x, y]).T
    area = ay * bx - ax * by
    unsure = np.abs(area) <= 4 * FINE * span * span  # the origin is near the wall's line, or the wall is tiny
    wall, beam = _covered(ax, ay, bx, by, heading, unsure, PAD * span)
    with np.errstate(divide="ignore", invalid="ignore"):
        r = area[wall] / ((bx - ax)[wall] * dy[beam] - (by - ay)[wall] * dx[beam])
    always = np.flatnonzero(unsure[wall]) if unsure.any() else beam[:0]
    r[always] = np.inf
    nearest = np.full(len(heading), np.inf)
    np.minimum.at(nearest, beam, r)
    blur = BLUR * span
    r[always] = -np.inf
    near = np.flatnonzero(r <= (nearest + 2 * blur)[beam])
    wall, beam = wall[near], beam[near]
    spans = np.full(len(heading), span)
    exact = measure(ends[wall], np.array(x), np.array(y), dx[beam], dy[beam], spans[beam])
    ranges, walls = first_of(beam, wall, exact, spans, len(ends))
    return ranges, walls, np.flatnonzero((nearest < np.inf) & ~(ranges <= nearest + blur))


def _covered(
    ax: Array, ay: Array, bx: Array, by: Array, heading: Array, unsure: Booleans, pad: float
) -> tuple[Integers, Integers]:
    """All pairs of a wall and a beam that it covers, or that passes within `pad` m of its ends, wall after wall."""
    heading = heading % TURN
    order = np.argsort(heading)
    twice = np.concatenate([heading[order], heading[order] + TURN])
    to_a, to_b = np.arctan2(ay, ax), np.arctan2(by, bx)
    sweep = (to_b - to_a + np.pi) % TURN - np.pi
    width = np.abs(sweep)
    distance = np.minimum(np.maximum(np.abs(ax), np.abs(ay)), np.maximum(np.abs(bx), np.abs(by)))
    beside = np.where(distance > pad, pad / np.maximum(distance, pad), np.pi) + PAD
    beside = np.where(unsure & (width > HALF), np.pi, beside)
    low = (np.where(sweep >= 0, to_a, to_b) - beside) % TURN
    begin = np.searchsorted(twice, low)
    end = np.searchsorted(twice, low + width + 2 * beside, side="right")
    wall, nth = spread(np.minimum(end - begin, len(heading)))
    return wall, order[(begin[wall] + nth) % len(heading)]
