"""Trajectories that other programs read: TUM text for evo, a flat CSV table for a spreadsheet."""

import csv
import math
from typing import TextIO

import numpy as np

from ekfsim.commands import Untold
from ekfsim.diagnostics.summary import Instants
from ekfsim.diagnostics.unplaced import Unplaced
from ekfsim.files.results.trace import ODOMETRY
from ekfsim.filters.belief import Correction, Mixture, Refused, posed
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import ellipse
from ekfsim.printable import cell
from ekfsim.provenance import provenance, told_in_a_line
from ekfsim.records import Control, Nees, Reading, Step
from ekfsim.scene import Scene


class Tum:
    """Writes `t x y 0 0 0 qz qw` lines of the truth and of the estimate:
    one for each instant that the summary counts.

    The poses are those after its last reading. t is the instant in s;
    where there is no clock, in the classroom, the index of the step.
    So the RMSE that evo finds between the two files is the summary's. Of a log without truth there
    is no file of it: evo reads none that has no rows.
    """

    def __init__(self, truth: TextIO | None, estimate: TextIO, scene: Scene) -> None:
        self._truth, self._estimate, self._layout = truth, estimate, scene.world.layout
        self._instants = Instants()
        self._waiting: Step | None = None  # the last step of an instant, until the next begins
        clock = "step" if scene.commanded else "t (s)"
        for file, name in ((truth, "truth"), (estimate, "estimate")):
            if file is not None:
                file.write(
                    f"# {name}: {told_in_a_line(scene)}\n# {clock} x y z qx qy qz qw (m, "
                    "unit quaternion)\n"
                )

    def write(self, step: Step) -> None:
        """Append the two poses after this step; with a clock, once the next instant begins."""
        if not self._instants.hold(step.entry):
            return
        if step.entry.t is None:
            self._append(step.entry.index, step)
            return
        if self._waiting is not None and self._waiting.entry.t != step.entry.t:
            self.finish()
        self._waiting = step

    def finish(self) -> None:
        """Append the poses of the last instant."""
        if self._waiting is not None:
            self._append(float(self._waiting.entry.t or 0.0), self._waiting)
            self._waiting = None

    def _append(self, t: float, step: Step) -> None:
        self._estimate.write(_tum_line(t, self._layout.pose(step.posterior.mean)))
        if self._truth is not None and step.entry.truth is not None:
            self._truth.write(_tum_line(t, step.entry.truth))


def _tum_line(t: float, pose: Array) -> str:
    x, y, theta = pose.tolist()
    return f"{t!r} {x!r} {y!r} 0 0 0 {math.sin(theta / 2)!r} {math.cos(theta / 2)!r}\n"


# of the CSV table; grows when a column changes its meaning, or goes. It is a column, the last: a
# line before the header would break whoever reads the table
FORMAT = 1
ESTIMATE = ("x", "y", "theta", "P_xx", "P_xy", "P_xtheta", "P_yy", "P_ytheta", "P_thetatheta")
TRUTH = ("true_x", "true_y", "true_theta")
JUDGED = ("ellipse_major", "ellipse_minor", "ellipse_orientation", "nees", "nees_dof", "impossible")
# how far a filter that weighs its readings believed this one; and of a belief of several Gaussians
# their number and, heaviest first, what each weighs and where its mean is; and how many times the
# told R a filter that learns it takes the noise of such readings for
CURED = ("trust", "hypotheses", "weights", "each_x", "each_y", "each_theta", "noise_factor")
COLUMNS = (
    *("index", "type", *ESTIMATE, *TRUTH),
    *("range", "predicted_range", "innovation", "innovation_variance", "nis", "refused"),
    *(*JUDGED, *CURED),
)
# z, predicted and innovation hold all their numbers, with a space between; so do those of each
# hypothesis in both
DRIVEN_COLUMNS = (
    *("index", "t", "type", "sensor", *ESTIMATE, *TRUTH),
    *("z", "predicted", "innovation", "nis", "refused", *JUDGED, *CURED),
)


class Table:
    """Writes a row a step; m, rad and their squares. An empty cell is a number that is undefined.

    Whatever else the state holds, its pose is told.
    """

    def __init__(self, file: TextIO, scene: Scene, confidence: float) -> None:
        self._origin = [cell(_cell(value)) for value in provenance(scene).values()]
        self._confidence, self._commanded = confidence, scene.commanded
        self._unplaced: Unplaced | None = None
        self._csv = csv.writer(file, lineterminator="\n")
        self._csv.writerow(
            [*columns_of(self._commanded), *provenance(scene), "confidence", "format"]
        )

    def write(self, step: Step) -> None:
        """Append the row of this step."""
        if self._unplaced is None:
            self._unplaced = Unplaced(step.posterior, step.layout)
        unplaced = self._unplaced.at(step.posterior)
        row = row_of(step, self._commanded, self._confidence, unplaced)
        self._csv.writerow([*row, *self._origin, self._confidence, FORMAT])


def columns_of(commanded: bool) -> tuple[str, ...]:
    """The columns that say what became of a step: of a robot that obeys commands, or of another."""
    return COLUMNS if commanded else DRIVEN_COLUMNS


def row_of(step: Step, commanded: bool, confidence: float, unplaced: bool = False) -> list[object]:
    """What stands in them; "" where a number is undefined, and where there is no idea of the place
    in place of an ellipse.
    """
    x, P = posed(step.posterior, step.layout)
    drawn, measured = ellipse(P, confidence), step.nees
    return [
        step.entry.index,
        *([_kind(step)] if commanded else _instrument(step)),
        *x.tolist(),
        *(float(P[i, j]) for i in range(3) for j in range(i, 3)),
        *([""] * 3 if step.entry.truth is None else step.entry.truth.tolist()),
        *(_reading(step) if commanded else _numbers(step)),
        *([""] * 3 if unplaced else map(float, (drawn.major, drawn.minor, drawn.orientation))),
        *([""] * 3 if measured is None else map(_cell, _judged(measured))),
        "" if step.correction is None else _cell(_trust(step.correction)),
        *_hypotheses(step),
        "" if step.correction is None else _cell(_learnt(step.correction)),
    ]


def _trust(c: Correction) -> float | None:
    return None if c.trust is None else float(c.trust)


def _learnt(c: Correction) -> float | None:
    return None if c.noise_factor is None else float(c.noise_factor)


def _hypotheses(step: Step) -> list[object]:
    """How many there are, their weights and their poses; nothing of another belief."""
    several = step.posterior
    if not isinstance(several, Mixture):
        return [""] * 5
    used = several.weights > 0
    poses = step.layout.pose(several.means[used])
    return [int(used.sum()), *map(_joined, (several.weights[used], *poses.T))]


def _judged(measured: Nees) -> tuple[float, int, bool]:
    return float(measured.value), int(measured.dof), bool(measured.impossible)


def _kind(step: Step) -> str:
    command = step.entry.command
    if isinstance(command, Untold):
        return "move"
    return "start" if command is None else type(command).__name__.lower()


def _instrument(step: Step) -> list[object]:
    """When a driven robot's step was, which kind it is, and of which sensor."""
    match step.entry.given:
        case Control():
            return [_cell(step.entry.t), "predict", ODOMETRY]
        case Reading(name=name):
            return [_cell(step.entry.t), "update", name]
    return [_cell(step.entry.t), "start", ""]


def _reading(step: Step) -> list[object]:
    c = step.correction
    if c is None or not isinstance(step.entry.given, Reading):
        return [""] * 6
    numbers = (step.entry.given.z[0], c.predicted[0], c.innovation[0], c.S[0, 0], c.nis)
    return [*(_cell(float(n)) for n in numbers), Refused(int(c.refused)).word or ""]


def _numbers(step: Step) -> list[object]:
    """z, predicted, innovation, NIS and why it is refused; of a motion input u alone."""
    given, c = step.entry.given, step.correction
    if isinstance(given, Control):
        return [_joined(given.u), "", "", "", ""]
    if c is None or given is None:
        return [""] * 5
    told = map(_joined, (given.z, c.predicted, c.innovation))
    return [*told, _cell(float(c.nis)), Refused(int(c.refused)).word or ""]


def _joined(values: Array) -> str:
    """Numbers with a space between; nothing where there is none among them."""
    return "" if np.isnan(values).all() else " ".join(map(repr, values.tolist()))


def _cell(value: object) -> object:
    """As it stands in the table: nothing for None and nan, 1 and 0 for true and false."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    return int(value) if isinstance(value, bool) else value
