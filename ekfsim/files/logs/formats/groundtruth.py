"""The true poses beside a log in CSV files, and columns that several formats share."""

from pathlib import Path

from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.folder import find_any
from ekfsim.files.logs.table import Rows
from ekfsim.files.logs.tables.declared import Column, Table
from ekfsim.files.logs.tables.reading import read_table
from ekfsim.files.logs.truth import Truth, truth_of

LATEST = 1e12  # s, until the year 33658
GRID = 1e8  # m, of any map grid
TIME = Column("t", "s", "the time, since 1970 or since any instant", ("time",), largest=LATEST)
X = Column("x", "m", "to the east, or along the map's first axis", largest=GRID)
Y = Column("y", "m", "to the north, or along the map's second axis", largest=GRID)
HEADING = Column("heading", "rad", "counter-clockwise from x, wrapped or not", ("phi", "theta"))
GROUNDTRUTH = Table(
    "the true poses",
    ("groundtruth*.csv",),
    (TIME, X, Y, HEADING),
    needed=False,
    told="They are interpolated; over gaps of a second and ten usual steps they are unknown.",
    example="""\
t,x,y,heading
0.0,0.0,0.0,0.0
0.1,0.05,0.0,0.01
0.2,0.1,0.001,0.02
0.3,0.15,0.002,0.03
0.4,0.2,0.004,0.04
""",
)


def read_truth(folder: Path, asked: Asked, motion: Rows) -> Truth | None:
    """The true poses of a log that has them."""
    file = find_any(folder, GROUNDTRUTH.what, *GROUNDTRUTH.files)
    if file is None:
        asked.warnings.append(
            f"{folder}: no groundtruth*.csv in it: the truth is unknown, and so are the errors"
        )
        return None
    return truth_of(read_table(file, GROUNDTRUTH, asked, motion), asked.warnings)
