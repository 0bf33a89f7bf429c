"""What is drawn of a belief: the estimate with its ellipse, cone and path, and the truth."""

from collections.abc import Iterator

from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.lines import Line2D

from ekfsim.filters.belief import Particles, parts
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import conditioned, outline
from ekfsim.views.picture.artists import (
    BLUE,
    CONE,
    CROWD,
    DOTS,
    GRAIN,
    GREEN,
    NOWHERE,
    ORANGE,
    PURPLE,
    SKY,
    TRUE_HEADING,
    TRUTH,
    area,
    empty,
    line,
    marks,
    place,
    ray,
    robot,
    scatter,
    sector,
)
from ekfsim.views.picture.belief.ghost import GhostArtists
from ekfsim.views.picture.belief.hypotheses import HypothesisArtists
from ekfsim.views.picture.belief.shape import Shape
from ekfsim.views.picture.belief.warned import EitherArea, alarm
from ekfsim.views.picture.belief.ways import WayArtists
from ekfsim.views.words.captions import conditioned_label, cone_label, ellipse_label

COVERED = 1.4  # body radii: an ellipse with a smaller major radius is not seen beneath the body
LARGE, SMALL = 7.0, 3.5  # points, of the mark at the reference point


class BeliefArtists:
    """The estimate with its ellipse, cone and path, and the truth."""

    def __init__(
        self,
        axes: Axes,
        probability: float,
        conditional: bool,
        driven: bool,
        body: bool = True,
        true: bool = True,
    ) -> None:
        """driven : whether the path has a corner for each of many instants, not for each command;
        body : whether to draw the robot; true : whether the truth is known, for the legend
        """
        self._driven = driven
        self._probability, self._true = probability, true
        self._placed = True  # whether the belief that is shown tells a place
        self.ways = WayArtists(axes)
        self.ghost = GhostArtists(axes)
        self.cone = area(axes, SKY, 0.35, "--", 1.0, 2.0, "cone", cone_label(probability))
        label = ellipse_label(probability)
        self.ellipse = area(axes, GREEN, 0.18, "-", 1.6, 3.1, "ellipse", label)
        self.alarms = alarm(axes, self.ellipse), alarm(axes, self.cone)
        self._ellipse, self._cone = map(EitherArea, (self.ellipse, self.cone), self.alarms)
        self.conditioned = dict(_edges(axes, probability)) if conditional else {}
        self.particles = axes.scatter(
            [], [], s=[GRAIN], c=CROWD, alpha=0.45, linewidths=0, zorder=2.2, label="particles"
        )
        self.particles.set_gid("particles")
        self.hypotheses = HypothesisArtists(axes)
        self.path = line(axes, "path", "path of the estimates", 3, BLUE, 1.2)
        self.path.set(marker="" if driven else ".", markersize=5)
        self.body = self._body = None
        if body:
            self.body = area(axes, BLUE, 0.55, "-", 1.0, 2.1, "body", "estimate")
            hollow = area(axes, BLUE, 0.0, "-", 1.0, 2.1, "hollow-body", "")
            self._body = EitherArea(self.body, hollow)
        self.reference = marks(axes, "reference", "estimate", 4.5, BLUE, "o", LARGE)
        self.reference.set(markerfacecolor="white", markeredgewidth=1.5)
        self.heading = line(axes, "true-heading", "truth", 5, TRUTH, 1.6)
        self.truth = marks(axes, "truth", "truth", 5.1, TRUTH, "o", 4)

    def show(self, shape: Shape, unit: float) -> None:
        """Move everything to a view. unit : m, what the robot's body measures in this Axes"""
        view, stands, half = shape.view, shape.stands, shape.region.half
        self._placed = not view.unplaced
        x, P = shape.region.pose, view.pose.covariance
        self._cone.show(sector(x, half, CONE * unit), stands.outside_cone)
        self._ellipse.show(shape.region.rim, stands.outside_ellipse)
        self.ghost.show(shape.before, unit)
        self.ways.show(shape)
        for sign, edge in self.conditioned.items():
            place(edge, outline(*conditioned(x, P, sign * half), self._probability))
        if isinstance(view.belief, Particles):
            scatter(self.particles, view.layout.pose(view.belief.states), view.belief.weights)
        elif not empty(self.particles):
            self.particles.set_offsets(NOWHERE)
        self.hypotheses.show(parts(view.belief, view.layout), self._probability)
        place(self.path, shape.path)
        dot = "" if self._driven or len(shape.path) > DOTS else "."
        if self.path.get_marker() != dot:
            self.path.set_marker(dot)
        self._show_robot(x, unit, shape.radius)
        true = view.step.entry.truth
        segment = NOWHERE if true is None else ray(true, TRUE_HEADING * unit)
        place(self.heading, segment)
        place(self.truth, segment[:1])

    def _show_robot(self, x: Array, unit: float, radius: float) -> None:
        """Move the robot, hollow where it would cover the ellipse. radius : m, the larger one"""
        place(self.reference, x[None, :2])
        if self._body is not None:
            covers = radius < COVERED * unit
            self._body.show(robot(x, unit), covers)
            if self.reference.get_markersize() != (size := SMALL if covers else LARGE):
                self.reference.set_markersize(size)

    def call(self, name: str) -> None:
        """Name the filter in the legend, where others are drawn beside it."""
        for artist in (self.body, self.reference):
            if artist is not None and name:
                artist.set_label(f"{name}: estimate")

    def handles(self) -> Iterator[Artist | tuple[Artist, ...]]:
        """What the legend shows of it."""
        if self._placed:
            yield self.reference if self.body is None else (self.body, self.reference)
            yield self.path
            yield self.ellipse
            yield self.cone
        yield from self.conditioned.values()
        yield self.particles
        if self._true:
            yield self.heading, self.truth
            yield self.ways.true
        yield self.ways.reckoned

    def passing(self) -> Iterator[Artist | tuple[Artist, ...]]:
        """What it shows of what comes and goes."""
        if self._true:
            yield self.alarms
        yield self.hypotheses.ellipses
        yield from self.ghost.handles()


def _edges(axes: Axes, probability: float) -> Iterator[tuple[int, Line2D]]:
    """The ellipses for the heading at either edge of its cone."""
    for sign, gid, color, dashes in (
        (1, "ellipse-plus", PURPLE, (6, 2)),
        (-1, "ellipse-minus", ORANGE, (1, 1)),
    ):
        label = conditioned_label(probability, sign)
        yield sign, line(axes, gid, label, 2.4, color, 1.8, (0, dashes))
