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
from ekfsim.files.logs.table import Rows, some
from ekfsim.files.logs.tables.declared import Column, Format, Table
from ekfsim.files.logs.tables.reading import Read, read_text
from ekfsim.files.logs.tables.stamps import POWER, SPOKEN, seconds_of, usual_step
from ekfsim.files.yaml.telling import quoted
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.sensors.lidar import LidarOffset
from ekfsim.models.sensors.mounted import bare, place_of
from ekfsim.models.sensors.offset import to_global
from ekfsim.records import Control, Entry, Log, Reading
from ekfsim.systems.instruments import Lidar, Pylon

CLOCK = 1 << 32  # µs after which the stamps' clock starts again
ODD = 20  # times the robot's own step, or a part of it: a usual step that cannot be meant
TABLE = Table(
    "the CSV file of the lidar and the inertial unit",
    ("*.csv",),
    (
        Column("X", "m", "of the pylon in the lidar's frame; nan or 0, 0 where unseen", maybe=True),
        Column("Y", "m", "ditto", maybe=True),
        Column("Latitude", "degrees north", "of the GPS", ("lat",), 4, maybe=True),
        Column("Longitude", "degrees east", "ditto", ("lon",), 5, maybe=True),
        Column("Yaw", "degrees", "clockwise, from the start", place=6),
        Column("AccelX", "m/s²", "forwards", ("accel_x", "ax"), 9),
        Column("AccelY", "m/s²", "to the left", ("accel_y", "ay"), 10),
        Column(
            "Time Stamp", "µs", "its low 32 bits are a clock", ("timestamp", "time_stamp", "t"), 3,
            maybe=True, largest=math.inf,
        ),
    ),
    named=False,
    widths=range(12, 13),
    told="Twelve columns without names: X, Y, Z, Time Stamp, Latitude, Longitude, Yaw, Pitch, "
    "Roll, AccelX, AccelY, AccelZ, of which Z, Pitch, Roll and AccelZ are not read.",
    example="""\
5.027,4.750,-0.36,6871947673600000,34.106,-117.705,0.0,0.0,0.0,0.0,0.0,0.0
5.007,4.702,-0.36,6871947673700000,34.106,-117.705,0.0,0.0,0.0,0.1,0.0,0.0
5.035,4.748,-0.36,6871947673800000,34.106,-117.705,0.0,0.0,0.0,0.1,0.0,0.0
nan,nan,-0.36,6871947673900000,34.106,-117.705,359.9,0.0,0.0,0.1,0.0,0.0
5.009,4.702,-0.36,6871947674000000,34.106,-117.705,359.9,0.0,0.0,0.1,0.0,0.0
""",
)  # fmt: skip
PYLON = Format(
    "pylon",
    "One CSV file of document 004: the pylon as the lidar sees it, the inertial unit, GPS; "
    "`ekfsim record --format own` writes it.",
    (TABLE,),
    alone=True,
)
EARTH_RADIUS = 6.3781e6  # m


def read_pylon(asked: Asked) -> Recorded:
    """Each row is one motion and, where the lidar saw the pylon, one reading. No truth is known.

    Raises UsageError where there is no such file, InputError with what is wrong in it.
    """
    path, world, reading, _, warnings = asked
    read = read_text(table_file(path, TABLE.what, ".csv"), TABLE, asked)
    some(read.rows, "lidar and accelerations")
    step = 1 / world.believed_robot.rate
    rows = _timed(read, step, asked)
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
    if pylon.delay:
        beam = _when_seen(beam, rows, pylon.delay, warnings)
    facing = place_of(pylon.sensor, np.column_stack([np.zeros((len(θ), 2)), θ]))[:, 2]
    z = beam if isinstance(bare(pylon.sensor), LidarOffset) else to_global(beam, facing)
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
    return Recorded(Log(tuple(entries), first, start_known=False), None, warnings)


def _when_seen(beam: Array, rows: Rows, delay: float, warnings: list[str]) -> Array:
    """What the lidar saw at each row, where a row holds what it saw `delay` s before : (n, 2)

    A row of this log is one motion, which no reading cuts in two: the nearest row is taken.
    """
    when, edges = rows.t - delay, np.concatenate([[0.0], rows.t])
    row = np.searchsorted((edges[1:] + edges[:-1]) / 2, when) - 1
    seen, known = np.full_like(beam, np.nan), row >= 0
    seen[row[known]] = beam[known]
    off = np.max(np.abs(rows.t[row[known]] - when[known]), initial=0.0)
    warnings.append(
        f"{rows.file}: each reading is taken at the row that is nearest to {delay:g} s before its "
        f"own; at most {off:.3g} s away"
    )
    return seen


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


def _timed(read: Read, step: float, asked: Asked) -> Rows:
    """The rows with their time before all else, in order;
    the first is one usual step after the start at 0.
    """
    rows, warnings = read.rows, asked.warnings
    ahead = _ahead(read, step, asked)
    t = step + np.concatenate([[0], np.cumsum(ahead)]) / 1e6
    back = np.flatnonzero(ahead < 0) + 1
    if len(back):
        more = f", and so do {len(back) - 1} more" if len(back) > 1 else ""
        told = (
            f"{rows.at(int(back[0]))}: Time Stamp lies {-ahead[back[0] - 1] / 1e6:g} s before the "
            f"row above{more}"
        )
        warnings.append(f"{told}: the rows are put in order of time")
    rows = replace(rows, values=np.column_stack([t, rows.values[:, :7]]))[
        np.argsort(t, kind="stable")
    ]
    rows = replace(rows, values=np.column_stack([rows.t - rows.t[0] + step, rows.values[:, 1:]]))
    tell_repeated(rows, warnings)
    tell_gaps(rows, warnings)
    return rows


def _ahead(read: Read, step: float, asked: Asked) -> Array:
    """How far the stamp of each row is ahead of that of the row above, in µs : (n − 1,)"""
    texts = read.texts("Time Stamp")
    unit = asked.recording.time_unit or read.layout.units.get("Time Stamp")
    clock = np.array(_stamps(read.rows, texts, read) if unit in (None, "us") else [], np.int64)
    # what seems half a clock's round ahead went back
    ahead = (np.diff(clock) + CLOCK // 2) % CLOCK - CLOCK // 2
    usual = float(np.median(ahead[ahead > 0])) / 1e6 if np.any(ahead > 0) else 0.0
    if unit is None and len(clock) > 1 and not step / ODD <= usual <= step * ODD:
        steps = {one: usual_step(seconds_of(texts, one)) for one in POWER}
        likely = [one for one, dt in steps.items() if step / ODD <= dt <= step * ODD]
        if likely:
            unit = likely[0]
            told = f"as the clock of such a log their usual step would be {usual:.3g} s"
            cure = "say otherwise with --set recording.timeUnit=us"
            asked.warnings.append(
                f"{read.rows.file}: the stamps are taken as {SPOKEN[unit]}: {told}; {cure}"
            )
    return ahead if unit in (None, "us") else np.diff(seconds_of(texts, str(unit))) * 1e6


def _stamps(rows: Rows, texts: list[str], read: Read) -> list[int]:
    """The free-running clock of each row in µs: the low 32 bits of its stamp.

    A stamp printed as a float is what is left of the 64 bits;
    one in plain digits is the number itself.
    """
    stamps, mistakes = list[int](), list[Mistake]()
    for number, written in zip(rows.lines.tolist(), texts, strict=True):
        text = written.strip()
        value = int(text) if text.isdecimal() else _whole(float(text))
        if not 0 <= value < 1 << 64:
            wrong = f"{quoted(text)} is no stamp"
            place = Place(rows.file, number, read.column(number, "Time Stamp"))
            mistakes.append(Mistake(place, "Time Stamp", wrong, "it is a 64-bit number"))
        else:
            stamps.append(value % CLOCK)
    if mistakes:
        raise InputError(mistakes[:20])
    return stamps


def _whole(number: float) -> int:
    """The whole number that a float stands for, −1 where it is none."""
    return int(number) if math.isfinite(number) else -1
