"""Groups of readings left out and stretches of motion made exact, many side by side: of a run that
has thousands of each no single one tells much.
"""

import itertools
from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ekfsim.diagnostics.innovations import named
from ekfsim.geometry import Array, Integers
from ekfsim.geometry.angles import wrap
from ekfsim.records import Control, Entry, Reading, Step
from ekfsim.systems.robot import Robot, Tick
from ekfsim.why.changes.beams import left_out
from ekfsim.why.changes.singles import spread_out
from ekfsim.why.records import Change

STRETCHES = 8  # of a run
FEW = 3  # readings of a target; rarer ones are not asked by themselves


@dataclass(frozen=True)
class Group:
    """Some entries of a run, and what becomes of them."""

    change: Change
    at: frozenset[int]  # their indexes


class Inputs(NamedTuple):
    """Motion inputs by the index of their entry, as they would be without noise."""

    of: Mapping[int, Array]


def groups_of(steps: Sequence[Step], robot: Robot | None) -> list[Group]:
    """Each sensor and each target left out, and each of eight stretches: its readings left out, its
    motion made exact where the truth and the robot are known.
    """
    entries = [step.entry for step in steps]
    sensors, targets = Counter[str](), Counter[str]()
    at_sensor: dict[str, set[int]] = {}
    at_target: dict[str, set[int]] = {}
    for entry in entries:
        if isinstance(entry.given, Reading):
            sensor, target = named(entry.given)
            for counter, held, name in (
                (sensors, at_sensor, sensor), (targets, at_target, target),
            ):  # fmt: skip
                counter[name] += 1
                held.setdefault(name, set()).add(entry.index)
    found = [_without(f"the {name}", at_sensor[name]) for name in sensors if len(sensors) > 1]
    found += [
        _without(f"the {name}", at_target[name])
        for name, often in targets.items()
        if often >= FEW and name not in sensors
    ]
    inputs = Inputs({}) if robot is None else exact_inputs(entries, robot)
    for some in _stretches(entries):
        span = f"from {_told(some[0])} to {_told(some[-1])}"
        readings = {one.index for one in some if isinstance(one.given, Reading)}
        if readings:
            found.append(_without(f"the readings {span}", readings))
        if exact := {one.index for one in some if one.index in inputs.of}:
            found.append(_exact(f"the motion {span}", exact, inputs))
    return found


def _told(entry: Entry) -> str:
    return f"step {entry.index}" if entry.t is None else f"{entry.t:.6g} s"


def _stretches(entries: Sequence[Entry]) -> Iterator[Sequence[Entry]]:
    cuts = np.linspace(0, len(entries), STRETCHES + 1).astype(int).tolist()
    for first, last in itertools.pairwise(cuts):
        if last > first:
            yield entries[first:last]


def _without(name: str, at: set[int]) -> Group:
    def of_entries(entries: Iterable[Entry]) -> Iterator[Entry]:
        for entry in entries:
            yield left_out(entry) if entry.index in at else entry

    told = f"{len(at)} left out" if len(at) > 1 else "left out"
    return Group(Change("reading", name, told, of_entries=of_entries), frozenset(at))


def _exact(name: str, at: set[int], inputs: Inputs) -> Group:
    def of_entries(entries: Iterable[Entry]) -> Iterator[Entry]:
        for entry in entries:
            yield _given(entry, inputs.of[entry.index]) if entry.index in at else entry

    return Group(
        Change("move", name, f"{len(at)} made exact", of_entries=of_entries), frozenset(at)
    )


def _given(entry: Entry, u: Array) -> Entry:
    """The entry with another motion input."""
    if not isinstance(entry.given, Control):
        return entry
    return replace(entry, given=replace(entry.given, u=u))


def exact_inputs(entries: Sequence[Entry], robot: Robot) -> Inputs:
    """What the robot would measure of each motion without noise: the way along the chord, and the
    turn, between the true poses before and after it.
    """
    moves, before = list[tuple[int, Array, Array]](), None
    for entry in entries:
        if isinstance(entry.given, Control) and before is not None and entry.truth is not None:
            moves.append((entry.index, before, entry.truth))
        before = entry.truth if entry.truth is not None else before
    if not moves:
        return Inputs({})
    start, end = (np.stack([move[i] for move in moves]) for i in (1, 2))
    way, turn = end[:, :2] - start[:, :2], np.asarray(wrap(end[:, 2] - start[:, 2]))
    middle = start[:, 2] + turn / 2
    distance = np.cos(middle) * way[:, 0] + np.sin(middle) * way[:, 1]
    dt = 1 / robot.rate
    velocity = way / dt
    after = np.concatenate([velocity[1:], velocity[-1:]])
    u = robot.ideal(Tick(start, end, distance, turn, velocity, after, dt))
    return Inputs({move[0]: row for move, row in zip(moves, u, strict=True)})


def abreast(entries: Sequence[Entry], some: Sequence[Group]) -> Iterator[Entry]:
    """The entries of one run, N times side by side, with one of N groups changed in each."""
    rows = len(some)
    at: dict[int, list[int]] = {}
    for row, group in enumerate(some):
        for index in group.at:
            at.setdefault(index, []).append(row)
    for entry in entries:
        spread = spread_out(entry, rows)
        changed = at.get(entry.index, ())
        if isinstance(entry.given, Reading) and changed:
            spread = left_out(spread, np.isin(np.arange(rows), changed))
        elif isinstance(entry.given, Control) and isinstance(spread.given, Control):
            u = spread.given.u
            for row in changed:
                (one,) = some[row].change.of_entries([entry])
                assert isinstance(one.given, Control)
                u = np.where((np.arange(rows) == row)[:, None], one.given.u, u)
            spread = replace(spread, given=replace(spread.given, u=u))
        yield spread


def instants(steps: Sequence[Step]) -> Integers:
    """The index of the last entry of each instant : (k,)"""
    times = [step.entry.index if step.entry.t is None else step.entry.t for step in steps]
    return np.array(
        [
            step.entry.index
            for step, now, then in zip(steps, times, [*times[1:], None], strict=True)
            if now != then
        ]
    )
