"""What happens at a step that its curves alone do not tell."""

from collections.abc import Iterator
from enum import Enum
from typing import NamedTuple

from ekfsim.commands import Kidnap, Say
from ekfsim.filters.belief import Refused
from ekfsim.records import Step


class Happened(Enum):
    """The kinds of events. The value is what a legend calls it."""

    KIDNAP = "kidnapped"
    BUMP = "bumped into a wall"
    AMBIGUOUS = "ambiguous, and used"
    NO_ECHO = "no echo"
    NO_WALL = "refused: no wall expected"
    GUARD = "left out by the guard"
    GATE = "refused by the gate"
    SAY = "say"


REFUSALS = {
    Refused.NO_ECHO: Happened.NO_ECHO,
    Refused.NO_WALL: Happened.NO_WALL,
    Refused.GUARD: Happened.GUARD,
    Refused.GATE: Happened.GATE,
}


class Event(NamedTuple):
    """Something that happened at a step."""

    row: int  # of the series
    happened: Happened
    text: str = ""  # of a say


def events(step: Step, row: int) -> Iterator[Event]:
    """What happened at a step: nothing, or one thing, or several."""
    match step.entry.command:
        case Kidnap():
            yield Event(row, Happened.KIDNAP)
        case Say(text):
            yield Event(row, Happened.SAY, text)
    if step.entry.bump is not None and int(step.entry.bump) >= 0:
        yield Event(row, Happened.BUMP)
    if step.correction is None:
        return
    refused = Refused(int(step.correction.refused))
    if refused:
        yield Event(row, REFUSALS[refused])
    elif step.remark is not None and step.remark.ambiguous:
        yield Event(row, Happened.AMBIGUOUS)
