"""The narrative: every number is read from the Step, every line is the assignment's or says what it leaves out."""

import math

import numpy as np

from ekfsim.consistency import BAND, inside_cone, inside_ellipse
from ekfsim.filters.belief import Correction, Gaussian, Refused
from ekfsim.filters.chi_square import band
from ekfsim.geometry.ellipse import cone_factor, ellipse
from ekfsim.models.laser import GRAZING, Laser, Sighting
from ekfsim.provenance import told_in_a_line
from ekfsim.records import Control, Kidnap, Move, Nees, Reading, Say, Sense, Step
from ekfsim.scene import Scene
from ekfsim.views.numbers import matrix, number, pose, turn
from ekfsim.views.playback import View


def narrate(view: View, scene: Scene, probability: float = 0.954) -> str:
    """What is said at one press of `n`; every line ends in a newline.

    A sense has two views: the beam, with the text down to the range, and the revised estimate, with the rest.
    """
    step = view.step
    match step.entry.command:
        case None:
            lines = _start(step, scene, probability)
        case Move() as move:
            lines = _move(step, move, scene, probability)
        case Sense(angle):
            lines = _beam(step, angle, scene) if view.beam else _update(step, probability)
        case Kidnap(x, y, theta):
            lines = [f"==>The robot was carried away to (x, y, th) = {pose((x, y, theta))}; the filter was not told"]
            lines += _judged(step, probability)
        case Say(text):
            lines = [f"==>{text}"]
    return "".join(f"{line}\n" for line in [*lines, ""])


def _start(step: Step, scene: Scene, probability: float) -> list[str]:
    return [
        told_in_a_line(scene),
        *scene.description.strip().splitlines(),
        "",
        f"First state estimate is (x, y, theta) = {pose(step.posterior.mean)}",
        "First state covariance matrix is:",
        *matrix(step.posterior.covariance),
        "",
        f"True state is (x, y, th) = {_truth(step)}",
        *_uncertainty(step.posterior, probability),
        *_judged(step, probability),
    ]


def _move(step: Step, move: Move, scene: Scene, probability: float) -> list[str]:
    slip = f", slip={number(move.slip)}" if move.slip else ""
    lines = [f"==>The robot moved: distance={number(move.distance)}, angle={turn(move.angle)}{slip}"]
    bump = step.entry.bump
    if bump is not None and bump >= 0:
        name, edge = scene.world.map.walls.name(int(bump))
        lines.append(f"It bumped into edge {edge} of {name} and stopped short of it; the filter was not told")
    if isinstance(step.entry.given, Control):
        d, a = step.entry.given.u
        lines.append(f"The odometry measured: distance={number(d)}, angle={turn(a)}")
    return [
        *lines,
        f"Current state estimate is (x, y, th) = {pose(step.prior.mean)}",
        f"New state estimate is (x, y, theta) = {pose(step.posterior.mean)}",
        "New state covariance matrix is:",
        *matrix(step.posterior.covariance),
        "",
        f"True state is (x, y, th) = {_truth(step)}",
        *_uncertainty(step.posterior, probability),
        *_judged(step, probability),
    ]


def _beam(step: Step, angle: float, scene: Scene) -> list[str]:
    lines = [f"==>Commanding the robot to sense at an angle of {turn(angle)}"]
    if step.sighting is not None and scene.guard != "off":
        lines += _doubts(step, step.sighting)
    assert isinstance(step.entry.given, Reading)
    z = float(step.entry.given.z[0])
    return [
        *lines,
        "The range is none: no echo, the beam met no wall" if math.isnan(z) else f"The range is {number(z)}",
    ]


def _doubts(step: Step, sighting: Sighting) -> list[str]:
    """What is doubtful about a beam before its reading is used."""
    lines = []
    if sighting.ambiguous:
        lines.append(
            f"This beam is ambiguous: expected to meet {_wall(step)}, but from a pose within 3 sigma it would meet "
            f"{_others(step, sighting)}"
        )
    if sighting.grazing:
        lines.append(
            f"This beam grazes its wall at {turn(float(sighting.incidence))} degrees (below {turn(GRAZING)}): "
            "a small turn would move its end far"
        )
    return lines


def _update(step: Step, probability: float) -> list[str]:
    c = step.correction
    assert c is not None
    lines = []
    if c.refused == Refused.NO_WALL or np.isnan(c.predicted).any():
        lines.append("The predicted range was none: no wall in the filter's map lies that way")
    else:
        by_x, by_y, by_heading = map(number, c.H[0])
        lines += [
            f"The predicted range was {number(c.predicted[0])}",
            f"It was expected to meet {_wall(step)} at {turn(_incidence(step))} degrees",
            "The derivatives are:",
            f"  dh/dx = {by_x}, dh/dy = {by_y}, dh/dth = {by_heading}",
        ]
    lines += [*_innovation(c), *_refusal(c)]
    if c.refused == Refused.NOT:
        lines.append(f"The Kalman gain is (x, y, th) = ({', '.join(number(k) for k in c.K[:, 0])})")
    return [
        *lines,
        f"Revised state estimate: (x, y, theta) = {pose(step.posterior.mean)}",
        "Revised covariance matrix is:",
        *matrix(step.posterior.covariance),
        *_uncertainty(step.posterior, probability),
        *_judged(step, probability),
    ]


def _innovation(c: Correction) -> list[str]:
    if np.isnan(c.innovation[0]):
        return []
    told = f"The innovation is {number(c.innovation[0])}, its standard deviation {number(math.sqrt(c.S[0, 0]))}"
    if np.isnan(c.nis):
        return [f"{told}; nothing is uncertain, so NIS is undefined and the gain is 0"]
    return [f"{told}; NIS is {number(float(c.nis))}", *_beside_band("NIS", float(c.nis), len(c.innovation))]


def _refusal(c: Correction) -> list[str]:
    match Refused(int(c.refused)):
        case Refused.NO_ECHO:
            return ["No echo: the reading is not used"]
        case Refused.NO_WALL:
            return ["No wall: the reading is not used"]
        case Refused.GUARD:
            return ["The guard left this ambiguous reading out"]
        case Refused.GATE:
            return ["The gate refused this reading: its NIS is too large to be believed"]
        case _:
            return []


def _uncertainty(belief: Gaussian, probability: float) -> list[str]:
    drawn = ellipse(belief.covariance, probability)
    factor = cone_factor(probability)
    halfwidth = factor * math.sqrt(belief.covariance[2, 2])
    return [
        "Uncertainty ellipse is:",
        f"  minor radius is {number(float(drawn.minor))}",
        f"  major radius is {number(float(drawn.major))}",
        f"  orientation is {turn(float(drawn.orientation))} degrees",
        f"  {factor:.4g}*sigma_theta is {turn(halfwidth)} degrees",
    ]


def _judged(step: Step, probability: float) -> list[str]:
    """The belief held against the truth, where the truth is known."""
    if step.entry.truth is None or step.nees is None:
        return []
    ellipse_side = "inside" if inside_ellipse(step.posterior, step.entry.truth, probability) else "outside"
    cone_side = "inside" if inside_cone(step.posterior, step.entry.truth, probability) else "outside"
    told = f"The true position lies {ellipse_side} the ellipse, the true heading {cone_side} the cone; "
    return [told + _nees(step.nees), *_nees_beside_band(step.nees)]


def _nees(measured: Nees) -> str:
    if measured.impossible:
        return "the belief is impossible: the error has a part where the covariance claims certainty"
    return f"NEES is {number(float(measured.value))} ({_count(int(measured.dof), 'degree')} of freedom)"


def _nees_beside_band(measured: Nees) -> list[str]:
    if measured.impossible or measured.dof == 0:
        return []
    return _beside_band("NEES", float(measured.value), int(measured.dof))


def _beside_band(name: str, value: float, dof: int) -> list[str]:
    """A line of its own for a value outside its two-sided 99 % band, on either side."""
    low, high = band(BAND, dof)
    if low <= value <= high:
        return []
    side = "above" if value > high else "below"
    return [f"{name} lies {side} its two-sided {100 * BAND:.0f} % band, {number(low)} to {number(high)}"]


def _wall(step: Step) -> str:
    assert step.sighting is not None
    return _wall_name(step, int(step.sighting.wall))


def _others(step: Step, sighting: Sighting) -> str:
    """The other walls that the beam would meet from the poses around the estimate, each named once."""
    line = _laser(step).walls.line
    own = line[sighting.wall] if sighting.wall >= 0 else -1
    others = [int(w) for w in sighting.probe_walls if (line[w] if w >= 0 else -1) != own]
    return " or ".join(dict.fromkeys(_wall_name(step, wall) for wall in others))


def _wall_name(step: Step, wall: int) -> str:
    if wall < 0:
        return "no wall"
    name, edge = _laser(step).walls.name(wall)
    return f"edge {edge} of {name}"


def _laser(step: Step) -> Laser:
    assert isinstance(step.entry.given, Reading)
    assert isinstance(step.entry.given.sensor, Laser)
    return step.entry.given.sensor


def _incidence(step: Step) -> float:
    assert step.sighting is not None
    return float(step.sighting.incidence)


def _truth(step: Step) -> str:
    return "unknown" if step.entry.truth is None else pose(step.entry.truth)


def _count(n: int, thing: str) -> str:
    return f"{n} {thing}" if n == 1 else f"{n} {thing}s"
