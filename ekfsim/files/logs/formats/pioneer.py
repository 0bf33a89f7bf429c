"""A log of document 001's robot, in ekfsim's own format:
ways of the wheels, ultrasonic and infrared beams.
"""

from pathlib import Path

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.folder import find, find_any, folder_of
from ekfsim.files.logs.formats.groundtruth import GROUNDTRUTH, TIME, read_truth
from ekfsim.files.logs.formats.targets import by_name
from ekfsim.files.logs.ordering import apart, in_order, tell_gaps
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.table import Rows, some
from ekfsim.files.logs.tables.declared import Column, Format, Table
from ekfsim.files.logs.tables.reading import read_table
from ekfsim.files.logs.timeline import Motions, Sample, Timeline
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion
from ekfsim.records import Reading
from ekfsim.systems.instrument import Target
from ekfsim.systems.instruments import Compass, Gyro, Infrared, Ultrasonic

ODOMETRY = Table(
    "the odometry",
    ("odometry*.csv",),
    (
        TIME,
        Column("left", "m", "way of the left wheel since the row before"),
        Column("right", "m", "way of the right wheel since the row before"),
    ),
    told="The first row is the start: its ways count for nothing.",
    example="""\
t,left,right
0.0,0.0,0.0
0.1,0.05,0.05
0.2,0.05,0.05
0.3,0.05,0.052
0.4,0.05,0.052
""",
)
ULTRASONIC = Table(
    "the ultrasonic beams",
    ("ultrasonic*.csv",),
    (
        TIME,
        Column("beam", "", "its number in the world, from 0"),
        Column("range", "m", "how far the wall is"),
    ),
    needed=False,
    told="Of this and the infrared beams one is needed.",
    example="""\
t,beam,range
0.1,0,1.95
0.1,1,2.40
0.2,0,1.90
0.2,1,2.41
0.3,0,1.85
""",
)
INFRARED = Table(
    "the infrared beams",
    ("infrared*.csv",),
    (
        TIME,
        Column("pair", "", "its number in the world, from 0"),
        Column("intensity", "1", "what came back, as the world's sensor has it"),
    ),
    needed=False,
    example="""\
t,pair,intensity
0.1,0,0.25
0.1,1,0.31
0.2,0,0.26
0.2,1,0.31
0.3,0,0.27
""",
)
COMPASS = Table(
    "the compass",
    ("compass*.csv",),
    (TIME, Column("yaw", "rad", "counter-clockwise from x")),
    needed=False,
    told="Where the world has the sensor.",
    example="""\
t,yaw
0.1,0.01
0.2,-0.02
0.3,0.01
0.4,0.03
0.5,0.02
""",
)
GYRO = COMPASS.but(what="the gyro's yaw", files=("gyro*.csv",))
PIONEER = Format(
    "pioneer",
    "Ways of the wheels and beams among walls, the robot of document 001 in ekfsim's own format; "
    "`ekfsim record --format own` writes it.",
    (ODOMETRY, ULTRASONIC, INFRARED, COMPASS, GYRO, GROUNDTRUTH),
)
FILES = {
    Ultrasonic.name: ULTRASONIC,
    Infrared.name: INFRARED,
    Compass.name: COMPASS,
    Gyro.name: GYRO,
}


def read_pioneer(asked: Asked) -> Recorded:
    """Each row of the odometry tells the ways since the row before it; the first is the start. A
    compass or a gyro of the world has a file of its own, t and yaw.

    Raises UsageError where a file is missing, InputError with what is wrong in one.
    """
    path, world, reading, recording, warnings = asked
    folder = folder_of(path, PIONEER.holds)
    odometry_file = find(folder, ODOMETRY.what, *ODOMETRY.files)
    odometry = some(read_table(odometry_file, ODOMETRY, asked), "odometry")
    odometry = apart(odometry, warnings, recording.same_time)
    if np.any(odometry.values[0, 1:]):
        warnings.append(f"{odometry.at(0)}: the first row is the start: its ways count for nothing")
    tell_gaps(odometry, warnings)
    truth = read_truth(folder, asked, odometry)
    samples = _samples(folder, asked, odometry)
    motion = world.believed_robot.motion(reading)
    u = _inputs(motion, odometry.values[1:, 1:], np.diff(odometry.t))
    motions = Motions(motion, odometry.t[:-1], odometry.t[1:], u, _amounts(motion))
    return Timeline(str(path), float(odometry.t[0]), motions, samples, truth).recorded(
        world, reading, warnings
    )


def _amounts(motion: Motion) -> Booleans:
    """Which entries of the input grow with the time: ways and dt do, speeds do not."""
    return np.array([quantity.unit in ("m", "s") for quantity in motion.inputs])


def _inputs(motion: Motion, ways: Array, dt: Array) -> Array:
    """The ways of the wheels as this model takes them: themselves, or as speeds over dt : (n, m)"""
    if _amounts(motion).all():
        return ways
    speeds = np.divide(ways, dt[:, None], out=np.zeros_like(ways), where=dt[:, None] > 0)
    return np.column_stack([speeds, dt])


def _samples(folder: Path, asked: Asked, odometry: Rows) -> list[Sample]:
    """The readings of the world's instruments, in the order in which the world names them."""
    _, world, reading, _, warnings = asked
    samples, wanted, found = list[Sample](), list[str](), list[Path]()
    for instrument in world.told_instruments:
        if instrument.name not in FILES:
            continue
        called, table = instrument.called, FILES[instrument.name]
        if called != instrument.name:  # a file of its own name
            table = table.but(what=f"the {called}", files=(f"{called}*.csv",))
        wanted.append(called)
        file = find_any(folder, table.what, *table.files)
        if file is None:
            warnings.append(f"{folder}: no {called}.csv in it: there are no such readings")
            continue
        found.append(file)
        beams = in_order(read_table(file, table, asked, odometry), warnings)
        samples += _read(beams, called, by_name(world, reading, instrument), warnings)
    if not found:
        names = " nor ".join(f"{name}.csv" for name in wanted or FILES)
        none = (
            f"{'neither' if ' nor ' in names else 'no'} {names} in it for a sensor "
            f"of {world.name!r}"
        )
        none = (
            f"{'neither' if ' nor ' in names else 'no'} {names} in it for a sensor "
            f"of {world.name!r}"
        )
        raise UsageError(f"{folder}: {none}: nothing to localize with")
    return samples


def _read(beams: Rows, kind: str, targets: dict[str, Target], warnings: list[str]) -> list[Sample]:
    """What each row tells of a beam that the world's instrument has."""
    samples, unknown = list[Sample](), list[int]()
    for row, (t, *number, value) in enumerate(beams.values.tolist()):
        target = targets.get(" ".join([kind, *(f"{beam:g}" for beam in number)]))
        if target is None:
            unknown.append(row)
        else:
            read = Reading(target.sensor, np.array([value]), target.name)
            samples.append(Sample(t, read, target.delay))
    if unknown:
        row, more = (
            unknown[0],
            f", nor those of {len(unknown) - 1} more rows" if len(unknown) > 1 else "",
        )
        number = beams.values[row, 1]
        warnings.append(
            f"{beams.at(row)}: the world's {kind} sensor has no number {number:g}{more}: left out"
        )
    return samples
