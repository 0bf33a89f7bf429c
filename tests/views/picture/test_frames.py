import math
import re
from dataclasses import replace
from io import BytesIO
from itertools import pairwise

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import to_rgba
from matplotlib.figure import Figure
from matplotlib.legend import Legend
from PIL import Image
from scenes import DESK, NOISE, ROOM, SILENT, START, rich, scene, told, unbounded

from ekfsim.commands import Kidnap, Move, Say, Sense
from ekfsim.floor import Map, RoundObstacle, WallLine
from ekfsim.geometry.ellipse import conditioned, radius_factor
from ekfsim.localization import play
from ekfsim.views.notebook.drawing import draw
from ekfsim.views.picture import frames, panels
from ekfsim.views.picture.artists import VERMILLION
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.frames import Frame, Picture
from ekfsim.views.picture.look import Look, Paper
from ekfsim.views.picture.panels import close_width
from ekfsim.views.playback.playback import views
from ekfsim.views.words.beams.beam import beam

HOOK = np.array([[7.0, 4], [7, 6], [9, 6]])
SIGMA = (0.3, 0.1, 0.2)


def shown(run, number=-1, look=Look()):  # noqa: B008
    """The picture of one view of a run, and the view."""
    every = list(views(play(run)))
    figure = Figure(figsize=(9, 7))
    FigureCanvasAgg(figure)
    picture = Picture(figure, run, scopes.of(run, play(run)), look)
    picture.show(every[number])
    return picture, every[number]


def words(legend: Legend) -> list[str]:
    return [text.get_text() for text in legend.get_texts()]


def test_the_ellipse_drawn_is_the_covariance():
    picture, view = shown(scene(Move(1.0, 0.5), sigma=SIGMA))
    x, P = view.belief
    offset = picture.main.belief.ellipse.get_xy() - x[:2]
    distance = np.vecdot(offset, np.linalg.solve(P[:2, :2], offset.T).T)
    assert distance == pytest.approx(radius_factor(0.954) ** 2)


def test_the_cone_opens_two_sigma_to_each_side():
    picture, view = shown(scene(sigma=SIGMA))
    x = view.belief.mean
    rays = picture.main.belief.cone.get_xy()[1:-1] - x[:2]
    angles = np.arctan2(rays[:, 1], rays[:, 0]) - x[2]
    assert (angles.min(), angles.max()) == (pytest.approx(-0.4), pytest.approx(0.4))


def test_the_conditioned_ellipses_belong_to_the_edges_of_the_cone():
    run = scene(Move(2.0, 0.5), sigma=SIGMA)
    picture, view = shown(run, look=Look(conditional=True))
    x, P = view.belief
    for sign, line in picture.main.belief.conditioned.items():
        center, C = conditioned(x, P, sign * 2 * math.sqrt(P[2, 2]))
        offset = line.get_xydata() - center
        assert np.vecdot(offset, np.linalg.solve(C, offset.T).T) == pytest.approx(
            radius_factor(0.954) ** 2
        )
    assert "ellipse if heading is at −2 σ" in words(picture.legend)
    assert "ellipse if heading is at +2 σ" in words(picture.legend)
    styles = {
        line.get_linestyle() + line.get_color() for line in picture.main.belief.conditioned.values()
    }
    assert len(styles) == 2
    assert not shown(run)[0].main.belief.conditioned


def test_robot_and_path_are_the_estimates_and_the_dot_is_the_truth():
    run = scene(Move(1.0, 0.5), Kidnap(3.0, 2.0, 1.0), Move(1.0, 0.5), sigma=SIGMA)
    picture, view = shown(run)
    belief = picture.main.belief
    assert belief.reference.get_xydata()[0] == pytest.approx(view.belief.mean[:2])
    assert belief.path.get_xydata() == pytest.approx(view.path())
    assert belief.truth.get_xydata()[0] == pytest.approx(view.step.entry.truth[:2])
    east, north = np.diff(belief.heading.get_xydata(), axis=0)[0]
    assert math.atan2(north, east) == pytest.approx(view.step.entry.truth[2])
    nose = belief.body.get_xy()[-2] - view.belief.mean[:2]
    assert math.atan2(nose[1], nose[0]) == pytest.approx(view.belief.mean[2])


def test_the_beam_has_the_measured_length_from_the_estimate_before_the_update():
    run = scene(Sense(0.3), sigma=SIGMA, obstacles=(DESK,))
    picture, view = shown(run, 1)
    line = picture.main.beam.measured.get_xydata()
    assert line[0] == pytest.approx(view.step.prior.mean[:2])
    east, north = line[1] - line[0]
    assert math.hypot(east, north) == pytest.approx(float(view.step.entry.given.z[0]))
    assert math.atan2(north, east) == pytest.approx(START[2] + 0.3)
    expected = picture.main.beam.expected.get_xydata()[0] - line[0]
    assert math.hypot(*expected) == pytest.approx(float(view.step.correction.predicted[0]))


def test_the_revised_view_has_no_beam():
    picture, _ = shown(scene(Sense(0.3), sigma=SIGMA), 2)
    assert len(picture.main.beam.measured.get_xydata()) == 0
    assert len(picture.main.beam.end.get_xydata()) == 0
    assert "the estimate moved" in picture.notes.get_text()


@pytest.mark.parametrize(
    ("ahead", "ending", "marker"),
    [
        (-0.2, "in the air, 20 cm short of desk", "o"),
        (0.2, "inside desk, 20 cm too far", "X"),
        (1.5, "1.5 m behind the edge of desk", "X"),
        (0.0, "on desk", "X"),
    ],
)
def test_the_end_of_a_beam_is_said_and_marked(ahead, ending, marker):
    run = scene(Sense(0.0), start=(1.0, 3.5, 0.0), obstacles=(DESK,), noise=SILENT)
    run = told(
        run, start=np.array([1.0 + ahead, 3.5, 0.0]), noise=NOISE, sigma=np.array([0.1, 0.1, 0.01])
    )
    picture, view = shown(run, 1)
    assert beam(view.step, run).ending == ending
    assert picture.main.beam.end.get_marker() == marker
    assert picture.notes.get_text().split("\n")[0].endswith(f"the beam ends {ending}")


def test_a_beam_may_end_outside_the_room():
    run = told(scene(Sense(0.0), start=(1.0, 6.0, 0.0)), start=np.array([3.0, 6.0, 0.0]))
    assert beam(list(views(play(run)))[1].step, run).ending.startswith("outside the room")


def test_what_is_special_of_a_beam_is_said():
    said = set()
    for run in (rich(), rich(guard="skip"), unbounded()):
        picture, _ = shown(run, 0)
        for view in views(play(run)):
            picture.show(view)
            said |= {word for word in WORDS if word in picture.notes.get_text()}
            ray = beam(view.step, run) if view.beam else None
            assert len(picture.main.beam.probes.get_segments()) == (
                0 if ray is None else len(ray.probes)
            )
            if ray is not None:
                assert bool(ray.probes) == ray.ambiguous
                # from the estimate to each pose
                asked = picture.main.beam.arms.get_xydata().reshape(-1, 2, 2)
                assert asked[:, 0] == pytest.approx(np.tile(ray.pose[:2], (len(ray.probes), 1)))
                assert asked[:, 1] == pytest.approx(
                    np.array([p.pose[:2] for p in ray.probes]).reshape(-1, 2)
                )
                assert ray.doubt in picture.notes.get_text().replace("\n", " ")
                assert bool(re.match("from .* it would meet .*, not ", ray.doubt)) == ray.ambiguous
            for axes in (picture.main, picture.close):
                walls = axes.beam.walls.get_segments()
                pairs = zip(walls, () if ray is None else ray.walls, strict=True)
                assert all(np.array_equal(drawn, wall) for drawn, wall in pairs)
    assert said == WORDS


WORDS = {
    "ambiguous",
    "grazing",
    "no echo",
    "no wall expected",
    "refused by the gate",
    "refused by the guard",
    "bumped into",
    "carried away",
}


def test_a_refused_beam_is_dashed_and_its_end_hollow():
    run = told(
        scene(Sense(0.0), gate=0.9, sigma=(0.01, 0.01, 0.01)), start=np.array([4.0, 1.0, START[2]])
    )
    picture, _ = shown(run, 1)
    assert picture.main.beam.measured.get_linestyle() == "--"
    assert picture.main.beam.end.get_markerfacecolor() == "white"


def test_the_legend_names_what_is_drawn():
    picture, _ = shown(rich(), look=Look(0.9))
    said = words(picture.legend)
    assert said[:4] == [
        "estimate",
        "path of the estimates",
        "90 % ellipse (2.15 σ)",
        "heading ± 1.64 σ (90 %)",
    ]
    assert {
        "truth",
        "obstacle",
        "filter's map",
    } <= set(said)
    beam = {"beam, as measured", "where it was expected to end"}
    assert not beam & set(said)
    for view in views(play(rich())):
        picture.show(view)
        now = words(picture.legend)
        met = view.beam and not {"no echo", "refused"} & set(picture.notes.get_text().split())
        assert beam <= set(now) or not met
        assert view.beam or not any("beam" in word for word in now)
        assert now[:4] == said[:4] or len(view.path()) == 1
    assert "95.4 % ellipse (2.48 σ)" in words(shown(scene())[0].legend)
    assert "heading ± 2 σ (95.4 %)" in words(shown(scene())[0].legend)
    assert not {"filter's map", "beam, as measured", "obstacle"} & set(
        words(shown(scene(Move(1.0, 0.0)))[0].legend)
    )


def test_circles_are_drawn_round_and_free_walls_as_lines_with_their_names():
    run = scene(obstacles=(DESK, RoundObstacle("pillar", np.array([7.0, 2.0]), 0.5)))
    lines = (WallLine("wall 1", HOOK), WallLine("screen", HOOK + np.array([-5, 1])))
    floor = replace(run.world.map, lines=lines)
    missing = Map(ROOM, floor.obstacles[:1], lines[1:])
    picture, _ = shown(told(replace(run, world=replace(run.world, map=floor)), map=missing))
    world = picture.main.world
    desk, pillar = (path.vertices for path in world.obstacles.get_paths())
    assert len(desk) < 10
    np.testing.assert_allclose(np.hypot(*(pillar - (7, 2)).T), 0.5, rtol=1e-12)
    drawn = [np.asarray(line) for line in world.lines.get_segments()]
    assert all(np.array_equal(one, line.points) for one, line in zip(drawn, lines, strict=True))
    assert len(world.told.get_segments()) == 3  # room, desk and screen, which stays open
    np.testing.assert_array_equal(world.told.get_segments()[-1], lines[1].points)
    assert {name.text for name in picture.names.shown} == {"desk", "pillar", "screen"}


def test_the_filters_map_is_drawn_where_it_differs():
    wrong = told(scene(obstacles=(DESK,)), map=Map(1.1 * ROOM))
    assert len(shown(wrong)[0].main.world.told.get_segments()) == 1
    assert not shown(scene(obstacles=(DESK,)))[0].main.world.told.get_segments()


@pytest.mark.parametrize(
    "text",
    [
        "$\\frac{$ a_b",
        "two\nlines\x07\x1b[0m",
        "日本語 😀 " * 80,
        "x" * 5000,
        "مرحبا नमस्ते é",
        "\u200d",
    ],
)
def test_any_text_can_be_shown(text):
    run = scene(Say(text), obstacles=(replace(DESK, name=text),))
    frame = Frame(run, scopes.of(run, play(run)))
    for view in views(play(run)):
        assert frame.rgb(view).shape[1:] == (900, 3)
    assert len(frame.picture.notes.get_text().split("\n")) <= 3


def test_the_command_is_told_with_its_number():
    run = scene(Say("x"), Move(1.75, math.radians(90)), Sense(math.radians(-90)))
    picture, _ = shown(run)
    told = []
    for view in views(play(run)):
        picture.show(view)
        told.append(picture.title.get_text())
    assert told[:3] == ["0 of 3: the start", "1 of 3: say", "2 of 3: move 1.75 m, turn 90°"]
    assert set(told[3:]) == {"3 of 3: sense at −90°"}


def test_an_ellipse_too_large_for_the_picture_is_told_in_numbers():
    picture, _ = shown(told(scene(), sigma=np.array([100.0, 10.0, 1.0])))
    assert (
        picture.notes.get_text()
        == "the 95.4 % ellipse is larger than the picture: radii 248 m and 24.8 m"
    )


def test_the_close_up_follows_the_ellipse():
    for sigma in (1e-6, 0.004, 0.1, 30.0):
        _, view = shown(told(scene(), sigma=np.array([sigma, sigma, 0.1])))
        width = close_width(view, 0.954, 1.0)
        assert width >= 1e-4
        assert width == 1e-4 or 2 < width / (2.48 * sigma) < 10
    assert close_width(shown(scene())[1], 0.954, 0.8) == 1.0


def test_limits_stay_put_and_the_axes_are_equal():
    run = rich()
    picture, _ = shown(run)
    box = picture.main.axes.get_xlim(), picture.main.axes.get_ylim()
    for view in views(play(run)):
        picture.show(view)
        assert (picture.main.axes.get_xlim(), picture.main.axes.get_ylim()) == box
    assert picture.main.axes.get_aspect() == 1
    assert (picture.main.axes.get_xlabel(), picture.main.axes.get_ylabel()) == ("x (m)", "y (m)")


def test_the_numbers_of_a_narrow_map_do_not_lie_on_one_another():
    run = scene(boundary=np.array([[0, 0], [0.5, 0], [0.5, 1000], [0, 1000]]))
    picture = Picture.on(Paper((900, 450)), run, scopes.of(run, play(run)))
    picture.show(next(iter(views(play(run)))))
    axes = picture.main.axes
    axes.get_figure().canvas.draw()
    low, high = axes.get_xlim()
    told = [label for label in axes.get_xticklabels() if low <= label.get_position()[0] <= high]
    boxes = [label.get_window_extent() for label in told]
    assert boxes
    assert all(left.x1 < right.x0 for left, right in pairwise(boxes))


def test_no_artist_ever_holds_a_nan():
    for run in (rich(), unbounded()):
        picture, _ = shown(run, look=Look(conditional=True))
        for view in views(play(run)):
            picture.show(view)
            for panel in (picture.main, picture.close):
                for line in panel.axes.lines:
                    known = line.get_gid() == "true-way"  # a kidnap breaks it
                    assert known or np.isfinite(line.get_xydata()).all(), line.get_gid()
                for area in panel.axes.patches:
                    assert np.isfinite(area.get_path().vertices).all(), area.get_gid()


def test_draw_on_axes_of_your_own_a_view_or_a_step():
    run = scene(Move(1.0, 0.5), sigma=SIGMA, obstacles=(DESK,))
    axes = Figure().add_subplot()
    step = list(play(run))[-1]
    main = draw(step, run, axes)
    assert main.belief.reference.get_xydata()[0] == pytest.approx(step.posterior.mean[:2])
    assert axes.get_legend() is not None
    assert {"ellipse", "cone", "path", "body", "truth", "obstacles"} <= {
        a.get_gid() for a in axes.get_children()
    }


def test_a_frame_redraws_all_that_moved():
    run = rich()
    every = list(views(play(run)))
    extent = scopes.of(run, play(run))
    used = Frame(run, extent)
    for view in every:
        used.rgb(view)
    for number in (0, 3, 7):
        assert np.array_equal(used.rgb(every[number]), Frame(run, extent).rgb(every[number]))


def test_a_png_is_reproducible_and_says_what_made_it():
    run = scene(Sense(0.3), sigma=SIGMA, obstacles=(DESK,))
    view = list(views(play(run)))[1]
    frame, made_by = (
        Frame(run, scopes.of(run, play(run))),
        {"Software": "ekfsim", "World": "Zürich 日本"},
    )
    png = frame.png(view, made_by)
    assert png == Frame(run, scopes.of(run, play(run))).png(view, made_by)
    with Image.open(BytesIO(png)) as picture:
        assert (picture.mode, picture.text) == ("RGB", made_by)
        assert picture.width == 900
        assert 500 < picture.height <= 700
        assert np.array_equal(np.asarray(picture), frame.rgb(view))


def test_names_stand_in_the_picture_where_they_fit():
    run = scene(obstacles=(DESK, replace(DESK, name="a" * 40, points=DESK.points + 2)))
    frame = Frame(run, scopes.of(run, play(run)))
    frame.rgb(next(views(play(run))))
    said = [name.text for name in frame.picture.names.shown]
    assert "desk" in said
    assert all(re.fullmatch("desk|a{19}…", name) for name in said)


@pytest.mark.parametrize("run", [rich(), unbounded(), scene(Move(1.0, 0.5), sigma=SIGMA)])
def test_what_is_not_drawn_because_it_is_empty_would_not_be_seen(run, monkeypatch):
    frame, every = Frame(run, scopes.of(run, play(run))), list(views(play(run)))
    shown = [frame.rgb(view) for view in every]
    monkeypatch.setattr(frames, "empty", lambda artist: False)
    for view, pixels in zip(every, shown, strict=True):
        assert np.array_equal(frame.rgb(view), pixels)


def test_the_frame_of_the_close_up_is_what_the_spines_would_be():
    drawn = []
    for by_spines in (True, False):
        canvas = FigureCanvasAgg(Figure(figsize=(2, 2)))
        axes = canvas.figure.add_axes((0.113, 0.127, 0.71, 0.73))
        axes.set(xticks=[], yticks=[])
        if not by_spines:
            axes.spines[:].set_visible(False)
            axes.add_collection(panels.frame(axes), autolim=False)
        canvas.draw()
        drawn.append(np.asarray(canvas.buffer_rgba()))
    assert np.array_equal(*drawn)
    assert drawn[0].min() == 0


def test_a_judgement_that_warns_has_a_sign_and_a_colour():
    right, _ = shown(scene(Move(1.0, 0.5), sigma=SIGMA))
    assert right.judgement.get_text().startswith("Verdict: no evidence")
    assert right.judgement.get_facecolor()[:3] == (0, 0, 0)
    wrong, _ = shown(told(scene(Move(1.0, 0.5), sigma=SIGMA), start=np.array([5.0, 5.0, 0.0])))
    assert wrong.judgement.get_text().startswith("⚠ Verdict: lost since step 0 · NEES ")
    assert wrong.judgement.get_facecolor() == to_rgba(VERMILLION)
    assert wrong.judgement in set(wrong.moving())
