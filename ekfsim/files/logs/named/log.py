"""A log of anybody's make: tables with named columns, in a folder or in one file."""

from ekfsim.errors import UsageError
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.named.files import Sources, files_of
from ekfsim.files.logs.named.inputs import WANTED as MOTION
from ekfsim.files.logs.named.motion import motions_of, rows_of, tells_ways
from ekfsim.files.logs.named.opening.opened import opened, opened_all
from ekfsim.files.logs.named.opening.ordered import after, numbered
from ekfsim.files.logs.named.places import landmarks_in, truth_in
from ekfsim.files.logs.named.readings import WANTED as READINGS
from ekfsim.files.logs.named.readings import fittings_of, samples_of
from ekfsim.files.logs.named.tables import Table
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.timeline import Timeline


def read_named(asked: Asked) -> Recorded:
    """The log in a folder or a file.

    Raises UsageError where a file is missing, InputError with what is wrong in one.
    """
    return read_tables(asked, files_of(asked.path, asked.recording))


def read_tables(asked: Asked, files: Sources) -> Recorded:
    """What the robot did, what its sensors told, what stands where, and where the robot truly was.
    Errors are counted at the rows of the motion.

    Raises UsageError where a file is missing, InputError with what is wrong in one.
    """
    path, world, reading, _, warnings = asked
    tables = list[Table]()
    source, of_motion = files.motion()
    motion = opened(source, MOTION)
    if not motion.has("t") and tells_ways(motion, of_motion):
        motion = numbered(motion, warnings)
    rows = rows_of(motion, asked)
    files = files.on_one_plane(warnings)
    landmarks, ids = landmarks_in(files, tables, asked)
    truth = truth_in(files, tables, asked, motion, rows)
    motions = motions_of(motion, rows, of_motion, asked, truth)
    known = world.landmarks if landmarks is None else landmarks
    fittings = fittings_of(world, reading, known, ids)
    samples = []
    for source, of_readings in files.readings():
        for part in opened_all(source, READINGS):
            tables.append(after(part, motion))
            samples += samples_of(tables[-1], of_readings, fittings, asked, rows)
            warnings[:] = dict.fromkeys(warnings)  # what is true of one file is told once
    _refuse_unknown(asked, [motion, *tables])
    start = float(motions.begin[0]) if len(motions.begin) else float(rows.t[0])
    timeline = Timeline(str(path), start, motions, samples, truth, landmarks, between=False)
    return timeline.recorded(world, reading, warnings)


def _refuse_unknown(asked: Asked, tables: list[Table]) -> None:
    """Raise UsageError for a column that is told for all tables, and stands in none."""
    told = asked.recording.columns
    for name, theirs in ({} if told is None else told.model_dump(exclude_unset=True)).items():
        if not any(name in table.shared for table in tables):
            wrong = f"recording.columns.{name}: no table of the log has a column {theirs!r}"
            found = dict.fromkeys(known for table in tables for known in table.places)
            raise UsageError(f"{asked.path}: {wrong}; found {', '.join(map(repr, found))}")
