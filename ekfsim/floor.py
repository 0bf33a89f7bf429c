"""What stands where on a floor: a plan of it, the true one or the one that a filter believes."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.circle import circle_outline
from ekfsim.raycast.walls import BOUNDARY as BOUNDARY
from ekfsim.raycast.walls import Walls
from ekfsim.systems.instrument import Landmark as Landmark

if TYPE_CHECKING:
    from shapely import Polygon


@dataclass(frozen=True)
class Obstacle:
    """A polygon that stops robots and beams. points : (n, 2) m, in the file's order, not closed."""

    name: str
    points: Array

    @property
    def outline(self) -> Array:
        """(n, 2) m, its rim as a line that ends where it begins."""
        return np.vstack([self.points, self.points[:1]])


@dataclass(frozen=True)
class RoundObstacle:
    """A circle that stops robots and beams."""

    name: str
    centre: Array  # (2,) m
    radius: float  # m

    @property
    def outline(self) -> Array:
        """(n, 2) m, its rim as a line to be drawn, which ends where it begins."""
        x, y = self.centre.tolist()
        return circle_outline(x, y, self.radius)


@dataclass(frozen=True)
class WallLine:
    """Walls that stand free: they stop robots and beams, and have no inside. points : (n, 2) m"""

    name: str
    points: Array


def wall_name(index: int) -> str:
    """What a wall that was given no name is called, by its place in the list.

    >>> wall_name(0)
    'wall 1'
    """
    return f"wall {index + 1}"


@dataclass(frozen=True)
class Map:
    """A floor plan: the true one, or the one that the filter believes."""

    boundary: Array | None = None  # (n, 2) m
    obstacles: tuple[Obstacle | RoundObstacle, ...] = ()
    lines: tuple[WallLine, ...] = ()

    def rings(self) -> Iterator[tuple[str, Array]]:
        """Every polygon with its name, the boundary first : (n, 2) m each, not closed."""
        if self.boundary is not None:
            yield BOUNDARY, self.boundary
        for obstacle in self.obstacles:
            if isinstance(obstacle, Obstacle):
                yield obstacle.name, obstacle.points

    def circles(self) -> Iterator[RoundObstacle]:
        """Every obstacle that is round."""
        return (one for one in self.obstacles if isinstance(one, RoundObstacle))

    def outlines(self) -> Iterator[tuple[str, Array]]:
        """All walls with their names, as lines to be drawn : (n, 2) m each; where one is closed, it
        ends where it begins.
        """
        if self.boundary is not None:
            yield BOUNDARY, np.vstack([self.boundary, self.boundary[:1]])
        for obstacle in self.obstacles:
            yield obstacle.name, obstacle.outline
        for line in self.lines:
            yield line.name, line.points

    def named_lines(self) -> Iterator[WallLine]:
        """The walls that stand free and were given a name of their own."""
        numbered = (wall_name(index) for index in range(len(self.lines)))
        return (line for line, name in zip(self.lines, numbered, strict=True) if line.name != name)

    @cached_property
    def areas(self) -> "tuple[Polygon | None, tuple[Polygon, ...]]":
        """The boundary and the obstacles as areas, for questions of inside and outside."""
        from shapely import Polygon  # seldom asked, and slow to import

        boundary = None if self.boundary is None else Polygon(self.boundary)
        return boundary, tuple(Polygon(obstacle.outline) for obstacle in self.obstacles)

    @cached_property
    def walls(self) -> Walls:
        """All edges, ready for ray casting; built once."""
        return Walls.of(
            dict(self.rings()),
            {line.name: line.points for line in self.lines},
            {one.name: np.append(one.centre, one.radius) for one in self.circles()},
        )
