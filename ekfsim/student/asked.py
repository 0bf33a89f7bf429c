"""One call of a filter: what it is asked, from which belief; and who answers."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple, Protocol, Self

from ekfsim.commands import Plain
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array
from ekfsim.records import Control, Entry, Reading, called


@dataclass(frozen=True, slots=True)
class Asked:
    """What one robot's filter is asked at one entry, and the belief that it is asked from."""

    x: Array  # (n,) the belief's mean, headings in (−π, π]
    P: Array  # (n, n)
    given: Control | Reading  # the motion with its input u, or the sensor with its reading z
    headings: tuple[int, ...] = (2,)  # which entries of the state are headings
    command: Plain | None = None  # what was asked of the robot; a filter is never told
    index: int = 0  # of the entry, from 1; 0 at the start, where only the belief is asked for
    earlier: "Asked | None" = None  # the call before, of the same run: `as_earlier`
    t: float | None = None  # s, in drives and recorded logs

    @classmethod
    def at(
        cls, entry: Entry, belief: Gaussian, headings: tuple[int, ...], earlier: "Asked | None"
    ) -> Self:
        """What is asked at an entry at which something is given."""
        assert entry.given is not None
        return cls(*belief, entry.given, headings, entry.command, entry.index, earlier, entry.t)

    def as_earlier(self) -> "Asked":
        """What the next call looks back at: what was asked, and before it what readings followed
        one another, as far as the motion that led there.
        """
        return replace(self, earlier=self.earlier if isinstance(self.given, Reading) else None)

    @property
    def step(self) -> str:
        """At which step it is, as people are told: step 7 (sense 90°)."""
        if self.index == 0:
            return "the start"
        return called(Entry(self.index, self.given, command=self.command, t=self.t))


class Answer(NamedTuple):
    """What came back of one call, as it came: of the right shapes and finite, not yet judged."""

    x: Array  # (n,) headings not yet wrapped
    P: Array  # (n, n) perhaps not symmetric


class Caller(Protocol):
    """Calls the code of one student for one run after another, here or in a process of its own.

    Raises fault.FaultError where no `Answer` comes of it.
    """

    def begin(self, x: Array, P: Array) -> Answer | None:
        """A run begins with this belief; whatever the code kept of an earlier run is forgotten.

        What it believes then, where it keeps a belief of its own.
        """

    def call(self, asked: Asked) -> Answer:
        """What the code makes of a motion input or a reading."""

    def place_of(self, given: Control | Reading) -> str:
        """file:line of the code that answers to it, where what came back of it is wrong."""


Calls = Sequence[tuple[Caller, Asked]]  # of runs side by side
Together = Callable[[Calls], Iterator[Answer]]


def one_by_one(calls: Calls) -> Iterator[Answer]:
    """What comes of each call in turn. Raises FaultError where one fails."""
    for caller, asked in calls:
        yield caller.call(asked)
