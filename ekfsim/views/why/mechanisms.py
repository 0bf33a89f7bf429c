"""How each mechanism is told of one run: what the filter was told or saw, and what was so."""

import math
from collections.abc import Sequence

import numpy as np

from ekfsim.commands import Kidnap, Move
from ekfsim.diagnostics.ambiguity import GRAZING, sighting_of
from ekfsim.diagnostics.verdict import BAND, LOST
from ekfsim.filters.belief import posed
from ekfsim.records import Reading, Step
from ekfsim.scene import Scene
from ekfsim.views.why.changes import joined, named
from ekfsim.views.why.driven import because_driven
from ekfsim.views.why.met import Met, called, met, told
from ekfsim.views.words.numbers import length
from ekfsim.why.changes.suspects import ELSEWHERE
from ekfsim.why.records import Change, Explanation, Mechanism

LASER = (Mechanism.LASER_OVERTRUSTED, Mechanism.LASER_DISTRUSTED)
KEYS = {
    "odometry_distance": "odometryDstSigmaRatio",
    "odometry_angle": "odometryAngSigmaRatio",
    "range": "rangeSigmaRatio",
}
OF_NO_BEAM = (  # what no single beam has done
    *(Mechanism.LASER_OVERTRUSTED, Mechanism.LASER_DISTRUSTED),
    *(Mechanism.ODOMETRY_OVERTRUSTED, Mechanism.ODOMETRY_DISTRUSTED),
    *(Mechanism.WHEEL_SCALE, Mechanism.TURN_SCALE, Mechanism.SLIP, Mechanism.KIDNAP),
    *(Mechanism.WRONG_START, Mechanism.HEADING_SPREAD, Mechanism.CHANCE),
)
NUMBERS = {2: "twice", 3: "three times", 4: "four times", 5: "five times", 10: "ten times"}
PARTS = {2: "half", 3: "a third of", 4: "a quarter of", 5: "a fifth of", 10: "a tenth of"}
NEAR = 0.02  # of a whole number: a ratio that is told as one
FEW = 3  # things of the map that are told by name


def because(explanation: Explanation, mechanism: Mechanism) -> str:
    """Why the run ended as it did, in a clause that begins a sentence."""
    scene, faults = explanation.scene, explanation.scene.world.faults
    if not scene.commanded:
        return because_driven(explanation, mechanism)
    match mechanism:
        case Mechanism.WRONG_WALL | Mechanism.LOOK_ALIKE_WALLS:
            return _wrong_wall(explanation, mechanism)
        case Mechanism.GRAZING_BEAMS:
            return _grazing(explanation)
        case Mechanism.ODOMETRY_OVERTRUSTED | Mechanism.ODOMETRY_DISTRUSTED:
            return f"The filter is told {told_noise(scene, mechanism)}"
        case Mechanism.LASER_OVERTRUSTED | Mechanism.LASER_DISTRUSTED:
            return f"The filter is told {told_noise(scene, mechanism)}"
        case Mechanism.WHEEL_SCALE:
            scale = faults.odometry_distance_scale
            return (
                f"The odometry takes each way for {scale:.4g} times its length, and the filter "
                "is not told"
            )
        case Mechanism.TURN_SCALE:
            scale = faults.odometry_angle_scale
            return (
                f"The odometry takes each turn for {scale:.4g} times its angle, and the filter "
                "is not told"
            )
        case Mechanism.RANGE_BIAS:
            bias = faults.range_bias
            side = "long" if bias > 0 else "short"
            return f"Each range is {length(abs(bias))} too {side}, which is no noise"
        case Mechanism.RANGE_SCALE:
            return f"Each range is {faults.range_scale:.4g} times the way, which is no noise"
        case Mechanism.SHORT_RETURNS:
            return _short_returns(explanation)
        case Mechanism.SLIP | Mechanism.KIDNAP:
            return _carried(explanation, mechanism)
        case Mechanism.MISPLACED_WALL | Mechanism.SHEARED_MAP:
            return _map(explanation, mechanism)
        case Mechanism.HEADING_SPREAD:
            return _spread(explanation)
        case Mechanism.LINEARISED_ELSEWHERE:
            about = ELSEWHERE.get(scene.filter, "another belief")
            return (
                f"The filter makes its straight lines about {about}, and the robot has gone "
                "elsewhere"
            )
        case Mechanism.WRONG_START:
            return _start(scene)
        case Mechanism.REPEATED_READINGS:
            return _repeated(explanation)
        case Mechanism.CLOSE_TO_THE_WALL:
            return _close(explanation)
        case Mechanism.CHANCE:
            return by_chance(explanation)
        case Mechanism.NO_DIRECTION_SEEN:
            return (
                "No beam measures along one direction, and the estimate says so: its ellipse grows "
                "there"
            )
    return f"What there is of it: {mechanism.value}"


def by_chance(explanation: Explanation) -> str:
    """That a bound has runs beyond it of every filter."""
    if explanation.outcome == "lost":
        many, beyond = 1 / (1 - LOST), f"beyond the {100 * LOST:g} % bound of its NEES"
    else:
        side = "above" if explanation.outcome == "over-confident" else "below"
        many, beyond = 2 / (1 - BAND), f"{side} the {100 * BAND:g} % band of its NIS"
    return f"Bad luck: of an honest filter, too, one run in {many:.0f} ends {beyond}"


def culprit(explanation: Explanation) -> Step | None:
    """The step that did it: that of the one reading or move that cures, else where they part."""
    steps = [change.step for change in explanation.cure if change.step is not None]
    at = steps[0] if steps else explanation.parts_at
    return next((step for step in explanation.lost_steps if step.entry.index == at), None)


def beam_of(explanation: Explanation) -> Met | None:
    """The beam that did it, where it was one: the culprit's, or the first one after it that met
    another wall than was predicted and moved the estimate.
    """
    step = culprit(explanation)
    if step is None or explanation.mechanism in OF_NO_BEAM:
        return None
    found = met(step, explanation.scene)
    if found is not None:
        return found
    if explanation.mechanism not in (Mechanism.WRONG_WALL, Mechanism.LOOK_ALIKE_WALLS):
        return None
    after = (s for s in explanation.lost_steps if s.entry.index >= step.entry.index)
    beams = (met(one, explanation.scene) for one in after)
    return next((beam for beam in beams if beam is not None and beam.wrong and beam.used), None)


def told_noise(scene: Scene, mechanism: Mechanism) -> str:
    """How much less or more noise the filter is told than there is, with the numbers.

    four times the laser's noise (rangeSigmaRatio 0.08 told, 0.02 true)
    """
    world, laser = scene.world, mechanism in LASER
    names = [name for name in KEYS if (name == "range") == laser]
    each = [
        (KEYS[name], getattr(world.told.noise, name), getattr(world.noise, name)) for name in names
    ]
    wrong = [one for one in each if one[1] != one[2]]
    whose = "laser's" if laser else "odometry's"
    if not wrong:
        less = mechanism in (Mechanism.LASER_OVERTRUSTED, Mechanism.ODOMETRY_OVERTRUSTED)
        return f"{'less' if less else 'more'} than the {whose} noise"
    numbers = joined([f"{key} {told:g} told, {true:g} true" for key, told, true in wrong])
    _, told_one, true_one = max(wrong, key=lambda one: abs(math.log(ratio(one[1], one[2]))))
    return f"{times(ratio(told_one, true_one))} the {whose} noise ({numbers})"


def ratio(told: float, true: float) -> float:
    """told / true, also where one of them is nothing."""
    least = 1e-6
    return max(told, least) / max(true, least)


def times(factor: float) -> str:
    """A factor in words.

    >>> times(4.0), times(0.25), times(0.7), times(1e-6)
    ('four times', 'a quarter of', '0.7 times', 'nothing of')
    """
    if factor < 1e-3:
        return "nothing of"
    for words, one in ((NUMBERS, factor), (PARTS, 1 / factor)):
        whole = round(one)
        if whole in words and abs(one - whole) < NEAR * whole:
            return words[whole]
    return f"{factor:.2g} times"


def _wrong_wall(explanation: Explanation, mechanism: Mechanism) -> str:
    beam = beam_of(explanation)
    if beam is None or beam.truth is None:
        return "A beam was predicted to meet one wall and met another"
    said = f"The beam of step {beam.step} {told(beam)}"
    row = "such walls stand in a row, and one looks like the next"
    return f"{said}: {row}" if mechanism is Mechanism.LOOK_ALIKE_WALLS else said


def _grazing(explanation: Explanation) -> str:
    step = culprit(explanation)
    sighting = None if step is None else sighting_of(step)
    if step is None or sighting is None or not float(sighting.incidence) < GRAZING:
        return "Beams meet their walls at so flat an angle that a small turn moves their ends far"
    angle = math.degrees(float(sighting.incidence))
    return (
        f"The beam of step {step.entry.index} meets its wall at {angle:.2g}°, where a small turn "
        "moves its end far"
    )


def _short_returns(explanation: Explanation) -> str:
    share = explanation.scene.world.faults.short_returns
    beam = beam_of(explanation)
    told = f"{100 * share:.3g} % of the beams end in the air, and the filter takes that for a wall"
    if beam is None or not beam.measured < beam.range or not beam.used:
        return told
    return (
        f"{told}: that of step {beam.step} after {length(beam.measured)}, "
        f"{length(beam.range - beam.measured)} before {called(beam.actual)}"
    )


def _carried(explanation: Explanation, mechanism: Mechanism) -> str:
    kind = Kidnap if mechanism is Mechanism.KIDNAP else Move
    steps = [
        step
        for step in explanation.lost_steps
        if isinstance(step.entry.command, kind)
        and not (isinstance(step.entry.command, Move) and not step.entry.command.slip)
    ]
    if not steps:
        return f"The cause is a {mechanism.value}"
    at = explanation.parts_at or steps[-1].entry.index
    step = next((one for one in reversed(steps) if one.entry.index <= at), steps[0])
    match step.entry.command:
        case Move(distance, _, slip):
            return (
                f"In the move of step {step.entry.index} the wheels slipped: of {length(distance)} "
                f"the robot drove {length((1 - slip) * distance)}, and the odometry does not know"
            )
    return f"At step {step.entry.index} the robot was carried away, and the filter was not told"


def _map(explanation: Explanation, mechanism: Mechanism) -> str:
    if mechanism is Mechanism.SHEARED_MAP:
        return "The walls of the filter's map stand at another angle than those of the room"
    wrong = [change for change in explanation.cure if change.kind == "map"]
    if not wrong:
        return "The filter's map is not the room's"
    names = joined([_with_what(change) for change in wrong[:FEW]])
    more = f" and {len(wrong) - FEW} more" if len(wrong) > FEW else ""
    return f"The filter's map is wrong about {names}{more}"


def _with_what(change: Change) -> str:
    name = named(change).removesuffix(" in the map").removesuffix(" of the map")
    return f"{name} ({change.told})" if change.told else name


def _spread(explanation: Explanation) -> str:
    scene = explanation.scene
    moves = (s for s in explanation.lost_steps if isinstance(s.entry.command, Move))
    step = next((s for s in moves if s.entry.index >= (explanation.parts_at or 0)), None)
    if step is None:
        step = culprit(explanation)
    if step is None or scene.log is not None:
        return "The heading is so uncertain that the straight line of the Jacobian misses the bend"
    σ = math.degrees(math.sqrt(float(posed(step.prior, step.layout).covariance[2, 2])))
    return (
        f"At step {step.entry.index} the heading is uncertain by σ = {σ:.2g}°: what the robot may "
        "have driven lies on a bend, and the filter makes a straight line of it"
    )


def _start(scene: Scene) -> str:
    told, true = scene.world.told, scene.world.start
    error = told.start - true
    turned = math.degrees(abs(math.remainder(float(error[2]), math.tau)))
    far = float(np.hypot(*error[:2]))
    apart_by = [text for text in (far and length(far), turned and f"{turned:.3g}°") if text]
    off = joined(apart_by) if apart_by else ""
    sure = "without doubt" if not told.sigma.any() else "too surely"
    if not off:
        return f"The filter is told {sure} where the robot starts"
    return f"The filter is told {sure} of a start that lies {off} from the true one"


def _repeated(explanation: Explanation) -> str:
    most = longest(explanation.lost_steps)
    many = f"{most} readings in a row were" if most > 1 else "Readings were"
    return (
        f"{many} taken from one place, and share the error of where that is: the filter takes them "
        "for independent"
    )


def longest(steps: Sequence[Step]) -> int:
    """How many readings come one after the other without a move, at most."""
    most = count = 0
    for step in steps:
        count = count + 1 if isinstance(step.entry.given, Reading) else 0
        most = max(most, count)
    return most


def _close(explanation: Explanation) -> str:
    beams = (met(step, explanation.scene) for step in explanation.lost_steps)
    least = min((b.predicted for b in beams if b is not None and b.predicted > 0), default=math.nan)
    σ = explanation.scene.world.told.noise.range * least
    near = "" if math.isnan(least) else f": at {length(least)} σ is {length(σ)}"
    return f"The laser's noise is told as a share of the predicted range{near}"
