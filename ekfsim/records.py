"""The two seams: what was asked (Command), what happened (Entry), what the filter made of it
(Step).

A simulation is a log being written, a recording a log already written: both are Entries, and no
filter can tell them apart. Every output is a function of Steps, and none touches a filter. All
records are frozen; arrays carry leading axes (…): none for one run, (N,) for a study of N runs.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.layout import POSE, Layout
from ekfsim.models.protocols import Motion, Sensor
from ekfsim.models.sensors.laser import Sighting


@dataclass(frozen=True, slots=True)
class Move:
    """Drive `distance` m straight ahead, then turn in place by `angle` rad; slipping wheels move
    the robot less.
    """

    distance: float
    angle: float
    slip: float = 0.0  # in [0, 1]


@dataclass(frozen=True, slots=True)
class Sense:
    """Measure the range along `angle` rad from straight ahead, counter-clockwise."""

    angle: float


@dataclass(frozen=True, slots=True)
class Kidnap:
    """Carry the true robot to x, y (m), θ (rad), and tell the filter nothing."""

    x: float
    y: float
    theta: float


@dataclass(frozen=True, slots=True)
class Say:
    """A sentence for the narrative and the picture."""

    text: str


@dataclass(frozen=True, slots=True)
class Repeat:
    """The same commands, `times` times over."""

    times: int
    commands: tuple["Command", ...]


Command = Move | Sense | Kidnap | Say | Repeat
Plain = Move | Sense | Kidnap | Say  # what is left when every Repeat is expanded


def expand(commands: Iterable[Command]) -> Iterator[Plain]:
    """Every command in the order of its execution, with the repetitions written out.

    >>> [c.angle for c in expand([Sense(0.0), Repeat(2, (Sense(1.0),))])]
    [0.0, 1.0, 1.0]
    """
    for command in commands:
        if isinstance(command, Repeat):
            for _ in range(command.times):
                yield from expand(command.commands)
        else:
            yield command


def expanded_length(commands: Iterable[Command]) -> int:
    """How many commands `expand` yields, counted without expanding.

    >>> expanded_length([Repeat(1000, (Repeat(1000, (Sense(0.0),)),))])
    1000000
    """
    return sum(
        c.times * expanded_length(c.commands) if isinstance(c, Repeat) else 1 for c in commands
    )


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


@dataclass(frozen=True)
class Log:
    """A recorded log: what was read of it, in the order of time."""

    entries: tuple[Entry, ...]  # the first is the start
    first: Gaussian  # the belief that the filter begins with


@dataclass(frozen=True, slots=True)
class Nees:
    """The error of a belief, squared and measured by its covariance: eᵀ P⁺ e. Arrays carry leading
    axes (…).
    """

    value: Array  # (…) nan where the belief is impossible
    dof: Integers  # (…) the rank of P
    impossible: Booleans  # (…) the error has a part where P claims certainty


@dataclass(frozen=True, slots=True)
class Step:
    """What the filter made of one entry. Every number of every output is read from here."""

    entry: Entry
    prior: Belief  # the belief the step began with
    posterior: Belief  # the belief it ended with
    prediction: Prediction | None = None  # F and G, after a motion input
    correction: Correction | None = None  # ν, S, H, K, NIS, refused, after a reading
    sighting: Sighting | None = None  # what the laser alone knows
    nees: Nees | None = None  # where the truth is known
    layout: Layout = POSE  # what the entries of its states are
