"""The narrative of a robot that is driven or was recorded, in the words of its own inputs, readings
and state.
"""

import math

from ekfsim.filters.belief import Correction, Refused
from ekfsim.geometry import Array
from ekfsim.models.protocols import Quantity
from ekfsim.records import Control, Reading
from ekfsim.scene import Scene
from ekfsim.views.playback.view import View
from ekfsim.views.words.beams.hypotheses import hypotheses
from ekfsim.views.words.beams.told import doubts, expected_wall
from ekfsim.views.words.narrative.long_form import SHORT, Form
from ekfsim.views.words.narrative.trust import learnt, trusted
from ekfsim.views.words.numbers import (
    MANY,
    instant,
    matrix,
    number,
    point,
    pose,
    quantities,
    quantity,
    state,
)
from ekfsim.views.words.uncertainty import crowd, judged, rest, surprise, uncertainty

REFUSED = {
    Refused.NOT: "",
    Refused.NO_ECHO: "No echo: the reading is not used\n",
    Refused.NO_WALL: "No wall: the reading is not used\n",
    Refused.GUARD: "Guard: this ambiguous reading is left out\n",
    Refused.GATE: "Gate: this reading is refused, its NIS is too large to be believed\n",
}
FIX = "A position was recorded that the filter is not given: (x, y) ="


def started(view: View, probability: float) -> str:
    """The first belief, and in which units it is told, and since when times are."""
    names = view.layout.names
    headings = " and ".join(names[i] for i in view.layout.headings)
    clock = (
        f"Times are told in s since the start, which the log stamps {instant(view.start)}\n"
        if view.start
        else ""
    )
    return (
        clock
        + (
            f"The state is ({', '.join(names)}): {headings} in degrees, all else and the matrices "
            f"in m, s and rad\n"
            f"First state estimate is {state(view.belief.mean, view.layout)}\n"
            f"First state covariance matrix is:\n{matrix(view.belief.covariance)}\n"
        )
        + _beside_truth(view, probability)
    )


def moved(view: View, probability: float, form: Form) -> str:
    """A motion input, or several that follow each other: the belief before the first and after the
    last.
    """
    given, before = view.step.entry.given, view.step.prior if view.before is None else view.before
    assert isinstance(given, Control)
    told = quantities(given.motion.inputs, given.u)
    return (
        f"==>{_span(view)}: {told}\n"
        f"State estimate before is {state(before.mean, view.layout)}\n"
        f"{form.carried(view)}"
        f"New state estimate is {state(view.belief.mean, view.layout)}{form.by('state')}\n"
        f"New state covariance matrix "
        f"is:{form.by('covariance')}\n{matrix(view.belief.covariance)}\n"
    ) + _beside_truth(view, probability)


def read(view: View, guarded: bool, form: Form) -> str:
    """A reading as it came, before it is used."""
    given = view.step.entry.given
    assert isinstance(given, Reading)
    nothing = all(map(math.isnan, given.z.tolist()))
    told = (
        "nothing came back"
        if nothing
        else quantities(given.sensor.outputs, given.z, directions=True)
    )
    at = "" if view.span is None else f"At t = {instant(view.span[1])} s "
    doubted = form.doubted(view.step) if guarded else ""
    return f"==>{at}{given.name} was read: {told}\n{doubts(view.step, guarded)}{doubted}"


def revised(view: View, scene: Scene, probability: float, form: Form) -> str:
    """What was expected in place of the reading, and what the filter made of the difference."""
    given, c = view.step.entry.given, view.step.correction
    assert isinstance(given, Reading)
    assert c is not None
    x, P = view.belief
    used = c.refused == Refused.NOT
    by = (form if used else SHORT).by
    return (
        _expected(view, given.sensor.outputs, c, form)
        + _innovation(given.sensor.outputs, c)
        + REFUSED[Refused(int(c.refused))]
        + (_gain(view, given.sensor.outputs, c.K, by("gain")) if used else "")
        + trusted(c, scene, form)
        + learnt(c, scene, form)
        + rest(c)
        + (hypotheses(view.step) if used else "")
        + f"Revised state estimate: {state(x, view.layout)}{by('revised')}\n"
        + f"Revised covariance matrix is:{by('revised_covariance')}\n{matrix(P)}"
        + _beside_truth(view, probability)
    )


def _expected(view: View, outputs: tuple[Quantity, ...], c: Correction, form: Form) -> str:
    if all(map(math.isnan, c.predicted.tolist())):
        return "No reading was predicted: nothing of the filter's map is within reach there\n"
    rows = f"rows {_names(outputs)}; columns {', '.join(view.layout.names)}"
    return (
        f"The predicted reading was "
        f"{quantities(outputs, c.predicted, directions=True)}{form.by('predicted')}\n"
        f"{expected_wall(view.step)}{form.expected(view.step)}"
        f"The derivatives are ({rows}):{form.by('derivatives')}\n"
        f"{matrix(c.H)}{form.noise(c)}"
    )


def _innovation(outputs: tuple[Quantity, ...], c: Correction) -> str:
    if any(map(math.isnan, c.innovation.tolist())):
        return ""
    nis, innovation = float(c.nis), f"The innovation is {quantities(outputs, c.innovation)}"
    if math.isnan(nis):
        return f"{innovation}; nothing is uncertain, so NIS is undefined and the gain is 0\n"
    dof = len(outputs)
    beside = surprise("NIS", nis, dof)
    if dof == 1:
        deviation = quantity(Quantity("deviation", outputs[0].unit), math.sqrt(float(c.S[0, 0])))
        return (
            f"{innovation}, its standard {deviation.replace(' =', '')}; NIS is "
            f"{number(nis)}\n{beside}"
        )
    return (
        f"{innovation}; its covariance is:\n{matrix(c.S)}NIS is {number(nis)} ({dof} degrees "
        f"of freedom)\n{beside}"
    )


def _gain(view: View, outputs: tuple[Quantity, ...], K: Array, by: str) -> str:
    """The gain of a filter that has one; particles are weighed in its place."""
    told = (
        f"The Kalman gain is (rows {', '.join(view.layout.names)}; columns "
        f"{_names(outputs)}):{by}\n{matrix(K)}"
    )
    return crowd(view.step.posterior) or told


def _beside_truth(view: View, probability: float) -> str:
    """The truth where it is known, how uncertain the pose is, and how the two agree."""
    entry = view.step.entry
    return (
        ("" if entry.truth is None else f"True pose is (x, y, th) = {pose(entry.truth.tolist())}\n")
        + ("" if entry.fix is None else f"{FIX} {point(*entry.fix.tolist())}\n")
        + uncertainty(view.pose, probability)
        + judged(view.step, view.pose, probability)
    )


def _span(view: View) -> str:
    """When the inputs of a view came, and how many there were."""
    if view.span is None:
        return (
            "The motion input was" if view.inputs == 1 else f"{view.inputs} motion inputs; the last"
        )
    first, last = view.span
    if view.inputs == 1:
        return f"At t = {instant(last)} s the motion input was"
    return (
        f"From t = {instant(first)} s to {instant(last)} s: {view.inputs} motion inputs; the last"
    )


def _names(outputs: tuple[Quantity, ...]) -> str:
    return ", ".join([*(q.name for q in outputs[:MANY]), *(["…"] if len(outputs) > MANY else [])])
