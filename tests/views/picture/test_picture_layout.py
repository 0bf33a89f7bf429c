"""Everything has its place on a figure of any size: nothing lies on another, the map is large."""

import math

import pytest

from ekfsim.views.picture.layout import (
    CLOSE_TITLE,
    COLUMN,
    HEADER,
    HIGHEST,
    NOTES,
    SPREAD,
    SPREAD_WIDE,
    TICKS,
    WIDTH,
    arranged,
    fitting,
)

SHAPES = (0.2, 0.5, 1.0, 1.3, 2.0, 3.2, 6.0, 8.0)
SIZES = ((9, 7), (9, 6.1), (13, 5.8), (6.2, 5.7), (6, 4.5), (7, 11), (19.2, 10.8))


def apart(a, b):
    return a[2] <= b[0] + 1e-9 or b[2] <= a[0] + 1e-9 or a[3] <= b[1] + 1e-9 or b[3] <= a[1] + 1e-9


def parts(layout):
    """Map, close-up and legend with all that is written at them: left, bottom, right, top."""
    x, y, width, height = layout.main
    yield x - TICKS[0], y - TICKS[1], x + width, y + height
    x, y, width, height = layout.close
    yield x, y - SPREAD, x + width, y + height + CLOSE_TITLE
    x, y = layout.legend
    yield x, y - layout.room, x + COLUMN * layout.columns - 0.2, y


@pytest.mark.parametrize("shape", SHAPES)
@pytest.mark.parametrize("size", SIZES)
@pytest.mark.parametrize("rows", [8, 14])
def test_nothing_lies_on_another_or_beyond_the_edge(size, shape, rows):
    layout = arranged(*size, shape, rows)
    boxes = list(parts(layout))
    assert all(apart(a, b) for i, a in enumerate(boxes) for b in boxes[:i])
    for left, bottom, right, top in boxes:
        assert 0 <= left < right <= size[0] + 0.01
        assert NOTES < bottom < top <= size[1] - HEADER + 1e-9
    _, _, width, height = layout.main
    assert width / height == pytest.approx(shape)


def test_a_corridor_fills_the_width_and_a_room_is_not_beneath_a_band():
    corridor, room = fitting(8.0, 12), fitting(1.25, 12)
    assert corridor.main[2] > 0.88 * WIDTH
    assert room.main[2] > 0.6 * WIDTH
    for layout in (corridor, room):
        assert layout.main[1] + layout.main[3] == pytest.approx(layout.height - HEADER)


@pytest.mark.parametrize("shape", SHAPES)
def test_a_picture_is_as_high_as_it_needs_to_whole_even_pixels(shape):
    layout = fitting(shape, 12)
    assert layout.height <= HIGHEST
    assert layout.slack < 0.03 or layout.height < HIGHEST
    pixels = 100 * layout.height
    assert math.isclose(pixels, 2 * round(pixels / 2))


@pytest.mark.parametrize("shape", [1.0, 1.3])
def test_a_flat_figure_has_legend_and_close_up_right_of_the_map(shape):
    layout = arranged(13.0, 5.9, shape, 14)
    assert layout.main[3] > 3.5
    assert layout.close[2] > 2.3
    assert layout.legend[0] > layout.close[0] + SPREAD_WIDE
