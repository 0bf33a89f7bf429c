"""The narrative: every number is read from the Step, every line is the assignment's or says what it
leaves out.
"""

import math

from ekfsim.commands import Kidnap, Move, Say, Sense, Untold
from ekfsim.filters.belief import Correction, Refused
from ekfsim.printable import shown
from ekfsim.records import Control, Reading, Step
from ekfsim.scene import Scene
from ekfsim.views.playback.view import View
from ekfsim.views.words.beams.hypotheses import hypotheses
from ekfsim.views.words.beams.told import doubts, edge_of, expected_wall
from ekfsim.views.words.narrative import driven as driven_narrative
from ekfsim.views.words.narrative.driven import REFUSED
from ekfsim.views.words.narrative.long_form import SHORT, Form, LongForm
from ekfsim.views.words.narrative.opening import opening, plain
from ekfsim.views.words.narrative.trust import learnt, trusted
from ekfsim.views.words.numbers import fill, fill_vector, fine, matrix, number, pose, turn
from ekfsim.views.words.uncertainty import crowd, judged, rest, surprise, uncertain

DERIVATIVES = "  dh/dx = %.6g, dh/dy = %.6g, dh/dth = %.6g\n"
INNOVATION = "The innovation is %.6g, its standard deviation %.6g; NIS is %.6g"
CERTAIN = "The innovation is %.6g; nothing is uncertain, so NIS is undefined and the gain is 0"
GAIN = "The Kalman gain is (x, y, th) = (%.6g, %.6g, %.6g)"


def narrate(view: View, scene: Scene, probability: float = 0.954, explain: bool = False) -> str:
    """What is said at one press of `n`; every line ends in a newline. explain : in the long form

    A sense has two views: the beam, with the text down to the range, and the revised estimate, with
    the rest.
    """
    step, form = view.step, LongForm.of(scene) if explain else SHORT
    match step.entry.command, step.entry.given:
        case Move() | Untold() as move, _:
            text = _move(view, move, scene, probability, form)
        case Sense(angle), _:
            text = (
                _beam(step, angle, scene, form)
                if view.beam
                else _update(view, scene, probability, form)
            )
        case Kidnap(x, y, theta), _:
            text = (
                f"==>The robot was carried away to (x, y, th) = {pose((x, y, theta))}; the filter "
                f"was not told\n" + ("" if view.unplaced else judged(step, view.pose, probability))
            )
        case Say(said), _:
            text = f"==>{plain(said)}\n"
        case _, Control():
            text = driven_narrative.moved(view, probability, form)
        case _, Reading():
            guarded = scene.guard != "off"
            text = (
                driven_narrative.read(view, guarded, form)
                if view.beam
                else driven_narrative.revised(view, scene, probability, form)
            )
        case _:
            text = opening(scene) + form.words + _start(view, scene, probability)
    parted = (apart.told for apart in view.apart if apart.since == step.entry.index)
    return shown("".join([text, *(f"{told}\n" for told in parted), "\n"]))


def _start(view: View, scene: Scene, probability: float) -> str:
    if not scene.commanded:
        return driven_narrative.started(view, probability)
    if view.unplaced:
        nowhere = "First state estimate: none, its particles lie all over the room\n"
        return nowhere + _truth(view.step)
    x, P = view.belief
    return (
        f"First state estimate is (x, y, theta) = {pose(x.tolist())}\n"
        f"First state covariance matrix is:\n{matrix(P)}\n"
        + _truth(view.step)
        + uncertain(view, probability)
    )


def _move(view: View, move: Move | Untold, scene: Scene, probability: float, form: Form) -> str:
    step = view.step
    assert isinstance(step.entry.given, Control)
    d, a = step.entry.given.u.tolist()
    x, P = step.posterior
    return (
        f"==>The robot moved{_commanded(move)}\n"
        + _bump(step, scene)
        + f"The odometry measured: distance={fine(d)}, angle={turn(a)}\n"
        + form.carried(view)
        + f"Current state estimate is (x, y, th) = {pose(step.prior.mean.tolist())}\n"
        + f"New state estimate is (x, y, theta) = {pose(x.tolist())}{form.by('state')}\n"
        + f"New state covariance matrix is:{form.by('covariance')}\n{matrix(P)}\n"
        + _truth(step)
        + uncertain(view, probability)
    )


def _commanded(move: Move | Untold) -> str:
    if isinstance(move, Untold):
        return " (its log does not tell what was commanded)"
    slip = f", slip={number(move.slip)}" if move.slip else ""
    return f": distance={fine(move.distance)}, angle={turn(move.angle)}{slip}"


def _bump(step: Step, scene: Scene) -> str:
    bump = step.entry.bump
    if bump is None or bump < 0:
        return ""
    wall = edge_of(scene.world.map.walls, int(bump))
    return f"It bumped into {wall} and stopped short of it; the filter was not told\n"


def _beam(step: Step, angle: float, scene: Scene, form: Form) -> str:
    assert isinstance(step.entry.given, Reading)
    z, guarded = float(step.entry.given.z[0]), scene.guard != "off"
    return (
        f"==>Commanding the robot to sense at an angle of {turn(angle)}\n"
        + doubts(step, guarded)
        + (form.doubted(step) if guarded else "")
        + (
            "There is no echo: the beam met no wall\n"
            if math.isnan(z)
            else f"The range is {fine(z)}\n"
        )
    )


def _update(view: View, scene: Scene, probability: float, form: Form) -> str:
    step = view.step
    c, (x, P) = step.correction, step.posterior
    assert c is not None
    refused = Refused(int(c.refused))
    used = refused is Refused.NOT
    by = (form if used else SHORT).by
    return (
        _expected(step, c, form)
        + _innovation(c, form)
        + REFUSED[refused]
        + (
            crowd(step.posterior) or f"{fill_vector(GAIN, *c.K[:, 0].tolist())}{by('gain')}\n"
            if used
            else ""
        )
        + trusted(c, scene, form)
        + learnt(c, scene, form)
        + rest(c)
        + (hypotheses(step) if used else "")
        + f"Revised state estimate: (x, y, theta) = {pose(x.tolist())}{by('revised')}\n"
        + f"Revised covariance matrix is:{by('revised_covariance')}\n{matrix(P)}"
        + uncertain(view, probability)
    )


def _expected(step: Step, c: Correction, form: Form) -> str:
    h = float(c.predicted[0])
    if math.isnan(h) or step.remark is None:
        return "No range was predicted: no wall of the filter's map lies that way\n"
    return (
        f"The predicted range was {fine(h)}{form.by('predicted')}\n"
        + expected_wall(step)
        + form.expected(step)
        + f"The derivatives are:{form.by('derivatives')}\n"
        + fill_vector(DERIVATIVES, *c.H[0].tolist())
        + form.noise(c)
    )


def _innovation(c: Correction, form: Form) -> str:
    ν, S, nis = float(c.innovation[0]), float(c.S[0, 0]), float(c.nis)
    if math.isnan(ν):
        return ""
    if math.isnan(nis):
        return f"{fill(CERTAIN, ν)}{form.by('innovation')}\n"
    told = f"{fill(INNOVATION, ν, math.sqrt(S), nis)}{form.by('innovation')}\n"
    return told + surprise("NIS", nis, len(c.innovation))


def _truth(step: Step) -> str:
    return (
        ""
        if step.entry.truth is None
        else f"True state is (x, y, th) = {pose(step.entry.truth.tolist())}\n"
    )
