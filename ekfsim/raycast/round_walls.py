"""Round walls beside the straight ones: few, and so every beam tries every one of them."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.raycast.brute import extent, in_portions, nearer, try_all_round
from ekfsim.raycast.rules import TIE


@dataclass(frozen=True, eq=False)
class RoundWalls:
    """The circles of one map."""

    circles: Array  # (C, 3) m, centre and radius of each, one at least
    first: int  # the index of the first of them as a wall: they follow all straight ones

    def before(
        self, straight: tuple[Array, Integers], x: Array, y: Array, dx: Array, dy: Array
    ) -> tuple[Array, Integers]:
        """Ranges and walls that beams meet first, of these walls and of the straight ones, which
        are found already : (…) both
        """
        found = in_portions(try_all_round, self.circles, x, y, dx, dy)
        tie = TIE * (self.extent + np.abs(x) + np.abs(y))
        return nearer(straight, found, self.first, tie)

    @cached_property
    def extent(self) -> float:
        """The largest coordinate of any circle, in m."""
        return extent(self.circles)

    @cached_property
    def plain(self) -> list[tuple[float, float, float]]:
        """The circles in plain numbers."""
        return [(x, y, radius) for x, y, radius in self.circles.tolist()]
