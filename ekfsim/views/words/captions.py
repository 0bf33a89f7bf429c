"""The words in a picture: the command, what is to be seen of it, and what made the picture."""

import math
from collections.abc import Iterable, Iterator

from ekfsim.commands import Command, Kidnap, Move, Repeat, Say, Sense, Untold
from ekfsim.filters.belief import Refused
from ekfsim.geometry.ellipse import cone_factor, cone_halfwidth, ellipse, radius_factor
from ekfsim.models.sensors.infrared import InfraredBeam
from ekfsim.models.sensors.mounted import bare
from ekfsim.records import Control, Entry, Reading, Step
from ekfsim.scene import Scene
from ekfsim.views.picture.sights import Sight, instants, told
from ekfsim.views.picture.written.lettering import shortened
from ekfsim.views.playback.view import View
from ekfsim.views.words.beams.beam import Beam, called
from ekfsim.views.words.beams.hypotheses import weights
from ekfsim.views.words.changes import ARROWS, carried, losing, revised
from ekfsim.views.words.numbers import length
from ekfsim.views.words.verdict import meaning

REFUSALS = {
    Refused.NO_ECHO: "no echo: nothing to learn",
    Refused.NO_WALL: "refused: the filter's map has no wall there",
    Refused.GUARD: "refused by the guard: the beam is ambiguous",
    Refused.GATE: "refused by the gate: too far from what was predicted",
}
OUT_OF_REACH = "refused: the filter's map has no wall within reach there"


def title(view: View, total: int) -> str:
    """The command and its number, or the instant and what was measured:
    "3 of 12: move 1.75 m, turn 90°".
    """
    entry, inputs = view.step.entry, view.inputs
    if view.span is not None:
        return f"t = {instants(*view.span)} s: {_measured(entry, inputs)}"
    if entry.command is None and entry.index > 0:
        return f"{entry.index}: {_measured(entry, inputs)}"
    number = f"{entry.index} of {total}" if total else str(entry.index)
    return f"{number}: {_asked(entry)}"


def _asked(entry: Entry) -> str:
    match entry.command:
        case Move(distance, angle, slip):
            return f"move {signed(distance)} m, turn {degrees(angle)}" + (
                f", slip {slip:g}" if slip else ""
            )
        case Sense(angle):
            return f"sense at {degrees(angle)}"
        case Kidnap(x, y, theta):
            return f"kidnap to ({signed(x)}, {signed(y)}), heading {degrees(theta)}"
        case Say():
            return "say"
        case Untold():
            assert isinstance(entry.given, Control)
            d, a = (float(f"{value:.4g}") for value in entry.given.u.tolist())
            return f"moved {signed(d)} m, turned {degrees(a)} by odometry"
    return "the start"


def _measured(entry: Entry, inputs: int) -> str:
    if entry.index == 0:
        return "the start"
    if isinstance(entry.given, Reading):
        return shortened(entry.given.name, 40)
    return "a motion input" if inputs == 1 else f"{inputs} motion inputs"


def notes(
    view: View, scene: Scene, read: Beam | Sight | None, probability: float = 0.954
) -> list[str]:
    """What is to be seen in this view, a paragraph each."""
    if view.beam:  # there is much to say of it
        return _notes(view, scene, read, probability)
    parted = (apart.told for apart in view.apart if apart.since is not None)
    said = [
        losing(view, watching(scene)),
        meaning(view, scene),
        *parted,
        *_notes(view, scene, read, probability),
    ]
    return [paragraph for paragraph in said if paragraph]


def _notes(view: View, scene: Scene, read: Beam | Sight | None, probability: float) -> list[str]:
    step, given = view.step, view.step.entry.given
    match step.entry.command:
        case Say(text):
            return [text]
        case Kidnap():
            return ["the robot was carried away; the filter was not told"]
    if view.beam:
        match read:
            case Beam():
                intensity = (
                    [told_of(step)]
                    if isinstance(given, Reading) and isinstance(bare(given.sensor), InfraredBeam)
                    else []
                )
                return [*intensity, *_ranges(read), *_warnings(read)]
            case Sight():
                return [told_of(step), *([] if not read.refused else [REFUSALS[read.refused]])]
        return []
    told = []
    if step.entry.bump is not None and (wall := int(step.entry.bump)) >= 0:
        told.append(f"bumped into {called(scene.world.map.walls.name(wall)[0])}")
    if step.correction is None:
        changed = carried(view, probability)
    else:
        refused = Refused(int(step.correction.refused))
        told += weights(step)
        changed = (
            REFUSALS[refused] + "; the estimate stays" if refused else revised(view, probability)
        )
    whose = f"{watching(scene)[0]}: " if view.others and changed else ""
    return [*told, f"{whose}{changed}"]


def _ranges(beam: Beam) -> list[str]:
    no_wall = "no wall expected" if beam.reaching else "no wall expected within reach"
    predicted = no_wall if math.isnan(beam.predicted) else f"expected {length(beam.predicted)}"
    if math.isnan(beam.measured):
        return [f"no echo; {predicted}"]
    return [f"measured {length(beam.measured)}, {predicted}: the beam ends {beam.ending}"]


def _warnings(beam: Beam) -> list[str]:
    told = []
    if beam.ambiguous:
        told.append(f"ambiguous: {beam.doubt}")
    if beam.grazing is not None:
        told.append(f"grazing: {math.degrees(beam.grazing):.2g}° between beam and wall")
    if beam.refused in (Refused.GUARD, Refused.GATE, Refused.NO_WALL):
        told.append(
            REFUSALS[beam.refused]
            if beam.reaching or beam.refused is not Refused.NO_WALL
            else OUT_OF_REACH
        )
    return ["; ".join(told)] if told else []


def told_of(step: Step) -> str:
    """What was measured and what was expected: "measured azimuth 12.3°; expected 12.8°"."""
    reading, correction = step.entry.given, step.correction
    assert isinstance(reading, Reading)
    assert correction is not None
    outputs = reading.sensor.outputs
    return (
        f"measured {told(reading.z, outputs)}; expected "
        f"{told(correction.predicted, outputs, named=False)}"
    )


def spread(view: View, probability: float) -> str:
    """How large ellipse and cone are, in numbers."""
    if view.unplaced:
        return "no idea yet: anywhere in the room"
    P = view.pose.covariance
    shape = ellipse(P, probability)
    half = math.degrees(cone_halfwidth(float(P[2, 2]), probability))
    return (
        f"radii {length(float(shape.major))}, {length(float(shape.minor))}; heading ± {half:.3g}°"
    )


def too_large(view: View, probability: float) -> str:
    """What stands for an ellipse that the picture cannot hold."""
    shape = ellipse(view.pose.covariance, probability)
    radii = f"{length(float(shape.major))} and {length(float(shape.minor))}"
    return f"the {percent(probability)} ellipse is larger than the picture: radii {radii}"


def away(step: Step, view: View) -> str:
    """Where the truth is, seen from the estimate: "truth 1.3 m away ↗"."""
    assert step.entry.truth is not None
    east, north = step.entry.truth[:2] - view.pose.mean[:2]
    arrow = ARROWS[round(math.atan2(north, east) / (math.pi / 4)) % 8]
    return f"truth {length(math.hypot(east, north))} away {arrow}"


def source(scene: Scene) -> str:
    """What made the picture: "classroom — seed 7, run 0, ekf".
    A log has a seed only where particles use it.
    """
    gate = f", gate {percent(scene.gate)}" if scene.gate is not None else ""
    guard = ", guard skips" if scene.guard == "skip" else ""
    reading = f", as {scene.reading}" if scene.reading != "corrected" else ""
    drawn = (
        f"seed {scene.seed}, run {scene.run}" if scene.log is None or scene.filter == "pf" else ""
    )
    log = "recorded" if scene.log is not None else ""
    origin = ", ".join(filter(None, (log, drawn, *watching(scene))))
    return f"{shortened(scene.world.name, 30)} — {origin}{gate}{guard}{reading}"


def watching(scene: Scene) -> list[str]:
    """What the filters are called in a picture, of which a person may have named some."""
    return [shortened(name, 24) for name in scene.watching]


def texts(scene: Scene) -> Iterator[str]:
    """Whatever of a person's own words a scene's pictures show."""
    yield from (scene.world.name, *scene.watching)
    for floor in (scene.world.map, scene.world.told.map):
        yield from (obstacle.name for obstacle in floor.obstacles)
        yield from (line.name for line in floor.named_lines())
    yield from _said(scene.commands)


def _said(commands: Iterable[Command]) -> Iterator[str]:
    """The text of each say, of one that is repeated once."""
    for command in commands:
        if isinstance(command, Say):
            yield command.text
        elif isinstance(command, Repeat):
            yield from _said(command.commands)


def ellipse_label(probability: float) -> str:
    """As the legend has it: "95.4 % ellipse (2.48 σ)"."""
    return f"{percent(probability)} ellipse ({radius_factor(probability):.3g} σ)"


def cone_label(probability: float) -> str:
    """As the legend has it: "heading ± 2 σ (95.4 %)"."""
    return f"heading ± {cone_factor(probability):.3g} σ ({percent(probability)})"


def conditioned_label(probability: float, sign: int) -> str:
    """As the legend has it: "ellipse if heading is at +2 σ"."""
    return f"ellipse if heading is at {'+' if sign > 0 else '−'}{cone_factor(probability):.3g} σ"


def percent(probability: float) -> str:
    """A probability as people write it: "95.4 %"."""
    return f"{100 * probability:.6g} %"


def degrees(angle: float) -> str:
    """An angle in rad as people write it: "90°"."""
    return f"{signed(round(math.degrees(angle), 6))}°"


def signed(value: float) -> str:
    """A number with a minus sign rather than a hyphen."""
    return f"{value:g}".replace("-", "−")
