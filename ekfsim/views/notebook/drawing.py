"""A view on Axes of one's own, and more runs over it: the world is drawn once."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from weakref import WeakKeyDictionary

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.backend_bases import RendererBase
from matplotlib.legend import Legend
from matplotlib.transforms import Bbox, ScaledTranslation

from ekfsim.floor import Map
from ekfsim.geometry.ellipse import outline
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.views.picture.belief.others import OtherArtists
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.extent.limits import Limits
from ekfsim.views.picture.look import STANDARD, Look
from ekfsim.views.picture.panels import BODY, Main, reading
from ekfsim.views.picture.written.legend import HANDLERS, entries
from ekfsim.views.picture.written.lettering import families
from ekfsim.views.picture.written.names import Names
from ekfsim.views.picture.written.samples import Handle
from ekfsim.views.playback.view import View
from ekfsim.views.words.captions import watching

POINTS = 8.0  # of the legend's letters
GAP, AXIS = 6.0, 40.0  # points, between picture and legend: beside it, and beneath its axis
LARGEST = 0.6  # of the Axes' own place: what the legend takes of it at most, across or upright


@dataclass
class Drawn:
    """What was drawn on an Axes."""

    scene: Scene
    main: Main
    place: Bbox  # what the Axes had of the figure, before the legend took its share of it
    names: list[str]  # of the runs
    over: list[OtherArtists] = field(default_factory=list)

    def moving(self) -> Iterable[Artist]:
        """What names keep clear of."""
        yield from self.main.moving
        for one in self.over:
            yield from (one.path, one.ellipse, one.heading, one.reference)

    def handles(self) -> Iterable[Handle]:
        """What a legend may show."""
        yield from self.main.handles()
        for one in self.over:
            yield from one.handles()


@dataclass
class Over:
    """A run that is drawn over another."""

    main: Main
    artists: OtherArtists

    def show(self, view: View, read: None = None) -> None:
        """Move it to another view."""
        self.artists.show(view, BODY * self.main.limits.size)


class Naming(Artist):
    """Puts the names in their places just before they are drawn: only then all has its own."""

    def __init__(self, drawn: Drawn) -> None:
        super().__init__()
        self._drawn, self._names = drawn, Names(drawn.main.axes, drawn.scene.world)
        self.set_zorder(self._names.artist.get_zorder() - 0.01)
        self.set_in_layout(False)

    def draw(self, renderer: RendererBase) -> None:
        """Nothing is seen of this artist itself."""
        self._names.show(self._drawn.moving())


_DRAWN: "WeakKeyDictionary[Axes, Drawn]" = WeakKeyDictionary()


def draw(
    view: View | Step,
    scene: Scene,
    ax: Axes,
    look: Look = STANDARD,
    limits: Limits | None = None,
    legend: bool = True,
    label: str = "",
) -> Main | Over:
    """Draw world, belief, truth and beam on Axes of your own, with a legend beside the picture.

    A Step is drawn as it ended. Without limits the picture fits this view. What is drawn on the
    same Axes afterwards, of a run in the same map, goes over it in a colour of its own, and the
    world stays as it is. label : what the legend calls the run, its filter where left out.
    What comes back moves the same artists: `picture = draw(view, scene, ax)`, then
    `picture.show(other, None)`.
    """
    if isinstance(view, Step):
        view = View(0, view)
    before = _DRAWN.get(ax)
    if before is not None and before.main.belief.path.axes is ax and _alike(before.scene, scene):
        picture: Main | Over = _over(before, view, scene, look, label)
        drawn = before
    else:
        fitting = limits or scopes.of(scene, [view.step], look.probability).at(view)
        main = Main(ax, scene, fitting, look.probability, look.conditional)
        place = before.place if before is not None else ax.get_position(original=True)
        drawn = Drawn(scene, main, place, [label or watching(scene)[0]])
        if label:
            main.belief.call(label)
        main.show(view, reading(view, scene))
        ax.add_artist(Naming(drawn))
        picture, _DRAWN[ax] = main, drawn
    _put_legend(ax, drawn, legend)
    drawn.main.limit(drawn.main.asked)  # to the shape that the Axes has now
    return picture


def _over(drawn: Drawn, view: View, scene: Scene, look: Look, label: str) -> Over:
    """Draw one more run, in a style of its own."""
    main, number = drawn.main, len(drawn.over)
    name = label or watching(scene)[0]
    same = sum(one == name or one.startswith(f"{name} (") for one in drawn.names)
    name = f"{name} ({same + 1})" if same else name
    artists = OtherArtists(main.axes, name, number, look.probability)
    x, P = view.pose
    rim = Limits.around(np.vstack([view.path(), outline(x, P[:2, :2], look.probability)]))
    main.limit(main.asked.joined(rim))
    if not number:
        main.belief.call(drawn.names[0])
    drawn.names.append(name)
    drawn.over.append(artists)
    over = Over(main, artists)
    over.show(view)
    return over


def _alike(one: Scene, other: Scene) -> bool:
    """Whether two scenes have the same map, the true one."""
    return one.world.map is other.world.map or _rings(one.world.map) == _rings(other.world.map)


def _rings(floor: Map) -> list[tuple[str, list[list[float]]]]:
    return [(name, points.tolist()) for name, points in floor.outlines()]


def _put_legend(ax: Axes, drawn: Drawn, wanted: bool) -> None:
    """Put a legend of what is seen beside the picture, or beneath it where that leaves more of it:
    the Axes gives the room, from its own place. A figure that has a layout finds the room itself.
    """
    figure = ax.get_figure(root=True)
    assert figure is not None
    if (before := ax.get_legend()) is not None:
        before.remove()
    managed = figure.get_layout_engine() is not None
    if not managed:
        ax.set_position(drawn.place)
    if not wanted:
        return
    beside = _legend(ax, drawn, 1, (1, 1), (GAP, 0))
    if managed:
        return
    width, height = drawn.place.size * np.array(figure.get_size_inches())
    across, tall = np.array(beside.get_window_extent().size) / figure.dpi
    rows = len(beside.get_texts())
    columns = max(1, int(width / across))
    tall *= -(-rows // columns) / rows
    limits, least = drawn.main.asked, (1 - LARGEST) * np.array([width, height])
    rooms = (
        np.array([max(width - across - GAP / 72, least[0]), height]),
        np.array([width, max(height - tall - AXIS / 72, least[1])]),
    )
    scales = [float((room / (limits.width, limits.height)).min()) for room in rooms]
    if scales[1] > scales[0]:
        beside.remove()
        _legend(ax, drawn, columns, (0, 0), (0, -AXIS))
    share = max(scales) * np.array([limits.width, limits.height]) / figure.get_size_inches()
    left, top = drawn.place.x0, drawn.place.y1
    ax.set_position(Bbox.from_extents(left, top - share[1], left + share[0], top))


def _legend(
    ax: Axes, drawn: Drawn, columns: int, corner: tuple[float, float], off: tuple[float, float]
) -> Legend:
    """corner : of the Axes, and how far off the legend's own upper left one is, in points"""
    figure = ax.get_figure(root=True)
    assert figure is not None
    shift = ScaledTranslation(off[0] / 72, off[1] / 72, figure.dpi_scale_trans)
    handles, words = entries(drawn.handles())
    legend = ax.legend(
        handles, words, loc="upper left", ncols=columns, bbox_to_anchor=corner,
        bbox_transform=ax.transAxes + shift, borderaxespad=0.0, fontsize=POINTS, frameon=False,
        labelspacing=0.4, handlelength=2.4, handler_map=HANDLERS,
    )  # fmt: skip
    for text in legend.get_texts():
        text.set(family=families(), parse_math=False)
    return legend
