"""The two Axes of a picture: the world as a whole, and the surroundings of the estimate."""

from collections.abc import Iterable, Iterator

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.lines import Line2D
from matplotlib.ticker import MaxNLocator

from ekfsim.commands import Command, Repeat, Sense
from ekfsim.geometry.ellipse import radius_factor
from ekfsim.models.protocols import Sensor
from ekfsim.models.sensors.infrared import InfraredBeam
from ekfsim.models.sensors.laser import Laser
from ekfsim.models.sensors.ultrasonic import UltrasonicBeam
from ekfsim.scene import Scene
from ekfsim.views.picture.artists import WorldArtists
from ekfsim.views.picture.belief.belief import BeliefArtists
from ekfsim.views.picture.belief.others import OtherArtists
from ekfsim.views.picture.belief.shape import Shape
from ekfsim.views.picture.extent.limits import Limits
from ekfsim.views.picture.sight_artists import BeamArtists, FixArtists, SightArtists
from ekfsim.views.picture.sights import Sight, kinds, sight
from ekfsim.views.picture.written.outlined import OutlinedText
from ekfsim.views.playback.view import View
from ekfsim.views.playback.zoom import PROBABILITY, Zoom, one_two_five
from ekfsim.views.words.beams.beam import Beam, beam
from ekfsim.views.words.captions import away, watching
from ekfsim.views.words.numbers import length

BODY = 0.022  # of the picture's longer side: the robot's radius
SLENDER = 4.0  # times the shorter side; that is what it is measured by where the longer is longer
# of the close-up's width: what the cone and the true heading are measured by there
CLOSE_BODY = 0.07
CERTAIN = 0.1  # of the picture's longer side: the close-up's width where nothing is uncertain
NARROWEST = 1e-4  # m
CORNERS = np.array([[-0.5, -0.5], [0.5, 0.5]])  # of a square about the origin, opposite ones
FAR = 1e5  # m; from there on a number is so long that few of them stand side by side
FEW = 4
STEPS = (1, 2, 2.5, 5, 10)  # between the numbers, as matplotlib chooses them


def reading(view: View, scene: Scene) -> Beam | Sight | None:
    """What is drawn of a reading, while it is shown."""
    return (beam(view.step, scene) or sight(view.step)) if view.beam else None


class Main:
    """World, belief, truth and the reading on one Axes."""

    def __init__(
        self, axes: Axes, scene: Scene, limits: Limits, probability: float, conditional: bool
    ) -> None:
        self._scene, self._probability = scene, probability
        self.axes = axes
        self.world = WorldArtists(axes, scene.world)
        static = set(axes.get_children())
        self.belief = BeliefArtists(
            axes,
            probability,
            conditional,
            not scene.commanded,
            true=_true(scene),
        )
        self.others = others(axes, scene, probability)
        self.belief.call(watching(scene)[0] if self.others else "")
        self.beam = BeamArtists(axes)
        self._sensors = sensors(scene)
        self.sight = SightArtists(axes, self._sensors)
        self.fixes = FixArtists(axes, scene)
        self.moving = [child for child in axes.get_children() if child not in static]
        axes.set_aspect("equal", adjustable="box")
        self.limit(limits)
        in_metres(axes)

    def limit(self, limits: Limits) -> None:
        """Show this much of the plane, and more to the shape of the Axes."""
        box = self.axes.get_position(original=True)
        figure = self.axes.get_figure(root=True)
        assert figure is not None
        width, height = figure.get_size_inches()
        self.asked = limits
        self.limits = limits.shaped(float(box.width * width / (box.height * height)))
        self.axes.set(
            xlim=(self.limits.left, self.limits.right), ylim=(self.limits.bottom, self.limits.top)
        )

    def show(self, view: View, read: Beam | Sight | None) -> None:
        """Move the artists to a view. read : what is drawn of its reading"""
        shorter = min(self.limits.width, self.limits.height)
        unit = BODY * min(self.limits.size, SLENDER * shorter)
        self.shape = Shape.of(view, self._probability)
        self.belief.show(self.shape, unit)
        for artists, other in zip(self.others, view.others, strict=False):
            artists.show(other, unit)
        self.beam.show(read if isinstance(read, Beam) else None, 2 * self.limits.size)
        self.sight.show(read if isinstance(read, Sight) else None)
        self.fixes.show(view.step.entry)

    def handles(self) -> Iterator[Artist | tuple[Artist, ...]]:
        """What a legend may show, in its order; what comes and goes from view to view is last."""
        yield from self.belief.handles()
        for artists in self.others:
            yield from artists.handles()
        yield from self.world.handles()
        yield from self.fixes.handles()
        yield from self.belief.passing()
        if not self._sensors.isdisjoint((Laser, UltrasonicBeam, InfraredBeam)):
            yield from self.beam.handles()
        yield from self.sight.handles()


class CloseUp:
    """The surroundings of the estimate, as wide as its ellipse asks for, with a scale bar."""

    def __init__(self, axes: Axes, scene: Scene, probability: float, conditional: bool) -> None:
        self._probability = probability
        self.axes = axes
        self.world = WorldArtists(axes, scene.world)
        self.belief = BeliefArtists(axes, probability, conditional, not scene.commanded, body=False)
        self.others = others(axes, scene, probability)
        self.beam = BeamArtists(axes)
        self.sight = SightArtists(axes)
        self.fixes = FixArtists(axes, scene)
        axes.set_aspect("equal", adjustable="box")
        # square from the first, whatever stands in the world
        axes.set(xticks=[], yticks=[], xlim=(0, 1), ylim=(0, 1))
        axes.set_title("close-up of the estimate", fontsize=9, pad=4)
        self.bar = axes.add_line(
            Line2D(
                [],
                [],
                color="black",
                lw=2.5,
                solid_capstyle="butt",
                transform=axes.transAxes,
                zorder=6,
                gid="scale",
            )
        )
        figure = axes.get_figure(root=True)
        assert figure is not None
        systems = axes.transAxes, figure.dpi_scale_trans
        self.scale = OutlinedText(0.05, 0.07, 8, *systems, "scale-text", halo=True)
        self.away = OutlinedText(0.05, 0.91, 8, *systems, "truth-away", halo=True)
        axes.add_artist(self.scale)
        axes.add_artist(self.away)
        # the frame as one artist, drawn in a third of the time of four
        axes.spines[:].set_visible(False)
        axes.add_collection(frame(axes), autolim=False)
        self.moving = [child for child in axes.get_children() if child.get_gid()]

    def show(self, shape: Shape, read: Beam | Sight | None, world: Limits) -> None:
        """Move there, and show it."""
        view = shape.view
        x, truth = view.pose.mean, view.step.entry.truth
        width = close_width(view, self._probability, CERTAIN * world.size)
        # set_xlim and set_ylim would do no more, and look for ticks, units and other Axes first
        self.axes.viewLim.set_points(x[:2] + width * CORNERS)
        self.belief.show(shape, CLOSE_BODY * width)
        for artists, other in zip(self.others, view.others, strict=False):
            artists.show(other, CLOSE_BODY * width)
        self.beam.show(read if isinstance(read, Beam) else None, 2 * width)
        self.sight.show(read if isinstance(read, Sight) else None)
        self.fixes.show(view.step.entry)
        bar = one_two_five(width / 6)
        self.bar.set_data([0.05, 0.05 + bar / width], [0.045, 0.045])
        self.scale.set_text(length(bar))
        hidden = (
            not view.unplaced
            and truth is not None
            and float(np.abs(truth[:2] - x[:2]).max()) > width / 2
        )
        self.away.set_text(away(view.step, view) if hidden else "")


def others(axes: Axes, scene: Scene, probability: float) -> list[OtherArtists]:
    """What is drawn of each filter that watches beside the first."""
    return [
        OtherArtists(axes, name, number, probability)
        for number, name in enumerate(watching(scene)[1:])
    ]


def frame(axes: Axes) -> LineCollection:
    """The four sides of an Axes, as its spines would draw them."""
    left = axes.spines["left"]
    sides = [[(0, 0), (0, 1)], [(1, 0), (1, 1)], [(0, 0), (1, 0)], [(0, 1), (1, 1)]]
    return LineCollection(
        sides,
        colors=[left.get_edgecolor()],
        linewidths=left.get_linewidth(),
        capstyle=left.get_capstyle(),
        zorder=left.get_zorder(),
        transform=axes.transAxes,
        clip_on=False,
        gid="frame",
    )


def close_width(view: View, probability: float, certain: float) -> float:
    """How wide the close-up is, in m: the same for a step's prediction and its update.
    certain : m, where nothing is uncertain
    """
    across = Zoom().take(view.step.prior, view.step) if view.across is None else view.across
    if across == 0:
        return one_two_five(max(certain, NARROWEST))
    larger = radius_factor(probability) / radius_factor(PROBABILITY)
    return one_two_five(max(across * larger, NARROWEST))


def sensors(scene: Scene) -> set[type[Sensor]]:
    """The kinds of sensors whose readings a run may hold;
    all that the classroom has where nothing is commanded yet.
    """
    if scene.log is not None or not scene.commanded:
        return kinds(scene)
    return {Laser} if senses(scene.commands) or not scene.commands else set()


def _true(scene: Scene) -> bool:
    """Whether the truth is known, at one instant at least."""
    return scene.log is None or any(entry.truth is not None for entry in scene.log.entries)


def senses(commands: Iterable[Command]) -> bool:
    """Whether any of the commands, repeated ones included, is a sense."""
    return any(
        senses(c.commands) if isinstance(c, Repeat) else isinstance(c, Sense) for c in commands
    )


def in_metres(axes: Axes) -> None:
    """Label both axes of a map, whose limits are set; each number is told whole, however far from
    the origin of its grid.
    """
    axes.set(xlabel="x (m)", ylabel="y (m)")
    far = max(map(abs, axes.get_xlim())) >= FAR
    axes.xaxis.set_major_locator(  # one number alone where a map is too narrow for two
        MaxNLocator(FEW) if far else MaxNLocator("auto", steps=STEPS, min_n_ticks=1)
    )
    if max(map(abs, axes.get_ylim())) >= FAR:
        axes.tick_params(axis="y", labelrotation=90)
        axes.yaxis.set_major_locator(MaxNLocator(FEW))
    axes.ticklabel_format(useOffset=False, style="plain")
