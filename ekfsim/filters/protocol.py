"""What every filter offers: two pure functions, and how it begins."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction
from ekfsim.filters.tuning import UNTUNED, Tuning
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.protocols import Motion, Sensor

if TYPE_CHECKING:
    from numpy.random import Generator


@dataclass(frozen=True)
class Beginning:
    """What a filter is told when a run begins. Most need no more than the gate and the headings."""

    first: Gaussian  # the first belief: (…, n), (…, n, n)
    headings: tuple[int, ...] = (2,)  # which entries of the state are headings, kept in (−π, π]
    # probability; a reading whose NIS lies beyond that χ² quantile is refused
    gate: float | None = None
    # one for each run, from the run's seed and number
    generators: Callable[[], Sequence["Generator"]] | None = None
    tuning: Tuning = UNTUNED  # the numbers that this filter alone may have
    # where the state would be by plan : (T + 1, n); None: no plan is known
    nominal: Callable[[], Array] | None = None
    # poses from all places where a robot can stand, as states: (generator, number) → (p, n); None:
    # no map tells where that is
    anywhere: "Callable[[Generator, int], Array] | None" = None
    # so many of them : (p, n), the same for all runs of a seed; None as above
    places: Callable[[int], Array] | None = None
    runs: Integers | None = None  # (N,) the numbers of runs side by side; None of one alone
    pose: tuple[int, int, int] = (0, 1, 2)  # which entries of the state are x, y and θ


class Filter(Protocol):
    """A filter holds its settings and nothing else; beliefs go in and come out."""

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Belief, Prediction]:
        """The belief after a motion input u : (…, m)."""

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Belief, Correction]:
        """The belief after a reading z : (…, k). Where skip : (…) is set the reading is judged but
        not used.
        """


class Kind(Protocol):
    """What filters of one kind have in common, a class of them as a rule; FILTERS holds those that
    are built in.
    """

    @property
    def remark(self) -> str:
        """What a reader of their results should know, without a full stop; "" if nothing."""

    def begin(self, beginning: Beginning) -> Filter:
        """A filter of the kind for a run that begins so; of a class, a classmethod."""
