"""Where a driven robot was a while ago: what an instrument reads that tells its readings late."""

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.geometry.angles import wrap


class Past:
    """The true poses from a while ago to now. Before the start the robot stood there."""

    def __init__(self, start: Array, longest: float) -> None:
        """start : (…, 3); longest : ticks, the farthest that is asked for"""
        self._poses, self._first = start[None], 0  # how many ticks were over at the first of them
        self._kept = int(np.ceil(longest)) + 1

    def goes_on(self, truth: Array) -> None:
        """Add the poses (T, …, 3) at the ends of the next ticks; forget what is too long ago."""
        known = self._poses[-self._kept :]
        self._first += len(self._poses) - len(known)
        self._poses = np.concatenate([known, truth])

    def before(self, ends: Integers, ticks: float) -> Array:
        """The poses so many ticks before ends : (D,) of ticks, counted from 1 → (D, …, 3)

        Between two ticks they lie on the straight line between their poses.
        """
        when = np.maximum(ends - ticks, 0.0) - self._first
        one = np.floor(when).astype(int)
        other = np.minimum(one + 1, len(self._poses) - 1)
        way = self._poses[other] - self._poses[one]
        way[..., 2] = wrap(way[..., 2])
        share = (when - one).reshape(-1, *(1,) * (way.ndim - 1))
        pose: Array = self._poses[one] + share * way
        pose[..., 2] = wrap(pose[..., 2])
        return pose
