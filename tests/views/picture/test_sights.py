"""What pictures show of every sensor, of particles, of recorded fixes and of the way that was
meant."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest
import shapely
import systems_scenes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import same_color
from matplotlib.figure import Figure
from scenes import rich, scene
from systems_scenes import SCENES, SQUARE

from ekfsim.commands import Move, Sense
from ekfsim.filters.belief import Correction, Gaussian, Particles, Refused
from ekfsim.localization import first_belief, play
from ekfsim.models.layout import INERTIAL, POSE, SPEED_POSE
from ekfsim.models.sensors.frozen import Frozen
from ekfsim.models.sensors.infrared import InfraredBeam
from ekfsim.models.sensors.landmarks import BearingOnly, MarkerAngles, RangeBearing, RangeOnly
from ekfsim.models.sensors.lidar import LidarOffset
from ekfsim.models.sensors.offset import LandmarkOffset
from ekfsim.models.sensors.position import Position
from ekfsim.records import Entry, Log, Reading, Step
from ekfsim.systems.instrument import Landmark
from ekfsim.views.picture.artists import BLUE, CROWD, MEANT, VERMILLION
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.frames import Frame, Picture
from ekfsim.views.picture.look import Look
from ekfsim.views.picture.sight_artists import recorded_fixes
from ekfsim.views.picture.sights import bare, kinds, sight
from ekfsim.views.playback.playback import views
from ekfsim.views.playback.view import View
from ekfsim.views.terminal.drawing import draw
from ekfsim.views.words.beams.beam import beam
from ekfsim.views.words.captions import source, title

POSE_AT = np.array([1.0, 2.0, math.pi / 2])  # looks north
GIDS = ("sight", "sight-end", "sight-way", "sight-expected", "sight-place")


def step_of(sensor, z, predicted, layout=POSE, refused=Refused.NOT, pose=POSE_AT):
    """A step that ends as it began: what is drawn of a reading asks for no more."""
    z, predicted = np.array(z, float), np.array(predicted, float)
    belief = Gaussian(layout.state(pose), 0.01 * np.eye(len(layout.names)))
    k, n = len(z), len(layout.names)
    nothing = np.zeros((k, k))
    correction = Correction(
        predicted, z - predicted, nothing, nothing, np.zeros((k, n)), np.zeros((n, k)),
        np.array(1.0),
        np.array(int(refused)),
    )  # fmt: skip
    return Step(
        Entry(7, Reading(sensor, z, "thing 1"), t=3.5),
        belief,
        belief,
        correction=correction,
        layout=layout,
    )


def drawn(run, look=Look()):  # noqa: B008
    """A picture of a run's scene, and its views."""
    steps = list(play(run))
    figure = Figure(figsize=(9, 7))
    FigureCanvasAgg(figure)
    return Picture(figure, run, scopes.of(run, steps), look), list(views(steps))


def words(run, look=Look()):  # noqa: B008
    """What the legends of a run's views say, all together."""
    picture, every = drawn(run, look)
    said = []
    for view in every:
        picture.show(view)
        said += [text.get_text() for text in picture.legend.get_texts()]
    return list(dict.fromkeys(said))


def lines(panel):
    return {line.get_gid(): line for line in panel.axes.lines if line.get_gid() in (*GIDS, "fixes")}


@pytest.mark.parametrize(
    "sensor", [MarkerAngles(4.0, 6.0, 0.2, 0.1, 0.1), BearingOnly(4.0, 6.0, 0.1)]
)
def test_a_direction_is_drawn_as_far_as_its_landmark(sensor):
    seen = sight(
        step_of(sensor, [0.1, -0.02][: len(sensor.outputs)], [-0.3, -0.03][: len(sensor.outputs)])
    )
    for line, bearing in ((seen.line, 0.1), (seen.way, -0.3)):
        assert line[0] == pytest.approx([1, 2])
        assert math.dist(*line) == pytest.approx(5)
        assert math.atan2(*(line[1] - line[0])[::-1]) == pytest.approx(math.pi / 2 + bearing)
    assert seen.place == pytest.approx(np.array([[4.0, 6.0]]))
    assert len(seen.end) == len(seen.expected) == 0


def test_range_and_bearing_put_the_landmark_somewhere():
    seen = sight(step_of(RangeBearing(1.0, 5.0, 0.1, 0.1), [2.0, -math.pi / 2], [3.0, 0.0]))
    assert seen.end[0] == pytest.approx([3.0, 2.0])
    assert seen.expected[0] == pytest.approx([1.0, 5.0])
    assert seen.place[0] == pytest.approx([1.0, 5.0])


def test_a_range_puts_the_robot_on_a_circle():
    seen = sight(step_of(RangeOnly(4.0, 6.0, 0.1), [6.0], [5.0]))
    assert np.hypot(*(seen.line - [4, 6]).T) == pytest.approx(6.0)
    nearest = seen.line[len(seen.line) // 2] - [4, 6]
    assert nearest / 6 == pytest.approx(np.array([-3, -4]) / 5)  # in the direction of the estimate
    assert seen.expected[0] == pytest.approx([1.0, 2.0])  # where the estimate is
    assert seen.place[0] == pytest.approx([4.0, 6.0])


def test_a_fix_is_a_point_with_its_standard_deviations():
    seen = sight(step_of(Position(0.5, 0.25, SPEED_POSE), [1.5, 2.5], [1.0, 2.0], SPEED_POSE))
    assert seen.fix
    assert seen.end[0] == pytest.approx([1.5, 2.5])
    assert np.hypot(*((seen.line - [1.5, 2.5]) / [0.5, 0.25]).T) == pytest.approx(1.0)
    assert seen.way == pytest.approx(np.array([[1.5, 2.5], [1.0, 2.0]]))
    assert seen.expected[0] == pytest.approx([1.0, 2.0])
    assert len(seen.place) == 0


def test_an_offset_is_drawn_in_the_global_frame():
    seen = sight(
        step_of(LandmarkOffset(4.0, 6.0, 0.1, 0.1, INERTIAL), [3.5, 4.5], [3.0, 4.0], INERTIAL)
    )
    assert seen.line == pytest.approx(np.array([[1.0, 2.0], [4.5, 6.5]]))
    assert seen.expected[0] == pytest.approx([4.0, 6.0])


def test_what_the_lidar_saw_is_drawn_from_the_estimate_as_it_is_turned():
    # it looks north: 3 m to the right is east, 4 m ahead is north
    at = np.array([1.0, 2.0, math.radians(90)])
    seen = sight(step_of(LidarOffset(4.0, 6.0, 0.1), [3.0, 4.0], [2.5, 4.5], pose=at))
    assert seen.line == pytest.approx(np.array([[1.0, 2.0], [4.0, 6.0]]))
    assert seen.expected[0] == pytest.approx([3.5, 6.5])
    assert seen.place[0] == pytest.approx([4.0, 6.0])


def test_an_intensity_is_drawn_as_the_distance_that_it_stands_for():
    walls = systems_scenes.CELLAR.walls
    sensor = InfraredBeam(walls, -math.pi / 2, 1.0, 1.0, 0.5, 0.05)
    at = np.array([0.0, 0.0, math.pi / 2])  # the wall is 3.2 m to the right
    z = 0.5 * (1 - math.log(1.2))
    seen = sight(step_of(sensor, [z], sensor.h(np.array([2.0, 0.0, math.pi / 2])), pose=at))
    assert seen.end[0] == pytest.approx([1.2, 0.0])
    assert seen.expected[0] == pytest.approx([1.2, 0.0])
    dark = sight(step_of(sensor, [-1e9], [z], pose=at))
    assert dark.end[0] == pytest.approx([7.5, 0.0])


def test_nothing_is_drawn_of_what_is_no_number():
    for sensor in (BearingOnly(4.0, 6.0, 0.1), RangeOnly(4.0, 6.0, 0.1)):
        seen = sight(step_of(sensor, [math.nan], [math.nan], refused=Refused.NO_ECHO))
        assert len(seen.line) == len(seen.end) == len(seen.way) == len(seen.expected) == 0
    seen = sight(step_of(Position(1.0, 1.0), [math.nan, 2.0], [1.0, 2.0]))
    assert len(seen.line) == len(seen.end) == 0


def test_a_wrapped_sensor_is_drawn_as_itself():
    sensor = RangeOnly(4.0, 6.0, 0.1)
    assert bare(Frozen(Frozen(sensor, POSE_AT), POSE_AT)) is sensor
    assert sight(step_of(Frozen(sensor, POSE_AT), [6.0], [5.0])).word == "range"


@pytest.mark.parametrize("made", SCENES)
def test_every_sensor_has_its_picture(made):
    run = made(gate=0.7)
    picture, every = drawn(run)
    frame = Frame(run, scopes.of(run, play(run)))
    refused = [view for view in every if view.beam and view.step.correction.refused]
    used = [view for view in every if view.beam and not view.step.correction.refused]
    for view in (used[len(used) // 2], refused[-1], every[-1]):
        assert frame.rgb(view).shape[1:] == (900, 3)
        picture.show(view)
        for panel in (picture.main, picture.close):
            for line in panel.axes.lines:
                assert np.isfinite(line.get_xydata()).all(), line.get_gid()
        text = draw(view, run, 0.954, (80, 24), (-5.0, 7.0, -5.0, 5.0), colour=False, ascii=True)
        assert text.isascii()
        assert "?" not in text.split("\n")[0]


@pytest.mark.parametrize(
    "made", [made for made in SCENES if made.__name__ not in ("ultrasonic", "infrared")]
)
def test_a_refused_reading_is_dashed_and_its_end_hollow(made):
    run = made(gate=0.7)
    picture, every = drawn(run)
    for refused in (False, True):
        view = next(v for v in every if v.beam and bool(v.step.correction.refused) is refused)
        picture.show(view)
        seen = sight(view.step)
        for panel in (picture.main, picture.close):
            shown = lines(panel)
            assert shown["sight"].get_linestyle() == ("--" if refused else "-")
            assert same_color(shown["sight"].get_color(), VERMILLION)
            assert same_color(shown["sight-expected"].get_color(), BLUE)
            assert shown["sight-end"].get_markerfacecolor() == ("white" if refused else VERMILLION)
            for gid, points in zip(
                GIDS, (seen.line, seen.end, seen.way, seen.expected, seen.place), strict=True
            ):
                assert shown[gid].get_xydata() == pytest.approx(points)
        assert ("refused by the gate" in picture.notes.get_text()) is refused
    picture.show(every[-1])
    assert all(
        len(line.get_xydata()) == 0 for gid, line in lines(picture.main).items() if gid in GIDS
    )


@pytest.mark.parametrize("made", [systems_scenes.ultrasonic, systems_scenes.infrared])
def test_a_beam_of_a_driven_robot_is_drawn_like_the_lasers(made):
    run = made(gate=0.7)
    picture, every = drawn(run)
    assert "beam, as measured" in words(run)
    view = next(v for v in every if v.beam and v.step.correction.refused)
    picture.show(view)
    seen, ray = sight(view.step), beam(view.step, run)
    assert picture.main.beam.measured.get_xydata() == pytest.approx(seen.line)
    assert picture.main.beam.expected.get_xydata() == pytest.approx(seen.expected)
    assert picture.main.beam.measured.get_linestyle() == "--"
    assert ray.ending in picture.notes.get_text()
    assert ("measured intensity" in picture.notes.get_text()) is (made is systems_scenes.infrared)


def test_the_legend_has_what_the_scene_has():
    said = {made.__name__: set(words(made(gate=0.7))) for made in SCENES}
    assert {"direction, as measured", "as it was expected", "landmark that it is of"} <= said[
        "mower"
    ]
    assert said["bearings"] ^ said["mower"] <= {"the truth is outside"}
    assert {
        "landmark, as measured",
        "where it was expected",
        "landmark, as measured, refused",
    } <= said["landmarks"]
    assert "range, as measured" in said["ranges"]
    assert "fix as measured, with 1 σ" in said["gnss"]
    assert "landmark that it is of" not in said["gnss"]
    assert {"offset, as measured", "way that was meant", "fix, recorded and not used"} <= said[
        "pylon"
    ]
    assert not any(
        "beam" in word
        for name in said
        for word in said[name]
        if name not in ("ultrasonic", "infrared")
    )
    assert not any("as measured" in word for word in words(scene(Move(1.0, 0.0))))


def test_a_crowded_legend_stays_clear_of_the_close_up():
    run = replace(rich(), filter="pf")
    run = replace(
        run, world=replace(run.world, landmarks=(Landmark(1, 1.0, 7.0),), expected_path=SQUARE)
    )
    most = 0
    for size in ((9, 7), (14, 6)):
        figure = Figure(figsize=size, dpi=100)
        canvas = FigureCanvasAgg(figure)
        picture = Picture(figure, run, scopes.of(run, play(run)), Look(conditional=True))
        for view in list(views(play(run)))[4:8]:
            picture.show(view)
            canvas.draw()
            legend = picture.legend.get_window_extent()
            most = max(most, len(picture.legend.get_texts()))
            for axes in (picture.main.axes, picture.close.axes):
                assert not legend.overlaps(axes.get_tightbbox())
            assert legend.y0 > 0
    assert most > 13


def test_the_close_up_is_square_whatever_stands_in_the_world():
    run = systems_scenes.mower()
    frame = Frame(run, scopes.of(run, play(run)))
    box = frame.picture.close.axes.get_window_extent()
    assert box.width == pytest.approx(box.height)


def test_particles_are_dots_of_the_size_of_their_weights():
    run = scene(Move(1.0, 0.3), Sense(0.2), sigma=(0.2, 0.2, 0.1), filter="pf")
    picture, every = drawn(run)
    assert "particles" in words(run)
    picture.show(every[-1])
    belief = every[-1].belief
    assert isinstance(belief, Particles)
    for panel in (picture.main, picture.close):
        dots = panel.belief.particles
        assert dots.get_offsets() == pytest.approx(belief.states[:, :2])
        assert same_color(dots.get_facecolor()[0][:3], CROWD)
        assert dots.get_sizes() == pytest.approx(
            5 * np.minimum(belief.weights * len(belief.weights), 8)
        )
    text = draw(every[-1], run, 0.954, (80, 24), (0.0, 10.0, 0.0, 8.0), colour=False, ascii=True)
    assert "` particles" in text
    assert "`" in "".join(text.split("\n")[1:-1])
    gaussian = scene(Move(1.0, 0.3), sigma=(0.2, 0.2, 0.1))
    assert "particles" not in words(gaussian)


def test_the_way_that_was_meant_is_a_closed_dashed_line():
    picture, every = drawn(systems_scenes.pylon())
    meant = picture.main.world.meant
    assert meant.get_xydata() == pytest.approx(np.array([*SQUARE, SQUARE[0]]))
    assert same_color(meant.get_color(), MEANT)
    assert meant.is_dashed()
    text = draw(
        every[0],
        systems_scenes.pylon(),
        0.954,
        (80, 24),
        (-1.0, 3.0, -1.0, 3.0),
        colour=False,
        ascii=True,
    )
    assert ",, meant way" in text


def test_fixes_that_were_not_used_are_crosses():
    run = systems_scenes.pylon()
    picture, every = drawn(run)
    view = [v for v in every if v.step.entry.fix is not None][-1]
    picture.show(view)
    assert picture.main.fixes.fixes.get_xydata()[0] == pytest.approx(view.step.entry.fix)
    assert picture.main.fixes.fixes.get_marker() == "+"
    text = draw(view, run, 0.954, (80, 24), (-4.0, 6.0, -4.0, 6.0), colour=False, ascii=True)
    assert "+ fix, not used" in text


def recorded(run):
    """The same run as a log."""
    entries = tuple(step.entry for step in play(run))
    return replace(run, drive=None, log=Log(entries, first_belief(run)))


def test_a_log_shows_every_fix_up_to_now():
    run = recorded(systems_scenes.pylon())
    index, fixes = recorded_fixes(run.log.entries)
    assert len(fixes) == len(np.unique(fixes, axis=0)) >= 5
    picture, every = drawn(run)
    for view in (every[0], every[len(every) // 2], every[-1]):
        picture.show(view)
        shown = picture.main.fixes.fixes.get_xydata()
        assert shown == pytest.approx(fixes[index <= view.step.entry.index])
    assert "fix, recorded and not used" in words(run)
    assert kinds(run) == {LandmarkOffset}
    assert source(run) == "pylon — recorded, ekf"
    assert (
        source(replace(run, filter="pf", gate=0.99))
        == "pylon — recorded, seed 0, run 0, pf, gate 99 %"
    )
    assert (
        source(replace(systems_scenes.gnss(), reading="printed"))
        == "gnss — seed 0, run 0, ekf, as printed"
    )


def test_a_log_without_truth_has_none_in_its_legend():
    run = recorded(systems_scenes.pylon())
    assert "truth" in words(run)
    blind = replace(
        run, log=Log(tuple(replace(entry, truth=None) for entry in run.log.entries), run.log.first)
    )
    assert "truth" not in words(blind)


def test_titles_tell_the_instant_and_what_was_measured():
    _, every = drawn(systems_scenes.mower())
    told = [title(view, 0) for view in every[:5]]
    assert told[:2] == ["t = 0.00 s: the start", "t = 0.01–2.00 s: 200 motion inputs"]
    assert re.fullmatch(r"t = 2\.00 s: marker \d", told[2])
    assert told[2] == told[3]
    step = step_of(BearingOnly(4.0, 6.0, 0.1), [0.1], [0.2])
    assert title(View(0, step, True), 0) == "t = 3.50 s: thing 1"
    assert title(View(0, replace(step, entry=replace(step.entry, t=None)), True), 0) == "7: thing 1"


def test_what_was_measured_is_told_in_units():
    run = systems_scenes.mower()
    picture, _ = drawn(run)
    picture.show(
        View(0, step_of(MarkerAngles(4.0, 6.0, 0.2, 0.1, 0.1), [0.1, -0.02], [-0.3, -0.03]), True)
    )
    assert (
        picture.notes.get_text()
        == "measured azimuth 5.73°, elevation −1.15°; expected −17.2°, −1.72°"
    )
    step = step_of(RangeBearing(4.0, 6.0, 0.1, 0.1), [1.25, 0.0], [1.5, -0.1], refused=Refused.GATE)
    picture.show(View(0, step, True))
    assert picture.notes.get_text() == (
        "measured range 1.25 m, bearing 0°; expected 1.5 m, −5.73°\n"
        "refused by the gate: too far from what was predicted"
    )


def test_the_terminal_tells_and_draws_a_refused_reading_otherwise():
    run = systems_scenes.landmarks()
    sensor = RangeBearing(1.0, 5.0, 0.1, 0.1)
    box = (-5.1, 7.0, -1.0, 6.0)
    pictures = {}
    for refused in (Refused.NOT, Refused.GATE):
        view = View(0, step_of(sensor, [3.0, -math.pi / 2], [3.0, 0.0], refused=refused), True)
        pictures[refused] = draw(view, run, 0.954, (80, 24), box, colour=False, ascii=True).split(
            "\n"
        )
    used, refused = pictures[Refused.NOT], pictures[Refused.GATE]
    assert used[0].startswith(
        "t = 3.50 s: thing 1, range 3 m, bearing -90 deg; predicted 3 m, 0 deg"
    )
    assert refused[0].startswith(
        "t = 3.50 s: thing 1, refused (gate): range 3 m, bearing -90 deg; predicted"
    )
    ray = next(line for line in used if "*" in line[45:])
    assert re.search(r"-{6,}\*", ray)
    assert not any(re.search(r"-{6,}", line) for line in refused[1:-1])
    assert any("?" in line for line in refused[1:-1])
    assert "-* landmark  x predicted" in used[-1]
    assert "- ? landmark refused" in refused[-1]


def test_limits_hold_what_is_drawn_of_every_system():
    for made in SCENES:
        run = made()
        steps = list(play(run))
        extent = scopes.of(run, steps)
        layout = run.world.layout
        points = [layout.pose(step.posterior.mean)[:2] for step in steps]
        points += [step.entry.truth[:2] for step in steps]
        points += [np.array([mark.x, mark.y]) for mark in run.world.landmarks]
        points += [] if run.world.expected_path is None else list(run.world.expected_path)
        assert extent.whole.hold(np.array(points)), made.__name__


def test_a_far_fix_does_not_shrink_the_world_to_a_dot():
    run = systems_scenes.pylon()
    steps = list(play(run))
    near = scopes.of(run, steps)
    steps[5] = replace(steps[5], entry=replace(steps[5].entry, fix=np.array([1e6, math.nan])))
    assert scopes.of(run, steps) == near
    steps[5] = replace(steps[5], entry=replace(steps[5].entry, fix=np.array([1e6, 0.0])))
    far = scopes.of(run, steps)
    assert near.base.size < far.base.size < 3 * near.base.size


def test_landmarks_have_their_numbers_where_there_is_room():
    run = systems_scenes.mower()
    frame = Frame(run, scopes.of(run, play(run)))
    frame.rgb(next(views(play(run))))
    assert [name.text for name in frame.picture.names.shown] == ["0", "1", "2", "3", "4"]
    crowd = tuple(Landmark(i, 0.02 * i, 0.0) for i in range(50))
    run = replace(run, world=replace(run.world, landmarks=(*crowd, Landmark(99, 3.0, 3.0))))
    frame = Frame(run, scopes.of(run, play(run)))
    frame.rgb(next(views(play(run))))
    names = frame.picture.names.shown
    assert "99" in [name.text for name in names]
    assert len(names) < 20
    boxes = [shapely.box(*name.box) for name in names]
    assert not any(a.intersects(b) for i, a in enumerate(boxes) for b in boxes[:i])
    text = draw(next(views(play(run))), run, 0.954, (80, 24), (-5.0, 7.0, -5.0, 5.0), colour=False)
    assert "#99" in text
    assert "#49" not in text


def test_a_path_of_many_instants_has_no_dots():
    assert drawn(scene(Move(1.0, 0.0)))[0].main.belief.path.get_marker() == "."
    picture, every = drawn(systems_scenes.mower())
    picture.show(every[-1])
    assert picture.main.belief.path.get_marker() == ""
    assert picture.main.belief.path.get_xydata() == pytest.approx(every[-1].path())


def test_a_wall_out_of_reach_is_no_wall_that_is_missing():
    run = systems_scenes.ultrasonic()
    picture, every = drawn(run)
    view = next(v for v in every if v.beam)
    nothing = replace(
        view.step.correction, predicted=np.array([math.nan]), refused=np.array(int(Refused.NO_WALL))
    )
    picture.show(replace(view, step=replace(view.step, correction=nothing)))
    assert "no wall expected within reach: the beam ends in the air" in picture.notes.get_text()
    assert picture.notes.get_text().endswith(
        "refused: the filter's map has no wall within reach there"
    )
