"""Which search suits which beams: what answers in the place of `Walls.cast`."""

from collections.abc import Callable
from functools import partial

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.raycast.brute import brute_force
from ekfsim.raycast.searches.few_walls import few_walls
from ekfsim.raycast.searches.many_beams import many_beams
from ekfsim.raycast.searches.nearby_beams import nearby_beams
from ekfsim.raycast.searches.round_before import round_before
from ekfsim.raycast.searches.scan import scan
from ekfsim.raycast.searches.single_beam import first, follow
from ekfsim.raycast.walls import Hit, Walls

FEW = 64  # beams that are sooner followed one by one than all at once
BLOCK = 4096  # beams that are followed together: few enough for a processor's cache
FEW_WALLS = 150  # walls that are sooner all tried than searched
VERY_FEW_WALLS = 8  # and that are so even where the beams lie close together

# of beams (4, n), x, y in m and unit direction: ranges, walls, and which of them are in doubt
Search = Callable[[Walls, Array], tuple[Array, Integers, Integers]]


def cast(walls: Walls, origin: Array, heading: Array) -> Hit:
    """`Walls.cast` in NumPy: few beams one by one, many all at once."""
    if origin.ndim == 1 and np.ndim(heading) == 0:
        r, wall = first(walls, float(origin[0]), float(origin[1]), float(heading))
        return Hit(np.array(r), np.array(wall))
    x, y, heading = together(origin, heading)
    if heading.size > FEW:
        return in_blocks(suited, walls, x, y, heading)
    beams = zip(*(v.ravel().tolist() for v in (x, y, heading)), strict=True)
    hits = [first(walls, *beam) for beam in beams]
    ranges, met = np.array([r for r, _ in hits]), np.array([wall for _, wall in hits], np.int64)
    return Hit(ranges.reshape(heading.shape), met.reshape(heading.shape))


def together(origin: Array, heading: Array) -> tuple[Array, Array, Array]:
    """x, y and heading of beams, broadcast : (…) each"""
    x, y = origin[..., 0], origin[..., 1]
    if x.shape == np.shape(heading):
        return x, y, heading
    x, y, heading = np.broadcast_arrays(x, y, heading)
    return x, y, heading


def in_blocks(search: Search, walls: Walls, x: Array, y: Array, heading: Array) -> Hit:
    """What a search finds of many beams, all (…); what it leaves in doubt is followed once more by
    a sure way.
    """
    shape = heading.shape
    x, y, heading = x.ravel(), y.ravel(), heading.ravel()
    ranges, met = np.full(x.shape, np.nan), np.full(x.shape, -1)
    for start in range(0, len(x) if walls.grid or walls.round else 0, BLOCK):
        part = slice(start, start + BLOCK)
        beams = np.empty((4, len(x[part])))
        beams[0], beams[1] = x[part], y[part]
        with np.errstate(invalid="ignore"):
            np.cos(heading[part], out=beams[2])
            np.sin(heading[part], out=beams[3])
        if walls.grid:
            ranges[part], met[part], doubtful = search(walls, beams)
            if doubtful.size:
                again = start + doubtful
                ranges[again], met[again] = _surely(walls, beams[:, doubtful])
        if walls.round:
            ranges[part], met[part] = round_before(walls.round, (ranges[part], met[part]), beams)
    return Hit(ranges.reshape(shape), met.reshape(shape))


def suited(walls: Walls, beams: Array) -> tuple[Array, Integers, Integers]:
    """The search that suits these beams best."""
    grid, ends, n = walls.flat_grid.grid, walls.segments.reshape(-1, 4), beams.shape[1]
    low, high = beams.min(axis=1), beams.max(axis=1)
    farthest = float(np.maximum(np.abs(low), np.abs(high))[:2].sum())
    if not (farthest < grid.horizon and np.isfinite(low).all()):
        return np.full(n, np.nan), np.full(n, -1), np.arange(n)
    x, y, dx, dy = beams
    if low[0] == high[0] and low[1] == high[1]:
        return scan(ends, float(low[0]), float(low[1]), dx, dy, grid.size + farthest)
    span = grid.size + np.abs(x) + np.abs(y)
    if len(ends) > VERY_FEW_WALLS:
        hits = nearby_beams(ends, beams, low, high, span)
        if hits is not None:
            return hits
    if len(ends) <= FEW_WALLS:
        return few_walls(ends, x, y, dx, dy, span)
    return *many_beams(walls.flat_grid, x, y, dx, dy), np.empty(0, np.int64)


def _surely(walls: Walls, beams: Array) -> tuple[Array, Integers]:
    """Cell by cell where rounding is small against a cell, by brute force from beyond."""
    ranges, met = np.full(beams.shape[1], np.nan), np.full(beams.shape[1], -1)
    far = np.abs(beams[0]) + np.abs(beams[1])
    near = far < walls.flat_grid.grid.horizon
    finite = np.isfinite(far + beams[2])
    if np.count_nonzero(finite) <= FEW:
        for k in np.flatnonzero(finite).tolist():
            ranges[k], met[k] = follow(walls.flat_grid.grid, *beams[:, k].tolist())
        return ranges, met
    for some, search in (
        (finite & near, partial(many_beams, walls.flat_grid)),
        (finite & ~near, partial(brute_force, walls.segments)),
    ):
        ranges[some], met[some] = search(*beams[:, some])
    return ranges, met
