"""A view drawn in text, for a terminal over any ssh:
what the window shows, in braille dots or in plain ASCII.
"""

import math
from collections.abc import Sequence

import numpy as np

from ekfsim.commands import Kidnap, Move, Say, Sense, Untold
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import outline
from ekfsim.records import Control, Reading
from ekfsim.scene import Scene
from ekfsim.views.picture.sights import instants
from ekfsim.views.playback.length import steps_of
from ekfsim.views.playback.view import View
from ekfsim.views.terminal.beliefs import ALARM, draw_true_way, draw_uncertainty, write_weights
from ekfsim.views.terminal.braille import (
    Bounds,
    Canvas,
    Pen,
    ansi,
    cells,
    inside,
    paint,
    printable,
)
from ekfsim.views.terminal.readings import (
    Item,
    direction,
    draw_fix,
    draw_particles,
    draw_reading,
    outcome,
)
from ekfsim.views.terminal.wrapping import within
from ekfsim.views.words.judgement import standing
from ekfsim.world import Landmark, World

WALL = Pen()
UNKNOWN_WALL = Pen(ascii="%", on=4, off=3)  # stands there, and the filter does not know
IMAGINED_WALL = Pen(ascii=":", on=1, off=3)  # the filter believes in it
PATH = Pen(ansi("#56B4E9"), ".", on=1, off=2)
MEANT = Pen(ansi("#777777"), ",", on=1, off=4)  # the way that was meant
ESTIMATE = Pen("1;" + ansi("#0072B2"))
TRUTH = Pen("1", "~")  # bright, on a light terminal as on a dark one
OTHERS = tuple(
    Pen(ansi(color), ",", on=2, off=1) for color in ("#8C510A", "#6A3D9A", "#C51B7D", "#6B6B00")
)

ROBOT = np.array([[2.5, 0.0], [-1.5, 1.75], [-1.5, -1.75]])  # cells' widths ahead and to the left
HEADING = 3.5  # cells' widths from the true position to the end of its heading
ARROWS = dict(zip("→↗↑↖←↙↓↘", ("E", "NE", "N", "NW", "W", "SW", "S", "SE"), strict=True))
PLAIN = str.maketrans(  # for an output that knows ASCII alone
    {"°": " deg", "−": "-", "–": "-", "±": "+-", "σ": " sigma", "Σ": "sum of ", "·": "|", **ARROWS}
)
CROWDED = 300  # landmarks, above which none shows its number


def draw(
    view: View,
    scene: Scene,
    probability: float,
    size: tuple[int, int],
    limits: Bounds,
    colour: bool,
    ascii: bool = False,
) -> str:
    """A view as text of `size` columns and rows: a title, the picture, a legend.

    limits : xmin, xmax, ymin, ymax in m, the same for the whole run, so that the picture does not
    jump ascii : for an output that cannot print braille
    """
    columns, rows = max(size[0], 1), max(size[1], 1)
    heads = within(title(view, scene, probability, ascii), columns, max(rows // 6, 1), ascii)
    canvas = Canvas(columns, max(rows - len(heads) - 1, 1), limits, ascii)
    legend = depict(canvas, view, scene, probability)
    bar = scale_bar(canvas)
    if len(heads) == 1 and cells(heads[0]) + cells(bar) + 2 <= columns:
        heads = [heads[0] + " " * (columns - cells(heads[0]) - cells(bar)) + bar]
    lines = [
        *heads, *canvas.render(colour).split("\n"), *legend_lines(legend, columns, 1, colour, ascii)
    ]  # fmt: skip
    return "\n".join(lines[:rows])


def depict(canvas: Canvas, view: View, scene: Scene, probability: float) -> list[Item]:
    """Draw a view on a canvas; gives its legend, the most important first."""
    step, mean = view.step, view.pose.mean
    legend = _draw_world(canvas, scene.world)
    true_way = draw_true_way(canvas, view)
    canvas.polyline(view.path(), PATH)
    path = Item(".." if canvas.ascii else "⠄⠠", "path", PATH.colour)
    for other, pen in zip(view.others, OTHERS, strict=False):
        canvas.polyline(other.path(), pen)
    # over the path, so that their numbers stay whole
    _draw_landmarks(canvas, scene.world.landmarks)
    belief = [*draw_particles(canvas, view), path, *draw_uncertainty(canvas, view, probability)]
    legend += draw_fix(canvas, step.entry) + belief + true_way
    legend = _draw_others(canvas, view, scene, probability) + legend
    if view.beam:
        legend = draw_reading(canvas, view) + legend
    estimate = None if view.unplaced else mean
    legend = _draw_robots(canvas, estimate, step.entry.truth) + legend
    write_weights(canvas, view, probability)
    return legend


def _draw_others(canvas: Canvas, view: View, scene: Scene, probability: float) -> list[Item]:
    """The other filters that watch, each with its ellipse and the first letter of its name where it
    believes to be.
    """
    legend = []
    for name, other, pen in zip(scene.watching[1:], view.others, OTHERS, strict=False):
        x, P = other.pose
        if np.isfinite(x).all() and np.isfinite(P).all():
            outside = standing(other, probability).outside_ellipse
            canvas.polyline(outline(x[:2], P[:2, :2], probability), ALARM if outside else pen)
            canvas.text(x[:2], name[0], pen.colour)
        legend.append(Item(name[0], name, pen.colour))
    return legend


def _draw_world(canvas: Canvas, world: World) -> list[Item]:
    """Walls, with their names where there is room;
    those on one map only, the true one or the filter's, are broken.
    """
    true, told = dict(world.map.outlines()), dict(world.told.map.outlines())
    both = {
        name
        for name, ring in true.items()
        if ring is told.get(name) or np.array_equal(ring, told.get(name, ()))
    }
    unknown = [ring for name, ring in true.items() if name not in both]
    imagined = [ring for name, ring in told.items() if name not in both]
    canvas.polylines(imagined, IMAGINED_WALL)
    canvas.polylines(unknown, UNKNOWN_WALL)
    canvas.polylines([true[name] for name in both], WALL)
    for obstacle in world.map.obstacles:
        name = printable(obstacle.name, canvas.ascii)
        place = _place(obstacle.outline[:-1], canvas.cell * np.array([len(name) + 2, 4]))
        if place is not None and cells(name) == len(name):
            canvas.text(place, name)
    legend = [Item("%%" if canvas.ascii else "⠒⠂", "not on its map")] if unknown else []
    legend += [Item("::" if canvas.ascii else "⠂⠂", "on its map only")] if imagined else []
    if world.expected_path is not None:
        canvas.polygons([world.expected_path], MEANT)
        legend.append(Item(",," if canvas.ascii else "⠂⠐", "meant way", MEANT.colour))
    return legend


def _draw_landmarks(canvas: Canvas, landmarks: Sequence[Landmark]) -> None:
    """Each landmark with its number, without where that would cover another."""
    written: list[tuple[float, float, int]] = []
    for x, y, text in ((mark.x, mark.y, f"#{mark.id}") for mark in landmarks):
        for x_other, y_other, length in written if len(landmarks) <= CROWDED else ():
            if (
                abs(y - y_other) < 2 * canvas.cell
                and abs(x - x_other) < (len(text) + length + 1) / 2 * canvas.cell
            ):
                text = text[:1]
                break
        written.append((x, y, len(text)))
        canvas.text((x, y), text if len(landmarks) <= CROWDED else text[:1])


def _place(ring: Array, box: Array) -> Array | None:
    """The middle of a box : (2,) m inside a polygon :
    (n, 2) m, near the polygon's own; None where none fits.
    """
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
    best = np.argmin(
        np.where(fits, np.linalg.norm(middles[:, 0] - (low + high) / 2, axis=-1), np.inf)
    )
    return np.asarray(middles[best, 0]) if fits[best] else None


def _draw_robots(canvas: Canvas, mean: Array | None, truth: Array | None) -> list[Item]:
    """The robot where it is believed to be, and a mark where it is. mean, truth : (3,)"""
    legend = [] if mean is None else _draw_estimate(canvas, mean)
    if truth is None:
        return legend
    canvas.polyline([truth[:2], truth[:2] + HEADING * canvas.cell * direction(truth[2])], TRUTH)
    canvas.text(truth[:2], "o", TRUTH.colour)
    lost = "" if inside(truth[:2], canvas.bounds) else " (outside)"
    return [*legend, Item("o~" if canvas.ascii else "o⠒", "truth" + lost, TRUTH.colour)]


def _draw_estimate(canvas: Canvas, mean: Array) -> list[Item]:
    ahead = direction(mean[2])
    triangle = mean[:2] + canvas.cell * ROBOT @ np.array([ahead, [-ahead[1], ahead[0]]])
    if canvas.ascii:
        quarter = round(mean[2] / (math.pi / 2)) % 4 if math.isfinite(mean[2]) else 0
        canvas.text(mean[:2], ">^<v"[quarter], ESTIMATE.colour)
    else:
        canvas.polygons([triangle], ESTIMATE)
        canvas.polyline(mean[:2], ESTIMATE)
    lost = "" if inside(mean[:2], canvas.bounds) else " (outside)"
    return [Item(">" if canvas.ascii else "⡷⠄", "estimate" + lost, ESTIMATE.colour)]


def title(view: View, scene: Scene, probability: float, ascii: bool = False) -> str:
    """What the picture shows: the number of the command, and what came of it."""
    what, entry = _what(view, scene.world, probability), view.step.entry
    total = steps_of(scene)
    step = f"{entry.index} of {total}" if total else str(entry.index)
    told = f"{step if view.span is None else f't = {instants(*view.span)} s'}: {what}"
    return printable(told.translate(PLAIN) if ascii else told, ascii)


def _what(view: View, world: World, probability: float) -> str:
    entry = view.step.entry
    bumped = entry.bump is not None and int(entry.bump) >= 0
    match entry.command, entry.given:
        case Move(distance, angle, slip), _:
            what = f"move {distance:g} m, turn {math.degrees(angle):.4g}°"
            what += (f", slip {slip:g}" if slip else "") + (
                ": bumped into a wall" if bumped else ""
            )
        case Sense(angle), _:
            what = f"sense at {math.degrees(angle):.4g}°, {outcome(view, probability)}"
        case Kidnap(), _:
            what = "the robot is carried away, and the filter is not told"
        case Say(text), _:
            what = text
        case Untold(), Control(_, u):
            d, a = u.tolist()
            what = f"moved {d:.4g} m, turned {math.degrees(a):.4g}° by odometry"
        case None, Control():
            what = "a motion input" if view.inputs == 1 else f"{view.inputs} motion inputs"
        case None, Reading(name=name):
            what = f"{name}, {outcome(view, probability)}"
        case _:
            what = f"the start in {world.name}"
    return what


def scale_bar(canvas: Canvas) -> str:
    """How long a length is in the picture: "├───┤ 2 m", at most a quarter of its width."""
    longest = max(canvas.columns // 4, 1) * canvas.cell  # m
    power = 10.0 ** math.floor(math.log10(longest))
    length = power * max(n for n in (1, 2, 5) if n * power <= longest)
    left, middle, right = "|-|" if canvas.ascii else "├─┤"
    return f"{left}{middle * (round(length / canvas.cell) - 2)}{right} {length:g} m"


def legend_lines(
    items: Sequence[Item], columns: int, most: int, colour: bool, ascii: bool
) -> list[str]:
    """As many items, from the first on, as there is room for in so many lines."""
    lines, left = [""], columns
    for sample, word, paint_with in items:
        text = f"{sample} {word}"
        if lines[-1] and cells(text) + 2 > left:
            if len(lines) == most:
                break
            lines, left = [*lines, ""], columns
        if cells(text) > left:
            break
        left -= cells(text) + (2 if lines[-1] else 0)
        lines[-1] += ("  " if lines[-1] else "") + (
            f"{paint(sample, paint_with)} {word}" if colour else text
        )
    return lines
