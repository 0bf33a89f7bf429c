"""A log of document 003: wheel speeds, satellite fixes, and the true pose."""

from pathlib import Path

import numpy as np

from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.folder import find, find_any, folder_of
from ekfsim.files.logs.formats.targets import only
from ekfsim.files.logs.ordering import apart, in_order, tell_gaps, tell_repeated
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.table import Rows, named_table, some
from ekfsim.files.logs.timeline import Motions, Sample, Timeline
from ekfsim.files.logs.truth import Truth, truth_of
from ekfsim.geometry import Array
from ekfsim.records import Reading
from ekfsim.systems.instruments import Gnss

TIME = ("t", "time")
HEADING = ("heading", "phi", "theta")
HOLDS = "wheelspeeds*.csv, gnss*.csv and, where it is known, groundtruth*.csv"


def read_gnss(asked: Asked) -> Recorded:
    """Each row of wheel speeds tells the speeds since the row before it; the first is the start.

    `coded` has all rows and all fixes, whatever their stamps, as the authors' program has: no fix
    cuts a row in two.

    Raises UsageError where a file is missing, InputError with what is wrong in one.
    """
    path, world, reading, recording, warnings = asked
    folder = folder_of(path, HOLDS)
    wheels_file = find(folder, "the wheel speeds", "wheelspeeds*.csv")
    fixes_file = find(folder, "the satellite fixes", "gnss*.csv")
    truth = read_truth(folder, warnings)
    wheels = some(named_table(wheels_file, (TIME, ("vl",), ("vr",)), warnings), "wheel speeds")
    if reading == "coded":
        wheels = in_order(wheels, warnings)
        tell_repeated(wheels, warnings)
    else:
        wheels = apart(wheels, warnings, recording.same_time)
    tell_gaps(wheels, warnings)
    fixes = in_order(named_table(fixes_file, (TIME, ("x",), ("y",)), warnings), warnings)
    tell_gaps(fixes, warnings)
    u = np.column_stack([wheels.values[1:, 1:], np.diff(wheels.t)])
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
        Sample(t, Reading(gnss.sensor, z, gnss.name))
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


def read_truth(folder: Path, warnings: list[str]) -> Truth | None:
    """The true poses of a log that has them."""
    file = find_any(folder, "the true poses", "groundtruth*.csv")
    if file is None:
        warnings.append(
            f"{folder}: no groundtruth*.csv in it: the truth is unknown, and so are the errors"
        )
        return None
    return truth_of(named_table(file, (TIME, ("x",), ("y",), HEADING), warnings), warnings)
