"""A rectangle of the plane: what a picture shows of it."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from ekfsim.geometry import Array

LEAST = 1e-3  # m; a world of one point is still this wide


@dataclass(frozen=True, slots=True)
class Limits:
    """A rectangle with its sides along the axes. All in m."""

    left: float
    bottom: float
    right: float
    top: float

    @classmethod
    def around(cls, points: Array) -> Self:
        """The smallest that holds all the finite ones of (n, 2) points;
        the unit square where there is none.
        """
        finite = points[np.isfinite(points).all(axis=-1)]
        if len(finite) == 0:
            return cls(0.0, 0.0, 1.0, 1.0)
        left, bottom = finite.min(axis=0).tolist()
        right, top = finite.max(axis=0).tolist()
        return cls(left, bottom, right, top)

    @property
    def width(self) -> float:
        """From left to right."""
        return self.right - self.left

    @property
    def height(self) -> float:
        """From bottom to top."""
        return self.top - self.bottom

    @property
    def size(self) -> float:
        """The longer side: what the robot's body and the cone are measured by."""
        return max(self.width, self.height, LEAST)

    @property
    def shape(self) -> float:
        """The width by the height."""
        return self.width / self.height

    def joined(self, other: "Limits") -> "Limits":
        """The smallest rectangle that holds both."""
        return Limits(
            min(self.left, other.left),
            min(self.bottom, other.bottom),
            max(self.right, other.right),
            max(self.top, other.top),
        )

    def meets(self, other: "Limits") -> bool:
        """Whether the two have a point in common."""
        return (
            self.left <= other.right
            and other.left <= self.right
            and self.bottom <= other.top
            and other.bottom <= self.top
        )

    def cut(self, other: "Limits") -> "Limits":
        """The part of this rectangle inside the other; they must meet."""
        return Limits(
            max(self.left, other.left),
            max(self.bottom, other.bottom),
            min(self.right, other.right),
            min(self.top, other.top),
        )

    def grown(self, by: float) -> "Limits":
        """With `by` m more on every side."""
        return Limits(self.left - by, self.bottom - by, self.right + by, self.top + by)

    def shaped(self, aspect: float) -> "Limits":
        """Grown to the shape of a box whose width is `aspect` times its height,
        about the same centre.
        """
        width, height = (
            max(self.width, self.height * aspect, LEAST),
            max(self.height, self.width / aspect, LEAST / aspect),
        )
        x, y = (self.left + self.right) / 2, (self.bottom + self.top) / 2
        return Limits(x - width / 2, y - height / 2, x + width / 2, y + height / 2)

    def hold(self, points: Array) -> bool:
        """Whether all finite ones of (n, 2) points lie inside."""
        around = Limits.around(points)
        return not np.isfinite(points).all(axis=-1).any() or self.joined(around) == self
