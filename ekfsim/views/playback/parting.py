"""From which step on filters that watch the same run believe different things."""

from collections import deque
from dataclasses import dataclass, field

from ekfsim.filters import FILTERS
from ekfsim.filters.belief import Gaussian, Refused
from ekfsim.filters.place import forward, label
from ekfsim.records import Step
from ekfsim.student.asked import Answer, Asked
from ekfsim.student.comparing.difference import DIFFERENT, differences, in_sigmas, sizes
from ekfsim.student.comparing.rounding import rounding


@dataclass(frozen=True, slots=True)
class Apart:
    """Two filters, one's own first, and where they part."""

    names: tuple[str, str]  # as people call them
    since: int | None  # index of the entry, from 1; None: up to here they believe the same
    size: float  # σ, of at least 1e-6, by which they differ there

    @property
    def told(self) -> str:
        """In a line."""
        names = " and ".join(self.names)
        if self.since is None:
            return f"{names} do not differ, at no step by a millionth of σ"
        return f"{names} differ from step {self.since} on, there by {in_sigmas(self.size)}"


@dataclass
class Parting:
    """Holds the steps of one filter against those of another, as they come."""

    first: str  # as a scene names them
    other: str
    index: int | None = None  # of the entry at which they part
    size: float = 0.0
    _waiting: deque[Step] = field(default_factory=deque)

    def take(self, step: Step) -> None:
        """A step of the first, which comes before that of the other."""
        if self.index is None:
            self._waiting.append(step)

    def hold(self, step: Step) -> None:
        """The other's step of the same entry."""
        if self.index is None:
            first = self._waiting.popleft()
            size = difference(first, step) if self._first_is_right else difference(step, first)
            if size > 0:
                self.index, self.size = step.entry.index, size

    def until(self, index: int) -> Apart:
        """Whether they have parted up to that entry."""
        own_last = _built_in(self.first) and not _built_in(self.other)
        names = (self.other, self.first) if own_last else (self.first, self.other)
        if self.index is None or self.index > index:
            return Apart((label(names[0]), label(names[1])), None, 0.0)
        return Apart((label(names[0]), label(names[1])), self.index, self.size)

    @property
    def _first_is_right(self) -> bool:
        """Whether the first is what the other is held against: the built-in one of the two."""
        return _built_in(self.first) or not _built_in(self.other)


def difference(right: Step, step: Step) -> float:
    """By how many σ, of at least 1e-6, a step believes something else than the right one; 0 where
    it is no more than rounding.
    """
    ours, theirs = Gaussian(*right.posterior), Answer(*step.posterior)
    in_x, in_P = sizes(theirs, ours, step.layout)
    size = float(max(in_x.max(), in_P.max()))
    made, given = right.correction or right.prediction, right.entry.given
    if size <= DIFFERENT or given is None or made is None:
        return size if size > DIFFERENT else 0.0
    if right.correction is not None and right.correction.refused != Refused.NOT:
        return size
    x, P = right.prior
    asked = Asked(x, P, given)
    found = differences(theirs, ours, rounding(asked, made, ours.covariance), step.layout)
    return max((one.size for one in found), default=0.0)


def _built_in(filter: str) -> bool:
    return forward(filter) in FILTERS
