"""How much of the plane a close-up of the estimate shows, from step to step."""

import math

from ekfsim.filters.belief import Belief, posed
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import ellipse
from ekfsim.models.layout import Layout
from ekfsim.records import Step

PROBABILITY = 0.954  # of the ellipse that it is measured by
ROOM = 2.6  # major radii from side to side
REACH = 3.0  # major radii from the estimate up to which it widens to hold the truth
SLACK = 1.6  # it becomes narrower only where that leaves so many times as much room as is needed


class Zoom:
    """Chooses a width for each step of a run, in their order: 1, 2 or 5 times a power of ten.

    A step has one width, which holds the ellipses before and after it, so that what it did to them
    is seen. It depends on the steps up to this one, whichever way a view is reached.
    """

    def __init__(self) -> None:
        self._width = 0.0

    def take(self, before: Belief, step: Step) -> float:
        """The width at a step, in m; 0 where all is certain. before : the belief that it began
        with
        """
        truth = step.entry.truth
        there = truth if step.correction is not None else None  # a motion begins elsewhere
        needed = ROOM * max(
            _radius(before, step.layout, there), _radius(step.posterior, step.layout, truth)
        )
        if needed == 0:
            self._width = 0.0
        elif needed > self._width:
            self._width = one_two_five(needed)
        else:
            self._width = min(self._width, one_two_five(SLACK * needed))
        return self._width


def one_two_five(least: float) -> float:
    """The smallest 1, 2 or 5 times a power of ten that is not less.

    >>> one_two_five(0.03), one_two_five(0.5), one_two_five(7)
    (0.05, 0.5, 10.0)
    """
    power = math.floor(math.log10(least))
    return next(v for digit in (1, 2, 5, 10, 20) if (v := float(f"{digit}e{power}")) >= least)


def _radius(belief: Belief, layout: Layout, truth: Array | None) -> float:
    """How far around an estimate there is something to see, in m: its ellipse, and the truth where
    that is not far.
    """
    x, P = posed(belief, layout)
    radius = float(ellipse(P, PROBABILITY).major)
    if not math.isfinite(radius):
        return 0.0
    error = 0.0 if truth is None else math.hypot(*(truth[:2] - x[:2]).tolist())
    return max(radius, error) if error <= REACH * radius else radius
