"""Trajectories that other programs read: TUM text for evo, a flat CSV table for a spreadsheet."""

import csv
import math
from typing import TextIO

from ekfsim.filters.belief import Refused
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import ellipse
from ekfsim.provenance import provenance, told_in_a_line
from ekfsim.records import Reading, Step
from ekfsim.scene import Scene


class Tum:
    """Writes `t x y 0 0 0 qz qw` lines of the truth and of the estimate; t is the index of the step."""

    def __init__(self, truth: TextIO, estimate: TextIO, scene: Scene) -> None:
        self._truth, self._estimate = truth, estimate
        for file, name in ((truth, "truth"), (estimate, "estimate")):
            file.write(f"# {name}: {told_in_a_line(scene)}\n# step x y z qx qy qz qw (m, unit quaternion)\n")

    def write(self, step: Step) -> None:
        """Append the two poses after this step."""
        self._estimate.write(_tum_line(step.entry.index, step.posterior.mean))
        if step.entry.truth is not None:
            self._truth.write(_tum_line(step.entry.index, step.entry.truth))


def _tum_line(t: float, pose: Array) -> str:
    x, y, theta = pose.tolist()
    return f"{t} {x!r} {y!r} 0 0 0 {math.sin(theta / 2)!r} {math.cos(theta / 2)!r}\n"


COLUMNS = (
    *("index", "type", "x", "y", "theta"),
    *("P_xx", "P_xy", "P_xtheta", "P_yy", "P_ytheta", "P_thetatheta"),
    *("true_x", "true_y", "true_theta"),
    *("range", "predicted_range", "innovation", "innovation_variance", "nis", "refused"),
    *("ellipse_major", "ellipse_minor", "ellipse_orientation", "nees", "nees_dof", "impossible"),
)


class Table:
    """Writes a row a step; m, rad and their squares. An empty cell is a number that is undefined."""

    def __init__(self, file: TextIO, scene: Scene, confidence: float) -> None:
        self._origin = [_cell(value) for value in provenance(scene).values()]
        self._confidence = confidence
        self._csv = csv.writer(file, lineterminator="\n")
        self._csv.writerow([*COLUMNS, *provenance(scene), "confidence"])

    def write(self, step: Step) -> None:
        """Append the row of this step."""
        command, P = step.entry.command, step.posterior.covariance
        drawn, measured = ellipse(P, self._confidence), step.nees
        self._csv.writerow(
            [
                step.entry.index,
                "start" if command is None else type(command).__name__.lower(),
                *step.posterior.mean.tolist(),
                *(float(P[i, j]) for i in range(3) for j in range(i, 3)),
                *([""] * 3 if step.entry.truth is None else step.entry.truth.tolist()),
                *_reading(step),
                *map(float, (drawn.major, drawn.minor, drawn.orientation)),
                *(
                    [""] * 3
                    if measured is None
                    else map(_cell, (float(measured.value), int(measured.dof), bool(measured.impossible)))
                ),
                *self._origin,
                self._confidence,
            ]
        )


def _reading(step: Step) -> list[object]:
    c = step.correction
    if c is None or not isinstance(step.entry.given, Reading):
        return [""] * 6
    numbers = (step.entry.given.z[0], c.predicted[0], c.innovation[0], c.S[0, 0], c.nis)
    return [*(_cell(float(n)) for n in numbers), Refused(int(c.refused)).word or ""]


def _cell(value: object) -> object:
    """As it stands in the table: nothing for None and nan, 1 and 0 for true and false."""
    if value is None or (isinstance(value, float) and math.isnan(value)):
        return ""
    return int(value) if isinstance(value, bool) else value
