"""Whether a filter that began with particles all over the floor has an idea by now where it is."""

import numpy as np

from ekfsim.filters.belief import Belief, Particles, posed
from ekfsim.models.layout import Layout

SHARE = 0.25  # of the area over which no idea at all spreads; crowds that spread over less gather


class Unplaced:
    """Follows the beliefs of one run. Mean and covariance of a crowd that may be anywhere tell no
    place: the mean lies in the middle of the room, and the ellipse is larger than it.
    """

    def __init__(self, first: Belief, layout: Layout) -> None:
        """first : what the run begins with; a crowd only where the start is unknown"""
        self._layout = layout
        self._floor = _area(first, layout) if isinstance(first, Particles) else None

    def at(self, belief: Belief) -> bool:
        """Whether it tells no place."""
        return self._floor is not None and _area(belief, self._layout) >= SHARE * self._floor


def _area(belief: Belief, layout: Layout) -> float:
    """√|P| of the position, in m²: the area of an ellipse is a multiple of it."""
    P = posed(belief, layout).covariance[:2, :2]
    return float(np.sqrt(max(np.linalg.det(P), 0.0)))
