"""A fix at every row of the wheels, by its number, as the authors of document 003 have it."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.sensors.mounted import bare
from ekfsim.models.sensors.position import Position
from ekfsim.records import Control, Entry, Reading


def stretched(entries: Iterable[Entry]) -> Iterator[Entry]:
    """The same log with a fix after each motion input: those recorded, spread evenly by number.

    Row i of n, the start being row 0, has the fix at place i (K − 1)/n of the K that were recorded,
    on the straight line from the one before that place to the one after it. No stamp is looked at:
    where the first fix comes late, or one is missing, all are given to the wrong rows. Nor could a
    filter at work do so: it would have to know the next fix, and how many will come. Readings of
    other instruments stay where they are.
    """
    log = list(entries)
    given = [fix for entry in log if (fix := _fix(entry)) is not None]
    rows = sum(isinstance(entry.given, Control) for entry in log)
    fixes, row, index = [reading.z for reading in given], 0, 0
    for entry in log:
        if _fix(entry) is not None:
            continue
        yield replace(entry, index=index)
        index += 1
        if given and isinstance(entry.given, Control):
            row += 1
            z = _at(row / rows * (len(fixes) - 1), fixes)
            yield replace(entry, index=index, given=replace(given[0], z=z))
            index += 1


def _fix(entry: Entry) -> Reading | None:
    """The fix that an entry brings, None where it brings something else."""
    return (
        entry.given
        if isinstance(entry.given, Reading) and isinstance(bare(entry.given.sensor), Position)
        else None
    )


def _at(place: float, fixes: list[Array]) -> Array:
    """The fix at a place between two numbers : (…, 2)"""
    before = int(place)
    after = min(before + 1, len(fixes) - 1)
    return np.asarray(fixes[before] + (place - before) * (fixes[after] - fixes[before]), np.float64)
