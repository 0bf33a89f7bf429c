"""The narrative: every number is read from the Step, every line is the assignment's or says what it leaves out."""

import math

import numpy as np

from ekfsim.consistency import BAND, inside_cone, inside_ellipse
from ekfsim.filters.belief import Correction, Gaussian, Refused
from ekfsim.filters.chi_square import band
from ekfsim.geometry.ellipse import cone_factor, cone_halfwidth, ellipse
from ekfsim.models.laser import GRAZING, Laser, Sighting
from ekfsim.provenance import told_in_a_line
from ekfsim.records import Control, Kidnap, Move, Nees, Reading, Say, Sense, Step
from ekfsim.scene import Scene
from ekfsim.views.numbers import fill, number, pose, turn
from ekfsim.views.playback import View

POSE = "(%.6g, %.6g, %.6g)"
MATRIX = "[[%.6g %.6g %.6g]\n[%.6g %.6g %.6g]\n[%.6g %.6g %.6g]]\n"
ODOMETRY = "The odometry measured: distance=%.6g, angle=%.6g\n"
MOVED = f"""\
Current state estimate is (x, y, th) = {POSE}
New state estimate is (x, y, theta) = {POSE}
New state covariance matrix is:
{MATRIX}
"""
TRUTH = f"True state is (x, y, th) = {POSE}\n"
EXPECTED = """\
The predicted range was %.6g
It was expected to meet {} at %.6g degrees
The derivatives are:
  dh/dx = %.6g, dh/dy = %.6g, dh/dth = %.6g
"""
INNOVATION = "The innovation is %.6g, its standard deviation %.6g; NIS is %.6g\n"
CERTAIN = "The innovation is %.6g; nothing is uncertain, so NIS is undefined and the gain is 0\n"
GAIN = "The Kalman gain is (x, y, th) = (%.6g, %.6g, %.6g)\n"
REVISED = f"""\
Revised state estimate: (x, y, theta) = {POSE}
Revised covariance matrix is:
{MATRIX}"""
ELLIPSE = """\
Uncertainty ellipse is:
  minor radius is %.6g
  major radius is %.6g
  orientation is %.6g degrees
  {:.4g}*sigma_theta is %.6g degrees
"""
REFUSED = {
    Refused.NOT: "",
    Refused.NO_ECHO: "No echo: the reading is not used\n",
    Refused.NO_WALL: "No wall: the reading is not used\n",
    Refused.GUARD: "Guard: this ambiguous reading is left out\n",
    Refused.GATE: "Gate: this reading is refused, its NIS is too large to be believed\n",
}


def narrate(view: View, scene: Scene, probability: float = 0.954) -> str:
    """What is said at one press of `n`; every line ends in a newline.

    A sense has two views: the beam, with the text down to the range, and the revised estimate, with the rest.
    """
    step = view.step
    match step.entry.command:
        case None:
            text = _start(step, scene, probability)
        case Move() as move:
            text = _move(step, move, scene, probability)
        case Sense(angle):
            text = _beam(step, angle, scene) if view.beam else _update(step, probability)
        case Kidnap(x, y, theta):
            there = fill(POSE, *pose((x, y, theta)))
            text = f"==>The robot was carried away to (x, y, th) = {there}; the filter was not told\n"
            text += _judged(step, probability)
        case Say(said):
            text = f"==>{_lines(said)}\n"
    return f"{text}\n"


def _start(step: Step, scene: Scene, probability: float) -> str:
    x, P = step.posterior
    return (
        f"{told_in_a_line(scene)}\n{_lines(scene.description)}\n\n"
        + fill(f"First state estimate is (x, y, theta) = {POSE}\n", *pose(x.tolist()))
        + fill(f"First state covariance matrix is:\n{MATRIX}\n", *P.ravel().tolist())
        + _truth(step)
        + _uncertainty(step.posterior, probability)
        + _judged(step, probability)
    )


def _move(step: Step, move: Move, scene: Scene, probability: float) -> str:
    assert isinstance(step.entry.given, Control)
    slip = f", slip={number(move.slip)}" if move.slip else ""
    d, a = step.entry.given.u.tolist()
    before, (x, P) = step.prior.mean, step.posterior
    return (
        f"==>The robot moved: distance={number(move.distance)}, angle={turn(move.angle)}{slip}\n"
        + _bump(step, scene)
        + fill(ODOMETRY, d, math.degrees(a))
        + fill(MOVED, *pose(before.tolist()), *pose(x.tolist()), *P.ravel().tolist())
        + _truth(step)
        + _uncertainty(step.posterior, probability)
        + _judged(step, probability)
    )


def _bump(step: Step, scene: Scene) -> str:
    bump = step.entry.bump
    if bump is None or bump < 0:
        return ""
    name, edge = scene.world.map.walls.name(int(bump))
    return f"It bumped into edge {edge} of {name} and stopped short of it; the filter was not told\n"


def _beam(step: Step, angle: float, scene: Scene) -> str:
    assert isinstance(step.entry.given, Reading)
    z = float(step.entry.given.z[0])
    doubts = "" if step.sighting is None else _doubts(step, step.sighting, scene.guard != "off")
    told = "There is no echo: the beam met no wall\n" if math.isnan(z) else f"The range is {number(z)}\n"
    return f"==>Commanding the robot to sense at an angle of {turn(angle)}\n{doubts}{told}"


def _doubts(step: Step, sighting: Sighting, guarded: bool) -> str:
    """What is doubtful about a beam before its reading is used."""
    doubts = ""
    if sighting.ambiguous and guarded:
        doubts += (
            f"This beam is ambiguous: expected to meet {_wall_name(step, int(sighting.wall))}, but from a pose within "
            f"3 sigma it would meet {_others(step, sighting)}\n"
        )
    if sighting.grazing:
        doubts += (
            f"This beam grazes its wall at {turn(float(sighting.incidence))} degrees (below {turn(GRAZING)}): "
            "a small turn would move its end far\n"
        )
    return doubts


def _update(step: Step, probability: float) -> str:
    c, (x, P) = step.correction, step.posterior
    assert c is not None
    return (
        _expected(step, c)
        + _innovation(c)
        + REFUSED[Refused(int(c.refused))]
        + (fill(GAIN, *c.K[:, 0].tolist()) if c.refused == Refused.NOT else "")
        + fill(REVISED, *pose(x.tolist()), *P.ravel().tolist())
        + _uncertainty(step.posterior, probability)
        + _judged(step, probability)
    )


def _expected(step: Step, c: Correction) -> str:
    h = float(c.predicted[0])
    if math.isnan(h) or step.sighting is None:
        return "No range was predicted: no wall of the filter's map lies that way\n"
    incidence = math.degrees(float(step.sighting.incidence))
    name = _wall_name(step, int(step.sighting.wall)).replace("%", "%%")
    return fill(EXPECTED.format(name), h, incidence, *c.H[0].tolist())


def _innovation(c: Correction) -> str:
    ν, S, nis = float(c.innovation[0]), float(c.S[0, 0]), float(c.nis)
    if math.isnan(ν):
        return ""
    if math.isnan(nis):
        return fill(CERTAIN, ν)
    return fill(INNOVATION, ν, math.sqrt(S), nis) + _beside_band("NIS", nis, len(c.innovation))


def _uncertainty(belief: Gaussian, probability: float) -> str:
    drawn, factor = ellipse(belief.covariance, probability), cone_factor(probability)
    halfwidth = cone_halfwidth(float(belief.covariance[2, 2]), probability)
    return fill(
        ELLIPSE.format(factor),
        float(drawn.minor),
        float(drawn.major),
        math.degrees(drawn.orientation),
        math.degrees(halfwidth),
    )


def _lines(text: str) -> str:
    """A text in plain lines: whatever else breaks a line or moves a cursor has no place in a narrative."""
    return "\n".join(text.strip().splitlines())


def _truth(step: Step) -> str:
    return "" if step.entry.truth is None else fill(TRUTH, *pose(step.entry.truth.tolist()))


def _judged(step: Step, probability: float) -> str:
    """The belief held against the truth, where the truth is known."""
    if step.entry.truth is None or step.nees is None:
        return ""
    ellipse_side = "inside" if inside_ellipse(step.posterior, step.entry.truth, probability) else "outside"
    cone_side = "inside" if inside_cone(step.posterior, step.entry.truth, probability) else "outside"
    told = f"The true position lies {ellipse_side} the ellipse, the true heading {cone_side} the cone; "
    return told + _nees(step.nees)


def _nees(measured: Nees) -> str:
    if measured.impossible:
        return "the belief is impossible: the error has a part where the covariance claims certainty\n"
    value, dof = float(measured.value), int(measured.dof)
    told = f"NEES is {number(value)} ({dof} {'degree' if dof == 1 else 'degrees'} of freedom)\n"
    return told + (_beside_band("NEES", value, dof) if dof else "")


def _beside_band(name: str, value: float, dof: int) -> str:
    """A line of its own for a value outside its two-sided 99 % band, on either side."""
    low, high = band(BAND, dof)
    if low <= value <= high:
        return ""
    side = "above" if value > high else "below"
    return f"{name} lies {side} its two-sided {100 * BAND:.0f} % band, {number(low)} to {number(high)}\n"


def _others(step: Step, sighting: Sighting) -> str:
    """The other walls that the beam would meet from the poses around the estimate, each named once."""
    line = np.append(_laser(step).walls.line, -1)  # the wall −1, none, takes the last
    others = sighting.probe_walls[line[sighting.probe_walls] != line[sighting.wall]]
    return " or ".join(dict.fromkeys(_wall_name(step, wall) for wall in others.tolist()))


def _wall_name(step: Step, wall: int) -> str:
    if wall < 0:
        return "no wall"
    name, edge = _laser(step).walls.name(wall)
    return f"edge {edge} of {name}"


def _laser(step: Step) -> Laser:
    assert isinstance(step.entry.given, Reading)
    assert isinstance(step.entry.given.sensor, Laser)
    return step.entry.given.sensor
