"""A log of document 004: one CSV of the pylon in the lidar's frame, the inertial unit, and GPS."""

import math
from dataclasses import replace

import numpy as np

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.folder import table_file
from ekfsim.files.logs.formats.targets import only
from ekfsim.files.logs.ordering import tell_gaps, tell_repeated
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.start.belief import assumed
from ekfsim.files.logs.table import Rows, Wanted, is_number, numbers_of, some
from ekfsim.files.logs.text import Lines, lines_of
from ekfsim.files.yaml.telling import quoted
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.sensors.lidar import LidarOffset
from ekfsim.models.sensors.offset import to_global
from ekfsim.records import Control, Entry, Log, Reading
from ekfsim.systems.instruments import Lidar, Pylon

COLUMNS = ("X", "Y", "Latitude", "Longitude", "Yaw", "AccelX", "AccelY")
PLACES = (0, 1, 4, 5, 6, 9, 10)
STAMP = 3  # the column that is no float
CLOCK = 1 << 32  # µs after which the stamps' clock starts again
EARTH_RADIUS = 6.3781e6  # m


def read_pylon(asked: Asked) -> Recorded:
    """Each row is one motion and, where the lidar saw the pylon, one reading. No truth is known.

    Raises UsageError where there is no such file, InputError with what is wrong in it.
    """
    path, world, reading, _, warnings = asked
    lines = lines_of(table_file(path, "the CSV file of the lidar and the inertial unit", ".csv"))
    wanted = Wanted(COLUMNS, PLACES, range(12, 13), frozenset({"X", "Y", "Latitude", "Longitude"}))
    rows = some(numbers_of(lines, wanted, ",", warnings), "lidar and accelerations")
    step = 1 / world.believed_robot.rate
    rows = _timed(rows, lines, step, warnings)
    θ = heading_of(rows.values[:, 5])
    # As in the authors' code the time between two rows is taken for constant; only the corrected
    # reading measures it.
    dt = np.diff(rows.t, prepend=0.0) if reading == "corrected" else np.full(len(rows), step)
    u = np.column_stack([rows.values[:, 6:8], θ, dt])
    # Eq. 8 is printed for another lidar's frame, and its letter leaves nothing to localize with:
    # every reading of the
    # document turns the offset rightly.
    beam = rows.values[:, 1:3]
    # no pylon stands within the lidar
    beam = np.where((beam == 0).all(axis=1, keepdims=True), np.nan, beam)
    fixes = metres(rows.values[:, 3:5])
    motion, pylon = world.believed_robot.motion(reading), only(world, reading, Pylon, Lidar)
    z = beam if isinstance(pylon.sensor, LidarOffset) else to_global(beam, θ)
    entries = [Entry(0, None, t=0.0)]
    for t, given, offset, fix in zip(rows.t.tolist(), u, z, fixes, strict=True):
        known = None if np.isnan(fix).any() else fix
        entries.append(Entry(len(entries), Control(motion, given), t=t, fix=known))
        if not np.isnan(offset).any():
            entries.append(Entry(len(entries), Reading(pylon.sensor, offset, pylon.name), t=t))
    unseen = int(np.isnan(z).any(axis=1).sum())
    if unseen:
        warnings.append(
            f"{rows.file}: in {unseen} of {len(rows)} rows the lidar did not see the pylon"
        )
    first = assumed(world, reading, str(path), warnings)
    return Recorded(Log(tuple(entries), first), None, warnings)


def heading_of(yaw: Array) -> Array:
    """θ = −yaw in (−π, π] of a yaw that grows clockwise, in degrees : (n,); half a turn is +π"""
    return np.where(np.mod(yaw, 360) == 180, math.pi, wrap(-yaw * (math.pi / 180)))


def metres(degrees: Array) -> Array:
    """x east and y north in m of latitude and longitude in degrees,
    from the first that is known : (n, 2)

    x = R π/180 (lon − lon₀) cos lat₀        y = R π/180 (lat − lat₀)
    """
    known = ~np.isnan(degrees).any(axis=1)
    if not known.any():
        return np.full(degrees.shape, np.nan)
    lat, lon = degrees[int(np.argmax(known))]
    north, east = np.moveaxis(degrees - (lat, lon), -1, 0) * (EARTH_RADIUS * math.pi / 180)
    return np.stack([east * math.cos(math.radians(lat)), north], axis=-1)


def _timed(rows: Rows, lines: Lines, step: float, warnings: list[str]) -> Rows:
    """The rows with their time before all else, in order;
    the first is one usual step after the start at 0.
    """
    clock = np.array(_stamps(rows, lines), dtype=np.int64)
    # µs; what seems half a clock's round ahead went back
    ahead = (np.diff(clock) + CLOCK // 2) % CLOCK - CLOCK // 2
    t = step + np.concatenate([[0], np.cumsum(ahead)]) / 1e6
    back = np.flatnonzero(ahead < 0) + 1
    if len(back):
        more = f", and so do {len(back) - 1} more" if len(back) > 1 else ""
        told = (
            f"{rows.at(int(back[0]))}: Time Stamp lies {-ahead[back[0] - 1] / 1e6:g} s before the "
            f"row above{more}"
        )
        warnings.append(f"{told}: the rows are put in order of time")
    rows = replace(rows, values=np.column_stack([t, rows.values]))[np.argsort(t, kind="stable")]
    rows = replace(rows, values=np.column_stack([rows.t - rows.t[0] + step, rows.values[:, 1:]]))
    tell_repeated(rows, warnings)
    tell_gaps(rows, warnings)
    return rows


def _stamps(rows: Rows, lines: Lines) -> list[int]:
    """The free-running clock of each row in µs: the low 32 bits of its stamp.

    A stamp printed as a float is what is left of the 64 bits;
    one in plain digits is the number itself.
    """
    stamps, mistakes = list[int](), list[Mistake]()
    as_written = dict(zip(lines.numbers, lines.texts, strict=True))
    for number in rows.lines.tolist():
        fields = as_written[number].split(",")
        text = fields[STAMP].strip()
        value = int(text) if text.isdecimal() else _whole(float(text)) if is_number(text) else -1
        if not 0 <= value < 1 << 64:
            column = len(",".join(fields[:STAMP])) + 2
            wrong = f"{quoted(text)} is no stamp"
            mistakes.append(
                Mistake(
                    Place(rows.file, number, column), "Time Stamp", wrong, "it is a 64-bit number"
                )
            )
        else:
            stamps.append(value % CLOCK)
    if mistakes:
        raise InputError(mistakes[:20])
    return stamps


def _whole(number: float) -> int:
    """The whole number that a float stands for, −1 where it is none."""
    return int(number) if math.isfinite(number) else -1
