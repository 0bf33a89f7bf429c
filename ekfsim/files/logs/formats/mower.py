"""A log of document 000, as its MATLAB listing reads it:
poselog, angles and map, text files of bare numbers.
"""

import math
from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.folder import find, folder_of
from ekfsim.files.logs.formats.groundtruth import HEADING, TIME, X, Y
from ekfsim.files.logs.formats.targets import of_landmarks
from ekfsim.files.logs.ordering import tell_back, tell_gaps, tell_repeated
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.start.belief import at_truth
from ekfsim.files.logs.table import Rows, some
from ekfsim.files.logs.tables.angles import BEYOND_A_TURN
from ekfsim.files.logs.tables.declared import Column, Format, Table
from ekfsim.files.logs.tables.reading import read_table
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.geometry.angles import wrap
from ekfsim.records import Control, Entry, Log, Reading
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.instrument import Landmark, Target
from ekfsim.systems.instruments import Markers

POSELOG = Table(
    "the positions",
    ("marker-001-poselog.txt", "*poselog.txt"),
    (
        TIME.but(place=2),
        Column("ΔD_L", "m", "way of the left wheel since the row before", place=3),
        Column("ΔD_R", "m", "way of the right wheel since the row before", place=4),
        Column("ω", "rad/s", "turn rate of the gyro", place=8, most=10.0),
        X.but(place=18),
        Y.but(place=19),
        HEADING.but(place=20),
    ),
    named=False,
    widths=range(21, 1000),
    told="x, y and heading are the true pose. Every row, the first too, is one time update.",
    example="""\
1 0 0.025 0.01 0.01 0 0 0 0.0 0 0 0 0 0 0 0 0 0 0.01 0.0 0.0
2 0 0.05 0.01 0.01 0 0 0 0.0 0 0 0 0 0 0 0 0 0 0.02 0.0 0.0
3 0 0.075 0.01 0.01 0 0 0 0.0 0 0 0 0 0 0 0 0 0 0.03 0.0 0.0
4 0 0.1 0.01 0.01 0 0 0 0.0 0 0 0 0 0 0 0 0 0 0.04 0.0 0.0
5 0 0.125 0.01 0.01 0 0 0 0.0 0 0 0 0 0 0 0 0 0 0.05 0.0 0.0
""",
)
ANGLES = Table(
    "the angles of the markers",
    ("marker-001-003-angles.txt", "*angles.txt"),
    (
        TIME,
        Column("marker", "", "its row in the map, from 0"),
        Column("azimuth", "rad", "from straight ahead, to the left positive", most=BEYOND_A_TURN),
        Column("elevation", "rad", "above the horizon", most=math.pi),
    ),
    named=False,
    widths=range(4, 1000),
    example="""\
0.03 0 0.32 0.10
0.06 1 -0.30 0.12
0.08 0 0.32 0.10
0.11 2 0.75 0.15
0.12 1 -0.30 0.12
""",
)
MAP = Table(
    "the map of the markers",
    ("marker-001-map.txt", "*map.txt"),
    (Column("marker", "", "its number"), X, Y),
    named=False,
    widths=range(3, 1000),
    example="""\
0 3.0 1.0
1 3.0 -1.0
2 2.0 2.0
3 -2.0 2.0
4 -2.0 -2.0
""",
)
MOWER = Format(
    "mower",
    "Ways of the wheels and angles to markers, as document 000 and its MATLAB listing have them; "
    "`ekfsim record --format own` writes it. White space or commas between the columns, no names.",
    (POSELOG, ANGLES, MAP),
)
MUCH_LATER = 10  # steps dT from which on it is told that a picture has to wait so long for its row


def read_mower(asked: Asked) -> Recorded:
    """Every row of the poselog, the first too, is one time update of dT; then the markers that
    belong to it are taken.

    To which row a picture belongs,
    the text and its listing say differently where stamps are uneven or repeat.

    Raises UsageError where a file is missing, InputError with what is wrong in one.
    """
    path, world, reading, _, warnings = asked
    folder = folder_of(path, MOWER.holds)
    files = [find(folder, table.what, *table.files) for table in MOWER.tables]
    poses = some(read_table(files[0], POSELOG, asked), "positions")
    _refuse_going_back(poses)
    tell_repeated(poses, warnings)
    tell_gaps(poses, warnings)
    angles = read_table(files[1], ANGLES, asked, poses)
    landmarks = _landmarks(read_table(files[2], MAP, asked), warnings)
    dT = 1 / world.believed_robot.rate
    tell_back(angles, warnings)
    rows_of = _rows_of_listing if reading == "coded" else _rows_of_text
    instrument, targets = of_landmarks(world, reading, landmarks, (Markers,))[0]
    if instrument.delay:  # by when they were, not by when they were stamped
        aged = np.column_stack([angles.t - instrument.delay, angles.values[:, 1:]])
        angles = replace(angles, values=aged)
    rows = rows_of(poses, angles, dT, warnings)
    readings = _by_row(rows, _readings(angles, landmarks, targets, warnings))
    u = np.column_stack([poses.values[:, 1:4], np.full(len(poses), dT)])
    truth = poses.values[:, 4:7].copy()
    truth[:, 2] = wrap(truth[:, 2])
    motion = world.believed_robot.motion(reading)
    # the listing begins before its first time update
    entries = [Entry(0, None, truth[0], t=float(poses.t[0]) - dT)]
    for row, t in enumerate(poses.t.tolist()):
        for given in (Control(motion, u[row]), *readings.get(row, ())):
            entries.append(Entry(len(entries), given, truth[row], t=t))
    first = at_truth(world, reading, _first_pose(poses, reading))
    return Recorded(Log(tuple(entries), first), landmarks, warnings)


def _first_pose(poses: Rows, reading: DocumentReading) -> Array:
    """Row 1's pose;
    the listing begins with the mean heading of the rows 2 to 100, each brought into (−2π, 2π).
    """
    pose = poses.values[0, 4:7].copy()
    if reading == "coded" and len(poses) > 1:
        pose[2] = np.mean(np.fmod(poses.values[1:100, 6], 2 * math.pi))
    pose[2] = wrap(pose[2])
    return pose


def _refuse_going_back(poses: Rows) -> None:
    """Raise InputError where a stamp lies before the one above:
    every row is a time update, so none can be moved.
    """
    back = np.flatnonzero(np.diff(poses.t) < 0) + 1
    mistakes = [
        Mistake(
            Place(poses.file, int(poses.lines[row])),
            "column 3",
            f"the stamp {poses.t[row]:.12g} lies before that of the row above, "
            f"{poses.t[row - 1]:.12g}",
            "every row is a time update: put the rows in their order",
        )
        for row in back[:20].tolist()
    ]
    if len(back) > 20:
        place = Place(poses.file, int(poses.lines[back[20]]))
        mistakes.append(Mistake(place, "", f"and {len(back) - 20} more such rows"))
    if mistakes:
        raise InputError(mistakes)


def _landmarks(table: Rows, warnings: list[str]) -> tuple[Landmark, ...]:
    """The markers in the order of the map, by whose rows the angles name them."""
    ids = table.values[:, 0]
    if len(table) and np.array_equal(ids, np.rint(ids)) and len(np.unique(ids)) == len(ids):
        if not np.array_equal(ids, np.arange(len(ids))):
            warnings.append(
                f"{table.file}: its ids are not 0, 1, 2, …: the angles name a marker by its row, "
                "from 0"
            )
    elif len(table):
        warnings.append(f"{table.file}: its ids are no names: the markers go by their rows, from 0")
        ids = np.arange(len(table), dtype=float)
    return tuple(
        Landmark(int(n), x, y) for n, (x, y) in zip(ids, table.values[:, 1:].tolist(), strict=True)
    )


def _readings(
    angles: Rows,
    landmarks: tuple[Landmark, ...],
    targets: Mapping[int, Target],
    warnings: list[str],
) -> list[Reading | None]:
    """What each row of the angles tells; None where the map has no such marker."""
    marker = angles.values[:, 1]
    unknown = np.flatnonzero(
        (marker < 0) | (marker >= len(landmarks)) | (marker != np.rint(marker))
    )
    if len(unknown):
        row = int(unknown[0])
        more = f", nor those of {len(unknown) - 1} more rows" if len(unknown) > 1 else ""
        warnings.append(f"{angles.at(row)}: the map has no row {marker[row]:g}{more}: left out")
    left_out = set(unknown.tolist())
    found = list[Reading | None]()
    for row, z in enumerate(angles.values[:, 2:4]):
        target = None if row in left_out else targets[landmarks[int(marker[row])].id]
        found.append(None if target is None else Reading(target.sensor, z, target.name))
    return found


def _by_row(rows: list[Integers], readings: list[Reading | None]) -> dict[int, list[Reading]]:
    """The readings by the row of the poselog at which they are used,
    there in the order of their file.
    """
    used = dict[int, list[Reading]]()
    for at, reading in zip(rows, readings, strict=True):
        if reading is not None:
            for row in at.tolist():
                used.setdefault(row, []).append(reading)
    return used


def _rows_of_text(poses: Rows, angles: Rows, dT: float, warnings: list[str]) -> list[Integers]:
    """At which rows each reading is used:
    the first whose stamp is not before its own, however late (section 2).
    """
    row = np.searchsorted(poses.t, angles.t, side="left")
    last = len(poses) - 1
    late = np.where(row <= last, poses.t[np.minimum(row, last)] - angles.t, 0.0)
    outside = (row > last) | ((row == 0) & (late > MUCH_LATER * dT))
    _tell(angles, outside, f"is not of the time of {poses.file}", "left out", warnings)
    span = np.max(late[~outside], initial=0.0)
    used = f"taken there all the same; the longest wait is {span:.3g} s"
    _tell(
        angles,
        ~outside & (late > MUCH_LATER * dT),
        f"is {MUCH_LATER * dT:g} s or more before any row",
        used,
        warnings,
    )
    return [row[i : i + 1] if not outside[i] else row[:0] for i in range(len(row))]


def _rows_of_listing(poses: Rows, angles: Rows, dT: float, warnings: list[str]) -> list[Integers]:
    """The same by the listing: every row with t − dT ≤ t_m ≤ t,
    of which there are many where stamps repeat.
    """
    first = np.searchsorted(poses.t, angles.t, side="left")
    end = np.searchsorted(poses.t - dT, angles.t, side="right")
    _tell(angles, end <= first, f"lies in no row's last {dT:g} s", "left out", warnings)
    _tell(
        angles,
        end > first + 1,
        f"lies in more than one row's last {dT:g} s",
        "used at each, by the listing",
        warnings,
    )
    return [np.arange(a, b) for a, b in zip(first, end, strict=True)]


def _tell(angles: Rows, which: Booleans, wrong: str, made: str, warnings: list[str]) -> None:
    """Warn of stamps, and of what is made of them."""
    if rows := np.flatnonzero(which).tolist():
        more = f", and so do {len(rows) - 1} more" if len(rows) > 1 else ""
        warnings.append(
            f"{angles.at(rows[0])}: the stamp {angles.t[rows[0]]:.12g} {wrong}{more}: {made}"
        )
