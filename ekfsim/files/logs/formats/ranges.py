"""A log of ranges to radio nodes (Plaza):
way and turn since the last row, ranges, nodes, and the true pose.
"""

import math
from dataclasses import replace
from pathlib import Path

import numpy as np

from ekfsim.files.keys.recorded.recording import TurnTruth
from ekfsim.files.logs.asked import Asked
from ekfsim.files.logs.folder import find, folder_of
from ekfsim.files.logs.formats.groundtruth import GROUNDTRUTH, TIME, X, Y, read_truth
from ekfsim.files.logs.formats.targets import landmarks_of, of_landmarks
from ekfsim.files.logs.ordering import apart, in_order, step_of, tell_gaps
from ekfsim.files.logs.recorded import Recorded
from ekfsim.files.logs.table import Rows, some
from ekfsim.files.logs.tables.declared import Column, Format, Table
from ekfsim.files.logs.tables.reading import read_table
from ekfsim.files.logs.timeline import Motions, Sample, Timeline
from ekfsim.files.logs.truth import Truth
from ekfsim.geometry.angles import wrap
from ekfsim.records import Reading
from ekfsim.systems.document import DocumentReading
from ekfsim.systems.instrument import Landmark
from ekfsim.systems.instruments import Ranges
from ekfsim.world import World

ODOMETRY = Table(
    "the odometry",
    ("odometry*.csv",),
    (
        TIME,
        Column("distance", "m", "way since the row before, backwards negative"),
        Column(
            "dheading", "rad", "turn since the row before, counter-clockwise", most=10, per_row=True
        ),
    ),
    example="""\
t,distance,dheading
0.1,0.3,0.0
0.2,0.3,0.01
0.3,0.31,0.01
0.4,0.3,0.02
0.5,0.3,0.02
""",
)
RANGES = Table(
    "the ranges",
    ("ranges*.csv",),
    (
        TIME,
        Column("node", "", "which node answered, a whole number"),
        Column("range", "m", "how far it is, as measured", positive=True),
    ),
    example="""\
t,node,range
0.1,1,10.6
0.2,2,14.5
0.3,1,10.4
0.4,3,22.0
0.5,2,14.1
""",
)
NODES = Table(
    "the nodes",
    ("nodes*.csv",),
    (Column("node", "", "its number"), X, Y),
    example="""\
node,x,y
1,10.0,0.0
2,0.0,14.0
3,20.0,10.0
4,-5.0,-5.0
5,0.0,-20.0
""",
)
PLAZA = Format(
    "ranges",
    "Way and turn of a robot, and ranges to radio nodes, as in the Plaza data; `ekfsim record` "
    "writes the format log in its place. A row of the odometry is a stride that ends at its time.",
    (ODOMETRY, RANGES, NODES, GROUNDTRUTH),
)
FIRST_METRES = 2.0  # of travel, by which a stored heading is found to point ahead or back


def read_ranges(asked: Asked) -> Recorded:
    """Each row of the odometry is a stride that ends at its time. Errors are counted there.

    Raises UsageError where a file is missing, InputError with what is wrong in one.
    """
    path, world, reading, recording, warnings = asked
    folder = folder_of(path, PLAZA.holds)
    odometry_file = find(folder, ODOMETRY.what, *ODOMETRY.files)
    ranges_file = find(folder, RANGES.what, *RANGES.files)
    nodes = read_table(find(folder, NODES.what, *NODES.files), NODES, asked)
    odometry = some(read_table(odometry_file, ODOMETRY, asked), "odometry")
    odometry = apart(odometry, warnings, recording.same_time)
    truth = read_truth(folder, asked, odometry)
    tell_gaps(odometry, warnings)
    if truth is not None:
        truth = _ahead(truth, odometry, recording.turn_truth, folder, warnings)
    ranges = in_order(read_table(ranges_file, RANGES, asked, odometry), warnings)
    landmarks = landmarks_of(nodes)
    start = _start(odometry, truth)
    begin = np.concatenate([[start], odometry.t[:-1]])
    u = np.column_stack([odometry.values[:, 1:], odometry.t - begin])
    motions = Motions(
        world.believed_robot.motion(reading), begin, odometry.t, u, np.array([True, True, True])
    )
    samples = _samples(ranges, landmarks, world, reading, warnings)
    return Timeline(str(path), start, motions, samples, truth, landmarks, between=False).recorded(
        world, reading, warnings
    )


def _start(odometry: Rows, truth: Truth | None) -> float:
    """When the first stride began:
    a usual step before its end, at a pose of the truth where one is near.
    """
    step = step_of(odometry)
    start = float(odometry.t[0]) - step
    if truth is not None:
        nearest = float(truth.t[np.argmin(np.abs(truth.t - start))])
        start = nearest if abs(nearest - start) < step / 2 else start
    return start


def _ahead(
    truth: Truth, odometry: Rows, turn: TurnTruth, folder: Path, warnings: list[str]
) -> Truth:
    """The truth with headings that point where the robot goes when its odometry counts up:
    logs of this kind differ; or turned about as it was asked.
    """
    if turn == "never" or (turn == "auto" and not _points_back(truth, odometry)):
        return truth
    if turn == "auto":
        told = "the true headings point against the first metres of travel as the odometry counts"
        warnings.append(
            f"{folder}: {told} them: half a turn is added "
            "(otherwise: --set recording.turnTruth=never)"
        )
    poses = truth.poses.copy()
    poses[:, 2] = np.unwrap(wrap(poses[:, 2] + math.pi))
    return replace(truth, poses=poses)


def _points_back(truth: Truth, odometry: Rows) -> bool:
    """Whether the true headings point against where the robot goes as its odometry counts.

    The first metres decide: Σ d_odometry (d_truth · heading) < 0 is back.
    Driven in reverse, both factors are negative.
    """
    poses = truth.at(odometry.t)
    d, steps = odometry.values[1:, 1], np.diff(poses[:, :2], axis=0)
    θ = poses[:-1, 2] + wrap(np.diff(poses[:, 2])) / 2
    along = d * (steps[:, 0] * np.cos(θ) + steps[:, 1] * np.sin(θ))
    known = np.isfinite(along)
    first = int(np.searchsorted(np.cumsum(np.abs(d[known])), FIRST_METRES)) + 1
    return bool(np.sum(along[known][:first]) < 0)


def _samples(
    ranges: Rows,
    landmarks: tuple[Landmark, ...],
    world: World,
    reading: DocumentReading,
    warnings: list[str],
) -> list[Sample]:
    """What each row tells of a node."""
    samples, unknown = list[Sample](), list[int]()
    for instrument, targets in of_landmarks(world, reading, landmarks, (Ranges,))[:1]:
        assert isinstance(instrument, Ranges)
        for row, (t, node, raw) in enumerate(ranges.values.tolist()):
            target = targets.get(int(node)) if node == int(node) else None
            if target is None:
                unknown.append(row)
            else:
                z = np.array([instrument.corrected(raw)])
                samples.append(Sample(t, Reading(target.sensor, z, target.name), target.delay))
    if unknown:
        node, more = (
            ranges.values[unknown[0], 1],
            f", nor those of {len(unknown) - 1} more rows" * (len(unknown) > 1),
        )
        warnings.append(f"{ranges.at(unknown[0])}: nodes.csv has no node {node:g}{more}: left out")
    return samples
