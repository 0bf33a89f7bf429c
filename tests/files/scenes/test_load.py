"""What stands in a file is what the objects hold: metres as they are, degrees as radians, beliefs
resolved."""

import os

import numpy as np
import pytest

from ekfsim.commands import Kidnap, Move, Repeat, Say, Sense, expanded_length
from ekfsim.errors import InputError
from ekfsim.files.packaged import resolve
from ekfsim.files.scenes.load import check, load_scene, load_world, read_scene, read_world
from ekfsim.files.scenes.one_file import kind_of
from ekfsim.scene import Expect
from ekfsim.world import Faults, Landmark, Noise

NOISE = """noise:
  executionDstSigmaRatio: 0.01
  executionAngSigmaRatio: 0.02
  odometryDstSigmaRatio: 0.03
  odometryAngSigmaRatio: 0.04
  rangeSigmaRatio: 5e-2
"""
START = "start: {x: 1, y: 2.5, theta: 90}\n"
DESK = "  - {name: desk, points: [[4, 3], [5, 3], [5, 4], [4, 4]]}\n"
PIANO = "  - {name: piano, points: [[6, 3], [7, 3], [7, 4]]}\n"
ROOM = "boundary: [[0, 0], [10, 0], [10, 8], [0, 8]]\n"


@pytest.fixture
def world(tmp_path):
    def load(text, head="name: room\n" + START + NOISE):
        path = tmp_path / "room.yaml"
        path.write_text(head + text)
        return load_world(path)

    return load


@pytest.fixture
def scene(tmp_path):
    def load(text, **options):
        (tmp_path / "room.yaml").write_text("name: room\n" + START + NOISE)
        path = tmp_path / "scene.yaml"
        path.write_text("world: room.yaml\n" + text)
        return load_scene(path, **options)

    return load


def test_the_smallest_world(world):
    room = world("")
    assert room.name == "room"
    assert room.description == ""
    assert room.map.boundary is None
    assert room.map.obstacles == ()
    assert room.landmarks == ()
    assert room.faults == Faults()
    assert room.noise == Noise(0.01, 0.02, 0.03, 0.04, 0.05)
    np.testing.assert_array_equal(room.start, [1, 2.5, np.pi / 2])
    np.testing.assert_array_equal(room.start_sigma, [0, 0, 0])


def test_what_the_filter_is_told_is_the_truth_where_nothing_differs(world):
    room = world(ROOM + "obstacles:\n" + DESK + "belief: {missing: []}\n")
    assert room.told.map is room.map
    assert room.told.noise == room.noise
    np.testing.assert_array_equal(room.told.start, room.start)
    np.testing.assert_array_equal(room.told.sigma, [0, 0, 0])


def test_everything_in_a_world(world):
    room = world(
        ROOM
        + "obstacles:\n"
        + DESK
        + PIANO
        + "description: A room.\nlandmarks: [{id: 3, x: 5, y: -5.0}]\n"
        "faults: {rangeBias: 0.1, rangeScale: 1.1, shortReturns: 0.2, odometryDstScale: 1.3, "
        "odometryAngScale: -1}\n"
    )
    np.testing.assert_array_equal(room.map.boundary, [[0, 0], [10, 0], [10, 8], [0, 8]])
    assert [obstacle.name for obstacle in room.map.obstacles] == ["desk", "piano"]
    np.testing.assert_array_equal(room.map.obstacles[1].points, [[6, 3], [7, 3], [7, 4]])
    assert room.map.obstacles[1].points.dtype == float
    assert room.description == "A room."
    assert room.landmarks == (Landmark(3, 5.0, -5.0),)
    assert room.faults == Faults(0.1, 1.1, 0.2, 1.3, -1.0)


def test_every_part_of_a_belief(world):
    told = world(
        ROOM + "obstacles:\n" + DESK + PIANO + "belief:\n  start: {x: 3, y: 4, theta: 270}\n"
        "  sigma: {x: 0.1, y: 0.2, theta: 180}\n  noise: {rangeSigmaRatio: 0.5}\n  missing: "
        "[desk]\n"
    ).told
    np.testing.assert_allclose(told.start, [3, 4, -np.pi / 2])
    np.testing.assert_allclose(told.sigma, [0.1, 0.2, np.pi])
    assert told.noise == Noise(0.01, 0.02, 0.03, 0.04, 0.5)
    assert [obstacle.name for obstacle in told.map.obstacles] == ["piano"]
    np.testing.assert_array_equal(told.map.boundary, [[0, 0], [10, 0], [10, 8], [0, 8]])


def test_a_belief_may_have_a_map_of_its_own(world):
    room = world(
        ROOM
        + "obstacles:\n"
        + DESK
        + "belief:\n boundary: [[0, 0], [9, 0], [9, 9]]\n obstacles:\n"
        + PIANO
    )
    assert [obstacle.name for obstacle in room.told.map.obstacles] == ["piano"]
    np.testing.assert_array_equal(room.told.map.boundary, [[0, 0], [9, 0], [9, 9]])
    assert [obstacle.name for obstacle in room.map.obstacles] == ["desk"]


def test_a_belief_without_obstacles(world):
    assert world("obstacles:\n" + DESK + "belief: {obstacles: []}\n").told.map.obstacles == ()


def test_the_first_belief_is_as_uncertain_as_the_start_unless_it_says_otherwise(world):
    start = (
        "name: room\nstart: {x: 1, y: 1, theta: 0, sigma: {x: 0.1, y: 0.2, theta: 18}}\n" + NOISE
    )
    room = world("", start)
    np.testing.assert_allclose(room.start_sigma, [0.1, 0.2, np.pi / 10])
    np.testing.assert_array_equal(room.told.sigma, room.start_sigma)
    room = world("belief: {sigma: {x: 0.5, y: 0}}\n", start)
    np.testing.assert_allclose(room.start_sigma, [0.1, 0.2, np.pi / 10])
    np.testing.assert_allclose(room.told.sigma, [0.5, 0, np.pi / 10])


def test_a_belief_may_start_where_no_robot_can(world):
    assert (
        world("obstacles:\n" + DESK + "belief: {start: {x: 4.5, y: 3.5, theta: 0}}\n").told.start[0]
        == 4.5
    )


def test_the_order_of_keys_does_not_matter(world):
    assert world(START + "name: room\n", NOISE).noise == world("").noise


def test_the_smallest_scene(scene, tmp_path):
    loaded = scene("commands: []\n")
    assert loaded.world.name == "room"
    assert loaded.commands == ()
    assert (loaded.seed, loaded.filter, loaded.gate, loaded.guard) == (0, "ekf", None, "warn")
    assert loaded.expect is None
    assert loaded.world_source == f"{tmp_path}/room.yaml"
    assert loaded.commands_source == f"{tmp_path}/scene.yaml"


def test_everything_in_a_scene(scene):
    loaded = scene(
        "seed: 7\nfilter: ekf\ngate: 0.99\nguard: off\ndescription: A tour.\n"
        "expect: {lost: [0.05, 0.3], nis: silent, nees: high, coverage: [0, 1], runs: 20}\n"
        "commands:\n"
        "  - move: {distance: 1.75, angle: 90}\n"
        "  - move: {distance: -1, angle: -450, slip: 0.8}\n"
        "  - sense: {angle: 180}\n"
        "  - repeat: {times: 3, commands: [{say: hi}, {repeat: {times: 2, commands: [{sense: "
        "{angle: 0}}]}}]}\n"
        "  - kidnap: {x: 3, y: 2, theta: -90}\n"
        "  - say: no\n"
    )
    assert (loaded.seed, loaded.filter, loaded.gate, loaded.guard) == (7, "ekf", 0.99, "off")
    assert loaded.description == "A tour."
    assert loaded.expect == Expect((0.05, 0.3), "silent", "high", (0.0, 1.0), 20)
    assert loaded.commands == (
        Move(1.75, np.pi / 2),
        Move(-1.0, -2.5 * np.pi, 0.8),
        Sense(np.pi),
        Repeat(3, (Say("hi"), Repeat(2, (Sense(0.0),)))),
        Kidnap(3.0, 2.0, -np.pi / 2),
        Say("no"),
    )


def test_what_repeats_nothing_is_left_out(scene):
    many = "repeat: {times: 1000000, commands: "
    loaded = scene(
        f"commands:\n  - {many}[{{{many}[]}}}}]}}\n  - repeat: {{times: 0, commands: [{{say: "
        f"a}}]}}\n"
    )
    assert loaded.commands == ()


def test_a_million_commands_load(scene):
    loaded = scene(
        "commands:\n  - repeat: {times: 1000, commands: [{repeat: {times: 1000, commands: [{say: "
        "a}]}}]}\n"
    )
    assert expanded_length(loaded.commands) == 1_000_000


def test_a_world_given_wins(scene, tmp_path):
    other = tmp_path / "other.yaml"
    other.write_text("name: other\n" + START + NOISE)
    loaded = scene("commands: []\n", world=other)
    assert loaded.world.name == "other"
    assert loaded.world_source == str(other)
    (tmp_path / "scene.yaml").write_text("world: nowhere.yaml\ncommands: []\n")
    assert load_scene(tmp_path / "scene.yaml", other).world.name == "other"
    (tmp_path / "scene.yaml").write_text("commands: []\n")
    assert load_scene(tmp_path / "scene.yaml", other).world.name == "other"


def test_sources_are_named_as_given(tmp_path, monkeypatch):
    (tmp_path / "worlds").mkdir()
    (tmp_path / "commands").mkdir()
    (tmp_path / "worlds/room.yaml").write_text("name: room\n" + START + NOISE)
    (tmp_path / "commands/tour.yaml").write_text("world: ../worlds/room.yaml\ncommands: []\n")
    monkeypatch.chdir(tmp_path)
    scene = load_scene("commands/tour.yaml")
    assert (scene.commands_source, scene.world_source) == ("commands/tour.yaml", "worlds/room.yaml")
    (tmp_path / "worlds/room.yaml").write_text("name: 5\n" + START + NOISE)
    with pytest.raises(InputError, match=r"^worlds/room.yaml:1:7: name: 5 is a number"):
        load_scene("commands/tour.yaml")


def test_the_two_kinds_of_file(tmp_path):
    path = tmp_path / "f.yaml"
    for text, kind in {
        "name: a\n": "world",
        "commands: []\n": "commands",
        "drive: x\n": "commands",
    }.items():
        path.write_text(text)
        assert kind_of(path) == kind


def test_a_file_that_can_be_read_only_once_is_checked(tmp_path):
    reading, writing = os.pipe()
    with os.fdopen(writing, "w") as file:
        file.write("name: room\n" + START + NOISE)
    assert check(f"/dev/fd/{reading}").get().name == "room"
    os.close(reading)


def test_warnings(tmp_path):
    world, scene = tmp_path / "room.yaml", tmp_path / "scene.yaml"
    world.write_text(
        "name: a\nstart: {x: 1, y: 1, theta: 361}\nbelief: {start: {x: 1, y: 1, theta: -400}}\n"
        + NOISE + ROOM + "obstacles:\n" + DESK
    )  # fmt: skip
    scene.write_text(
        "world: room.yaml\ncommands:\n  - move: {distance: 1, angle: 1.5708}\n  - sense: {angle: "
        "360}\n"
        "  - repeat: {times: 2, commands: [{sense: {angle: 5156.62}}]}\n  - sense: {angle: -3.14}\n"
        "  - kidnap: {x: 11, y: 1, theta: 0}\n  - kidnap: {x: 4.5, y: 3.5, theta: 0}\n"
    )
    turn = "is more than a full turn; angles are in degrees: 90 is a quarter turn"
    of_world = [
        f"{world}:2:28: start.theta: 361 {turn}",
        f"{world}:3:37: belief.start.theta: -400 {turn}",
    ]
    of_scene = [
        f"{scene}:3:32: commands[0].move.angle: 1.5708 looks like radians; angles are in degrees: "
        f"write 90",
        f"{scene}:5:51: commands[2].repeat.commands[0].sense.angle: 5156.62 {turn}",
        f"{scene}:6:20: commands[3].sense.angle: -3.14 looks like radians; angles are in degrees: "
        f"write -180",
        f"{scene}:7:13: commands[4].kidnap: the robot is carried to [11, 1], outside the boundary "
        f"or on its wall; "
        "it cannot move there",
        f"{scene}:8:13: commands[5].kidnap: the robot is carried to [4.5, 3.5], inside the "
        f"obstacle 'desk' "
        "or on its wall; it cannot move there",
    ]
    assert read_world(world).warnings == of_world
    assert read_scene(scene).warnings == [*of_scene, *of_world]
    assert check(scene).get().world.name == "a"
    assert load_scene(scene).world.start[2] == pytest.approx(np.radians(1))


def test_a_beam_without_noise_is_warned_of_where_the_place_is_in_doubt(tmp_path):
    world = tmp_path / "w.yaml"
    text = (
        resolve("room", "worlds").read_text().replace("rangeSigmaRatio: 0.02", "rangeSigmaRatio: 0")
    )
    world.write_text(text)
    (warning,) = check(world).warnings
    assert str(warning) == (
        f"{world}:13:20: noise.rangeSigmaRatio: a linearised filter takes a beam without noise "
        f"for certain, and soon "
        "claims a place it is not at; a small ratio, such as 0.001, leaves room for the bend"
    )
    assert (
        check(resolve("room", "worlds")).warnings
        == check(resolve("no-noise", "worlds")).warnings
        == []
    )


def test_an_outline_may_repeat_its_first_point_at_its_end():
    """As every GeoJSON, WKT and shapely outline does: it is the same world."""
    text = (
        "name: t\nsystem: pioneer\nboundary: [[0, 0], [9, 0], [9, 9], [0, 9]{}]\n"
        "obstacles: [{{name: a, points: [[4, 4], [6, 4], [6, 6]{}]}}]\n"
        "start: {{x: 1, y: 1, theta: 0}}\nbelief: {{boundary: [[0, 0], [9, 0], [9, 8]{}]}}\n"
    )
    closed = load_world(text.format(", [0, 0]", ", [4.0, 4]", ", [0, 0]"))
    plain = load_world(text.format("", "", ""))
    for one, other in ((closed.map, plain.map), (closed.told.map, plain.told.map)):
        np.testing.assert_array_equal(one.boundary, other.boundary)
        np.testing.assert_array_equal(one.obstacles[0].points, other.obstacles[0].points)
        np.testing.assert_array_equal(one.walls.segments, other.walls.segments)
