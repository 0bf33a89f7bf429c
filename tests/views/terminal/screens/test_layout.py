import re
from itertools import product

import pytest
from scenes import scene

from ekfsim.commands import Kidnap, Move, Say, Sense
from ekfsim.localization import play
from ekfsim.views.playback.playback import views
from ekfsim.views.terminal.braille import CONTROL_SEQUENCE, cells
from ekfsim.views.terminal.screens.layout import Layout, Look, Panes, ample
from ekfsim.views.terminal.screens.moment import Moment
from ekfsim.views.words.narrative.narrating import narrate

PLACE = scene(
    Move(1.0, 0.5), Sense(0.2), Say("一句很长的话 " * 9), Kidnap(3.0, 1.0, 2.0), Sense(0.0)
)
VIEWS = list(views(play(PLACE)))
BOUNDS = (-1.0, 11.0, -1.0, 9.0)
PLAIN = Look(colour=False, ascii=False)
BRAILLE = re.compile("[\u2801-\u28ff]")
LOST = 7  # the last view: the robot was carried away


def moment(number, **more):
    view = VIEWS[number]
    before = narrate(VIEWS[number - 1], PLACE) if number and VIEWS[number - 1].beam else ""
    return Moment(
        view,
        narrate(view, PLACE),
        f"step {view.step.entry.index} of 5, view {number} of 7",
        **{"before": before, **more},
    )


def screen(number, size, panes=Panes.BOTH, look=PLAIN, scroll=None, **more):
    layout = Layout(PLACE, 0.954, BOUNDS, BOUNDS, *size, look)
    return layout.lines(moment(number, **more), panes, scroll)[0]


SIZES = [(39, 15), (79, 24), (99, 30), (119, 40), (199, 60), (60, 80), (9, 4), (1, 1), (300, 5)]


@pytest.mark.parametrize(("size", "panes"), [*product(SIZES, Panes)])
@pytest.mark.parametrize("look", [PLAIN, Look(colour=True, ascii=True)])
def test_every_line_keeps_to_the_screen(size, panes, look):
    long = {"note": "Saved " + "x" * 200}
    many = {"note": "\n".join(f"a.yaml:{n}:1: wrong" for n in range(60))}
    for number, more in product((0, 1, 2, 3, 4, LOST), ({}, long, many, {"page": "a  b\n" * 50})):
        lines = screen(number, size, panes, look, **more)
        plain = [CONTROL_SEQUENCE.sub("", line) for line in lines]
        assert len(plain) == size[1]
        assert max(map(cells, plain)) <= size[0]
        assert not look.ascii or all(line.isascii() for line in plain)


@pytest.mark.parametrize(
    ("size", "both"), [((109, 24), True), ((108, 36), True), ((108, 35), False)]
)
def test_there_is_room_for_both_from_110_columns_or_36_lines(size, both):
    assert ample(*size) == both


def test_side_by_side_the_numbers_of_a_reading_stand_whole_beside_the_picture():
    lines = screen(3, (119, 40))
    assert sum(" │ " in line for line in lines) == 40 - 4 - 1
    told = " ".join(line.split(" │ ")[1] for line in lines if " │ " in line).split()
    asked = (narrate(VIEWS[2], PLACE) + narrate(VIEWS[3], PLACE)).split()
    assert told == asked
    assert any(BRAILLE.search(line.split(" │ ")[0]) for line in lines if " │ " in line)


def test_one_above_the_other_where_it_is_high():
    lines = screen(3, (80, 60))
    rule = lines.index("─" * 80)
    assert BRAILLE.search("".join(lines[:rule]))
    assert (
        " ".join(lines[rule + 1 : -1]).split()
        == (narrate(VIEWS[2], PLACE) + narrate(VIEWS[3], PLACE)).split()
    )


def test_a_long_room_stands_above_its_numbers_however_wide_the_screen_is():
    corridor = (0.0, 40.0, 0.0, 3.0)
    for shape, above in ((BOUNDS, False), (corridor, True)):
        layout = Layout(PLACE, 0.954, BOUNDS, shape, 119, 40, PLAIN)
        assert ("─" * 119 in layout.lines(moment(3), Panes.BOTH, None)[0]) == above


def test_the_picture_stays_where_it_is():
    def walls(number, size):
        return [i for i, line in enumerate(screen(number, size, Panes.PICTURE)) if "⡇" in line]

    assert walls(0, (79, 24)) == walls(3, (79, 24)) == walls(4, (79, 24)) == walls(LOST, (79, 24))


def test_numbers_are_never_cut_and_all_can_be_scrolled_to():
    size = (39, 15)
    seen, scroll, layout = [], 0, Layout(PLACE, 0.954, BOUNDS, BOUNDS, *size, PLAIN)
    for _ in range(40):
        lines, at = layout.lines(moment(3), Panes.NUMBERS, scroll)
        seen += [line for line in lines if not re.match("[▲▼]", line)]
        scroll = at + 3
    words = set(" ".join(seen).split())
    assert {*(narrate(VIEWS[2], PLACE) + narrate(VIEWS[3], PLACE)).split()} <= words


def test_signs_tell_how_much_more_there_is():
    size, layout = (39, 15), Layout(PLACE, 0.954, BOUNDS, BOUNDS, 39, 15, PLAIN)
    every = Layout(PLACE, 0.954, BOUNDS, BOUNDS, 39, 200, PLAIN)
    whole = [line for line in every.lines(moment(3), Panes.NUMBERS, 0)[0][5:-1] if line]
    top = layout.lines(moment(3), Panes.NUMBERS, 0)[0]
    below = int(re.search(r"▼ (\d+) more", "".join(top))[1])
    end, at = layout.lines(moment(3), Panes.NUMBERS, 999)
    above = int(re.search(r"▲ (\d+) more", "".join(end))[1])
    rows = size[1] - 3 - 1 - 1  # heads, status, the sign
    total = len(narrate(VIEWS[2], PLACE).splitlines())
    assert total < below + rows == above + rows
    assert at == above - 1
    assert whole[-1] in end


def test_a_view_begins_where_its_own_numbers_do():
    lines = screen(3, (79, 24), Panes.NUMBERS)
    assert not any(line.startswith("==>") for line in lines)
    assert any("predicted range" in line for line in lines[:9])


def test_what_warns_is_coloured_and_has_a_sign_besides():
    plain, coloured = (screen(LOST, (119, 40), look=Look(c, False)) for c in (False, True))
    (judged,) = (line for line in plain if line.startswith("⚠ "))
    assert "lost since step 4" in judged
    (painted,) = (line for line in coloured if "⚠ " in line)
    assert painted == f"\x1b[1;38;5;166m{judged}\x1b[0m"
    assert not any("⚠" in line for line in screen(1, (119, 40)))


def test_the_status_line_keeps_what_matters_most():
    def status(columns, **more):
        return screen(3, (columns, 24), Panes.PICTURE, **more)[-1].rstrip()

    place = "step 2 of 5, view 3 of 7"
    assert status(119) == f"{place} · n next · ? keys · v the numbers · p back · q quit"
    assert status(50) == f"{place} · n next · ? keys"
    assert status(36) == f"{place} · ? keys"
    assert status(119, note="The run is over") == f"{place} · The run is over"
    assert status(30, note="The run is over") == "The run is over"
    assert status(119, typed=13).startswith(f"{place} · 13 · ")


def test_each_mistake_has_a_line_of_its_own_up_to_half_of_the_screen():
    mistakes = [f"a.yaml:{n}:1: wrong" for n in range(1, 31)]
    few = screen(1, (79, 24), note="\n".join(mistakes[:3]))
    assert [line.rstrip() for line in few[-4:]] == ["step 1 of 5, view 1 of 7", *mistakes[:3]]
    many = screen(1, (79, 24), note="\n".join(mistakes))
    assert [line.rstrip() for line in many[-12:]] == [
        "step 1 of 5, view 1 of 7", *mistakes[:10], "… 20 more lines"
    ]  # fmt: skip
    assert BRAILLE.search("".join(many))
