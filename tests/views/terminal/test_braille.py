import re

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st

from ekfsim.views.terminal.braille import Canvas, Pen, ansi, cells, clip, paint, printable, shorten

UNIT = (0.0, 1.0, 0.0, 1.0)
ESCAPE = re.compile(r"\x1b\[[0-9;]*m")
numbers = st.floats(-30, 30)


def dots(canvas: Canvas) -> set[tuple[int, int]]:
    """The inked dots as (column, row) from the upper left, read back from the braille
    characters."""
    # of the eight bits, as Unicode has them
    places = [(0, 0), (0, 1), (0, 2), (1, 0), (1, 1), (1, 2), (0, 3), (1, 3)]
    return {
        (2 * j + x, 4 * i + y)
        for i, line in enumerate(canvas.render().split("\n"))
        for j, character in enumerate(line)
        for bit, (x, y) in enumerate(places)
        if character != " " and ord(character) - 0x2800 >> bit & 1
    }


def test_every_dot_of_a_cell_has_its_place() -> None:
    for x in range(2):
        for y in range(4):
            canvas = Canvas(1, 1, (0, 1, 0, 3))  # a dot to each metre
            canvas.polyline([(x, 3 - y)], Pen())
            assert dots(canvas) == {(x, y)}


def test_a_square_is_square_and_centred() -> None:
    # 20 × 8 dots: one to each metre, 6 columns of dots left free at each side
    canvas = Canvas(10, 2, (0, 7, 0, 7))
    canvas.polygons([np.array([[0, 0], [7, 0], [7, 7], [0, 7]])], Pen())
    inked = np.array(sorted(dots(canvas)))
    assert inked.min(axis=0).tolist() == [6, 0]
    assert inked.max(axis=0).tolist() == [13, 7]
    assert len(inked) == 4 * 7


def test_ascii_cells_are_twice_as_high_as_wide() -> None:
    canvas = Canvas(9, 5, (0, 8, 0, 8), ascii=True)
    canvas.polygons([np.array([[0, 0], [8, 0], [8, 8], [0, 8]])], Pen(ascii="+"))
    assert canvas.render() == "\n".join(["+" * 9, *["+       +"] * 3, "+" * 9])


def test_north_is_up_and_east_is_right() -> None:
    canvas = Canvas(5, 5, (0, 4, 0, 8), ascii=True)
    canvas.polyline([(0, 0), (0, 8)], Pen(ascii="n"))
    canvas.polyline([(2, 0), (4, 0)], Pen(ascii="e"))
    assert canvas.render() == "n\nn\nn\nn\nn eee"


def test_dashes_run_on_around_corners_and_along_short_pieces() -> None:
    long, short = Canvas(10, 1, (0, 19, 0, 3)), Canvas(10, 1, (0, 19, 0, 3))
    pen = Pen(on=2, off=3)
    long.polyline([(0, 0), (19, 0)], pen)
    short.polyline(np.column_stack([np.linspace(0, 19, 20), np.zeros(20)]), pen)
    assert dots(long) == {(x, 3) for x in range(20) if x % 5 < 2}
    assert dots(short) >= dots(long)
    assert len(dots(short)) < 20


@settings(deadline=None)
@given(st.tuples(numbers, numbers, numbers, numbers))
def test_clipping_agrees_with_shapely(ends: tuple[float, float, float, float]) -> None:
    a, b = np.array(ends).reshape(2, 1, 2)
    start, end = clip(a, b, (-3, 8, -2, 5))
    expected = shapely.intersection(shapely.LineString([a[0], b[0]]), shapely.box(-3, -2, 8, 5))
    if len(start) == 0:
        assert expected.length == 0
    else:
        assert np.linalg.norm(end - start) == pytest.approx(expected.length, abs=1e-9)
        assert shapely.box(-3, -2, 8, 5).covers(shapely.points(np.concatenate([start, end]))).all()


def test_what_lies_outside_costs_nothing_and_is_not_drawn() -> None:
    t = np.linspace(0, 2 * np.pi, 73)
    circle = np.column_stack([np.cos(t), np.sin(t)])
    canvas = Canvas(80, 24, UNIT)
    for radius in (3.0, 1e6, 1e12, 1e300):  # dot by dot it would never end
        canvas.polyline(radius * circle, Pen())
    assert dots(canvas) == set()
    canvas.polyline([(-1e6, 0.5), (1e6, 0.5)], Pen())
    assert len({x for x, _ in dots(canvas)}) == 96  # as wide as 24 rows are high


def test_points_that_are_no_numbers_break_a_line() -> None:
    canvas = Canvas(8, 4, (0, 15, 0, 15))
    canvas.polyline(
        [(0, 0), (3, 0), (np.nan, 0), (10, 0), (12, 0), (np.inf, 9), (-np.inf, 4)], Pen()
    )
    assert dots(canvas) == {(x, 15) for x in (0, 1, 2, 3, 10, 11, 12)}
    canvas.polyline(np.empty((0, 2)), Pen())
    canvas.polygons([], Pen())
    canvas.text((np.nan, 0), "lost")
    assert "l" not in canvas.render()


@settings(deadline=None)
@given(st.integers(1, 30), st.integers(1, 12), st.booleans(), st.lists(st.tuples(numbers, numbers)))
def test_no_line_is_longer_than_the_canvas(
    columns: int, rows: int, ascii: bool, points: list
) -> None:
    canvas = Canvas(columns, rows, (-9, 9, 4, 7), ascii)
    canvas.polyline(points, Pen())
    for point in points:
        canvas.text(point, "label 机é\n")
    lines = canvas.render().split("\n")
    assert len(lines) == rows
    assert all(cells(line) <= columns for line in lines)
    assert not ascii or canvas.render().isascii()


def test_a_world_without_extent_is_drawn() -> None:
    canvas = Canvas(8, 4, (2, 2, 3, 3))
    canvas.polyline([(2, 3)], Pen())
    canvas.polyline([(0, 3), (5, 3)], Pen())
    assert len(dots(canvas)) == 1


def test_text_stands_in_the_middle_and_covers_lines() -> None:
    canvas = Canvas(9, 3, (0, 16, 0, 8), ascii=True)
    canvas.polyline([(0, 4), (16, 4)], Pen(ascii="-"))
    canvas.text((8, 4), "desk")
    assert canvas.render().split("\n")[1] == "---desk--"
    canvas.text((16, 4), "wide")
    canvas.text((17, 4), "outside")
    assert canvas.render().split("\n")[1] == "---deskwi"


def test_the_last_to_draw_is_on_top() -> None:
    canvas = Canvas(3, 1, (0, 5, 0, 3))
    canvas.text((2, 1), "x")
    canvas.polyline([(2, 1)], Pen("31"))
    assert "x" not in canvas.render()
    canvas.text((2, 1), "o", "32")
    assert canvas.render(colour=True).strip() == "\x1b[32mo\x1b[0m"


def test_colour_only_when_asked_for_and_once_for_each_run() -> None:
    canvas = Canvas(10, 1, (0, 19, 0, 3))
    canvas.polyline([(0, 0), (9, 0)], Pen("31"))
    canvas.polyline([(10, 0), (15, 0)], Pen())
    assert canvas.render() == "⣀" * 8
    assert canvas.render(colour=True) == "\x1b[31m⣀⣀⣀⣀⣀\x1b[0m⣀⣀⣀"


def test_colours_are_the_nearest_of_the_cube() -> None:
    assert [ansi(c) for c in ("#000000", "#ffffff", "#0072B2", "#56B4E9")] == [
        "38;5;16",
        "38;5;231",
        "38;5;25",
        "38;5;74",
    ]
    assert paint("a", "") == "a"
    assert paint(" ", "31") == " "


@pytest.mark.parametrize(
    ("text", "ascii", "expected"),
    [
        ("plain", False, "plain"),
        ("a\x1b[31;1mred\x1b[0m\x1b]0;title\x07b\x9b2J", False, "aredb2J"),
        ("\x1b7\x07\b\x7fbell\u202e\u200b\ufeff", False, "7bell"),
        (" two\tlines\r\n and\u2028 more ", False, "two lines and more"),
        ("e\u0301 z\u0335\u0336\u0337", False, "é z"),
        ("\U0001f468\u200d\U0001f469\ufe0f", False, "\U0001f468\U0001f469"),
        ("\ud800\ue000", False, ""),
        ("café 机 90°", True, "cafe ? 90?"),
    ],
)
def test_no_text_disturbs_a_line(text: str, ascii: bool, expected: str) -> None:
    assert printable(text, ascii) == expected


@settings(deadline=None)
@given(st.text(), st.integers(0, 20), st.booleans())
def test_texts_are_cut_to_their_cells(text: str, columns: int, ascii: bool) -> None:
    text = printable(text, ascii)
    short = shorten(text, columns, ascii)
    assert cells(short) <= columns
    assert short == text or cells(text) > columns
    assert not re.search(r"[\x00-\x1f\x7f-\x9f]", short)


def test_cut_texts_say_so() -> None:
    assert shorten("a long title", 8) == "a long…"
    assert shorten("a long title", 8, ascii=True) == "a lon..."
    assert shorten("机器人定位", 6) == "机器…"
    assert shorten("x" * 10_000, 2) == "x…"


@pytest.mark.parametrize("place", [3.0, 3.5, 3.25])
def test_a_line_between_two_rows_of_dots_has_no_gaps(place):
    """np.rint would carry every half to the even one."""
    canvas = Canvas(10, 5, (0.0, 19.0, 0.0, 19.0))  # a dot is as wide as a unit
    canvas.polyline([(place, 0.5), (place, 15.5)], Pen())
    canvas.polyline([(5.5, place), (15.5, place)], Pen())
    bits = [ord(sign) - 0x2800 for sign in canvas.render().replace("\n", "").replace(" ", "")]
    assert sum(bit.bit_count() for bit in bits) == 16 + 11


def test_a_note_covers_no_other_text():
    canvas = Canvas(9, 5, (0.0, 9.0, 0.0, 5.0), ascii=True)
    middle = (4.5, 2.5)
    canvas.text(middle, "o")
    canvas.polyline([(0, 2.5), (9, 2.5)], Pen(ascii="."))
    canvas.text(middle, "*")
    for number in range(12):
        canvas.note(middle, f"{number:02}")
    lines = canvas.render().splitlines()
    assert "*" in "".join(lines)
    written = [number for number in range(12) if f"{number:02}" in "\n".join(lines)]
    assert written[:3] == [0, 1, 2]  # the first found a place, later ones where they do not cover
    assert 3 <= len(written) < 12
    for line in lines:
        assert not any(one.isdigit() and len(one) > 2 for one in line.replace(".", " ").split())
    canvas.note((99.0, 0.0), "far")
    assert "far" not in canvas.render()
