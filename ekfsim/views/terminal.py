"""A view drawn in text, for a terminal over any ssh: what the window shows, in braille dots or in plain ASCII."""

import math
from typing import NamedTuple

import numpy as np

from ekfsim.filters.belief import Refused
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import cone_halfwidth, outline
from ekfsim.models.laser import Laser
from ekfsim.records import Control, Kidnap, Move, Reading, Say, Sense, Step
from ekfsim.scene import Scene
from ekfsim.views.braille import Bounds, Canvas, Pen, ansi, cells, inside, paint, printable, shorten
from ekfsim.views.playback import View
from ekfsim.world import World

WALL = Pen()
UNKNOWN_WALL = Pen(ascii="%", on=4, off=3)  # stands there, and the filter does not know
IMAGINED_WALL = Pen(ascii=":", on=1, off=3)  # the filter believes in it
PATH = Pen(ansi("#56B4E9"), ".", on=1, off=2)
ELLIPSE = Pen(ansi("#009E73"), "*")
CONE = Pen(ansi("#009E73"), "'")
BEAM = Pen(ansi("#D55E00"), "-")
ESTIMATE = Pen("1;" + ansi("#0072B2"))
TRUTH = Pen("1", "~")  # bright, on a light terminal as on a dark one

ROBOT = np.array([[2.5, 0.0], [-1.5, 1.75], [-1.5, -1.75]])  # cells' widths ahead and to the left
HEADING = 3.5  # cells' widths from the true position to the end of its heading
CONE_LENGTH = 0.25  # of the shorter side of the picture


class Item(NamedTuple):
    """One entry of the legend."""

    sample: str
    word: str
    colour: str = ""


def draw(
    view: View,
    scene: Scene,
    probability: float,
    size: tuple[int, int],
    limits: Bounds,
    colour: bool,
    ascii: bool = False,
) -> str:
    """A view as text of at most `size` columns and rows: a title, the picture, a legend.

    limits : xmin, xmax, ymin, ymax in m, the same for the whole run, so that the picture does not jump
    ascii : for an output that cannot print braille
    """
    columns, rows = max(size[0], 1), max(size[1], 1)
    canvas = Canvas(columns, max(rows - 2, 1), limits, ascii)
    step, (mean, P) = view.step, view.belief
    legend = _draw_world(canvas, scene.world)
    canvas.polyline(view.path(), PATH)
    legend += _draw_uncertainty(canvas, mean, P, probability)
    if view.beam:
        legend = _draw_beam(canvas, mean, step) + legend
    legend = _draw_robots(canvas, mean, step.entry.truth) + legend
    lines = [
        _title_line(_title(view, scene.world), _scale(limits), columns, ascii),
        *canvas.render(colour).split("\n"),
        _legend_line(legend, columns, colour, ascii),
    ]
    return "\n".join(lines[:rows])


def _draw_world(canvas: Canvas, world: World) -> list[Item]:
    """Walls, with their names where there is room; those on one map only, the true one or the filter's, are broken."""
    true, told = dict(world.map.rings()), dict(world.told.map.rings())
    both = {name for name, ring in true.items() if ring is told.get(name) or np.array_equal(ring, told.get(name, ()))}
    unknown = [ring for name, ring in true.items() if name not in both]
    imagined = [ring for name, ring in told.items() if name not in both]
    canvas.polygons(imagined, IMAGINED_WALL)
    canvas.polygons(unknown, UNKNOWN_WALL)
    canvas.polygons([true[name] for name in both], WALL)
    for obstacle in world.map.obstacles:
        name = printable(obstacle.name, canvas.ascii)
        place = _place(obstacle.points, canvas.cell * np.array([len(name) + 2, 4]))
        if place is not None and cells(name) == len(name):
            canvas.text(place, name)
    for landmark in world.landmarks:
        canvas.text((landmark.x, landmark.y), f"#{landmark.id}")
    legend = [Item("%%" if canvas.ascii else "⠒⠂", "not on its map")] if unknown else []
    return legend + ([Item("::" if canvas.ascii else "⠂⠂", "on its map only")] if imagined else [])


def _place(ring: Array, box: Array) -> Array | None:
    """The middle of a box : (2,) m inside a polygon : (n, 2) m, near the polygon's own; None where none fits."""
    low, high = ring.min(axis=0) + box / 2, ring.max(axis=0) - box / 2
    if np.any(low > high):
        return None
    middles = np.stack(np.meshgrid(*np.linspace(low, high, 9).T), axis=-1).reshape(-1, 1, 2)
    rim = np.array([(x, y) for x in (-0.5, 0, 0.5) for y in (-0.5, 0, 0.5)])
    x, y = np.moveaxis((middles + rim * box)[..., None, :], -1, 0)
    (ax, ay), (bx, by) = ring.T, np.roll(ring, -1, axis=0).T
    with np.errstate(divide="ignore", invalid="ignore"):  # level edges cross nothing
        crossed = ((ay > y) != (by > y)) & (x < ax + (y - ay) / (by - ay) * (bx - ax))
    fits = np.all(np.sum(crossed, axis=-1) % 2 == 1, axis=-1)
    best = np.argmin(np.where(fits, np.linalg.norm(middles[:, 0] - (low + high) / 2, axis=-1), np.inf))
    return np.asarray(middles[best, 0]) if fits[best] else None


def _draw_uncertainty(canvas: Canvas, mean: Array, P: Array, probability: float) -> list[Item]:
    """The ellipse of the position and the cone of the heading. mean : (3,), P : (3, 3)"""
    if not (np.isfinite(mean).all() and np.isfinite(P).all()):
        return [Item("!", "the belief is no number")]
    canvas.polyline(outline(mean[:2], P[:2, :2], probability), ELLIPSE)
    xmin, xmax, ymin, ymax = canvas.bounds
    length, halfwidth = CONE_LENGTH * min(xmax - xmin, ymax - ymin), cone_halfwidth(float(P[2, 2]), probability)
    if halfwidth < math.pi:
        for side in (halfwidth, -halfwidth):
            canvas.polyline([mean[:2], mean[:2] + length * _direction(mean[2] + side)], CONE)
    return [
        Item(".." if canvas.ascii else "⠄⠠", "path", PATH.colour),
        Item("*" if canvas.ascii else "⢎⡱", f"{100 * probability:g} % ellipse", ELLIPSE.colour),
        Item("'" if canvas.ascii else "⡠⠊", "cone" if halfwidth < math.pi else "any heading", CONE.colour),
    ]


def _draw_beam(canvas: Canvas, mean: Array, step: Step) -> list[Item]:
    """The beam as measured, from the estimate, and a mark where the filter had predicted its end. mean : (3,)"""
    reading, correction = step.entry.given, step.correction
    if not isinstance(reading, Reading) or not isinstance(reading.sensor, Laser):
        return []
    ahead = _direction(mean[2] + reading.sensor.bearing)
    measured = mean[:2] + reading.z[0] * ahead  # nan without an echo, and then nothing is drawn
    canvas.polyline([mean[:2], measured], BEAM)
    canvas.text(measured, "*", BEAM.colour)
    if correction is not None:
        canvas.text(mean[:2] + correction.predicted[0] * ahead, "x", BEAM.colour)
    return [Item("-*" if canvas.ascii else "⠒*", "beam", BEAM.colour), Item("x", "predicted", BEAM.colour)]


def _draw_robots(canvas: Canvas, mean: Array, truth: Array | None) -> list[Item]:
    """The robot where it is believed to be, and a mark where it is. mean, truth : (3,)"""
    ahead = _direction(mean[2])
    triangle = mean[:2] + canvas.cell * ROBOT @ np.array([ahead, [-ahead[1], ahead[0]]])
    if canvas.ascii:
        quarter = round(mean[2] / (math.pi / 2)) % 4 if math.isfinite(mean[2]) else 0
        canvas.text(mean[:2], ">^<v"[quarter], ESTIMATE.colour)
    else:
        canvas.polygons([triangle], ESTIMATE)
        canvas.polyline(mean[:2], ESTIMATE)
    lost = "" if inside(mean[:2], canvas.bounds) else " (outside)"
    legend = [Item(">" if canvas.ascii else "⡷⠄", "estimate" + lost, ESTIMATE.colour)]
    if truth is None:
        return legend
    canvas.polyline([truth[:2], truth[:2] + HEADING * canvas.cell * _direction(truth[2])], TRUTH)
    canvas.text(truth[:2], "o", TRUTH.colour)
    lost = "" if inside(truth[:2], canvas.bounds) else " (outside)"
    return [*legend, Item("o~" if canvas.ascii else "o⠒", "truth" + lost, TRUTH.colour)]


def _direction(angle: float) -> Array:
    """The unit vector of a direction in rad : (2,)"""
    return np.array([math.cos(angle), math.sin(angle)])


def _title(view: View, world: World) -> str:
    """What the picture shows: the number of the command, and what came of it."""
    entry, step = view.step.entry, view.step
    bumped = entry.bump is not None and int(entry.bump) >= 0
    match entry.command, entry.given:
        case Move(distance, angle, slip), _:
            what = f"move {distance:g} m, turn {math.degrees(angle):.4g}°"
            what += (f", slip {slip:g}" if slip else "") + (": bumped into a wall" if bumped else "")
        case Sense(angle), _:
            what = f"sense at {math.degrees(angle):.4g}°, {_outcome(step, view.beam)}"
        case Kidnap(), _:
            what = "the robot is carried away, and the filter is not told"
        case Say(text), _:
            what = text
        case None, Control():
            what = "odometry"
        case None, Reading():
            what = f"reading, {_outcome(step, view.beam)}"
        case _:
            what = f"the start in {world.name}"
    return f"{entry.index}: {what}"


def _outcome(step: Step, beam: bool) -> str:
    """What a reading said, while the beam is shown, and what became of it, after."""
    reading, correction = step.entry.given, step.correction
    if not isinstance(reading, Reading) or correction is None:
        return "not used"
    if not beam:
        word = Refused(int(correction.refused)).word
        return "the estimate is revised" if word is None else f"not used ({word})"
    measured, predicted = (
        f"{value[0]:.3f} m" if math.isfinite(value[0]) else "nothing" for value in (reading.z, correction.predicted)
    )
    ambiguous = step.sighting is not None and bool(step.sighting.ambiguous)
    return f"measured {measured}, predicted {predicted}{', ambiguous' if ambiguous else ''}"


def _scale(limits: Bounds) -> str:
    """What the picture covers."""
    xmin, xmax, ymin, ymax = limits
    return f"x {xmin:.4g}…{xmax:.4g} m  y {ymin:.4g}…{ymax:.4g} m"


def _title_line(title: str, scale: str, columns: int, ascii: bool) -> str:
    """The title, and the scale at the right where there is room for both."""
    if ascii:
        title, scale = title.replace("°", " deg"), scale.replace("…", "..")
    title = printable(title, ascii)
    gap = columns - cells(title) - cells(scale)
    return title + " " * gap + scale if gap >= 2 else shorten(title, columns, ascii)


def _legend_line(items: list[Item], columns: int, colour: bool, ascii: bool) -> str:
    """As many items, from the first on, as there is room for."""
    line, left = "", columns
    for sample, word, paint_with in items:
        text = f"{sample} {word}"
        left -= cells(text) + (2 if line else 0)
        if left < 0:
            break
        line += ("  " if line else "") + (f"{paint(sample, paint_with)} {word}" if colour else text)
    return line
