"""What was measured, a row a reading → readings of the world's sensors."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.keys.recorded.columns import ReadingsKeys
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.named.sigmas import as_sure, columns_of_sigmas, sigmas_of
from ekfsim.files.logs.named.tables import Table
from ekfsim.files.logs.ordering import in_order, tell_gaps
from ekfsim.files.logs.table import Rows, is_number
from ekfsim.files.logs.timeline import Sample
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Sensor
from ekfsim.models.sensors.infrared import InfraredBeam
from ekfsim.models.sensors.mounted import Mounted
from ekfsim.models.sensors.ultrasonic import UltrasonicBeam
from ekfsim.records import Reading
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.instrument import Instrument, Landmark, Target
from ekfsim.systems.instruments import Ranges
from ekfsim.world import World

WANTED = "t,target,range,bearing or t,x,y"
CALLED = {"east": "offset_east", "north": "offset_north"}  # a fix to the east is another thing
# of the rows, from which on those that repeat the one above hold it: a sensor with noise seldom
# says the same twice
HELD = 0.3


@dataclass(frozen=True)
class Fitting:
    """An instrument of the world, the columns that it reads, and its sensors by their targets."""

    instrument: Instrument
    columns: tuple[str, ...]
    targets: Mapping[str, Target]  # by a landmark's id or name, or a beam's number
    only: Target | None  # where it reads one thing alone
    names: tuple[str, ...]  # how a log may call it: its own name, and its kind

    @property
    def is_beam(self) -> bool:
        """Whether it looks for the first wall: no echo is then a reading, too."""
        return self.only is None and all(one.place is None for one in self.targets.values())

    def beam(self, bearing: float) -> Target | None:
        """A beam in this direction; None where it is none. bearing : rad from straight ahead"""
        if math.isnan(bearing):
            return None
        some = next(iter(self.targets.values()))
        name = f"{self.instrument.called} {math.degrees(bearing):.6g}°"
        return some._replace(name=name, sensor=turned_to(some.sensor, bearing))

    def z(self, numbers: Array) -> Array:
        """A reading as the filter is given it: a radio's range without its scale and bias."""
        if isinstance(self.instrument, Ranges):
            return np.array([self.instrument.corrected(float(numbers[0]))])
        return numbers

    def told(self, z: Array) -> Array:
        """A reading as the instrument told it: the other way round."""
        if isinstance(self.instrument, Ranges):
            return self.instrument.raw(z)
        return z


def fittings_of(
    world: World,
    reading: DocumentReading,
    landmarks: Sequence[Landmark],
    ids: Mapping[str, int] | None,
) -> list[Fitting]:
    """The world's instruments around these landmarks, which may go by names."""
    around = world.around(reading)._replace(landmarks=tuple(landmarks))
    fittings, called = [], {instrument.called for instrument in world.told_instruments}
    for instrument in world.told_instruments:
        targets = list(instrument.targets(around))
        if not targets:
            continue
        outputs = (one.name for one in targets[0].sensor.outputs)
        columns = tuple(CALLED.get(name, name) for name in outputs)
        placed = targets[0].place is not None
        numbers = [mark.id for mark in landmarks] if placed else list(range(len(targets)))
        named = {str(number): target for number, target in zip(numbers, targets, strict=True)}
        if placed and ids:
            named.update({name: named[str(number)] for name, number in ids.items()})
        only = targets[0] if len(targets) == 1 and not placed else None
        kind = () if instrument.name in called else (instrument.name,)  # of which it is no name
        names = (instrument.called, *kind)
        fittings.append(Fitting(instrument, columns, named, only, names))
    return fittings


def samples_of(
    table: Table, keys: ReadingsKeys, fittings: Sequence[Fitting], asked: Asked, motion: Rows
) -> list[Sample]:
    """The readings of a table, each once for every instrument that it fits.

    Raises InputError where its columns fit none.
    """
    fit = _fit(table, keys, fittings)
    samples = list[Sample]()
    for one in fit:
        samples += _of_one(table, one, keys, asked, motion)
    return samples


def turned_to(sensor: Sensor, bearing: float) -> Sensor:
    """A beam that points in another direction, wherever it is mounted. bearing : rad"""
    if isinstance(sensor, Mounted):
        return replace(sensor, sensor=turned_to(sensor.sensor, bearing))
    assert isinstance(sensor, UltrasonicBeam | InfraredBeam)
    return replace(sensor, bearing=bearing)


def _fit(table: Table, keys: ReadingsKeys, fittings: Sequence[Fitting]) -> list[Fitting]:
    """The instruments whose columns a table has. Raises InputError where there is none."""
    known = [one for one in fittings if keys.sensor is None or keys.sensor in one.names]
    if not fittings and not len(table.lines):
        return []  # a log of the motion alone
    if not fittings:
        right = "landmarks.csv (id,x,y) in the log, or landmarks: and sensors: in the world"
        wrong = "the world has no sensor that could see anything, or nothing to be seen"
        raise InputError([Mistake(Place(table.file, 1, 1), "", wrong, f"write {right}")])
    if not known:
        there = ", ".join(one.instrument.called for one in fittings)
        wrong = f"the world has no sensor {keys.sensor!r} that could see anything"
        raise InputError([Mistake(Place(table.file, 1, 1), "", wrong, f"it has: {there}")])
    fit = [one for one in known if table.has(*one.columns)]
    if not fit:
        wanted = " or ".join(f"t,{','.join(one.columns)}" for one in known)
        raise table.lacks("as the readings of this world's sensors are", f"write {wanted}")
    return fit


def _of_one(
    table: Table, one: Fitting, keys: ReadingsKeys, asked: Asked, motion: Rows
) -> list[Sample]:
    """What a table tells of one instrument."""
    warnings = asked.warnings
    ranges = frozenset(one.columns) & {"range"} if not one.is_beam else frozenset[str]()
    sigmas = columns_of_sigmas(table, one.columns)
    told_of = keys.target is not None or table.has("target")
    by_bearing = one.is_beam and table.has("bearing") and not told_of
    names = ["t", *one.columns, *(["bearing"] if by_bearing else []), *sigmas]
    rows = table.rows(names, asked, motion, frozenset(names[1:]), ranges)
    rows = _in_order(table, one, _of_sensor(table, one, rows), warnings)
    values = rows.values[:, 1 : 1 + len(one.columns)]
    unread: Booleans = np.all(np.isnan(values), axis=1)
    if unread.any() and not one.is_beam:
        rows, values = rows[~unread], values[~unread]
    held = False if table.has("sensor") and keys.held is None else keys.held
    rows, values = _fresh(rows, values, held, one, warnings)
    if keys.every is None and keys.target is None:  # what is not in sight leaves gaps
        tell_gaps(rows, warnings)
    if by_bearing:
        targets = [one.beam(bearing) for bearing in rows.values[:, 1 + len(one.columns)].tolist()]
    else:
        targets = _targets(table, keys, one, rows)
    unknown = list[int]()
    σ = sigmas_of(one.columns, sigmas, rows, warnings)
    samples = list[Sample]()
    for row, (t, target) in enumerate(zip(rows.t.tolist(), targets, strict=True)):
        if target is None:
            unknown.append(row)
            continue
        sensor = as_sure(target.sensor, σ[row]) if sigmas else target.sensor
        read = Reading(sensor, one.z(values[row]), target.name)
        samples.append(Sample(t, read, target.delay))
    if unknown:
        _tell_unknown(table, keys, one, rows, unknown, warnings)
    return samples


def _of_sensor(table: Table, one: Fitting, rows: Rows) -> Rows:
    """The rows that are of this instrument, where a column tells."""
    if not table.has("sensor"):
        return rows
    words = table.words("sensor", rows)
    return rows[np.array([word in one.names for word in words], bool)]


def _in_order(table: Table, one: Fitting, rows: Rows, warnings: list[str]) -> Rows:
    """The rows by time, none twice: two that differ in what was seen are no repetition."""
    if one.only is not None or not table.has("target"):
        return in_order(rows, warnings)
    seen = np.unique(table.words("target", rows), return_inverse=True)[1]
    both = replace(rows, values=np.column_stack([rows.values, seen.reshape(len(rows))]))
    rows = in_order(both, warnings)
    return replace(rows, values=rows.values[:, :-1])


def _fresh(
    rows: Rows, values: Array, held: bool | None, one: Fitting, warnings: list[str]
) -> tuple[Rows, Array]:
    """The rows without those that hold the reading of the row above, where that is how they are."""
    same: Booleans = np.zeros(len(rows), bool)
    same[1:] = (values[1:] == values[:-1]).all(axis=1)
    if held is False or one.only is None or not same.any():
        return rows, values
    if held is None and np.mean(same) < HELD:
        return rows, values
    if held is None:
        told = (
            f"{same.sum()} of {len(rows)} rows repeat the {one.instrument.called} of the row above"
        )
        warnings.append(
            f"{rows.file}: {told}: taken as one that is held until the next; say otherwise with "
            "held: false"
        )
    return rows[~same], values[~same]


def _targets(table: Table, keys: ReadingsKeys, one: Fitting, rows: Rows) -> list[Target | None]:
    """What each row is of, None where the world has no such thing."""
    if one.only is not None:
        return [one.only] * len(rows)
    if keys.target is not None:
        return [one.targets.get(_id(str(keys.target)))] * len(rows)
    if not table.has("target"):
        right = "name what is seen: a landmark's id, or a beam's number"
        raise table.lacks("'target'", right)
    return [one.targets.get(_id(word)) for word in table.words("target", rows)]


def _id(word: str) -> str:
    """How a landmark or a beam is called: 7, also where a program wrote 7.0."""
    if is_number(word) and float(word).is_integer():
        return str(int(float(word)))
    return word


def _tell_unknown(
    table: Table,
    keys: ReadingsKeys,
    one: Fitting,
    rows: Rows,
    unknown: list[int],
    warnings: list[str],
) -> None:
    row = unknown[0]
    more = f", nor is that of {len(unknown) - 1} more rows" if len(unknown) > 1 else ""
    told = keys.target
    word = table.words("target", rows[row : row + 1])[0] if told is None else str(told)
    what = "beam" if one.is_beam else "landmark"
    warnings.append(f"{rows.at(row)}: target {word!r} is no {what} that is known{more}: left out")
