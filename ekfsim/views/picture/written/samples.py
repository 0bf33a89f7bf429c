"""Samples of what is drawn, as a legend shows them."""

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.collections import Collection, LineCollection, PathCollection
from matplotlib.lines import Line2D
from matplotlib.patches import Patch, Rectangle
from matplotlib.transforms import Bbox

Handle = Artist | tuple[Artist, ...]  # those of a tuple are drawn on top of each other


class LineSample(Line2D):
    """A line across the sample's box, with a marker in its middle."""

    def fill(self, box: Bbox) -> None:
        """Move it to a box."""
        self.set_data(np.linspace(box.x0, box.x1, 3), np.full(3, (box.y0 + box.y1) / 2))


class MarkSample(Line2D):
    """Marks beside each other."""

    def fill(self, box: Bbox) -> None:
        """Move them to a box."""
        self.set_data(np.linspace(box.x0, box.x1, 7)[1:-1], np.full(5, (box.y0 + box.y1) / 2))


class AreaSample(Rectangle):
    """A rectangle that fills the sample's box."""

    def fill(self, box: Bbox) -> None:
        """Move it to a box."""
        self.set_bounds(*box.bounds)


Sample = LineSample | MarkSample | AreaSample


def sample(handle: Handle) -> list[Sample]:
    """What shows how an artist is drawn; its transform and place are still to be set."""
    return [_one(artist) for artist in (handle if isinstance(handle, tuple) else (handle,))]


def first(handle: Handle) -> Artist:
    """The artist that is called by what the legend says."""
    return handle[0] if isinstance(handle, tuple) else handle


def style(handle: Handle) -> object:
    """What of an artist's style differs from view to view, and in the legend."""
    if isinstance(handle, tuple):
        return tuple(map(style, handle))
    if not isinstance(handle, Line2D):
        return ()
    shape = handle.get_marker(), handle.get_markersize()
    return (handle.get_linestyle(), handle.get_linewidth(), *shape)


def _one(artist: Artist) -> Sample:
    made: Sample
    drawn: Any = artist  # matplotlib leaves the types of its collections out
    match artist:
        case Line2D():
            made = LineSample([], [])
            made.update_from(artist)
            made.set(markevery=[1], clip_path=None)
        case Patch():
            made = AreaSample((0, 0), 0, 0)
            made.update_from(artist)
            made.set_clip_path(None)
        case LineCollection():
            width, (start, dashes) = drawn.get_linewidths()[0], drawn.get_linestyles()[0]
            made = LineSample([], [], color=drawn.get_colors()[0], linewidth=width)
            if dashes is not None:  # in points; of a line in widths
                made.set_linestyle((start / width, [length / width for length in dashes]))
        case PathCollection():
            made = MarkSample([], [], color=drawn.get_facecolor()[0], ls="none", marker=".")
        case Collection():
            face, edge = artist.get_facecolor()[0], artist.get_edgecolor()[0]
            made = AreaSample((0, 0), 0, 0, facecolor=face, edgecolor=edge)
            made.set_linewidth(drawn.get_linewidths()[0])
        case _:
            raise TypeError(f"no sample of {artist!r}")
    made.set(clip_on=False, animated=False, visible=True)
    return made
