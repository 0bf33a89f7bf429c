"""Where everything stands on a figure: the map as large as its own shape allows, and what explains
it beside it or beneath it, whichever leaves the map more room.
"""

import math
from dataclasses import dataclass

Box = tuple[float, float, float, float]  # left, bottom, width, height

# all in inches
WIDTH, HIGHEST = 9.0, 7.0  # of a picture whose size nobody asked for
HEADER = 0.68  # from the upper edge to the map: the title, and the line that judges
TITLE, JUDGED = 0.31, 0.56  # from the upper edge to their baselines
NOTES = 0.68  # from the lower edge to the caption's first baseline: three lines, what made it
MARGIN = 0.2
CAPTION = 0.2  # the height of the caption's first line, with what parts it from what is above
TICKS = (0.76, 0.48)  # left of the map and below it: its numbers and its quantities
GAP = 0.25  # between the map and what explains it
COLUMN = 2.25  # the legend's, as wide as its longest words
ROW = 0.168  # of the legend
CLOSE_TITLE, SPREAD = 0.3, 0.22  # above the close-up and below it
SPREAD_WIDE = 2.35  # how long the line below the close-up may be
LEAST_CLOSE, BENEATH, MOST_CLOSE, WIDEST_CLOSE = 1.5, 1.8, 2.8, 4.5  # the close-up's sides
LEAST = 0.1  # of anything, however small the figure


@dataclass(frozen=True, slots=True)
class Layout:
    """In inches, from the figure's lower left corner."""

    width: float
    height: float
    main: Box
    close: Box
    legend: tuple[float, float]  # its upper left corner
    room: float  # for its height
    columns: int  # of the legend
    slack: float = 0.0  # of the height, which nothing needs

    def share(self, box: Box) -> Box:
        """A box as shares of the figure."""
        left, bottom, width, height = box
        return left / self.width, bottom / self.height, width / self.width, height / self.height


def arranged(width: float, height: float, shape: float, rows: int) -> Layout:
    """How a figure of this size is divided. shape : the map's width by its height;
    rows : of the legend
    """
    ways = (_beside, _beneath, _in_a_row)
    return max((way(width, height, shape, rows) for way in ways), key=_worth)


def fitting(shape: float, rows: int) -> Layout:
    """The same for a figure as high as the map asks for, to two pixels in a hundred an inch."""
    slack = arranged(WIDTH, HIGHEST, shape, rows).slack
    return arranged(WIDTH, math.ceil(50 * (HIGHEST - slack) - 1e-6) / 50, shape, rows)


def _worth(layout: Layout) -> float:
    """The map's area; of less worth where the close-up is too small to be read."""
    _, _, across, high = layout.main
    return across * high * min(layout.close[2] / LEAST_CLOSE, 1.0) ** 2


def _beside(width: float, height: float, shape: float, rows: int) -> Layout:
    """The map left, legend and close-up in a column right of it."""
    (left, below), top, lowest = TICKS, height - HEADER, NOTES + CAPTION
    widest, tallest = width - left - GAP - COLUMN - MARGIN, top - lowest - below
    across = max(min(widest, tallest * shape), LEAST)
    high, start = across / shape, left + across + GAP
    ceiling = top - rows * ROW - CLOSE_TITLE
    side = max(min(width - start - MARGIN, ceiling - lowest - SPREAD), LEAST)
    floor = max(min(top - high, ceiling - side), lowest + SPREAD)
    used = min(floor - SPREAD, top - high - below)
    return Layout(
        width, height, (left, top - high, across, high), (start, floor, side, side), (start, top),
        top - floor - side - CLOSE_TITLE, 1, max(used - lowest, 0.0),
    )  # fmt: skip


def _beneath(width: float, height: float, shape: float, rows: int) -> Layout:
    """The map across the figure, close-up and legend in a row below it."""
    (left, below), top, lowest = TICKS, height - HEADER, NOTES + CAPTION
    widest = width - left - MARGIN
    tallest = top - lowest - below - CLOSE_TITLE - SPREAD - BENEATH
    across = max(min(widest, tallest * shape), LEAST)
    high = across / shape
    ceiling = top - high - below - CLOSE_TITLE
    side = max(min(ceiling - lowest - SPREAD, MOST_CLOSE, widest / 3), LEAST)
    start = left + max(side, SPREAD_WIDE) + GAP
    columns = max(int((width - start) / COLUMN), 1)
    taken = max(side, math.ceil(rows / columns) * ROW)
    return Layout(
        width, height, (left, top - high, across, high), (left, ceiling - side, side, side),
        (start, ceiling), ceiling - lowest, columns, max(ceiling - taken - SPREAD - lowest, 0.0),
    )  # fmt: skip


def _in_a_row(width: float, height: float, shape: float, rows: int) -> Layout:
    """The map left, the close-up right of it, and the legend right of that: for a flat figure."""
    (left, below), top, lowest = TICKS, height - HEADER, NOTES + CAPTION
    tallest = top - lowest - below
    explained = 2 * GAP + COLUMN + MARGIN
    across = max(min(width - left - explained - SPREAD_WIDE, tallest * shape), LEAST)
    high, start = across / shape, left + across + GAP
    ceiling = top - CLOSE_TITLE
    most = width - left - across - explained
    side = max(min(most, ceiling - lowest - SPREAD, WIDEST_CLOSE), LEAST)
    after = start + max(side, SPREAD_WIDE) + GAP
    needed = max(high + below, CLOSE_TITLE + side + SPREAD, rows * ROW)
    return Layout(
        width, height, (left, top - high, across, high), (start, ceiling - side, side, side),
        (after, top), top - lowest, 1, max(top - needed - lowest, 0.0),
    )  # fmt: skip
