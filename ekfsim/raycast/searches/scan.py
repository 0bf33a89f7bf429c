"""A scan, many beams from one place: every wall is asked which beams its two ends enclose.

Seen from the origin a wall covers an angle, and of the sorted headings a contiguous piece lies
within it. Only these pairs of a wall and a beam are tried; the beams need not be evenly spaced. As
in few_walls.py the ranges are rough at first,

    r = area / (e × d)     with the wall's edge e and the beam's direction d

and the nearest are looked at closely.
"""

import numpy as np

from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.raycast.searches.candidates import first_of, measure
from ekfsim.raycast.searches.few_walls import BLUR, FINE
from ekfsim.raycast.searches.grid import spread

PAD = 1e-9  # of the coordinates' size: how far beside a wall's end a beam still belongs to it
# rad: a wall that covers more lies at the origin's feet, and its sides are not to be told apart
HALF = 3.0
TURN = 2 * np.pi


def scan(
    ends: Array, x: float, y: float, dx: Array, dy: Array, span: float
) -> tuple[Array, Integers, Integers]:
    """Ranges and walls of beams from (x, y) m in the unit directions (dx, dy), all (n,), and which
    are in doubt.

    ends : (W, 4) m: x, y of the first and of the second end of each wall; span : m, the
    coordinates' size
    """
    ax, ay, bx, by = (ends - [x, y, x, y]).T
    area = ay * bx - ax * by
    # the origin is near the wall's line, or the wall is tiny
    unsure = np.abs(area) <= 4 * FINE * span * span
    wall, beam = _covered(ax, ay, bx, by, np.arctan2(dy, dx), unsure, PAD * span)
    with np.errstate(divide="ignore", invalid="ignore"):
        r = area[wall] / ((bx - ax)[wall] * dy[beam] - (by - ay)[wall] * dx[beam])
    always = np.flatnonzero(unsure[wall]) if unsure.any() else beam[:0]
    r[always] = np.inf
    nearest = np.full(len(dx), np.inf)
    np.minimum.at(nearest, beam, r)
    blur = BLUR * span
    r[always] = -np.inf
    near = np.flatnonzero(r <= (nearest + 2 * blur)[beam])
    wall, beam = wall[near], beam[near]
    spans = np.full(len(dx), span)
    exact = measure(ends[wall], x, y, dx[beam], dy[beam], spans[beam])
    ranges, walls = first_of(beam, wall, exact, spans, len(ends))
    return ranges, walls, np.flatnonzero((nearest < np.inf) & ~(ranges <= nearest + blur))


def _covered(
    ax: Array, ay: Array, bx: Array, by: Array, heading: Array, unsure: Booleans, pad: float
) -> tuple[Integers, Integers]:
    """All pairs of a wall and a beam that it covers, or that passes within `pad` m of its ends,
    wall after wall.
    """
    ahead = heading - heading[0]
    ahead[ahead < 0] += TURN
    order = np.argsort(ahead)
    to_a, to_b = np.arctan2(ay, ax), np.arctan2(by, bx)
    sweep = to_b - to_a
    sweep -= TURN * np.rint(sweep / TURN)
    width = np.abs(sweep)
    # too long by √2 at most
    distance = np.minimum(np.abs(ax) + np.abs(ay), np.abs(bx) + np.abs(by))
    beside = np.minimum(4 * pad / np.maximum(distance, pad) + 2 * PAD, np.pi)
    beside[unsure & (width > HALF)] = np.pi
    low = np.where(sweep >= 0, to_a, to_b) - beside - heading[0]
    low -= TURN * np.floor(low / TURN)
    begin, end = _between(ahead[order], low, low + width + 2 * beside)
    counts = np.minimum(end - begin, len(order))
    wall, nth = spread(counts)
    return wall, np.concatenate([order, order])[np.repeat(begin % len(order), counts) + nth]


def _between(heading: Array, low: Array, high: Array) -> tuple[Integers, Integers]:
    """Which of the sorted headings is the first from `low` on, and which the first past `high`,
    counted on for a turn.

    Of evenly spaced headings a division tells.
    """
    count = len(heading)
    step = heading[-1] / max(1, count - 1)
    if step > 0 and np.abs(heading - step * np.arange(count)).max() <= PAD:
        again = high >= TURN
        first, past = np.ceil(low / step), np.floor((high - TURN * again) / step) + 1
        first, past = np.minimum(first, count), np.minimum(past, count) + count * again
        return first.astype(np.int64), past.astype(np.int64)
    twice = np.concatenate([heading, heading + TURN])
    return np.searchsorted(twice, low), np.searchsorted(twice, high, side="right")
