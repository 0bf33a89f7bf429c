"""A log of the classroom: what the odometry measured of each move, and the range of each beam.

entries.csv   index,kind,distance,angle,bearing,range     m, degrees; a row a move or a sense
world.yaml    the map and the ratios, as the filter is told them
truth.csv     index,x,y,theta                             m, degrees; where the truth is known

Rows have no time: each is a step of its own, under the number that it had in the run.
"""

import math
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from ekfsim.commands import Sense, Untold
from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.keys.fields import FAR, FARTHEST
from ekfsim.files.keys.recorded.recording import AngleUnit
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.degrees import radians
from ekfsim.files.logs.folder import find, find_any, folder_of
from ekfsim.files.logs.formats.groundtruth import X, Y
from ekfsim.files.logs.header import places_of, separator_of
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.table import is_number
from ekfsim.files.logs.tables.declared import Column, Format, Table
from ekfsim.files.logs.text import Lines, lines_of
from ekfsim.files.yaml.telling import nearest, quoted
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.laser import Laser
from ekfsim.records import Control, Entry, Log, Reading

ENTRIES, WORLD, TRUTH = "entries.csv", "world.yaml", "truth.csv"
HOLDS = f"{ENTRIES}, {WORLD} and, where it is known, {TRUTH}"
COLUMNS = ("index", "kind", "distance", "angle", "bearing", "range")
TRUTH_COLUMNS = ("index", "x", "y", "theta")
CLASSROOM = Format(
    "classroom",
    "What the robot of a classroom measured, a row a move or a sense, and its world; "
    "`ekfsim record` writes it. Rows have no time.",
    (
        Table(
            "what was measured",
            (ENTRIES,),
            (
                Column("index", "", "of the command, from 1, growing"),
                Column("kind", "", "move or sense"),
                Column("distance", "m", "of a move, by the odometry"),
                Column("angle", "degrees", "of a move, by the odometry"),
                Column("bearing", "degrees", "of the laser, from straight ahead"),
                Column("range", "m", "of a beam; empty where there was no echo"),
            ),
            told=f"Beside it lies {WORLD}, the map and the ratios as the filter is told them.",
            example="""\
index,kind,distance,angle,bearing,range
1,move,1.76,95.9,,
2,sense,,,90,2.01
3,move,0.5,0,,
4,sense,,,0,
5,sense,,,-90,1.25
""",
        ),
        Table(
            "the true poses",
            (TRUTH,),
            (
                Column("index", "", "of the command, 0 for the start"),
                X,
                Y,
                Column("theta", "degrees", "counter-clockwise from x"),
            ),
            needed=False,
            example="""\
index,x,y,theta
0,1.0,1.0,90
1,1.0,2.75,180
2,1.0,2.75,180
3,0.5,2.75,180
4,0.5,2.75,180
""",
        ),
    ),
)
OF_KIND = {"move": ("distance", "angle"), "sense": ("bearing", "range")}
MAY_BE_EMPTY = "range"  # no echo
LARGEST = {"x": FARTHEST, "y": FARTHEST}  # m; of all others it is FAR


def read_classroom(asked: Asked) -> Recorded:
    """A log without a clock. What was commanded is not told, but where the laser looked.

    Raises UsageError where a file is missing, InputError with what is wrong in one.
    """
    path, world, reading, recording, warnings = asked
    unit = recording.angle_unit or "degrees"
    folder = folder_of(path, HOLDS)
    rows = _entries(find(folder, "what was measured", ENTRIES), unit)
    file = find_any(folder, "the true poses", TRUTH)
    truth = {} if file is None else _truth(file, {0, *(row.index for row in rows)}, unit)
    noise = world.told.noise
    motion = MoveTurn(noise.odometry_distance, noise.odometry_angle)
    entries = [Entry(0, None, truth.get(0))]
    for row in rows:
        true = truth.get(row.index)
        if row.kind == "move":
            u = np.array([row["distance"], row["angle"]])
            entries.append(Entry(row.index, Control(motion, u), true, Untold()))
        else:
            laser = Laser(world.told.map.walls, row["bearing"], noise.range)
            given = Reading(laser, np.array([row["range"]]))
            entries.append(Entry(row.index, given, true, Sense(row["bearing"])))
    return Recorded(Log(tuple(entries), world.first_belief(reading)), None, warnings)


@dataclass(frozen=True)
class _Row:
    """A row of the entries."""

    index: int
    kind: str
    numbers: Mapping[str, float]  # m, rad; nan where the field is empty

    def __getitem__(self, column: str) -> float:
        return self.numbers[column]


def _entries(file: Path, unit: AngleUnit) -> list[_Row]:
    """The moves and beams. Raises InputError with all that is wrong in the file."""
    lines = lines_of(file)
    mistakes, rows, before = list[Mistake](), list[_Row](), 0
    for fields in _fields(lines, COLUMNS, mistakes):
        row, wrong = _row(fields, before, unit)
        mistakes += wrong
        if row is not None:
            before = row.index
            rows.append(row)
    if mistakes:
        raise InputError(mistakes)
    return rows


def _truth(file: Path, known: set[int], unit: AngleUnit) -> dict[int, Array]:
    """The true poses by their index : (3,) each. Raises InputError with what is wrong."""
    lines = lines_of(file)
    mistakes, poses = list[Mistake](), dict[int, Array]()
    for fields in _fields(lines, TRUTH_COLUMNS, mistakes):
        numbers, wrong = _numbers(fields, TRUTH_COLUMNS[1:], unit)
        index = _index(fields)
        if index is not None and index in poses:
            wrong.append(fields["index"].mistake("index", "stands twice", "delete one row"))
        elif index is None or index not in known:
            right = f"0 is the start, the others are those of {ENTRIES}"
            wrong.append(fields["index"].mistake("index", "is no row of the log", right))
        if not wrong and index is not None:
            x, y, θ = numbers["x"], numbers["y"], float(wrap(np.array(numbers["theta"])))
            poses[index] = np.array([x, y, θ])
        mistakes += wrong
    if mistakes:
        raise InputError(mistakes)
    return poses


@dataclass(frozen=True)
class _Field:
    """One field of a row, and where it stands."""

    text: str  # without the spaces around it
    place: Place

    def mistake(self, column: str, wrong: str, right: str) -> Mistake:
        """What is wrong with it."""
        return Mistake(self.place, column, f"{quoted(self.text)} {wrong}", right)


def _fields(
    lines: Lines, columns: tuple[str, ...], mistakes: list[Mistake]
) -> Iterator[dict[str, _Field]]:
    """The wanted fields of each row that has as many as the header names columns."""
    width, places = places_of(lines, [(column,) for column in columns])
    separator = separator_of(lines.texts[0])
    for number, text in zip(lines.numbers[1:], lines.texts[1:], strict=True):
        fields = text.split(separator)
        if len(fields) != width:
            stand = "1 column stands" if len(fields) == 1 else f"{len(fields)} columns stand"
            right = f"it must have {width}, as the first line names"
            place = Place(lines.file, number, 1)
            mistakes.append(Mistake(place, "", f"{stand} in this row", right))
            continue
        starts = np.cumsum([0, *(len(field) + 1 for field in fields)]).tolist()
        found = {}
        for column, at in zip(columns, places, strict=True):
            field = fields[at]
            indent = len(field) - len(field.lstrip())
            place = Place(lines.file, number, starts[at] + indent + 1)
            found[column] = _Field(field.strip().strip('"'), place)
        yield found


def _row(
    fields: dict[str, _Field], before: int, unit: AngleUnit
) -> tuple[_Row | None, list[Mistake]]:
    """A row of the entries, or what is wrong with it. before : the index of the row above"""
    kind, index = fields["kind"].text.lower(), _index(fields)
    mistakes = []
    if index is None or index <= before:
        right = f"write a whole number above {before}, that of the row above"
        mistakes.append(fields["index"].mistake("index", "does not go on", right))
    if kind not in OF_KIND:
        near = nearest(kind, list(OF_KIND))
        right = f"did you mean '{near}'?" if near else "write move or sense"
        mistakes.append(fields["kind"].mistake("kind", "is no kind of entry", right))
        return None, mistakes
    for other, columns in OF_KIND.items():
        for column in columns if other != kind else ():
            if fields[column].text:
                right = f"leave the field empty: a {kind} has none"
                mistakes.append(fields[column].mistake(column, f"stands in a {kind}", right))
    numbers, wrong = _numbers(fields, OF_KIND[kind], unit)
    mistakes += wrong
    if numbers.get(MAY_BE_EMPTY, 0.0) < 0:
        right = "a range is 0 or more; an empty field is no echo"
        mistakes.append(fields["range"].mistake("range", "is negative", right))
    return (None, mistakes) if mistakes else (_Row(index or 0, kind, numbers), [])


def _index(fields: dict[str, _Field]) -> int | None:
    text = fields["index"].text
    return int(text) if text.isascii() and text.isdigit() and len(text) < 10 else None


def _numbers(
    fields: dict[str, _Field], columns: tuple[str, ...], unit: AngleUnit
) -> tuple[dict[str, float], list[Mistake]]:
    """Numbers in m and rad, nan for an empty field that may be; and the mistakes in them."""
    numbers, mistakes = dict[str, float](), list[Mistake]()
    for column in columns:
        field = fields[column]
        if not field.text and column == MAY_BE_EMPTY:
            numbers[column] = math.nan
        elif not is_number(field.text):
            wrong = "is not a number" if field.text else "stands where a number belongs"
            meant = field.text.replace(",", ".")
            right = f"write {meant}" if is_number(meant) else "write e.g. 1.5"
            mistakes.append(field.mistake(column, wrong, right))
        elif not abs(float(field.text)) <= LARGEST.get(column, FAR):
            right = f"write one within ±{LARGEST.get(column, FAR):.0e}"
            mistakes.append(field.mistake(column, "cannot be meant", right))
        else:
            angle = unit == "degrees" and column in ("angle", "bearing", "theta")
            numbers[column] = radians(field.text) if angle else float(field.text)
    return numbers, mistakes
