"""Round walls beside the straight ones."""

from dataclasses import dataclass
from functools import cached_property, partial

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.raycast.brute import extent, in_portions, nearer, try_all_round
from ekfsim.raycast.rules import TIE
from ekfsim.raycast.searches.round_cells import RoundCells


@dataclass(frozen=True, eq=False)
class RoundWalls:
    """The circles of one map."""

    circles: Array  # (C, 3) m, centre and radius of each, one at least
    first: int  # the index of the first of them as a wall: they follow all straight ones

    def before(
        self,
        straight: tuple[Array, Integers],
        x: Array,
        y: Array,
        dx: Array,
        dy: Array,
        some: Integers | None = None,
    ) -> tuple[Array, Integers]:
        """Ranges and walls that beams meet first, of these walls and of the straight ones, which
        are found already : (…) both

        some : the circles that are tried, in their order, where others are known not to be met
        """
        circles = self.circles if some is None else self.circles[some]
        r, circle = in_portions(partial(try_all_round, self.extent), circles, x, y, dx, dy)
        if some is not None:
            circle = np.append(some, -1)[circle]  # no circle, −1, takes the last
        tie = TIE * (self.extent + np.abs(x) + np.abs(y))
        return nearer(straight, (r, circle), self.first, tie)

    @cached_property
    def extent(self) -> float:
        """The largest coordinate of any circle, in m."""
        return extent(self.circles)

    @cached_property
    def cells(self) -> RoundCells:
        """What many beams look many circles up in."""
        return RoundCells.over(self.circles)

    @cached_property
    def plain(self) -> list[tuple[float, float, float]]:
        """The circles in plain numbers."""
        return [(x, y, radius) for x, y, radius in self.circles.tolist()]
