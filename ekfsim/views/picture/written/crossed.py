"""Where in a window lines run, in squares of a few pixels: asked of many boxes at once."""

import numpy as np

from ekfsim.geometry import Array, Booleans

SQUARE = 6.0  # pixels


class Crossed:
    """The squares of a window that lines cross."""

    def __init__(self, window: tuple[float, float, float, float]) -> None:
        """window : left, bottom, right, top in pixels"""
        self._low, self._high = np.array(window[:2]), np.array(window[2:])
        columns, rows = np.ceil((self._high - self._low) / SQUARE).astype(int) + 1
        self._seen = np.zeros((int(rows), int(columns)), bool)

    def add(self, points: Array) -> None:
        """A line through points, broken where one is not finite : (n, 2) pixels"""
        starts, ends = points[:-1], points[1:]
        if len(points) == 1:
            starts = ends = points
        whole = np.isfinite(starts).all(axis=1) & np.isfinite(ends).all(axis=1)
        starts, ways = starts[whole], (ends - starts)[whole]
        first, last = self._clipped(starts, ways)
        met = first <= last
        starts, ways, first, last = starts[met], ways[met], first[met], last[met]
        steps = np.ceil(np.hypot(*ways.T) * (last - first) / (SQUARE / 2)).astype(int) + 1
        number = np.repeat(np.arange(len(steps)), steps)
        share = np.arange(len(number)) - np.repeat(np.cumsum(steps) - steps, steps)
        share = share / np.maximum(steps - 1, 1)[number]
        along = first[number] + share * (last - first)[number]
        places = starts[number] + along[:, None] * ways[number]
        columns, rows = ((places - self._low) / SQUARE).astype(int).T
        self._seen[rows, columns] = True

    def inside(self, boxes: Array) -> Booleans:
        """Whether a line crosses each of these. boxes : (n, 4) pixels"""
        total = np.zeros(np.add(self._seen.shape, 1), np.int32)
        along = np.cumsum(self._seen, axis=1, dtype=np.int32)
        # down the columns, turned to rows for it, as that is three times as fast
        total[1:, 1:] = np.cumsum(np.ascontiguousarray(along.T), axis=1).T
        rows, columns = self._seen.shape
        low = np.floor((boxes[:, :2] - self._low) / SQUARE).astype(int)
        high = np.floor((boxes[:, 2:] - self._low) / SQUARE).astype(int) + 1
        (left, bottom), (right, top) = (np.clip(each, 0, [columns, rows]).T for each in (low, high))
        return np.asarray(
            total[top, right] - total[bottom, right] - total[top, left] + total[bottom, left] > 0
        )

    def _clipped(self, starts: Array, ways: Array) -> tuple[Array, Array]:
        """The shares of each way at which it enters the window and leaves it; the first is the
        larger one where it misses the window. starts, ways : (n, 2)
        """
        with np.errstate(divide="ignore", invalid="ignore"):
            one, other = (self._low - starts) / ways, (self._high - starts) / ways
        still = ways == 0
        within = (starts >= self._low) & (starts <= self._high)
        enter = np.where(still, np.where(within, -np.inf, np.inf), np.minimum(one, other))
        leave = np.where(still, np.where(within, np.inf, -np.inf), np.maximum(one, other))
        return np.maximum(enter.max(axis=1), 0.0), np.minimum(leave.min(axis=1), 1.0)
