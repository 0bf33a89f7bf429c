"""The files of one robot in a folder of the UTIAS multi-robot data, whatever they are called."""

import os
import re
from pathlib import Path
from typing import NamedTuple

from ekfsim.errors import UsageError
from ekfsim.files.looking import exists, is_folder, read_from

ODOMETRY, MEASUREMENT, GROUNDTRUTH = "Odometry.dat", "Measurement.dat", "Groundtruth.dat"
LANDMARKS, BARCODES = "Landmark_Groundtruth.dat", "Barcodes.dat"
ENDINGS = (".dat", ".txt", ".csv")  # of any of these; the first that is there
HOLDS = f"Robot1_{ODOMETRY}, Robot1_{MEASUREMENT}, {BARCODES} and {LANDMARKS}"


class RobotFiles(NamedTuple):
    """One robot's files, and those of all robots; the names before them are any, or none."""

    robot: str  # what stands before Odometry.dat
    odometry: Path
    measurement: Path
    landmarks: Path
    truth: Path | None
    barcodes: Path | None


def files_of(path: Path, robot: int | None) -> RobotFiles:
    """The files of the robot whose odometry a path names; of a folder the only robot's, or that of
    a number.

    Raises UsageError where one is missing, or nothing says which robot it is to be.
    """
    with read_from(path):
        if not exists(path):
            raise UsageError(f"{path}: no such folder; name the one that holds {HOLDS}")
        named = not is_folder(path)
    folder = path.parent if named else path
    with read_from(folder):
        there = _as_distributed(os.listdir(folder))
    names = sorted(there)
    named_so = next((name for name, own in there.items() if own == path.name), path.name)
    if named and not named_so.endswith(ODOMETRY):
        wrong = "is a file, and no robot's odometry"
        raise UsageError(f"{path}: {wrong}; name Robot1_{ODOMETRY}, or the folder that holds it")
    odometry = named_so if named else _odometry_in(folder, names, robot)
    prefix = odometry.removesuffix(ODOMETRY)
    if named and robot is not None and robot != _number(prefix):
        wrong = f"is not the odometry of the robot {robot}, which recording.robot names"
        raise UsageError(f"{path}: {wrong}; leave one of the two out")
    landmarks = _of_all(names, prefix, LANDMARKS)
    if landmarks is None:
        raise _missing(folder, LANDMARKS, "the landmarks")
    measurement, truth = f"{prefix}{MEASUREMENT}", f"{prefix}{GROUNDTRUTH}"
    if measurement not in names:
        raise _missing(folder, measurement, "the measurements")
    barcodes = _of_all(names, prefix, BARCODES)
    return RobotFiles(
        prefix.strip("_-. "),
        folder / there[odometry],
        folder / there[measurement],
        folder / there[landmarks],
        folder / there[truth] if truth in names else None,
        folder / there[barcodes] if barcodes is not None else None,
    )


def _as_distributed(names: list[str]) -> dict[str, str]:
    """The files of a folder by the names that they have in the data as distributed, *.dat."""
    found = dict[str, str]()
    for ending in ENDINGS:
        for name in names:
            if name.endswith(ending) and not name.startswith("."):
                found.setdefault(f"{name.removesuffix(ending)}{ENDINGS[0]}", name)
    return found


def _odometry_in(folder: Path, names: list[str], robot: int | None) -> str:
    """The name of the odometry in a folder. Raises UsageError where it is none, or one of many."""
    found = [name for name in names if name.endswith(ODOMETRY)]
    numbers = {name: _number(name.removesuffix(ODOMETRY)) for name in found}
    if not found:
        raise _missing(folder, f"*{ODOMETRY}", "the odometry")
    if robot is not None:
        fit = [name for name in found if numbers[name] == robot]
        if len(fit) != 1:
            told = "no" if not fit else "more than one"
            raise UsageError(f"{folder}: {told} robot {robot} in it; {_choices(folder, found)}")
        return fit[0]
    if len(found) > 1:
        wrong = f"the odometry of {len(found)} robots is in it"
        raise UsageError(f"{folder}: {wrong}; {_choices(folder, found)}")
    return found[0]


def _choices(folder: Path, found: list[str]) -> str:
    """How one of several robots is named."""
    listed = ", ".join([*found[:10], *(["…"] if len(found) > 10 else [])])
    number = next((n for name in found if (n := _number(name.removesuffix(ODOMETRY)))), None)
    by_number = "" if number is None else f", or --set recording.robot={number}"
    return f"name one of {listed}: --log {folder / found[0]}{by_number}"


def _number(prefix: str) -> int | None:
    """The last number in what stands before a file's name: 3 of Robot3_"""
    digits = re.findall(r"\d{1,6}", prefix)
    return int(digits[-1]) if digits else None


def _of_all(names: list[str], prefix: str, ending: str) -> str | None:
    """A file that all robots share: with the robot's own prefix, with none, or with any other."""
    ends = [name for name in names if name.endswith(ending)]
    best = [name for name in (f"{prefix}{ending}", ending) if name in ends]
    return best[0] if best else ends[0] if len(ends) == 1 else None


def _missing(folder: Path, file: str, what: str) -> UsageError:
    return UsageError(f"{folder}: no file '{file}' in it; it would hold {what}")
