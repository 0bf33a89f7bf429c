"""A log of document 001's robot, in ekfsim's own format:
ways of the wheels, ultrasonic and infrared beams.
"""

from pathlib import Path

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.folder import find, find_any, folder_of
from ekfsim.files.logs.formats.gnss import TIME, read_truth
from ekfsim.files.logs.formats.targets import by_name
from ekfsim.files.logs.ordering import apart, in_order, tell_gaps
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.table import Rows, named_table, some
from ekfsim.files.logs.timeline import Motions, Sample, Timeline
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion
from ekfsim.records import Reading
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.instrument import Target
from ekfsim.systems.instruments import Compass, Gyro, Infrared, Ultrasonic
from ekfsim.world import World

HOLDS = (
    "odometry.csv, ultrasonic.csv or infrared.csv or both and, where it is known, groundtruth.csv"
)
FILES = {  # each file's columns, beside t; the yaws in rad
    Ultrasonic.name: ("beam", "range"),
    Infrared.name: ("pair", "intensity"),
    Compass.name: ("yaw",),
    Gyro.name: ("yaw",),
}


def read_pioneer(asked: Asked) -> Recorded:
    """Each row of the odometry tells the ways since the row before it; the first is the start. A
    compass or a gyro of the world has a file of its own, t and yaw.

    Raises UsageError where a file is missing, InputError with what is wrong in one.
    """
    path, world, reading, recording, warnings = asked
    folder = folder_of(path, HOLDS)
    odometry_file = find(folder, "the odometry", "odometry*.csv")
    columns = TIME, ("left",), ("right",)
    odometry = some(named_table(odometry_file, columns, warnings), "odometry")
    odometry = apart(odometry, warnings, recording.same_time)
    if np.any(odometry.values[0, 1:]):
        warnings.append(f"{odometry.at(0)}: the first row is the start: its ways count for nothing")
    tell_gaps(odometry, warnings)
    truth = read_truth(folder, warnings)
    samples = _samples(folder, world, reading, warnings)
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


def _samples(
    folder: Path, world: World, reading: DocumentReading, warnings: list[str]
) -> list[Sample]:
    """The readings of the world's instruments, in the order in which the world names them."""
    samples, wanted, found = list[Sample](), list[str](), list[Path]()
    for instrument in world.told_instruments:
        if instrument.name not in FILES:
            continue
        wanted.append(instrument.name)
        file = find_any(folder, f"the {instrument.name}", f"{instrument.name}*.csv")
        if file is None:
            warnings.append(f"{folder}: no {instrument.name}.csv in it: there are no such readings")
            continue
        found.append(file)
        beams = in_order(
            named_table(file, (TIME, *((name,) for name in FILES[instrument.name])), warnings),
            warnings,
        )
        samples += _read(beams, instrument.name, by_name(world, reading, instrument), warnings)
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
            samples.append(Sample(t, Reading(target.sensor, np.array([value]), target.name)))
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
