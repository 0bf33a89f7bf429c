"""The narrative: every number is read from the Step, every line is the assignment's or says what it leaves out."""

import math

from ekfsim.filters import FILTERS
from ekfsim.filters.belief import Correction, Refused
from ekfsim.filters.pf import PF
from ekfsim.provenance import told_in_a_line
from ekfsim.records import Control, Kidnap, Move, Reading, Say, Sense, Step
from ekfsim.scene import Scene
from ekfsim.views import driven_narrative
from ekfsim.views.driven_narrative import REFUSED
from ekfsim.views.numbers import fill, number, pose, turn
from ekfsim.views.playback import View
from ekfsim.views.told_beams import doubts, expected_wall
from ekfsim.views.uncertainty import beside_band, crowd, judged, uncertainty

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
PREDICTED = "The predicted range was %.6g\n"
DERIVATIVES = """\
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


def narrate(view: View, scene: Scene, probability: float = 0.954) -> str:
    """What is said at one press of `n`; every line ends in a newline.

    A sense has two views: the beam, with the text down to the range, and the revised estimate, with the rest.
    """
    step = view.step
    match step.entry.command, step.entry.given:
        case Move() as move, _:
            text = _move(view, move, scene, probability)
        case Sense(angle), _:
            text = _beam(step, angle, scene) if view.beam else _update(view, probability)
        case Kidnap(x, y, theta), _:
            there = fill(POSE, *pose((x, y, theta)))
            text = f"==>The robot was carried away to (x, y, th) = {there}; the filter was not told\n"
            text += judged(step, view.pose, probability)
        case Say(said), _:
            text = f"==>{_lines(said)}\n"
        case _, Control():
            text = driven_narrative.moved(view, probability)
        case _, Reading():
            guarded = scene.guard != "off"
            text = driven_narrative.read(view, guarded) if view.beam else driven_narrative.revised(view, probability)
        case _:
            text = _opening(scene) + _start(view, scene, probability)
    return f"{text}\n"


def _opening(scene: Scene) -> str:
    """What is run, and what should be known of the filter and of the reading of the document."""
    told = f"{told_in_a_line(scene)}\n{_lines(scene.description)}\n\n"
    if remark := FILTERS[scene.filter].remark:
        told += f"The filter {scene.filter}: {remark}\n"
    if FILTERS[scene.filter] is PF:
        told += f"The filter {scene.filter}: {scene.tuning.particles} particles\n"
    if scene.reading != "corrected":
        told += f"{_followed(scene)}\n"
    return told


def _followed(scene: Scene) -> str:
    """What a reading of the document changes in a run of this robot and its instruments."""
    if scene.world.follows(scene.reading):
        return f"The equations are those of the document as {scene.reading}, not the corrected ones"
    return f"Of the equations that this run uses none is {scene.reading} otherwise: they are the corrected ones"


def _start(view: View, scene: Scene, probability: float) -> str:
    if not scene.commanded:
        return driven_narrative.started(view, probability)
    x, P = view.belief
    return (
        fill(f"First state estimate is (x, y, theta) = {POSE}\n", *pose(x.tolist()))
        + fill(f"First state covariance matrix is:\n{MATRIX}\n", *P.ravel().tolist())
        + _truth(view.step)
        + uncertainty(view.pose, probability)
        + judged(view.step, view.pose, probability)
    )


def _move(view: View, move: Move, scene: Scene, probability: float) -> str:
    step = view.step
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
        + uncertainty(view.pose, probability)
        + judged(step, view.pose, probability)
    )


def _bump(step: Step, scene: Scene) -> str:
    bump = step.entry.bump
    if bump is None or bump < 0:
        return ""
    name, edge = scene.world.map.walls.name(int(bump))
    return f"It bumped into edge {edge + 1} of {name} and stopped short of it; the filter was not told\n"


def _beam(step: Step, angle: float, scene: Scene) -> str:
    assert isinstance(step.entry.given, Reading)
    z = float(step.entry.given.z[0])
    told = "There is no echo: the beam met no wall\n" if math.isnan(z) else f"The range is {number(z)}\n"
    return f"==>Commanding the robot to sense at an angle of {turn(angle)}\n{doubts(step, scene.guard != 'off')}{told}"


def _update(view: View, probability: float) -> str:
    step = view.step
    c, (x, P) = step.correction, step.posterior
    assert c is not None
    return (
        _expected(step, c)
        + _innovation(c)
        + REFUSED[Refused(int(c.refused))]
        + (crowd(step.posterior) or fill(GAIN, *c.K[:, 0].tolist()) if c.refused == Refused.NOT else "")
        + fill(REVISED, *pose(x.tolist()), *P.ravel().tolist())
        + uncertainty(view.pose, probability)
        + judged(step, view.pose, probability)
    )


def _expected(step: Step, c: Correction) -> str:
    h = float(c.predicted[0])
    if math.isnan(h) or step.sighting is None:
        return "No range was predicted: no wall of the filter's map lies that way\n"
    return fill(PREDICTED, h) + expected_wall(step) + fill(DERIVATIVES, *c.H[0].tolist())


def _innovation(c: Correction) -> str:
    ν, S, nis = float(c.innovation[0]), float(c.S[0, 0]), float(c.nis)
    if math.isnan(ν):
        return ""
    if math.isnan(nis):
        return fill(CERTAIN, ν)
    return fill(INNOVATION, ν, math.sqrt(S), nis) + beside_band("NIS", nis, len(c.innovation))


def _lines(text: str) -> str:
    """A text in plain lines: whatever else breaks a line or moves a cursor has no place in a narrative."""
    return "\n".join(text.strip().splitlines())


def _truth(step: Step) -> str:
    return "" if step.entry.truth is None else fill(TRUTH, *pose(step.entry.truth.tolist()))
