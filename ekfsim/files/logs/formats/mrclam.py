"""A log of the UTIAS multi-robot data (MRCLAM):
commanded speeds, and landmarks seen by a camera.
"""

from typing import NamedTuple

import numpy as np

from ekfsim.errors import InputError, Mistake, Place, UsageError
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.formats.mrclam_files import BARCODES as BARCODES_FILE
from ekfsim.files.logs.formats.mrclam_files import RobotFiles, files_of
from ekfsim.files.logs.formats.mrclam_tables import (
    BARCODES,
    LANDMARKS,
    MEASUREMENT,
    ODOMETRY,
    TRUTH,
)
from ekfsim.files.logs.formats.targets import landmarks_of, of_landmarks
from ekfsim.files.logs.ordering import apart, in_order, tell_gaps
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.table import Rows, some
from ekfsim.files.logs.tables.reading import read_table
from ekfsim.files.logs.timeline import Motions, Sample, Timeline
from ekfsim.files.logs.truth import Truth, truth_of
from ekfsim.geometry import Array
from ekfsim.records import Reading
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.instrument import Instrument, Landmark
from ekfsim.systems.instruments import Bearings, RangeBearings, Ranges
from ekfsim.world import World

ROBOTS = range(1, 6)  # the subjects that move
ALL_BUT_ODD = 0.99  # of the numbers of the measurements


class Names(NamedTuple):
    """Which subject each number of the measurements means."""

    subject_of: dict[int, int]
    kind: str  # of those numbers, as messages call it


def read_mrclam(asked: Asked) -> Recorded:
    """A row of the odometry holds until the next. Errors are counted at its instants.

    Raises UsageError where a file is missing, InputError with what is wrong in one.
    """
    path, world, reading, recording, warnings = asked
    files = files_of(path, recording.robot)
    landmarks = landmarks_of(read_table(files.landmarks, LANDMARKS, asked))
    odometry = some(read_table(files.odometry, ODOMETRY, asked), "odometry")
    odometry = apart(odometry, warnings, recording.same_time, until_next=True)
    tell_gaps(odometry, warnings)
    seen = in_order(read_table(files.measurement, MEASUREMENT, asked, odometry), warnings)
    truth = _truth(files, asked, odometry)
    names = _names(seen, files, landmarks, asked)
    samples = _samples(seen, names, landmarks, world, reading, warnings)
    u = np.column_stack([odometry.values[:-1, 1:], np.diff(odometry.t)])
    motions = Motions(
        world.believed_robot.motion(reading),
        odometry.t[:-1],
        odometry.t[1:],
        u,
        np.array([False, False, True]),
    )
    timeline = Timeline(
        str(path), float(odometry.t[0]), motions, samples, truth, landmarks, between=False
    )
    return timeline.recorded(world, reading, warnings)


def _truth(files: RobotFiles, asked: Asked, odometry: Rows) -> Truth | None:
    if files.truth is None:
        name = files.odometry.name.replace("Odometry", "Groundtruth")
        asked.warnings.append(
            f"{files.odometry.parent}: no {name} in it: the truth is unknown, and so are the errors"
        )
        return None
    return truth_of(read_table(files.truth, TRUTH, asked, odometry), asked.warnings)


def _names(
    seen: Rows,
    files: RobotFiles,
    landmarks: tuple[Landmark, ...],
    asked: Asked,
) -> Names:
    """The subject that each number of the measurements means: by its barcode, or itself.

    Raises UsageError where there are no barcodes, and the numbers are no subjects.
    """
    targets, warnings = asked.recording.targets, asked.warnings
    given = (
        list[Rows]() if files.barcodes is None else [read_table(files.barcodes, BARCODES, asked)]
    )
    subject_of = _subjects(given[0]) if given else {}
    subjects = {*ROBOTS, *subject_of.values(), *(mark.id for mark in landmarks)}
    themselves = Names({subject: subject for subject in subjects}, "landmark")
    numbers = seen.values[:, 1]
    are_subjects = np.count_nonzero(np.isin(numbers, list(subjects)))
    are_barcodes = np.count_nonzero(np.isin(numbers, list(subject_of)))
    if targets is not None and (targets == "subjects" or given):
        return themselves if targets == "subjects" else Names(subject_of, "barcode")
    if not given:
        if 2 * are_subjects < len(seen):
            raise UsageError(
                f"{files.measurement}: {len(seen) - are_subjects} of {len(seen)} numbers are no "
                f"landmark's; if they are barcodes, put {BARCODES_FILE} beside this file"
            )
        warnings.append(
            f"{files.measurement.parent}: no {BARCODES_FILE} in it: the numbers of the "
            "measurements are taken for those of the landmarks"
        )
        return themselves
    if 2 * are_barcodes < len(seen) and are_subjects >= ALL_BUT_ODD * len(seen):
        warnings.append(
            f"{files.measurement}: {len(seen) - are_barcodes} of {len(seen)} numbers are no "
            "barcode, but all are subjects: read as those of the landmarks themselves "
            "(otherwise: --set recording.targets=barcodes)"
        )
        return themselves
    if are_barcodes and (worn := _worn(numbers, subject_of, landmarks)):
        warnings.append(
            f"{files.landmarks}: its numbers are barcodes, for those of the measurements are among "
            "them and no subjects' are: read so (otherwise: --set recording.targets=barcodes)"
        )
        return worn
    return Names(subject_of, "barcode")


def _worn(
    numbers: Array, subject_of: dict[int, int], landmarks: tuple[Landmark, ...]
) -> Names | None:
    """The numbers of the measurements where the landmarks go by their barcodes, None where by their
    subjects. numbers : (n,)
    """
    robots = {code: subject for code, subject in subject_of.items() if subject in ROBOTS}
    of_landmarks = numbers[~np.isin(numbers, list(robots))]
    ids = [mark.id for mark in landmarks]
    by_subject = [code for code, subject in subject_of.items() if subject in ids]
    if not len(of_landmarks):
        return None
    by_subjects, worn = (np.mean(np.isin(of_landmarks, known)) for known in (by_subject, ids))
    if by_subjects >= 0.5 or worn < ALL_BUT_ODD:
        return None
    return Names({**{id: id for id in ids}, **robots}, "barcode")


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
    names: Names,
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
        f"of no known {names.kind}": [],
        "of no known landmark": [],
    }
    for row, (t, barcode, r, φ) in enumerate(seen.values.tolist()):
        subject = names.subject_of.get(int(barcode)) if barcode == int(barcode) else None
        if subject in known:
            for instrument, targets in instruments:
                target = targets[subject]
                read = Reading(target.sensor, _reading(instrument, r, φ), target.name)
                samples.append(Sample(t, read, target.delay))
        elif subject is None:
            left_out[f"of no known {names.kind}"].append(row)
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
