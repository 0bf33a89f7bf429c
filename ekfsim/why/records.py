"""What is put right in a run, what came of it, and what that explains."""

import functools
from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from enum import Enum
from typing import Literal

from ekfsim.records import Entry, Step
from ekfsim.scene import Scene
from ekfsim.shown import Shown

Kind = Literal[
    "noise",  # a told number of the noise made true
    "number",  # any other number that is told of a robot or an instrument
    "start",  # the told start
    "sigma",  # how sure the filter is told to be of it
    "map",  # something of the told map
    "fault",  # a fault taken out
    "beams",  # a class of beams left out, or their noise made true
    "wall",  # no beam is predicted to meet another wall than it does
    "linear",  # nothing is made linear
    "reading",  # one reading left out
    "guess",  # of a recorded log: another noise, a bias, a scale or a clock put right by so much
    "move",  # one move made exact: the filter is given what truly happened
]
Outcome = Literal["consistent", "lost", "over-cautious", "over-confident", "recorded"]


# how many of how many are done, and of what
Heard = Callable[[int, int, str], None]
REPLAYS = "replays"


class Mechanism(Enum):
    """What makes a filter diverge. The value is its plain name."""

    WRONG_WALL = "wrong wall"
    ODOMETRY_OVERTRUSTED = "odometry overtrusted"
    ODOMETRY_DISTRUSTED = "odometry distrusted"
    LASER_OVERTRUSTED = "laser overtrusted"
    LASER_DISTRUSTED = "laser distrusted"
    WHEEL_SCALE = "wheel scale"
    TURN_SCALE = "turn scale"
    SLIP = "slip"
    KIDNAP = "kidnap"
    RANGE_BIAS = "range bias"
    RANGE_SCALE = "range scale"
    MISPLACED_WALL = "wrong map"
    SHEARED_MAP = "sheared map"
    LOOK_ALIKE_WALLS = "look-alike walls"
    HEADING_SPREAD = "heading spread"
    LINEARISED_ELSEWHERE = "linearised elsewhere"  # of filters that do so about another belief
    GRAZING_BEAMS = "grazing beams"
    WRONG_START = "wrong start"
    REPEATED_READINGS = "repeated readings"
    SHORT_RETURNS = "short returns"
    CLOSE_TO_THE_WALL = "close to the wall"
    # of robots that are driven
    SENSOR_OVERTRUSTED = "sensor overtrusted"
    SENSOR_DISTRUSTED = "sensor distrusted"
    SENSOR_BIAS = "sensor bias"
    OUTLIERS = "outliers"
    MISPLACED_LANDMARK = "misplaced landmark"
    LATE_READINGS = "late readings"
    MOTION_BIAS = "motion bias"
    WRONG_ROBOT = "wrong numbers of the robot"
    WRONG_SENSOR = "wrong numbers of a sensor"
    WRONG_EQUATIONS = "wrong equations"
    CHANCE = "chance"  # nothing: by its own bound one run in so many is beyond it
    NO_DIRECTION_SEEN = "no direction is seen"  # of a run that did not diverge


def as_it_is(scene: Scene) -> Scene:
    """The same scene."""
    return scene


def as_they_are(entries: Iterable[Entry]) -> Iterable[Entry]:
    """The same entries."""
    return entries


@dataclass(frozen=True)
class Change:
    """One thing put right or left out, all draws being the same."""

    kind: Kind
    name: str  # a noun phrase: "the told rangeSigmaRatio", "the beam of step 13"
    told: str = ""  # what was put right: "0.01 told, 0.02 true"
    step: int | None = None  # of one reading or move
    of_scene: Callable[[Scene], Scene] = field(default=as_it_is, compare=False, repr=False)
    of_entries: Callable[[Iterable[Entry]], Iterable[Entry]] = field(
        default=as_they_are, compare=False, repr=False
    )


@dataclass(frozen=True)
class Tried:
    """A change made alone, and how the run ends with it."""

    change: Change
    cures: bool
    nees_end: float  # nan where the belief is impossible
    lost_from: int | None  # None where it is not lost
    outcome: Outcome = "consistent"


@dataclass(frozen=True)
class Shares:
    """Of how many of the same runs something holds, as they stand and with a change: as a share,
    and the 95 % interval of its difference (Newcombe 1998, method 10). Without a change the
    interval is that of the share (Wilson).
    """

    runs: int
    lost: float  # as they stand
    lost_with: float  # with the change
    low: float  # of lost_with − lost
    high: float
    change: Change | None  # as a rule of a whole class: "such beams left out"
    of: Outcome = "lost"  # what is counted


@dataclass(frozen=True, repr=False)
class Explanation(Shown):
    """Why a run ended as it did, with the evidence."""

    scene: Scene
    outcome: Outcome
    lost_from: int | None
    tried: tuple[Tried, ...] = ()
    cure: tuple[Change, ...] = ()  # the smallest set that was found; () where there is none
    others: tuple[Change, ...] = ()  # other single changes that cure as well
    parts_at: int | None = None  # the first step at which the lost and the cured run part
    mechanism: Mechanism | None = None  # None: not found, or more than one
    causes: tuple[Mechanism, ...] = ()  # each of them, where the cure needs more than one
    replays: int = 0
    budget: int = 0
    shares: Shares | None = None
    lost_steps: tuple[Step, ...] = ()  # of the run as it stands, whatever became of it
    cured_steps: tuple[Step, ...] = ()
    stopped: bool = False  # by Ctrl-C, before all was tried

    def __repr__(self) -> str:
        named = "nothing to explain" if self.outcome == "consistent" else "not found"
        if self.mechanism is not None:
            named = self.mechanism.value
        return f"Explanation({self.outcome}: {named}, {self.replays} replays)"


def together(name: str, changes: tuple[Change, ...]) -> Change:
    """Several changes as one; one alone is itself."""
    if len(changes) == 1:
        return changes[0]

    def of_scene(scene: Scene) -> Scene:
        return functools.reduce(lambda so_far, one: one.of_scene(so_far), changes, scene)

    def of_entries(entries: Iterable[Entry]) -> Iterable[Entry]:
        return functools.reduce(lambda so_far, one: one.of_entries(so_far), changes, entries)

    said = "; ".join(f"{one.name}: {one.told}" for one in changes)
    return Change(changes[0].kind, name, said, None, of_scene, of_entries)
