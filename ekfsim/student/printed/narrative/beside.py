"""The steps of a narrative beside those of a run: which are which, and what was measured and
predicted in them.
"""

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from ekfsim.commands import Move, Sense
from ekfsim.filters.belief import Correction, Gaussian
from ekfsim.filters.protocol import Filter
from ekfsim.geometry import Array
from ekfsim.records import Control, Entry, Reading
from ekfsim.student.printed.digits import Halves
from ekfsim.student.printed.narrative.hanging import (
    COMMANDED,
    RADIAN,
    Due,
    Numbers,
    Printed,
    finite,
    turned,
)
from ekfsim.student.printed.narrative.numbers import Check, Formula, Guess
from ekfsim.student.printed.narrative.reading import Block, Narrative, Number
from ekfsim.student.printed.table import Row

ALIKE = 1e-6  # m, degrees; commands that differ by less are one
HEADING = 2  # its place in the state
MEASURED = 1e-4  # m, degrees; what was measured is told to so much


@dataclass(frozen=True)
class Beside:
    """The steps of a narrative that are those of a run."""

    entries: tuple[tuple[Block, Entry], ...]  # those whose commands are
    same_run: bool  # whether what was measured in them is that of the run, too
    stranger: Block | None  # the first whose command is another


class Corrections:
    """What the reference makes of a reading, from a belief : state (3) in m and degrees, P (9)."""

    def __init__(self, given: Reading, reference: Filter) -> None:
        self._given, self._reference = given, reference
        self._made = dict[bytes, Correction]()

    def __call__(self, numbers: Array) -> Correction:
        """What it makes of the reading; asked again, it knows."""
        key = numbers.tobytes()
        if key not in self._made:
            x, P = numbers[:3] * np.array([1.0, 1.0, RADIAN]), numbers[3:12].reshape(3, 3)
            prior = Gaussian(x, (P + P.T) / 2)
            given = self._given
            self._made[key] = self._reference.update(prior, given.sensor, given.z)[1]
        return self._made[key]


def beside(told: Narrative, given: Sequence[Entry]) -> Beside:
    """The steps from the first on, as long as their commands agree.

    given : the moves and beams of the run
    """
    steps = [block for block in told.blocks if block.kind in ("move", "sense")]
    pairs = list[tuple[Block, Entry]]()
    stranger = None
    for n, block in enumerate(steps):
        if n == len(given) or not _is_of(block, given[n]):
            stranger = block
            break
        pairs.append((block, given[n]))
    votes = [vote for block, entry in pairs for vote in _votes(block, entry)]
    return Beside(tuple(pairs), bool(votes) and sum(votes) * 2 >= len(votes), stranger)


def rows_of(pairs: Sequence[tuple[Block, Entry]], start: Block | None) -> dict[int, Row]:
    """The beliefs that are printed, by the index of their entry."""
    rows = {}
    first = [] if start is None else [(start, "first", 0)]
    after = [
        (block, "new" if block.kind == "move" else "revised", entry.index) for block, entry in pairs
    ]
    for block, which, index in (*first, *after):
        state, P = block.facts.get(f"{which} state"), block.facts.get(f"{which} covariance")
        if state is not None and P is not None and finite((*state, *P)):
            values, halves = _numbers(state, P)
            rows[index] = Row(state[0].line, values.mean, values.covariance, halves)
    return rows


def measured(block: Block, entry: Entry) -> Iterator[Due]:
    """The odometry, or the range, beside those of the run."""
    numbers = tuple(Number(value, 0.0, 0) for value in _measured_in(entry))
    odometry, ranged = block.facts.get("odometry"), block.facts.get("range")
    if isinstance(entry.given, Control) and odometry is not None:
        command = entry.command if isinstance(entry.command, Move) else None
        commanded = () if command is None else (command.distance, command.angle / RADIAN)
        for i, name in enumerate(("distance", "angle")):
            guesses: tuple[Guess, ...] = ()
            if commanded:
                guesses = ((COMMANDED, _always(commanded[i])),)
            check = Check(
                f"the {name} of the odometry", odometry[i], _nth(i), ("m", "degrees")[i], guesses,
                read="section 3: u is what the odometry measured",
            )  # fmt: skip
            yield check, numbers
    if isinstance(entry.given, Reading) and ranged is not None and not math.isnan(_first(numbers)):
        yield Check("the range", ranged[0], _nth(0), "m", least=ALIKE), numbers


def predicted(block: Block, entry: Entry, before: Printed, reference: Filter) -> Iterator[Due]:
    """The predicted range, the derivatives and what follows of them, in the map as it is told."""
    if before.state is None or before.P is None or not isinstance(entry.given, Reading):
        return
    numbers: Numbers = (*before.state, *before.P)
    if not finite(numbers):
        return
    made = Corrections(entry.given, reference)
    facts = block.facts
    if (ranged := facts.get("predicted range")) is not None:
        z = float(entry.given.z[0])
        guesses = (("this is the range that was measured", _always(z)),)
        yield Check(
            "the predicted range", ranged[0], lambda n: float(made(n).predicted[0]), "m", guesses,
            read="eq 8: from the estimate, in the map, to the first wall",
        ), numbers  # fmt: skip
    for i, printed in enumerate(facts.get("derivatives", ())):
        name = ("dh/dx", "dh/dy", "dh/dth")[i]
        yield Check(
            name, printed, _slope(made, i), ("", "", "m")[i], _of_slope(made, i), least=1e-9,
            read="eq 11: J_H is the slope of the predicted range",
        ), numbers  # fmt: skip
    for name, value in (
        ("C_v", lambda c: c.R[0, 0]), ("S", lambda c: c.S[0, 0]),
        ("deviation", lambda c: math.sqrt(max(c.S[0, 0], 0.0))),
    ):  # fmt: skip
        for printed in facts.get(name, ()):
            told = "the standard deviation of the innovation" if name == "deviation" else name
            yield Check(told, printed, _of_correction(made, value), read="eq 11"), numbers
    for i, printed in enumerate(facts.get("gain", ())):
        yield Check(
            f"the gain of {'xyθ'[i]}", printed, _of_correction(made, _gain(i)), least=1e-9,
            read="eq 11: P J_H' S^-1",
        ), numbers  # fmt: skip


def _is_of(block: Block, entry: Entry) -> bool:
    """Whether a step has the command of an entry, as far as both are known."""
    if (block.kind == "move") != isinstance(entry.given, Control):
        return False
    match entry.command:
        case Move(distance, angle) if (told := block.facts.get("commanded")) is not None:
            return _near(told[0], distance) and _near(told[1], angle / RADIAN)
        case Sense(angle) if (told := block.facts.get("bearing")) is not None:
            return abs(turned(told[0].value - angle / RADIAN)) <= told[0].half + ALIKE
    return True


def _near(printed: Number, value: float) -> bool:
    return abs(printed.value - value) <= printed.half + ALIKE


def _votes(block: Block, entry: Entry) -> Iterator[bool]:
    """For each number that was measured, whether it is that of the run. What the odometry measured
    shows in the new state as well; where that is as commanded, it says nothing.
    """
    values = _measured_in(entry)
    if block.kind == "sense":
        for printed in block.facts.get("range", ()):
            yield abs(printed.value - values[0]) <= printed.half + MEASURED
        return
    told = block.facts.get("odometry")
    shown = _driven_way(block) if told is None else [one.value for one in told]
    if len(shown) < 2:
        return
    fits = all(abs(a - b) <= MEASURED * 10 for a, b in zip(shown, values, strict=True))
    if not fits and isinstance(entry.command, Move):
        command = entry.command.distance, entry.command.angle / RADIAN
        if all(abs(a - b) <= MEASURED * 10 for a, b in zip(shown, command, strict=True)):
            return
    yield fits


def _driven_way(block: Block) -> list[float]:
    """What the states before and after a move tell of the odometry: m, degrees."""
    before, after = block.facts.get("current state"), block.facts.get("new state")
    if before is None or after is None:
        return []
    x, y = (after[i].value - before[i].value for i in (0, 1))
    θ = before[2].value * RADIAN
    turn = turned(after[2].value - before[2].value)
    return [x * math.cos(θ) + y * math.sin(θ), turn]


def _measured_in(entry: Entry) -> tuple[float, ...]:
    """d in m and a in degrees, or a range in m."""
    match entry.given:
        case Control(_, u):
            d, a = u.tolist()
            return d, a / RADIAN
        case Reading(_, z):
            return (float(z[0]),)
    raise AssertionError(entry)


def _first(numbers: Numbers) -> float:
    return numbers[0].value


def _numbers(state: Numbers, P: Numbers) -> tuple[Gaussian, Halves]:
    """A printed belief in m and rad."""
    scale = np.array([1.0, 1.0, RADIAN])
    x, half = (np.array([getattr(one, name) for one in state]) for name in ("value", "half"))
    spread, halves = (
        np.array([getattr(one, name) for one in P]).reshape(3, 3) for name in ("value", "half")
    )
    return Gaussian(x * scale, spread), Halves(half * scale, halves)


def _always(value: float) -> Formula:
    return lambda n: value


def _nth(i: int) -> Formula:
    return lambda n: float(n[i])


def _of_correction(made: Corrections, value: Callable[[Correction], float]) -> Formula:
    return lambda n: float(value(made(n)))


def _gain(i: int) -> Callable[[Correction], float]:
    return lambda c: float(c.K[i, 0])


def _slope(made: Corrections, i: int) -> Formula:
    return lambda n: float(made(n).H[0, i])


def _of_slope(made: Corrections, i: int) -> tuple[Guess, ...]:
    """What else may stand in the place of a derivative."""
    slope = _slope(made, i)
    if i < HEADING:
        return (
            ("its sign is wrong", lambda n: -slope(n)),
            ("dh/dx and dh/dy are exchanged", _slope(made, 1 - i)),
        )
    return (
        ("its sign is wrong", lambda n: -slope(n)),
        ("it is per degree, and P is in radians", lambda n: RADIAN * slope(n)),
        ("the range is missing in it", lambda n: slope(n) / float(made(n).predicted[0])),
        ("it is left out", _always(0.0)),
    )
