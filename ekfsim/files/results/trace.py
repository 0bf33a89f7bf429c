"""The trace: a JSON object a line for each step,
SI units, angles in radians, null where a number is undefined.
"""

import json
import math
from typing import Any, TextIO

import numpy as np

from ekfsim.commands import Kidnap, Move, Say, Sense, Untold
from ekfsim.diagnostics.ambiguity import Sighting, sighting_of
from ekfsim.filters.belief import Belief, Correction, Mixture, Refused
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import ellipse
from ekfsim.models.sensors.laser import Laser
from ekfsim.provenance import provenance
from ekfsim.records import Control, Reading, Step
from ekfsim.scene import Scene

FORMAT = 1  # of the trace; grows when a key changes its meaning, or goes
ODOMETRY = "odometry"  # what a line calls the sensor of its motion input


class Trace:
    """Writes the steps of one run to a file, each as it comes."""

    def __init__(self, file: TextIO, scene: Scene, confidence: float) -> None:
        self._file, self._scene, self._confidence = file, scene, confidence

    def write(self, step: Step) -> None:
        """Append the line of this step; the first is the start."""
        line = line_of(step, self._scene, self._confidence)
        self._file.write(
            json.dumps(line, allow_nan=False, ensure_ascii=False, separators=(",", ":")) + "\n"
        )


def line_of(step: Step, scene: Scene, confidence: float) -> dict[str, Any]:
    """The trace's line of one step."""
    match step.entry.command, step.entry.given:
        case Move() | Untold() as move, _:
            return _move(step, move, scene, confidence)
        case Sense(angle), _:
            return _sense(step, angle, confidence)
        case Kidnap(x, y, theta), _:
            return _told("kidnap", {"x": x, "y": y, "theta": theta}, step)
        case Say(text), _:
            return _told("say", {"text": text}, step)
        case _, Control() as control:
            return _predict(step, control, scene)
        case _, Reading() as reading:
            return _update(step, reading, scene)
        case _:
            return _start(step, scene, confidence)


def _start(step: Step, scene: Scene, confidence: float) -> dict[str, Any]:
    return {
        "type": "start",
        "format": FORMAT,
        **provenance(scene),
        "confidence": confidence,
        **({} if step.entry.t is None else {"t": step.entry.t}),
        "state": list(scene.world.layout.names),
        **_belief(step.posterior),
        "truth": _numbers(step.entry.truth),
    }


def _predict(step: Step, control: Control, scene: Scene) -> dict[str, Any]:
    """A motion input of a driven or recorded robot:
    a line like that of a reading, of which none was predicted.
    """
    assert step.prediction is not None
    return {
        **_happened("predict", step, ODOMETRY, control.u),
        **dict.fromkeys(("predicted", "innovation", "S", "H", "gain", "nis")),
        "updated": True,
        "refused": None,
        "F": _finite(step.prediction.F),
        "G": _finite(step.prediction.G),
        **_believed(step, scene),
    }


def _update(step: Step, reading: Reading, scene: Scene) -> dict[str, Any]:
    c = step.correction
    assert c is not None
    predicted = not np.isnan(c.predicted).all()
    return {
        **_happened("update", step, reading.name, reading.z),
        "predicted": _finite(c.predicted),
        "innovation": _finite(c.innovation),
        "S": _finite(c.S) if predicted else None,
        "H": _finite(c.H) if predicted else None,
        "gain": _finite(c.K) if predicted else None,
        "nis": _number(c.nis),
        "updated": bool(c.refused == Refused.NOT),
        "refused": Refused(int(c.refused)).word,
        **({} if c.settled else {"settled": False}),
        **({} if c.trust is None else {"trust": _number(c.trust)}),
        **_learnt(c),
        **_believed(step, scene),
    }


def _happened(kind: str, step: Step, sensor: str, z: Array) -> dict[str, Any]:
    return {
        "type": kind,
        "index": step.entry.index,
        "t": step.entry.t,
        "sensor": sensor,
        "z": _finite(z),
    }


def _believed(step: Step, scene: Scene) -> dict[str, Any]:
    """The beliefs of the whole state; NEES is that of its pose, as the truth is a pose."""
    return {
        "state": list(scene.world.layout.names),
        "prior": _belief(step.prior),
        "posterior": _belief(step.posterior),
        "truth": _numbers(step.entry.truth),
        **({} if step.entry.fix is None else {"fix": _finite(step.entry.fix)}),
        **_nees(step),
    }


def _move(step: Step, move: Move | Untold, scene: Scene, confidence: float) -> dict[str, Any]:
    assert isinstance(step.entry.given, Control)
    assert step.prediction is not None
    distance, angle = step.entry.given.u.tolist()
    bump = -1 if step.entry.bump is None else int(step.entry.bump)
    return {
        "type": "move",
        "index": step.entry.index,
        "command": _commanded(move),
        "odometry": {"distance": distance, "angle": angle},
        "F": _numbers(step.prediction.F),
        "G": _numbers(step.prediction.G),
        "M": _numbers(step.entry.given.motion.M(step.entry.given.u)),
        "prior": _belief(step.prior),
        "posterior": _belief(step.posterior),
        "truth": _numbers(step.entry.truth),
        "bump": scene.world.map.walls.name(bump)[0] if bump >= 0 else None,
        **_judged(step, confidence),
    }


def _commanded(move: Move | Untold) -> dict[str, float] | None:
    if isinstance(move, Untold):
        return None
    slip = {"slip": move.slip} if move.slip else {}
    return {"distance": move.distance, "angle": move.angle, **slip}


def _sense(step: Step, angle: float, confidence: float) -> dict[str, Any]:
    assert isinstance(step.entry.given, Reading)
    assert step.correction is not None
    return {
        "type": "sense",
        "index": step.entry.index,
        "command": {"angle": angle},
        "range": _number(step.entry.given.z[0]),
        **_corrected(step.correction),
        **_sighted(
            step.entry.given.sensor,
            sighting_of(step),
            not np.isnan(step.correction.predicted[0]) and not step.correction.tangent,
        ),
        "prior": _belief(step.prior),
        "posterior": _belief(step.posterior),
        "truth": _numbers(step.entry.truth),
        **_judged(step, confidence),
    }


def _corrected(c: Correction) -> dict[str, Any]:
    predicted = not np.isnan(c.predicted[0])
    return {
        "predicted_range": _number(c.predicted[0]),
        "range_variance": _number(c.R[0, 0]),
        "H": _numbers(c.H[0]) if predicted else None,
        "innovation": _number(c.innovation[0]),
        "innovation_variance": _number(c.S[0, 0]),
        "gain": _numbers(c.K[:, 0]) if predicted else None,
        "nis": _number(c.nis),
        "updated": bool(c.refused == Refused.NOT),
        "refused": Refused(int(c.refused)).word,
        **({} if c.settled else {"settled": False}),
        **({} if c.trust is None else {"trust": _number(c.trust)}),
        **_learnt(c),
    }


def _learnt(c: Correction) -> dict[str, Any]:
    """Of a filter that learns its sensor's noise, how many times the told R it now takes it for."""
    return {} if c.noise_factor is None else {"noise_factor": _number(c.noise_factor)}


def _sighted(sensor: Any, sighting: Sighting | None, predicted: bool) -> dict[str, Any]:
    """The wall that is expected to be met; none where the beam meets none, or runs along it."""
    wall = incidence = None
    if predicted and isinstance(sensor, Laser) and sighting is not None and sighting.wall >= 0:
        name, edge = sensor.walls.name(int(sighting.wall))
        wall, incidence = {"name": name, "edge": edge}, _number(sighting.incidence)
    return {
        "wall": wall,
        "incidence": incidence,
        "ambiguous": None if sighting is None else bool(sighting.ambiguous),
    }


def _judged(step: Step, confidence: float) -> dict[str, Any]:
    drawn = ellipse(step.posterior.covariance, confidence)
    return {
        "ellipse": {
            "major": float(drawn.major),
            "minor": float(drawn.minor),
            "orientation": float(drawn.orientation),
        },
        **_nees(step),
    }


def _nees(step: Step) -> dict[str, Any]:
    measured = step.nees
    return {
        "nees": None if measured is None else _number(measured.value),
        "nees_dof": None if measured is None else int(measured.dof),
        "impossible": None if measured is None else bool(measured.impossible),
    }


def _told(kind: str, command: dict[str, Any], step: Step) -> dict[str, Any]:
    return {
        "type": kind,
        "index": step.entry.index,
        "command": command,
        "truth": _numbers(step.entry.truth),
    }


def _belief(belief: Belief) -> dict[str, Any]:
    """Mean and covariance; of several Gaussians, each a hypothesis, also what each weighs, and its
    own two, heaviest first.
    """
    told: dict[str, Any] = {
        "mean": _finite(belief.mean),
        "covariance": _finite(belief.covariance),
    }
    if isinstance(belief, Mixture):
        each = zip(belief.weights.tolist(), belief.means, belief.covariances, strict=True)
        told["hypotheses"] = [
            {"weight": weight, "mean": _finite(mean), "covariance": _finite(covariance)}
            for weight, mean, covariance in each
            if weight > 0
        ]
    return told


def _number(value: Any) -> float | None:
    number = float(value)
    return number if math.isfinite(number) else None


def _numbers(values: Array | None) -> Any:
    return None if values is None else values.tolist()


def _finite(values: Array) -> Any:
    """Nested lists, None in the place of what is no number."""
    if np.isfinite(values).all():
        return values.tolist()
    return (
        np.array([_number(value) for value in values.flat], object).reshape(values.shape).tolist()
    )
