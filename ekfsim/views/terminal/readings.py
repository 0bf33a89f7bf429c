"""What a picture in text shows of a reading, of recorded fixes and of particles."""

import math
from typing import NamedTuple

import numpy as np

from ekfsim.filters.belief import Particles, Refused
from ekfsim.geometry import Array
from ekfsim.models.sensors.laser import Laser
from ekfsim.records import Entry, Reading
from ekfsim.views.picture.sights import sight, told
from ekfsim.views.playback.view import View
from ekfsim.views.terminal.braille import Canvas, Pen, ansi
from ekfsim.views.words.beams.hypotheses import weights
from ekfsim.views.words.changes import revised
from ekfsim.views.words.narrative.trust import believed

READ = ansi("#D55E00")
BEAM, REFUSED_BEAM = Pen(READ, "-"), Pen(READ, "-", on=2, off=3)
EXPECTED_WAY = Pen(READ, ".", on=1, off=3)
MEASURED, REFUSED_END, PREDICTED, FIX = "*", "?", "x", "+"
PARTICLE = Pen(ansi("#CC79A7"), "`")
NOT_USED = ansi("#8A8A8A")


class Item(NamedTuple):
    """One entry of the legend."""

    sample: str
    word: str
    colour: str = ""


def draw_reading(canvas: Canvas, view: View) -> list[Item]:
    """A reading as measured, from the estimate,
    and a mark where the filter had expected its end.
    """
    seen = sight(view.step)
    if seen is None:
        return []
    refused, directed = bool(seen.refused), seen.word == "direction"  # which ends nowhere
    canvas.polyline(seen.line, REFUSED_BEAM if refused else BEAM)
    if directed:
        canvas.polyline(seen.way, EXPECTED_WAY)
    for points, mark in (
        (seen.end, REFUSED_END if refused else MEASURED),
        (seen.expected, PREDICTED),
    ):
        for point in points:
            canvas.text(point, mark, READ)
    sample = ("- " if canvas.ascii else "⠒ ") if refused else ("-" if canvas.ascii else "⠒")
    end = "" if seen.word in ("direction", "range") else REFUSED_END if refused else MEASURED
    measured = Item((sample + end).strip(), seen.word + (" refused" if refused else ""), READ)
    predicted = (".." if canvas.ascii else "⠂⠐") if directed else PREDICTED
    return [measured, Item(predicted, "predicted", READ)]


def draw_fix(canvas: Canvas, entry: Entry) -> list[Item]:
    """The newest position that was recorded and that the filter is not given."""
    if entry.fix is None:
        return []
    canvas.text(entry.fix, FIX, NOT_USED)
    return [Item(FIX, "fix, not used", NOT_USED)]


def draw_particles(canvas: Canvas, view: View) -> list[Item]:
    """A dot for each particle that has a weight."""
    if not isinstance(view.belief, Particles):
        return []
    places = view.layout.pose(view.belief.states)[view.belief.weights > 0, :2]
    lift = np.full_like(places, np.nan)  # between two dots
    canvas.polyline(np.stack([places, places, lift], axis=1).reshape(-1, 2), PARTICLE)
    return [Item("`" if canvas.ascii else "⠌⠂", "particles", PARTICLE.colour)]


def outcome(view: View, probability: float) -> str:
    """What a reading said, while the beam is shown, and what became of it, after."""
    step = view.step
    reading, correction = step.entry.given, step.correction
    if not isinstance(reading, Reading) or correction is None:
        return "not used"
    word = Refused(int(correction.refused)).word
    if not view.beam:
        if word is not None:
            return f"not used ({word})"
        said = [*weights(step), believed(correction), revised(view, probability)]
        return ", ".join(filter(None, said))
    if not isinstance(reading.sensor, Laser):
        outputs, refused = reading.sensor.outputs, "" if word is None else f"refused ({word}): "
        return (
            f"{refused}{told(reading.z, outputs)}; predicted "
            f"{told(correction.predicted, outputs, named=False)}"
        )
    measured, predicted = (
        f"{value[0]:.3f} m" if math.isfinite(value[0]) else "nothing"
        for value in (reading.z, correction.predicted)
    )
    ambiguous = step.remark is not None and bool(step.remark.ambiguous)
    return f"measured {measured}, predicted {predicted}{', ambiguous' if ambiguous else ''}"


def direction(angle: float) -> Array:
    """The unit vector of a direction in rad : (2,)"""
    return np.array([math.cos(angle), math.sin(angle)])
