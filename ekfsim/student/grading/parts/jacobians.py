"""A student's own derivatives beside numerical ones, at the beliefs of the reference."""

from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np

from ekfsim.files.keys.homework import JacobiansKeys
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.protocols import angles
from ekfsim.records import Control, Reading
from ekfsim.student.asked import Asked
from ekfsim.student.fault import FaultError
from ekfsim.student.grading.bench import Bench
from ekfsim.student.grading.parts.pupil import Pupil
from ekfsim.student.grading.scores import Scored

STEP = 1e-5  # m, rad, s, …; central differences are wrong by some 1e-10 of f''' and 1e-11 of f
BENT = 1e-3  # by so much the slopes on both sides may differ; more is a corner, which has none
DIFFERENT = 1e-4  # of the largest entry, of at least 1: what is nearer is the same
MOST_POINTS = 200  # of a scene, evenly spaced


def graded_jacobian(score: Scored, keys: JacobiansKeys, bench: Bench, pupil: Pupil) -> Scored:
    """At which share of the points a function of the student's is the derivative."""
    name = score.check.about
    right = points = 0
    first = ""
    try:
        for scene in keys.scenes:
            for asked, numerical in _points(name, scene, bench):
                theirs = pupil.derivative(name, asked.x, asked.given)
                points += 1
                wrong = _wrong(name, theirs, numerical)
                right += not wrong
                first = first or (wrong and f"{scene}: {asked.step}: {wrong}")
    except FaultError as fault:
        return score.failed(f"the code failed: {fault}", str(fault))
    if points == 0:
        scenes = ", ".join(keys.scenes)
        return score.lost(f"{scenes}: nothing is asked there of which {name} were the derivative")
    words = [f"{right} of {points} are right" if first else f"all {points} are right"]
    if first:
        words.insert(0, f"first wrong number: {first}")
    share = 1.0 if right == points else right / points
    return replace(score, words=tuple(words), first_wrong=first).earned(share)


def has_points(name: str, scene: str, bench: Bench) -> bool:
    """Whether a scene asks for a derivative anywhere."""
    return next(_points(name, scene, bench), None) is not None


def _points(name: str, scene: str, bench: Bench) -> Iterator[tuple[Asked, Array]]:
    """Where it is asked for, and what it is there; corners, which have no derivative, left out."""
    wanted = Reading if name == "H" else Control
    steps = [one.asked for one in bench.by_itself(scene, 0, "ekf")]
    asked = [one for one in steps if isinstance(one.given, wanted)]
    for i in np.unique(np.linspace(0, len(asked) - 1, min(len(asked), MOST_POINTS)).astype(int)):
        if (numerical := numerical_derivative(name, asked[i])) is not None:
            yield asked[i], numerical


def numerical_derivative(name: str, asked: Asked) -> Array | None:
    """∂f/∂x, ∂f/∂u or ∂h/∂x by central differences; None at a corner, and without a wall."""
    match asked.given:
        case Control(motion, u) if name == "F":
            return _differences(lambda x: motion.f(x, u), asked.x, asked.headings)
        case Control(motion, u):
            return _differences(lambda u: motion.f(asked.x, u), u, asked.headings)
        case Reading(sensor, _):
            return _differences(sensor.h, asked.x, angles(sensor.outputs))


def _differences(
    function: Callable[[Array], Array], at: Array, headings: tuple[int, ...]
) -> Array | None:
    """The derivative of a function at a point : (outputs, inputs)"""

    def apart(one: Array, other: Array) -> Array:
        between = one - other
        for i in headings:
            between[i] = wrap(between[i])
        return between

    here, columns = function(at), []
    for i in range(len(at)):
        step = np.zeros(len(at))
        step[i] = STEP
        ahead, behind = function(at + step), function(at - step)
        forward, backward = apart(ahead, here) / STEP, apart(here, behind) / STEP
        size = max(1.0, float(np.abs(forward).max()))
        if not np.abs(forward - backward).max() <= BENT * size:
            return None
        columns.append((forward + backward) / 2)
    return np.stack(columns, axis=-1)


def _wrong(name: str, theirs: Array, numerical: Array) -> str:
    """What is wrong with it: the entry that is farthest off, and both numbers."""
    apart = np.abs(theirs - numerical)
    if apart.max() <= DIFFERENT * max(1.0, float(np.abs(numerical).max())):
        return ""
    i, j = (int(part) for part in np.unravel_index(np.argmax(apart), apart.shape))
    return (
        f"{name}[{i}, {j}] is {theirs[i, j]:.6g}; the numerical derivative is {numerical[i, j]:.6g}"
    )
