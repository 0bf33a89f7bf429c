"""What a picture in text shows of a belief: its ellipse and cone, those before, the true way."""

import math

import numpy as np

from ekfsim.filters.belief import parts
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import cone_halfwidth, outline
from ekfsim.views.playback.view import View
from ekfsim.views.terminal.braille import Canvas, Pen, ansi
from ekfsim.views.terminal.readings import Item, direction
from ekfsim.views.words.judgement import standing

ELLIPSE = Pen(ansi("#009E73"), "*")
CONE = Pen(ansi("#009E73"), "'")
ALARM = Pen(
    "1;" + ansi("#D55E00"), "!", on=3, off=2
)  # either of them, while the truth is outside of it
GHOST = Pen(ansi("#8A8A8A"), '"', on=1, off=1)
TRUE_WAY = Pen(ansi("#8A8A8A"), "~", on=1, off=4)
HEAVY = Pen(ansi("#CC79A7"), "`")  # hypotheses
LIGHT = Pen(ansi("#CC79A7"), "`", on=1, off=2)
EVEN, LABELLED = 0.5, 0.05  # weights from which a hypothesis is drawn whole, and told
CONE_LENGTH = 0.25  # of the shorter side of the picture


def draw_true_way(canvas: Canvas, view: View) -> list[Item]:
    """Where the robot truly was up to now."""
    points = view.true.points()
    canvas.polyline(points, TRUE_WAY)
    sample = "~~" if canvas.ascii else "⠂ ⠂"
    return [Item(sample, "true way", TRUE_WAY.colour)] if len(points) > 1 else []


def draw_uncertainty(canvas: Canvas, view: View, probability: float) -> list[Item]:
    """The ellipse of the position and the cone of the heading; the ellipse before, beneath them."""
    mean, P = view.pose
    if not (np.isfinite(mean).all() and np.isfinite(P).all()):
        return [Item("!", "the belief is no number")]
    if view.unplaced:
        return [Item("?", "no idea yet: anywhere in the room", ELLIPSE.colour)]
    ghost = _draw_ghost(canvas, view.earlier, probability)
    stands, half = standing(view, probability), cone_halfwidth(float(P[2, 2]), probability)
    ellipse = ALARM if stands.outside_ellipse else ELLIPSE
    cone = ALARM if stands.outside_cone else CONE
    canvas.polyline(outline(mean[:2], P[:2, :2], probability), ellipse)
    several = _draw_hypotheses(canvas, view, probability)
    _draw_cone(canvas, mean, half, cone)
    round_, edges = ("*", "'") if canvas.ascii else ("⢎⡱", "⡠⠊")
    size = Item(round_, f"{100 * probability:g} % ellipse", ELLIPSE.colour)
    opening = Item(edges, "cone" if half < math.pi else "any heading", CONE.colour)
    return [
        _warned("ellipse", canvas.ascii) if stands.outside_ellipse else size,
        _warned("cone", canvas.ascii) if stands.outside_cone else opening,
        *several,
        *ghost,
    ]


def _draw_hypotheses(canvas: Canvas, view: View, probability: float) -> list[Item]:
    """The ellipses of a belief that is several Gaussians, the lighter the more broken."""
    several = parts(view.belief, view.layout)
    for w, (x, P) in several:
        canvas.polyline(outline(x[:2], P[:2, :2], probability), HEAVY if w >= EVEN else LIGHT)
    sample = "``" if canvas.ascii else "⢎⡱"
    return [Item(sample, "hypotheses, with weights", HEAVY.colour)] if several else []


def write_weights(canvas: Canvas, view: View, probability: float) -> None:
    """The weights of the hypotheses that matter, heaviest first, each where it covers no text."""
    for w, (x, P) in reversed(parts(view.belief, view.layout)):
        if w >= LABELLED:
            rim = outline(x[:2], P[:2, :2], probability)
            canvas.note(rim[rim[:, 1].argmax()], f"{w:.2f}", HEAVY.colour)


def _warned(what: str, ascii: bool) -> Item:
    return Item("!" if ascii else "⢆⡰", f"{what}: truth outside", ALARM.colour)


def _draw_ghost(canvas: Canvas, before: tuple[Array, Array] | None, p: float) -> list[Item]:
    """The ellipse of the belief before, if it was another and is no point."""
    if before is None or not all(np.isfinite(part).all() for part in before):
        return []
    x, P = before
    if not P[:2, :2].any():
        return []
    canvas.polyline(outline(x[:2], P[:2, :2], p), GHOST)
    return [Item('"' if canvas.ascii else "⠢⠔", "before", GHOST.colour)]


def _draw_cone(canvas: Canvas, mean: Array, half: float, pen: Pen) -> None:
    """Both edges of the heading's cone, unless it may be any."""
    xmin, xmax, ymin, ymax = canvas.bounds
    length = CONE_LENGTH * min(xmax - xmin, ymax - ymin)
    for side in (half, -half) if half < math.pi else ():
        canvas.polyline([mean[:2], mean[:2] + length * direction(mean[2] + side)], pen)
