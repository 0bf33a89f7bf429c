"""Worlds and scenes of text, dicts and Python's values hold to all the checks of files."""

import copy
import pickle

import numpy as np
import pytest

import ekfsim
from ekfsim.errors import InputError, UsageError
from ekfsim.floor import Obstacle, RoundObstacle, WallLine

RATIOS = ("executionDst", "executionAng", "odometryDst", "odometryAng", "range")
NOISE = {f"{name}SigmaRatio": 0.02 for name in RATIOS}
ROOM = [(0, 0), (10, 0), (10, 8), (0, 8)]
DESK = [[4, 3], [5, 3], [5, 4], [4, 4]]
FILE = """\
name: lab
boundary: [[0, 0], [10, 0], [10, 8], [0, 8]]
obstacles: [{name: desk, points: [[4, 3], [5, 3], [5, 4], [4, 4]]}]
start: {x: 1, y: 1, theta: 90, sigma: {x: 0.1, y: 0.2, theta: 5}}
noise: {executionDstSigmaRatio: 0.02, executionAngSigmaRatio: 0.02, odometryDstSigmaRatio: 0.02,
        odometryAngSigmaRatio: 0.02, rangeSigmaRatio: 0.02}
belief: {missing: [desk], start: {x: 1.2, y: 1, theta: 80}}
"""
COMMANDS = [{"move": {"distance": 1, "angle": 90}}, {"sense": {"angle": 0}}]


def lab(**changed):
    told = {
        "name": "lab", "boundary": np.array(ROOM), "obstacles": {"desk": np.array(DESK)},
        "start": (1, 1, 90), "sigma": [0.1, 0.2, 5], "noise": NOISE,
        "belief": {"missing": ["desk"], "start": np.array([1.2, 1, 80])},
    }  # fmt: skip
    return ekfsim.World.of(**{**told, **changed})


def arrays(world):
    told = world.told
    yield from (world.start, world.start_sigma, told.start, told.sigma)
    for floor in (world.map, told.map):
        yield from (points for _, points in floor.rings())


def test_python_text_and_dict_make_the_world_of_the_file(tmp_path):
    (tmp_path / "lab.yaml").write_text(FILE)
    worlds = [
        ekfsim.load_world(tmp_path / "lab.yaml"), ekfsim.load_world(FILE), lab(),
        lab(obstacles=[Obstacle("desk", np.array(DESK))], noise=lab().noise),
    ]  # fmt: skip
    for world in worlds:
        assert (world.name, world.noise) == ("lab", worlds[0].noise)
        pairs = zip(arrays(world), arrays(worlds[0]), strict=True)
        assert all(np.array_equal(ours, theirs) for ours, theirs in pairs)
    assert np.array_equal(worlds[0].told.start, [1.2, 1, np.radians(80)])


def test_walls_are_the_same_by_text_dict_and_python():
    hook, panel = [[7, 0], [7, 5]], [[2, 6], [4, 6], [4, 7]]
    named = {"name": "panel", "points": panel}
    text = FILE.replace("missing: [desk]", "missing: [wall 1]")
    worlds = [
        ekfsim.load_world(text + f"walls: [{hook}, {{name: panel, points: {panel}}}]\n"),
        lab(walls=[np.array(hook), named], belief={"missing": ["wall 1"]}),
        lab(walls={"wall 1": hook, "panel": np.array(panel)}, belief={"missing": ["wall 1"]}),
        lab(walls=[WallLine("wall 1", np.array(hook)), WallLine("panel", np.array(panel))],
            belief={"walls": [named]}),
    ]  # fmt: skip
    for world in worlds:
        assert [line.name for line in world.map.lines] == ["wall 1", "panel"]
        assert [line.name for line in world.told.map.lines] == ["panel"]
        assert [line.points.tolist() for line in world.map.lines] == [hook, panel]
        assert [line.name for line in world.map.named_lines()] == ["panel"]
    assert (world.map.walls.first(6.0, 1.0, 0.0), world.told.map.walls.first(6.0, 1.0, 0.0)) == (
        (1.0, 8),
        (4.0, 1),
    )


def test_circles_are_the_same_by_text_dict_and_python():
    circle = {"x": 7, "y": 2, "radius": 0.5}
    text = FILE.replace(
        "obstacles: [", "obstacles: [{name: pillar, circle: {x: 7, y: 2, radius: 0.5}}, "
    )
    worlds = [
        ekfsim.load_world(text),
        lab(obstacles={"pillar": {"circle": circle}, "desk": DESK}),
        lab(obstacles=[
            RoundObstacle("pillar", np.array([7, 2.0]), 0.5), Obstacle("desk", np.array(DESK))
        ]),
    ]  # fmt: skip
    for world in worlds:
        pillar, desk = world.map.obstacles
        assert (pillar.name, pillar.centre.tolist(), pillar.radius) == ("pillar", [7, 2], 0.5)
        assert desk.points.tolist() == DESK
        assert world.told.map.obstacles == (pillar,)
        assert world.map.walls.first(1.0, 2.0, 0.0) == (5.5, 8)


def test_a_scene_is_the_same_by_file_text_and_dict(tmp_path):
    (tmp_path / "lab.yaml").write_text(FILE)
    text = "seed: 3\ncommands: [{move: {distance: 1, angle: 90}}, {sense: {angle: 0}}]\n"
    (tmp_path / "lab-commands.yaml").write_text(f"world: lab.yaml\n{text}")
    scenes = [
        ekfsim.load_scene(tmp_path / "lab-commands.yaml"),
        ekfsim.scene(text, world=lab()),
        ekfsim.scene(text, FILE),
        ekfsim.scene({"world": lab(), "seed": np.int64(3), "commands": COMMANDS}),
    ]
    ends = [[*ekfsim.play(scene)][-1].posterior.mean for scene in scenes]
    assert all(np.array_equal(end, ends[0]) for end in ends)
    assert [scene.world_source for scene in scenes[1:]] == ["lab"] * 3
    assert [scene.commands_source for scene in scenes[1:]] == ["text", "text", "dict"]
    told = scenes[1].with_("noise.rangeSigmaRatio", 0.3).world.told
    assert told.noise.range == 0.3
    assert np.array_equal(told.start, scenes[1].world.told.start)


def test_a_text_names_packaged_worlds_and_files_of_the_current_folder(tmp_path, monkeypatch):
    text = "world: {}\ncommands: [{{sense: {{angle: 0}}}}]\n"
    assert ekfsim.scene(text.format("room")).world_source == "worlds/room.yaml"
    (tmp_path / "lab.yaml").write_text(FILE)
    monkeypatch.chdir(tmp_path)
    assert ekfsim.scene(text.format("lab.yaml")).world.name == "lab"


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"start": (4.5, 3.5, 0)}, "start: the robot starts at [4.5, 3.5], inside the obstacle "
                                   "'desk' or on its wall; start it where it can move"),
        ({"noise": None}, "noise: the key is missing"),
        ({"noise": {**NOISE, "range": 1}}, "noise: unknown key 'range'"),
        ({"start": (1, 1)}, "start: a list stands where a mapping 'key: value' belongs"),
        ({"start": (1, 1, float("nan"))}, "start.theta: .nan is not a finite number"),
        ({"boundary": ROOM[:2]}, "boundary: 2 points make no polygon"),
        ({"boundary": {1, 2}}, "boundary: 'set' is no kind of value that a file can hold"),
        ({"obstacles": {"desk": DESK, 3: DESK}}, "obstacles[1].name: 3 is a number where text "
                                                 "belongs"),
        ({"name": "a\x1b"}, "name: the character U+001B cannot stand in text; delete it"),
        ({"belief": {"missing": ["chair"]}}, "belief.missing[0]: "),
        ({"robot": {"rate": 3}}, "robot: the classroom's robot is told by 'noise'"),
        ({"belief": {1: 2}}, "belief: the key 1 is no text; write a word"),
    ],
)  # fmt: skip
def test_a_wrong_value_is_told_by_the_path_of_its_key(changed, words):
    with pytest.raises(InputError) as refused:
        lab(**changed)
    assert f"World.of: {words}" in str(refused.value)


def test_all_mistakes_are_told_at_once():
    with pytest.raises(InputError) as refused:
        lab(boundary=ROOM[:2], noise=None, start=3)
    assert len(refused.value.mistakes) == 3


def test_a_list_that_holds_itself_ends():
    endless = []
    endless.append(endless)
    with pytest.raises(InputError, match="nested more than 64 levels deep"):
        lab(belief={"missing": endless})


def test_a_text_has_lines_and_a_dict_has_paths():
    wrong = {"world": "rom", "commands": [{"mve": 1}]}
    with pytest.raises(InputError) as refused:
        ekfsim.scene(wrong)
    assert str(refused.value).splitlines() == [
        "dict: world: rom: no such file; did you mean 'room'?",
        "dict: commands[0]: 'mve' is not a command; did you mean 'move'?",
    ]
    with pytest.raises(InputError) as refused:
        ekfsim.scene("world: room\ncommands:\n  - mve: 1\n")
    assert (
        str(refused.value) == "text:3:5: commands[0]: 'mve' is not a command; did you mean 'move'?"
    )


@pytest.mark.parametrize("what", [3, None, ["room"]])
def test_what_is_neither_file_text_nor_dict_is_told(what):
    with pytest.raises(UsageError, match="neither a file nor what one holds"):
        ekfsim.load_scene(what)
    with pytest.raises(UsageError, match="neither a file nor what one holds"):
        ekfsim.load_world(what)


def test_a_misspelt_name_is_no_text():
    with pytest.raises(UsageError, match=r"'tuor' is neither a file nor .*; did you mean 'tour'"):
        ekfsim.scene("tuor")


def test_nobody_writes_into_a_world():
    world = lab()
    for one in (world, copy.copy(world), ekfsim.load_scene("tour").world):
        for array in arrays(one):
            with pytest.raises(ValueError, match="read-only"):
                array += 1
    assert pickle.loads(pickle.dumps(world)).with_("noise.rangeSigmaRatio", 0.4).noise.range == 0.4


def test_arrays_that_were_handed_over_stay_their_owners():
    points = np.array(DESK, dtype=float)
    world = lab(obstacles={"desk": points})
    points += 1
    assert np.array_equal(world.map.obstacles[0].points, DESK)
