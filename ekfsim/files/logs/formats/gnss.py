"""A log of document 003: wheel speeds, satellite fixes, and the true pose."""

import numpy as np

from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.folder import find, folder_of
from ekfsim.files.logs.formats.groundtruth import GROUNDTRUTH, TIME, X, Y, read_truth
from ekfsim.files.logs.formats.targets import only
from ekfsim.files.logs.ordering import apart, in_order, tell_gaps, tell_repeated
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.table import Rows, some
from ekfsim.files.logs.tables.declared import Column, Format, Table
from ekfsim.files.logs.tables.reading import read_table
from ekfsim.files.logs.timeline import Motions, Sample, Timeline
from ekfsim.geometry import Array
from ekfsim.records import Reading
from ekfsim.systems.instruments import Gnss

WHEELS = Table(
    "the wheel speeds",
    ("wheelspeeds*.csv",),
    (
        TIME,
        Column("vr", "m/s", "speed of the right wheel since the row before"),
        Column("vl", "m/s", "speed of the left wheel since the row before"),
    ),
    told="The first row is the start: its speeds count for nothing.",
    example="""\
t,vr,vl
0.0,0.0,0.0
0.1,0.5,0.5
0.2,0.5,0.5
0.3,0.5,0.45
0.4,0.5,0.45
""",
)
FIXES = Table(
    "the satellite fixes",
    ("gnss*.csv",),
    (TIME, X, Y),
    example="""\
t,x,y
0.05,0.1,-0.05
0.15,0.0,0.1
0.25,0.2,0.05
0.3,0.1,0.0
0.35,0.2,0.1
""",
)
GNSS = Format(
    "gnss",
    "Wheel speeds and satellite fixes in metres of a plane, as in the course TME290; "
    "`ekfsim record --format own` writes it of the system gnss.",
    (WHEELS, FIXES, GROUNDTRUTH),
)


def read_gnss(asked: Asked) -> Recorded:
    """Each row of wheel speeds tells the speeds since the row before it; the first is the start.

    `coded` has all rows and all fixes, whatever their stamps, as the authors' program has: no fix
    cuts a row in two.

    Raises UsageError where a file is missing, InputError with what is wrong in one.
    """
    path, world, reading, recording, warnings = asked
    folder = folder_of(path, GNSS.holds)
    wheels_file = find(folder, WHEELS.what, *WHEELS.files)
    fixes_file = find(folder, FIXES.what, *FIXES.files)
    wheels = some(read_table(wheels_file, WHEELS, asked), "wheel speeds")
    if reading == "coded":
        wheels = in_order(wheels, warnings)
        tell_repeated(wheels, warnings)
    else:
        wheels = apart(wheels, warnings, recording.same_time)
    truth = read_truth(folder, asked, wheels)
    tell_gaps(wheels, warnings)
    fixes = in_order(read_table(fixes_file, FIXES, asked, wheels), warnings)
    tell_gaps(fixes, warnings)
    left_right = wheels.values[1:, [2, 1]]
    u = np.column_stack([left_right, np.diff(wheels.t)])
    motions = Motions(
        world.believed_robot.motion(reading),
        wheels.t[:-1],
        wheels.t[1:],
        u,
        np.array([False, False, True]),
    )
    gnss = only(world, reading, Gnss)
    taken = _at_rows(fixes, wheels, warnings) if reading == "coded" else fixes.t
    samples = [
        Sample(t, Reading(gnss.sensor, z, gnss.name), gnss.delay)
        for t, z in zip(taken.tolist(), fixes.values[:, 1:], strict=True)
    ]
    return Timeline(str(path), float(wheels.t[0]), motions, samples, truth).recorded(
        world, reading, warnings
    )


def _at_rows(fixes: Rows, wheels: Rows, warnings: list[str]) -> Array:
    """The time of the first row of the wheels that is not before each fix,
    or of the last row : (n,) s
    """
    if outside := np.count_nonzero((fixes.t < wheels.t[0]) | (fixes.t > wheels.t[-1])):
        found = "1 fix is" if outside == 1 else f"{outside} fixes are"
        told = f"{fixes.file}: {found} of before or after {wheels.file}"
        warnings.append(f"{told}: spread over its rows all the same, as the authors' program does")
    return wheels.t[np.minimum(np.searchsorted(wheels.t, fixes.t), len(wheels) - 1)]
