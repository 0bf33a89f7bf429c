"""What was measured, a row a reading → readings of the world's sensors."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from ekfsim.files.logs.named.tables import Table
from ekfsim.files.logs.ordering import in_order, tell_gaps
from ekfsim.files.logs.timeline import Sample
from ekfsim.geometry import Array
from ekfsim.records import Reading
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.instrument import Instrument, Landmark, Target
from ekfsim.systems.instruments import Ranges
from ekfsim.world import World

RANGES = frozenset({"range"})
WANTED = "t,target,range,bearing or t,x,y"


@dataclass(frozen=True)
class Fitting:
    """An instrument of the world, the columns that it reads, and its sensors by their targets."""

    instrument: Instrument
    columns: tuple[str, ...]
    targets: dict[int, Target]  # by a landmark's id or a beam's number
    only: Target | None  # where it reads one thing alone


def fittings_of(
    world: World, reading: DocumentReading, landmarks: Sequence[Landmark]
) -> list[Fitting]:
    """The world's instruments around these landmarks."""
    around = world.around(reading)._replace(landmarks=tuple(landmarks))
    fittings = []
    for instrument in world.told_instruments:
        targets = list(instrument.targets(around))
        if not targets:
            continue
        columns = tuple(one.name for one in targets[0].sensor.outputs)
        placed = targets[0].place is not None
        ids = [mark.id for mark in landmarks] if placed else range(len(targets))
        by_id = dict(zip(ids, targets, strict=True))
        only = targets[0] if len(targets) == 1 and not placed else None
        fittings.append(Fitting(instrument, columns, by_id, only))
    return fittings


def samples_of(table: Table, fittings: Sequence[Fitting], warnings: list[str]) -> list[Sample]:
    """The readings of a table, once for each instrument that its columns fit.

    Raises InputError where they fit none.
    """
    found = [one for one in fittings if table.has(*one.columns)]
    if not found:
        known = " or ".join(f"t,{','.join(one.columns)}" for one in fittings)
        raise table.lacks("as the readings of this world's sensors are", f"write {known}")
    columns = list(dict.fromkeys(column for one in found for column in one.columns))
    targeted = any(one.only is None for one in found)
    if targeted and not table.has("target"):
        raise table.lacks("'target'", "name what is seen: a landmark's id, or a beam's number")
    names = ["t", *(["target"] if targeted else []), *columns]
    rows = in_order(table.rows(names, warnings, ranges=RANGES & frozenset(columns)), warnings)
    tell_gaps(rows, warnings)
    samples, unknown = list[Sample](), list[int]()
    places = {name: place for place, name in enumerate(names)}
    for row, numbers in enumerate(rows.values.tolist()):
        for one in found:
            target = one.only or one.targets.get(numbers[places["target"]])
            if target is None:
                unknown.append(row)
                continue
            z = np.array([numbers[places[column]] for column in one.columns])
            read = Reading(target.sensor, _given(one, z), target.name)
            samples.append(Sample(numbers[0], read, target.delay))
    if unknown:
        row = unknown[0]
        more = f", and so are {len(unknown) - 1} more rows" if len(unknown) > 1 else ""
        target = rows.values[row, 1]
        warnings.append(
            f"{rows.at(row)}: target {target:g} is no landmark, and no beam{more}: left out"
        )
    return samples


def _given(one: Fitting, z: Array) -> Array:
    """A reading as the filter is given it: a radio's range without its scale and bias."""
    if isinstance(one.instrument, Ranges):
        return np.array([one.instrument.corrected(float(z[0]))])
    return z
