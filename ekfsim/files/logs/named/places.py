"""The landmarks and the true poses of a log."""

from pathlib import Path

import numpy as np

from ekfsim.files.logs.folder import find_any
from ekfsim.files.logs.formats.targets import landmarks_of
from ekfsim.files.logs.named.tables import named
from ekfsim.files.logs.table import Wanted, bare_table
from ekfsim.files.logs.truth import Truth, truth_of
from ekfsim.systems.instrument import Landmark

TUM = Wanted(("t", "x", "y", "qx", "qy", "qz", "qw"), (0, 1, 2, 4, 5, 6, 7), range(8, 9))


def landmarks_in(folder: Path, warnings: list[str]) -> tuple[Landmark, ...] | None:
    """What stands where, None where the log does not tell. Raises InputError with what is wrong."""
    file = find_any(folder, "the landmarks", "landmarks*.csv")
    if file is None:
        return None
    return landmarks_of(named(file, "id,x,y").rows(("id", "x", "y"), warnings))


def truth_in(folder: Path, warnings: list[str]) -> Truth | None:
    """The true poses, None where the log has none. Raises InputError with what is wrong in them."""
    file = find_any(folder, "the true poses", "truth*.csv", "truth*.tum")
    if file is None:
        told = "no truth.csv and no truth.tum in it: the truth is unknown, and so are the errors"
        warnings.append(f"{folder}: {told}")
        return None
    if file.suffix == ".tum":
        rows = bare_table(file, TUM, warnings)
        qx, qy, qz, qw = rows.values[:, 3:].T
        θ = np.arctan2(2 * (qw * qz + qx * qy), 1 - 2 * (qy**2 + qz**2))
        values = np.column_stack([rows.values[:, :3], θ])
        return truth_of(type(rows)(rows.file, rows.lines, values, rows.left_out), warnings)
    return truth_of(named(file, "t,x,y,theta").rows(("t", "x", "y", "theta"), warnings), warnings)
