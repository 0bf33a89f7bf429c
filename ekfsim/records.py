"""The two seams: what happened (Entry), and what the filter made of it (Step).

A simulation is a log being written, a recording a log already written: both are Entries, and no
filter can tell them apart. Every output is a function of Steps, and none touches a filter. All
records are frozen; arrays carry leading axes (…): none for one run, (N,) for a study of N runs.
"""

import math
from dataclasses import dataclass, field
from typing import Protocol

from ekfsim.commands import Move, Plain, Sense
from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.layout import POSE, Layout
from ekfsim.models.protocols import Motion, Sensor
from ekfsim.shown import Shown


@dataclass(frozen=True, slots=True)
class Control:
    """A motion input as the filter is given it. u : (…, m) in the motion's units."""

    motion: Motion
    u: Array


@dataclass(frozen=True, slots=True)
class Reading:
    """The reading of one sensor. z : (…, k) in the sensor's units, nan where it met nothing."""

    sensor: Sensor
    z: Array
    name: str = "laser"  # which sensor it is: "marker 3", "gnss"


@dataclass(frozen=True, slots=True)
class Entry:
    """What happened at one command or instant.

    index counts from 1 in the order of the log; 0 is the start, where nothing has happened yet.
    """

    index: int
    given: Control | Reading | None  # what the filter is given; None where it is told nothing
    truth: Array | None = None  # (…, 3) true pose after it, where it is known
    # what was asked for; None at the start, in drives and in recorded logs
    command: Plain | None = None
    bump: Integers | None = None  # (…) the true wall that cut a move short, −1 where none did
    t: float | None = None  # s, in drives and recorded logs
    judged: bool = True  # whether errors are counted at this instant
    # (…, 2) m, a position that was recorded and that the filter is not given
    fix: Array | None = None


def called(entry: Entry) -> str:
    """Which step an entry is, for a person: its number, and its command or its instant.

    >>> called(Entry(7, None, command=Sense(math.pi / 2)))
    'step 7 (sense 90°)'
    >>> called(Entry(7, None, command=Move(1.75, math.pi / 2)))
    'step 7 (move 1.75 m, 90°)'
    """
    match entry.command, entry.given:
        case Move(distance, angle), _:
            told = f" (move {distance:.6g} m, {math.degrees(angle):.6g}°)"
        case Sense(angle), _:
            told = f" (sense {math.degrees(angle):.6g}°)"
        case _, Reading(_, _, name) if entry.t is not None:
            told = f" ({name} at {entry.t:.6f}".rstrip("0").rstrip(".") + " s)"
        case _, Control() if entry.t is not None:
            told = f" (motion at {entry.t:.6f}".rstrip("0").rstrip(".") + " s)"
        case _:
            told = ""
    return f"step {entry.index}{told}"


@dataclass(frozen=True)
class Log:
    """A recorded log: what was read of it, in the order of time."""

    entries: tuple[Entry, ...]  # the first is the start
    first: Gaussian  # the belief that the filter begins with
    start_known: bool = True  # whether the truth tells where that is
    # where it was read from; what `replace` makes of it was not, and has none
    given: object = field(default=None, init=False, compare=False, repr=False)


@dataclass(frozen=True, slots=True)
class Nees:
    """The squared error of a belief by its covariance: eᵀ P⁺ e. Arrays carry leading axes (…)."""

    value: Array  # (…) nan where the belief is impossible
    dof: Integers  # (…) the rank of P
    impossible: Booleans  # (…) the error has a part where P claims certainty


class Remark(Protocol):
    """What is to be said of a reading before it is used.

    What else there is to it, only who made it and who tells it know.
    """

    @property
    def ambiguous(self) -> Booleans:
        """(…) from poses that the filter holds possible, something else would be read."""


@dataclass(frozen=True, slots=True, repr=False)
class Step(Shown):
    """What the filter made of one entry. Every number of every output is read from here."""

    entry: Entry
    prior: Belief  # the belief the step began with
    posterior: Belief  # the belief it ended with
    prediction: Prediction | None = None  # F and G, after a motion input
    correction: Correction | None = None  # ν, S, H, K, NIS, refused, after a reading
    remark: Remark | None = None  # where there is more to say of the reading
    nees: Nees | None = None  # where the truth is known
    layout: Layout = POSE  # what the entries of its states are
    # the Scene that it was played in, where a notebook is to show it
    scene: object = field(default=None, compare=False)

    def __repr__(self) -> str:
        x = self.posterior.mean
        if x.ndim > 1:
            return f"Step({called(self.entry)}, {len(x)} runs)"
        states = zip(self.layout.names, x.tolist(), strict=True)
        return f"Step({called(self.entry)}: {', '.join(f'{n} {v:.6g}' for n, v in states)})"
