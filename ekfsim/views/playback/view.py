"""One view: what is on the screen after so many presses of `n`."""

from dataclasses import dataclass, field

import numpy as np

from ekfsim.diagnostics.verdict import Evidence
from ekfsim.filters.belief import Belief, Gaussian, posed
from ekfsim.geometry import Array
from ekfsim.models.layout import Layout
from ekfsim.records import Nees, Step
from ekfsim.shown import Shown
from ekfsim.views.playback.parting import Apart
from ekfsim.views.playback.trail import Way


@dataclass(frozen=True, slots=True)
class Judged:
    """What is known of the run by now: of the belief that the view shows, not of a later one."""

    nees: Nees | None = None  # of that belief; None where no truth is known
    # index of the step since which the run is lost without a gap up to here; None: it is not lost
    lost_from: int | None = None
    closing: Evidence | None = None  # of the whole run, in its last view alone


@dataclass(frozen=True, slots=True, repr=False)
class View(Shown):
    """What is on the screen after so many presses of `n`.
    View 0 is the world before anything happens.

    A reading has two: first the beam, while the estimate is still the old one, then the revised
    estimate without it. The motion inputs of a driven or recorded robot that follow each other
    share one, and its step is the last of them.
    """

    number: int
    step: Step
    beam: bool = False
    settled: Way = field(default_factory=Way)  # the estimated positions before this view's own
    true: Way = field(default_factory=Way)  # where the robot truly was, up to now
    reckoned: Way = field(default_factory=Way)  # where it would be by its odometry alone, up to now
    judged: Judged = Judged()
    inputs: int = 1  # how many steps the view gathers
    # the belief before the first of them, where more than one may be gathered
    before: Belief | None = None
    since: float | None = None  # s, the instant of the first of the steps, as stamped
    start: float = 0.0  # s, the stamp of the start
    # m, that a close-up is wide; 0 where all is certain; None in a view that is of no run
    across: float | None = None
    # whether what is shown, and what was believed before, tells no place: diagnostics/unplaced.py
    unplaced: bool = False
    was_unplaced: bool = False
    others: tuple["View", ...] = ()  # the same view as other filters have it, that watch beside
    apart: tuple[Apart, ...] = ()  # of each of them: whether it believes something else

    def __repr__(self) -> str:
        what = "the beam" if self.beam else "as it ended"
        return f"View({self.number}: {what}, of {self.step!r})"

    @property
    def belief(self) -> Belief:
        """The belief that is shown: the prior while the beam is, the posterior after."""
        return self.step.prior if self.beam else self.step.posterior

    @property
    def layout(self) -> Layout:
        """What the entries of the estimated state are."""
        return self.step.layout

    @property
    def pose(self) -> Gaussian:
        """What that belief says of the pose, which is drawn : (3,), (3, 3)"""
        return posed(self.belief, self.layout)

    @property
    def earlier(self) -> Gaussian | None:
        """What was believed of the pose before its steps, where the view shows something else, and
        where both tell a place.
        """
        before = self.step.prior if self.before is None else self.before
        if self.beam or before is self.belief or self.unplaced or self.was_unplaced:
            return None
        was, now = posed(before, self.layout), self.pose
        return None if all(map(np.array_equal, was, now)) else was

    @property
    def span(self) -> tuple[float, float] | None:
        """The first and the last instant of its steps, in s since the start;
        None where there is no clock.
        """
        last = self.step.entry.t
        return (
            None
            if last is None
            else ((last if self.since is None else self.since) - self.start, last - self.start)
        )

    def named(self, digits: int = 4) -> str:
        """What the file of its picture is called; the beam of a reading comes before its step."""
        return f"step-{self.step.entry.index:0{digits}}" + ("-beam" if self.beam else "")

    def path(self) -> Array:
        """All estimated positions from the start to the one that is drawn : (n, 2) m"""
        if self.unplaced:
            return self.settled.points()
        return np.vstack([self.settled.points(), self.layout.pose(self.belief.mean)[:2]])
