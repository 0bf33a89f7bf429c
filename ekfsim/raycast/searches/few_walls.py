"""Many beams and few walls: every beam tries every wall, in broad strokes first.

With across_a, across_b of a wall's ends (see rules.py) and its `area`, twice that of the triangle
from the beam's origin to both ends, a beam crosses the wall at

    r = area / (across_b − across_a)     where across_a and across_b differ in sign and r ≥ 0

All three are linear in what is known of the beam, (x, y, dx, dy, x dy − y dx), so a matrix product
gives each for all pairs. Rounding may spoil the last digits: the walls that come out nearest,
within `BLUR`, are looked at closely, and a beam for which the close look does not bear out the
broad one is left in doubt, to be followed by a surer way.
"""

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.raycast.searches.candidates import first_of, measure

# beams × walls that are held in memory at a time: what a processor has at hand, in arrays small
# enough that none is asked of the operating system and given back to it each time
ROUGH = 1 << 13
# of the coordinates' size: a wall that looks this short to a beam is not judged in broad strokes
FINE = 1e-6
# of the coordinates' size: what a range in broad strokes may be off, and to spare; rounding / FINE
# is 1e-9
BLUR = 1e-8


def few_walls(
    ends: Array, x: Array, y: Array, dx: Array, dy: Array, span: Array
) -> tuple[Array, Integers, Integers]:
    """Ranges and walls of many beams, all (n,), and which beams are left in doubt.

    ends : (W, 4) m: x, y of the first and of the second end of each wall; span : (n,) m, the
    coordinates' size
    """
    if not len(ends) or not len(x):
        return np.full(x.shape, np.nan), np.full(x.shape, -1), np.empty(0, np.int64)
    ax, ay, bx, by = ends.T
    ones = np.ones(len(ends))
    to_a, to_b = np.stack([ax, ay, ones], -1), np.stack([bx, by, ones], -1)
    to_area = np.stack([by - ay, ax - bx, ay * bx - ax * by], -1)
    aims, origins = np.stack([dy, -dx, y * dx - x * dy]), np.stack([x, y, np.ones_like(x)])
    blur, nearest, side = BLUR * span, np.empty(x.shape), np.empty(x.shape)
    pairs = []
    step = max(1, ROUGH // len(ends))
    for first in range(0, len(x), step):
        part = slice(first, first + step)
        # (W, step)
        across_a, across_b, r = (
            to_a @ aims[:, part],
            to_b @ aims[:, part],
            to_area @ origins[:, part],
        )
        with np.errstate(divide="ignore", invalid="ignore"):
            r /= np.subtract(across_b, across_a)
        sides = np.multiply(across_a, across_b, out=across_a)
        r = np.where((sides >= 0) | (r < -blur[part]), np.inf, r)
        least = r.min(0, out=nearest[part])
        near = np.flatnonzero(r <= np.where(least < np.inf, least + 2 * blur[part], -1))
        np.abs(sides, out=sides).min(0, out=side[part])
        wall, beam = np.divmod(near, len(least))
        pairs.append((wall, beam + first))
    wall, beam = (
        pairs[0] if len(pairs) == 1 else (np.concatenate(each) for each in zip(*pairs, strict=True))
    )
    exact = measure(ends[wall], x[beam], y[beam], dx[beam], dy[beam], span[beam])
    ranges, walls = first_of(beam, wall, exact, span, len(ends))
    doubtful = (nearest < np.inf) & ~(ranges <= nearest + blur)
    return ranges, walls, np.flatnonzero(doubtful | (side <= (FINE * span) ** 2))
