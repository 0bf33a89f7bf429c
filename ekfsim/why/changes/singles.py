"""Single readings left out and single moves made exact, many side by side: the same run in each,
with another change.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from ekfsim.geometry import Array, Integers
from ekfsim.geometry.angles import wrap
from ekfsim.records import Control, Entry, Reading
from ekfsim.scene import Scene
from ekfsim.why.changes.beams import left_out
from ekfsim.why.records import Change


def reading(step: int) -> Change:
    """The reading of a step left out."""

    def of_entries(entries: Iterable[Entry]) -> Iterator[Entry]:
        for entry in entries:
            yield left_out(entry) if entry.index == step else entry

    return Change("reading", f"the beam of step {step}", "left out", step, of_entries=of_entries)


def move(step: int) -> Change:
    """The filter is given what truly happened at a step."""

    def of_entries(entries: Iterable[Entry]) -> Iterator[Entry]:
        before: Array | None = None
        for entry in entries:
            yield exact(entry, before) if entry.index == step else entry
            before = entry.truth

    return Change("move", f"the move of step {step}", "made exact", step, of_entries=of_entries)


def exact(entry: Entry, before: Array | None) -> Entry:
    """The entry with what the robot truly did: how far straight ahead, and what turn in place.

    before : (…, 3) the true pose before it
    """
    if not isinstance(entry.given, Control) or before is None or entry.truth is None:
        return entry
    way, θ, measured = entry.truth - before, before[..., 2], entry.given.u[..., 1]
    d = np.cos(θ) * way[..., 0] + np.sin(θ) * way[..., 1]
    a = measured + wrap(way[..., 2] - measured)  # turns may go round more than once
    return replace(entry, given=replace(entry.given, u=np.stack([d, a], axis=-1)))


def singles(entries: Sequence[Entry]) -> list[Change]:
    """Every reading left out, and every move made exact, each by itself."""
    found = []
    for entry in entries:
        if isinstance(entry.given, Reading):
            found.append(reading(entry.index))
        elif isinstance(entry.given, Control):
            found.append(move(entry.index))
    return found


def abreast(entries: Sequence[Entry], changes: Sequence[Change]) -> Iterator[Entry]:
    """The entries of one run, N times side by side, with one of N single changes in each."""
    rows = len(changes)
    at = {one.step: row for row, one in enumerate(changes)}
    before: Array | None = None
    for entry in entries:
        given, row = entry.given, at.get(entry.index)
        spread = spread_out(entry, rows)
        if row is not None and isinstance(given, Reading):
            spread = left_out(spread, np.arange(rows) == row)
        elif row is not None and isinstance(given, Control) and isinstance(spread.given, Control):
            one = exact(entry, before).given
            assert isinstance(one, Control)
            u = spread.given.u.copy()
            u[row] = one.u
            spread = replace(spread, given=replace(spread.given, u=u))
        yield spread
        before = entry.truth


def spread_out(entry: Entry, rows: int) -> Entry:
    """The entry of one run as that of N."""
    given, truth = entry.given, entry.truth
    match given:
        case Reading(_, z):
            given = replace(given, z=np.broadcast_to(z, (rows, *z.shape)))
        case Control(_, u):
            given = replace(given, u=np.broadcast_to(u, (rows, *u.shape)))
    if truth is not None:
        truth = np.broadcast_to(truth, (rows, *truth.shape))
    return replace(entry, given=given, truth=truth)


def numbers(scene: Scene, rows: int) -> Integers:
    """The scene's run, N times : (N,)"""
    return np.full(rows, scene.run)


def blind() -> Change:
    """No reading is used."""
    return Change(
        "beams", "all beams", "left out",
        of_entries=lambda entries: (left_out(entry) for entry in entries),
    )  # fmt: skip
