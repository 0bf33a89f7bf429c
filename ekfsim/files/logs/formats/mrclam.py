"""A log of the UTIAS multi-robot data (MRCLAM):
commanded speeds, and landmarks seen by a camera.
"""

from pathlib import Path

import numpy as np

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.folder import find, find_any, folder_of
from ekfsim.files.logs.formats.targets import landmarks_of, of_landmarks
from ekfsim.files.logs.ordering import in_order, tell_gaps, tell_repeated
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.table import Rows, Wanted, bare_table, some
from ekfsim.files.logs.timeline import Motions, Sample, Timeline
from ekfsim.files.logs.truth import Truth, truth_of
from ekfsim.geometry import Array
from ekfsim.records import Reading
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.instrument import Instrument, Landmark
from ekfsim.systems.instruments import Bearings, RangeBearings, Ranges
from ekfsim.world import World

HOLDS = "Robot*_Odometry.dat, Robot*_Measurement.dat, Barcodes.dat and Landmark_Groundtruth.dat"
ROBOTS = range(1, 6)  # the subjects that move
ODOMETRY = Wanted(("t", "speed", "turn rate"), (0, 1, 2), range(3, 4))
MEASUREMENT = Wanted(
    ("t", "barcode", "range", "bearing"), (0, 1, 2, 3), range(4, 5), ranges=frozenset({"range"})
)
GROUNDTRUTH = Wanted(("t", "x", "y", "orientation"), (0, 1, 2, 3), range(4, 5))
BARCODES = Wanted(("subject", "barcode"), (0, 1), range(2, 3))
LANDMARKS = Wanted(("subject", "x", "y"), (0, 1, 2), range(3, 6))


def read_mrclam(asked: Asked) -> Recorded:
    """A row of the odometry holds until the next. Errors are counted at its instants.

    Raises UsageError where a file is missing, InputError with what is wrong in one.
    """
    path, world, reading, _, warnings = asked
    folder = folder_of(path, HOLDS)
    odometry_file = find(folder, "the odometry", "Robot*_Odometry.dat")
    robot = odometry_file.name.removesuffix("_Odometry.dat")
    seen_file = find(folder, "the measurements", f"{robot}_Measurement.dat")
    barcodes = bare_table(find(folder, "the barcodes", "Barcodes.dat"), BARCODES, warnings)
    places = bare_table(
        find(folder, "the landmarks", "Landmark_Groundtruth.dat"), LANDMARKS, warnings
    )
    landmarks = landmarks_of(places)
    odometry = some(in_order(bare_table(odometry_file, ODOMETRY, warnings), warnings), "odometry")
    tell_repeated(odometry, warnings, ": the last row of one time holds")
    tell_gaps(odometry, warnings)
    seen = in_order(bare_table(seen_file, MEASUREMENT, warnings), warnings)
    truth = _truth(folder, robot, warnings)
    samples = _samples(seen, _subjects(barcodes), landmarks, world, reading, warnings)
    u = np.column_stack([odometry.values[:-1, 1:], np.diff(odometry.t)])
    held = u[:, 2] > 0  # of several rows of one time the last
    motions = Motions(
        world.believed_robot.motion(reading),
        odometry.t[:-1][held],
        odometry.t[1:][held],
        u[held],
        np.array([False, False, True]),
    )
    timeline = Timeline(
        str(path), float(odometry.t[0]), motions, samples, truth, landmarks, between=False
    )
    return timeline.recorded(world, reading, warnings)


def _truth(folder: Path, robot: str, warnings: list[str]) -> Truth | None:
    file = find_any(folder, "the true poses", f"{robot}_Groundtruth.dat")
    if file is None:
        warnings.append(
            f"{folder}: no {robot}_Groundtruth.dat in it: the truth is unknown, and so are "
            "the errors"
        )
        return None
    return truth_of(bare_table(file, GROUNDTRUTH, warnings), warnings)


def _subjects(barcodes: Rows) -> dict[int, int]:
    """The subject that wears each barcode.
    Raises InputError where two wear the same, or one is no whole number.
    """
    subject_of, mistakes = dict[int, int](), list[Mistake]()
    for line, (subject, barcode) in zip(
        barcodes.lines.tolist(), barcodes.values.tolist(), strict=True
    ):
        place = Place(barcodes.file, line)
        if subject != int(subject) or barcode != int(barcode):
            mistakes.append(
                Mistake(
                    place, "", f"{subject:g} or {barcode:g} is no name", "both are whole numbers"
                )
            )
        elif subject_of.setdefault(int(barcode), int(subject)) != subject:
            told = f"the subject {subject_of[int(barcode)]} has the barcode {barcode:g} already"
            mistakes.append(Mistake(place, "", told, "give each its own"))
    if mistakes:
        raise InputError(mistakes)
    return subject_of


def _samples(
    seen: Rows,
    subject_of: dict[int, int],
    landmarks: tuple[Landmark, ...],
    world: World,
    reading: DocumentReading,
    warnings: list[str],
) -> list[Sample]:
    """What each row tells of a landmark, once for each instrument of the world."""
    instruments = of_landmarks(world, reading, landmarks, (RangeBearings, Bearings, Ranges))
    known, samples = {mark.id for mark in landmarks}, list[Sample]()
    left_out: dict[str, list[int]] = {
        "of another robot": [],
        "of no known barcode": [],
        "of no known landmark": [],
    }
    for row, (t, barcode, r, φ) in enumerate(seen.values.tolist()):
        subject = subject_of.get(int(barcode)) if barcode == int(barcode) else None
        if subject in known:
            for instrument, targets in instruments:
                target = targets[subject]
                samples.append(
                    Sample(t, Reading(target.sensor, _reading(instrument, r, φ), target.name))
                )
        elif subject is None:
            left_out["of no known barcode"].append(row)
        else:
            left_out["of another robot" if subject in ROBOTS else "of no known landmark"].append(
                row
            )
    for whose, rows in left_out.items():
        if rows:
            more = f", and so are {len(rows) - 1} more" if len(rows) > 1 else ""
            warnings.append(f"{seen.at(rows[0])}: this measurement is {whose}{more}: left out")
    return samples


def _reading(instrument: Instrument, r: float, φ: float) -> Array:
    """What an instrument that sees range, bearing or both tells of them."""
    if isinstance(instrument, Ranges):
        return np.array([instrument.corrected(r)])
    return np.array([φ]) if isinstance(instrument, Bearings) else np.array([r, φ])
