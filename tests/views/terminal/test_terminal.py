import math
import re
import subprocess
import sys
from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from ekfsim.commands import Command, Kidnap, Move, Say, Sense
from ekfsim.filters.belief import Gaussian
from ekfsim.floor import Map, Obstacle
from ekfsim.localization import play
from ekfsim.records import Entry
from ekfsim.scene import Scene
from ekfsim.views.playback.playback import Playback
from ekfsim.views.playback.view import View
from ekfsim.views.terminal.braille import cells
from ekfsim.views.terminal.drawing import draw
from ekfsim.world import Landmark, Noise, Told, World

LIMITS = (0.0, 10.0, 0.0, 8.0)
SIZE = (80, 24)
ROOM = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 8.0], [0.0, 8.0]])
DESK = Obstacle("desk", np.array([[6.0, 2.0], [9.0, 2.0], [9.0, 5.0], [6.0, 5.0]]))
EXACT = Noise(0.0, 0.0, 0.0, 0.0, 0.0)


def scene(
    *commands: Command,
    obstacles: tuple[Obstacle, ...] = (DESK,),
    told: Map | None = None,
    **world: object,
) -> Scene:
    floor = Map(ROOM, obstacles)
    start = np.array([2.0, 4.0, 0.0])
    what = Told(start, np.zeros(3), EXACT, told or floor)
    return Scene(World("room", floor, start, np.zeros(3), EXACT, what, **world), commands)


def view(of: Scene, number: int) -> View:
    found = Playback(play(of)).view(number)
    assert found is not None
    return found


def believing(view: View, mean: list[float], P: np.ndarray) -> View:
    return replace(view, step=replace(view.step, posterior=Gaussian(np.array(mean), P)))


def picture(of: Scene, number: int, ascii: bool = True, size: tuple[int, int] = SIZE) -> list[str]:
    return draw(view(of, number), of, 0.954, size, LIMITS, colour=False, ascii=ascii).split("\n")


def nearest(place):
    return math.floor(place + 0.5 + 1e-6)  # halves all go one way


def at(lines: list[str], x: float, y: float) -> str:
    """The character at a point in m of an ASCII picture at 80 × 24: 21 steps down for 8 m, twice as
    many across."""
    per_metre = 42 / 8
    return lines[1 + nearest(10.5 - (y - 4) * per_metre / 2)].ljust(80)[
        nearest(39.5 + (x - 5) * per_metre)
    ]


def test_everything_stands_where_it_is() -> None:
    lines = picture(scene(Move(2.0, math.pi / 2)), 1)
    assert [at(lines, *corner) for corner in ROOM] == ["#"] * 4
    assert [at(lines, *corner) for corner in DESK.points] == ["#"] * 4
    assert at(lines, 7.5, 0.0) == "#"
    assert "desk" in lines[1 + nearest(10.5 - (3.5 - 4) * 21 / 8)]
    assert at(lines, 2.0, 4.0) == "."  # the path begins at the start
    assert at(lines, 4.0, 4.0) == "o"  # the truth, over the estimate
    assert at(lines, 4.0, 4.5) == "~"  # and its heading
    assert at(lines, 4.0, 5.8) == "'"  # a certain heading makes a cone of one line


def test_the_estimate_is_drawn_where_it_is_believed() -> None:
    room = scene()
    for degrees, arrow in ((0, ">"), (90, "^"), (180, "<"), (-90, "v"), (-170, "<")):
        seen = believing(view(room, 0), [5.0, 6.0, math.radians(degrees)], np.zeros((3, 3)))
        lines = draw(seen, room, 0.954, SIZE, LIMITS, colour=False, ascii=True).split("\n")
        assert at(lines, 5.0, 6.0) == arrow
        assert at(lines, 2.0, 4.0) == "o"


def test_the_ellipse_has_its_radii() -> None:
    room = scene(obstacles=())
    P = np.diag([(2.0 / 2.4816) ** 2, (1.0 / 2.4816) ** 2, 0.0])  # radii 2 m and 1 m
    lines = draw(
        believing(view(room, 0), [3.0, 4.0, 0.0], P), room, 0.954, SIZE, LIMITS, False, True
    ).split("\n")
    stars = {(i, j) for i, line in enumerate(lines[1:-1]) for j, c in enumerate(line) if c == "*"}
    assert max(j for _, j in stars) - min(j for _, j in stars) == pytest.approx(4 * 42 / 8, abs=1)
    assert max(i for i, _ in stars) - min(i for i, _ in stars) == pytest.approx(2 * 21 / 8, abs=1)


def test_ellipse_and_cone_warn_each_by_itself() -> None:
    room = scene(obstacles=())
    P = np.diag([(2.0 / 2.4816) ** 2, (1.0 / 2.4816) ** 2, 0.01])  # the cone is 0.2 rad wide
    for mean, ellipse, cone in (
        ([3.9, 4.0, 0.19], "*", "'"),
        ([4.1, 4.0, 0.19], "!", "'"),
        ([3.9, 4.0, 0.21], "*", "!"),
    ):
        seen = believing(view(room, 0), mean, P)
        lines = draw(seen, room, 0.954, SIZE, LIMITS, False, True).split("\n")
        drawn = set("".join(lines[1:-1]))
        assert drawn & set("*!'") == {ellipse, cone}
        words = "ellipse: truth outside" if ellipse == "!" else "95.4 % ellipse"
        words += f"  {cone} cone" + (": truth outside" if cone == "!" else "")
        assert f"{ellipse} {words}" in lines[-1]
    unknown = replace(seen.step.entry, truth=None)
    seen = replace(seen, step=replace(seen.step, entry=unknown))
    assert "!" not in draw(seen, room, 0.954, SIZE, LIMITS, False, True)


def test_what_was_believed_before_is_dotted() -> None:
    room = scene(obstacles=())
    seen = believing(view(room, 0), [5.0, 4.0, 0.0], np.diag([0.01, 0.01, 0.01]))
    before = Gaussian(np.array([5.0, 4.0, 0.0]), np.diag([(2.0 / 2.4816) ** 2, 0.1, 0.01]))
    seen = replace(seen, step=replace(seen.step, prior=before))
    lines = draw(seen, room, 0.954, (120, 24), LIMITS, False, True).split("\n")
    ghost = {j for line in lines[1:-1] for j, c in enumerate(line) if c == '"'}
    assert max(ghost) - min(ghost) == pytest.approx(4 * 42 / 8, abs=1)
    assert '" before' in lines[-1]


def test_the_true_way_leads_to_the_truth() -> None:
    run = scene(Move(2.0, math.pi / 2), Kidnap(2.0, 6.0, 0.0), Move(4.0, 0.0))
    seen = view(run, 3)
    lines = draw(seen, run, 0.954, (120, 40), LIMITS, False, True).split("\n")
    assert lines[-1].endswith("~~ true way")
    way = {(i, j) for i, line in enumerate(lines[1:-1]) for j, c in enumerate(line) if c == "~"}
    levels = {i for i, _ in way}
    assert len(levels) == 2  # of the first move, and after it was carried away, with none between


@pytest.mark.parametrize("degrees", [0, 45, 90, 160, -30])
def test_the_robot_is_a_triangle_that_points_ahead(degrees: float) -> None:
    room, heading = scene(obstacles=()), math.radians(degrees)
    seen = believing(view(room, 0), [5.0, 4.0, heading], np.zeros((3, 3)))
    lines = draw(seen, room, 0.954, SIZE, LIMITS, colour=False).split("\n")[1:-1]
    ahead, left = (
        np.array([math.cos(heading), math.sin(heading)]),
        np.array([-math.sin(heading), math.cos(heading)]),
    )
    # in dots from the middle
    for corner in (5 * ahead, -3 * ahead + 3.5 * left, -3 * ahead - 3.5 * left, 0 * ahead):
        column, row = nearest(79.5 + corner[0]), nearest(43.5 - corner[1])
        bit = [[0, 3], [1, 4], [2, 5], [6, 7]][row % 4][column % 2]
        assert ord(lines[row // 4][column // 2]) - 0x2800 >> bit & 1


@pytest.mark.parametrize("ascii", [False, True])
@pytest.mark.parametrize("scale", [0.0, 1e-300, 1e-12, 1.0, 1e6, 1e12, 1e140, math.inf, math.nan])
def test_no_covariance_breaks_the_picture(scale: float, ascii: bool) -> None:
    room = scene()
    P = np.full((3, 3), scale) if not math.isfinite(scale) else scale * np.eye(3)
    lines = draw(
        believing(view(room, 0), [5.0, 4.0, 0.0], P), room, 0.954, SIZE, LIMITS, False, ascii
    ).split("\n")
    assert len(lines) == 24
    assert "#" in lines[1] or "⡏" in lines[1] or "⢸" in lines[2]  # the room stands
    assert ("no number" in lines[-1]) == (not math.isfinite(scale))
    assert ("any heading" in lines[-1]) == (math.pi**2 / 4 < scale < math.inf)


def test_the_beam_is_drawn_until_the_estimate_is_revised() -> None:
    aimed = scene(Sense(math.pi / 2))
    beam, revised = picture(aimed, 1), picture(aimed, 2)
    assert beam[0].startswith("1 of 1: sense at 90 deg, measured 4.000 m, predicted 4.000 m")
    assert revised[0].startswith("1 of 1: sense at 90 deg, nothing was uncertain")
    assert [at(beam, 2.0, y) for y in (5.0, 6.0, 7.0)] == ["-"] * 3
    assert [at(revised, 2.0, y) for y in (5.0, 6.0, 7.0)] == [" "] * 3
    assert "beam" in beam[-1]
    assert "beam" not in revised[-1]


def test_a_beam_ends_where_it_was_measured_and_a_cross_where_it_was_predicted() -> None:
    lines = picture(scene(Sense(0.0), told=Map(ROOM)), 1)  # the filter does not know the desk
    assert at(lines, 6.0, 4.0) == "*"
    assert at(lines, 10.0, 4.0) == "x"
    assert at(lines, 6.0, 2.0) == "%"
    assert "%% not on its map" in lines[-1]


def test_an_obstacle_that_only_the_filter_believes_in_is_dotted() -> None:
    lines = picture(scene(obstacles=(), told=Map(ROOM, (DESK,))), 0)
    assert at(lines, 6.0, 2.0) == ":"
    assert ":: on its map only" in lines[-1]


def test_a_beam_without_echo_is_told_and_not_drawn() -> None:
    nowhere = scene(Sense(0.0), obstacles=())
    nowhere = replace(nowhere, world=replace(nowhere.world, map=Map()))
    lines = picture(nowhere, 1)
    assert "measured nothing, predicted 8.000 m" in lines[0]
    assert at(lines, 8.0, 4.0) == " "
    assert picture(nowhere, 2)[0].startswith("1 of 1: sense at 0 deg, not used (no echo)")


def test_titles() -> None:
    tour = scene(Move(1.0, 0.5, 0.25), Say("Look here."), Kidnap(3.0, 3.0, 0.0), Move(9.0, 0.0))
    titles = [picture(tour, n, ascii=False)[0] for n in range(5)]
    assert [re.split(" {2,}", title)[0] for title in titles] == [
        "0 of 4: the start in room",
        "1 of 4: move 1 m, turn 28.65°, slip 0.25",
        "2 of 4: Look here.",
        "3 of 4: the robot is carried away, and the filter is not told",
        "4 of 4: move 9 m, turn 0°: bumped into a wall",
    ]
    assert all(title.endswith("  ├─────────┤ 2 m") for title in titles)  # 87 dots for 8 m
    assert all(cells(title) == 80 for title in titles)


def test_legend_at_80_columns_is_whole() -> None:
    assert picture(scene(Sense(0.0)), 1, ascii=False)[-1] == (
        "⡷⠄ estimate  o⠒ truth  ⠒* beam  x predicted  ⠄⠠ path  ⢎⡱ 95.4 % ellipse  ⡠⠊ cone"
    )


def test_what_left_the_picture_is_said_to_be_outside() -> None:
    room = scene()
    lines = draw(
        believing(view(room, 0), [50.0, 4.0, 0.0], np.eye(3)), room, 0.954, SIZE, LIMITS, False
    ).split("\n")
    assert "estimate (outside)" in lines[-1]
    assert "truth (outside)" not in lines[-1]


def test_a_recorded_log_without_truth_or_commands_is_drawn() -> None:
    room = scene()
    seen = view(room, 0)
    lines = draw(
        replace(seen, step=replace(seen.step, entry=Entry(3, None))),
        room,
        0.954,
        SIZE,
        LIMITS,
        False,
        True,
    )
    assert "o~" not in lines
    assert ">" in lines


def test_landmarks_stand_with_their_number() -> None:
    lines = picture(scene(landmarks=(Landmark(7, 5.0, 6.0),)), 0)
    assert "#7" in lines[1 + nearest(10.5 - 2 * 21 / 8)]


@pytest.mark.parametrize("ascii", [False, True])
@pytest.mark.parametrize("colour", [False, True])
@pytest.mark.parametrize("size", [(20, 8), (80, 24), (1, 1), (3, 2), (0, 0), (300, 100), (200, 4)])
def test_the_picture_keeps_to_its_size(size: tuple[int, int], colour: bool, ascii: bool) -> None:
    nasty = Obstacle("d\x1b[2Jesk\n机", DESK.points)
    tour = scene(Move(1.0, 0.1), Sense(0.3), Say("一句很长的话 \x1b[31m " * 20), obstacles=(nasty,))
    for number in range(5):
        text = draw(view(tour, number), tour, 0.954, size, LIMITS, colour, ascii)
        plain = re.sub(r"\x1b\[[0-9;]+m", "", text) if colour else text
        assert "\x1b" not in plain
        assert not ascii or plain.isascii()
        lines = plain.split("\n")
        assert len(lines) == max(size[1], 1)
        assert max(map(cells, lines)) <= max(size[0], 1)


def test_colour_changes_no_character() -> None:
    aimed = scene(Sense(0.3))
    coloured = draw(view(aimed, 1), aimed, 0.954, SIZE, LIMITS, colour=True)
    assert "\x1b[38;5;166m" in coloured  # the beam
    assert re.sub(r"\x1b\[[0-9;]+m", "", coloured) == "\n".join(picture(aimed, 1, ascii=False))


@settings(deadline=None)
@given(st.text(max_size=200))
def test_no_sentence_breaks_the_title(text: str) -> None:
    said = scene(Say(text), obstacles=(Obstacle(text, DESK.points),))
    lines = picture(said, 1, ascii=False, size=(40, 12))
    assert len(lines) == 12
    assert max(map(cells, lines)) <= 40
    assert not any(re.search(r"[\x00-\x1f\x7f-\x9f]", line) for line in lines)


def test_names_stand_inside_their_obstacles_or_nowhere() -> None:
    corner = Obstacle(
        "corner", np.array([[1.0, 1.0], [9.0, 1.0], [9.0, 7.0], [8.0, 7.0], [8.0, 3.0], [1.0, 3.0]])
    )
    lines = picture(scene(obstacles=(corner,)), 0)
    (row,) = (i for i, line in enumerate(lines) if "corner" in line)
    assert 1 + 10.5 - (3 - 4) * 21 / 8 < row < 1 + 10.5 - (1 - 4) * 21 / 8  # in the foot of the L
    assert not any(
        "slot" in line
        for line in picture(scene(obstacles=(Obstacle("slot", DESK.points / [9, 1]),)), 0)
    )


def test_drawing_loads_no_plotting_library() -> None:
    script = """
import sys
import ekfsim.views.terminal.screens.console, ekfsim.views.terminal.keys.keyboard
print([m for m in ("matplotlib", "shapely", "pydantic", "scipy") if m in sys.modules])
"""
    assert (
        subprocess.run(
            [sys.executable, "-c", script], capture_output=True, text=True, check=True
        ).stdout
        == "[]\n"
    )
