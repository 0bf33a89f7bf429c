"""Cells → outlines along their edges: cell i covers i to i + 1."""

import numpy as np

from ekfsim.geometry import Array, Booleans


def without_corners(free: Booleans) -> Booleans:
    """The same cells, but for those that free cells touch at a corner alone: no robot passes there,
    and an outline would touch itself.
    """
    free = free.copy()
    while True:
        a, b, c, d = free[:-1, :-1], free[:-1, 1:], free[1:, :-1], free[1:, 1:]
        falling, rising = a & d & ~b & ~c, b & c & ~a & ~d
        if not (falling.any() or rising.any()):
            return free
        free[:-1, :-1][falling] = False
        free[:-1, 1:][rising] = False


def outlines(free: Booleans) -> list[Array]:
    """The outlines of the free cells, free to the left, (n, 2) each: x, y in cells, y upwards as
    the rows are numbered. Every edge of a cell is one of it, so that points are 1 apart. The outer
    ones run counter-clockwise, those of holes clockwise.

    free : no two cells touch at a corner alone
    """
    around = np.pad(free, 1).astype(np.int8)
    # at each edge between two cells, whether free begins or ends there
    right, up = np.diff(around, axis=1)[1:-1], np.diff(around, axis=0)[:, 1:-1]
    step: dict[tuple[int, int], tuple[int, int]] = {}
    for changes, beginning, ending in (
        (right, ((0, 1), (0, 0)), ((0, 0), (0, 1))),
        (up, ((0, 0), (1, 0)), ((1, 0), (0, 0))),
    ):
        for sign, ((x_0, y_0), (x_1, y_1)) in ((1, beginning), (-1, ending)):
            row, column = np.nonzero(changes == sign)
            starts = zip((column + x_0).tolist(), (row + y_0).tolist(), strict=True)
            ends = zip((column + x_1).tolist(), (row + y_1).tolist(), strict=True)
            step.update(zip(starts, ends, strict=True))
    rings = []
    while step:
        place = start = next(iter(step))
        ring = []
        while True:
            ring.append(place)
            place = step.pop(place)
            if place == start:
                break
        rings.append(np.array(ring, np.float64))
    return rings
