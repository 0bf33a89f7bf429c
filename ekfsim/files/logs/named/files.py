"""Which files of a folder hold what."""

import os
from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.files.logs.folder import find
from ekfsim.files.looking import read_from

HOLDS = (
    "motion.csv, readings.csv and, where they are known, landmarks.csv, truth.csv and world.yaml"
)


def motion_file(folder: Path) -> Path:
    """The table of what the robot did. Raises UsageError where there is none, or several."""
    return find(folder, "what the robot did", "motion*.csv", "odometry*.csv")


def readings_files(folder: Path) -> list[Path]:
    """The tables of readings, in the order of their names. Raises UsageError where none is."""
    with read_from(folder):
        names = sorted(name for name in os.listdir(folder) if name.endswith(".csv"))
    found = [folder / name for name in names if name.startswith("readings")]
    if not found:
        raise UsageError(f"{folder}: no file 'readings*.csv' in it; it would hold the readings")
    return found
