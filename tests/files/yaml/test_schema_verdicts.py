"""An editor that reads the schema and `ekfsim check` say the same of a file, or the schema says
that it cannot."""

import json

import pytest
from jsonschema import Draft202012Validator

from ekfsim.errors import InputError
from ekfsim.files.scenes.check_study import check
from ekfsim.files.yaml.parsing import parse
from ekfsim.files.yaml.schema import json_schema

NOISE = {
    "executionDstSigmaRatio": 0.05,
    "executionAngSigmaRatio": 0.05,
    "odometryDstSigmaRatio": 0.02,
    "odometryAngSigmaRatio": 0.02,
    "rangeSigmaRatio": 0.01,
}
ROOM = {"name": "a", "start": {"x": 1, "y": 1, "theta": 0}, "noise": NOISE}
MOWER = {
    "name": "a",
    "system": "mower",
    "start": {"x": 1, "y": 1, "theta": 0},
    "landmarks": [{"id": 1, "x": 2, "y": 2}],
}
SCENE = {"world": "room.yaml", "commands": [{"say": "a"}]}
DRIVE = {"world": "mower.yaml", "drive": {"path": "circle"}}
STUDY = {"study": "scene.yaml"}
DESK = {"name": "desk", "points": [[4, 3], [5, 3], [5, 4]]}


def world(**more):
    return "world", json.dumps({**ROOM, **more})


def mower(**more):
    return "world", json.dumps({**MOWER, **more})


def scene(**more):
    return "commands", json.dumps({**SCENE, **more})


def command(one):
    return scene(commands=[one])


def drive(**more):
    return "commands", json.dumps({**DRIVE, **more})


def study(**more):
    return "study", json.dumps({**STUDY, **more})


def text(pair, old, new):
    kind, written = pair
    assert old in written
    return kind, written.replace(old, new)


ALIKE = [  # right or wrong: both say the same
    world(), world(description="d", boundary=[[0, 0], [9, 0], [9, 9], [0, 9]], obstacles=[DESK]),
    mower(),
    world(name=""), world(name=5), world(colour=1), ("world", json.dumps({"name": "a",
    "noise": NOISE})),
    world(noise={**NOISE, "rangeSigmaRatio": -1}), world(noise={**NOISE, "rangeSigmaRatio": "1"}),
    world(noise={**NOISE, "rangeSigmaRatio": True}), world(noise={"rangeSigmaRatio": 1}),
    world(noise=None),
    world(start={"x": 1e8, "y": -1e8, "theta": 0}), world(start={"x": 1.001e8, "y": 1, "theta": 0}),
    world(start={"x": 1, "y": 1}), world(start={"x": 1, "y": 1, "theta": 0, "sigma": {"x": -1}}),
    world(boundary=[[0, 0], [9, 0]]), world(boundary=[[0, 0], [9, 0], [9]]), world(boundary=[[0, 0],
    [9, 0], "a"]),
    world(landmarks=[{"id": 3.0, "x": 1, "y": 1}]), world(landmarks=[{"id": 1e3, "x": 1, "y": 1}]),
    world(landmarks=[{"id": 3.5, "x": 1, "y": 1}]), world(landmarks=[{"id": -1, "x": 1, "y": 1}]),
    world(landmarks=[{"id": 2**63, "x": 1, "y": 1}]), world(faults={"shortReturns": 1.5}),
    world(faults={"shortReturns": 0.5}), world(robot={"rate": 10}), world(sensors=[]),
    world(system="boat"),
    mower(noise=NOISE), mower(robot={"rate": 0}), mower(robot={"halfTrack": 1}),
    mower(robot={"rate": 10}), mower(sensors=[{"markers": {"rate": 1}}]),
    mower(sensors=[{"markers": {"views": [[-30, 30]]}}]), mower(sensors=[{"markers": {},
    "gnss": {}}]),
    mower(sensors=[{}]), mower(sensors=[{"markers": {"views": [[-30]]}}]),
    mower(sensors=[{"markers": {"speed": 1}}]),
    scene(), scene(seed=7.0), scene(seed=1e3), scene(seed=2**32), scene(seed=2**63), scene(seed=-1),
    scene(seed="7"),
    text(scene(seed=1000), "1000", "1e3"), text(scene(seed=7), ": 7", ": 7.000"),
    text(scene(seed=7), ": 7", ": 7.5"),
    scene(gate=0.99), scene(gate=1), scene(gate=0), scene(guard="warn"), scene(guard="wrn"),
    scene(filter="ukf"),
    scene(filter="UKF"), scene(expect={"lost": [0.05, 0.3], "nis": "silent"}),
    scene(expect={"lost": [0.05]}),
    scene(expect={"lost": [0.05, 1.3]}), scene(expect={"runs": 0}), scene(expect={"nis": "loud"}),
    scene(drive=[]),
    command({"move": {"distance": 1, "angle": 90}}), command({"move": {"distance": 1}}),
    command({"turn": {"angle": 1}}),
    command({"move": {"distance": 1, "angle": 0, "slip": 2}}), command({}),
    command({"say": "a", "sense": {"angle": 0}}),
    command({"repeat": {"times": 2.0, "commands": []}}), command({"repeat": {"times": 2.5,
    "commands": []}}),
    command({"repeat": {"times": -1, "commands": []}}), command({"kidnap": {"x": 1, "y": 1,
    "theta": 0}}),
    command({"kidnap": {"x": 2e8, "y": 1, "theta": 0}}), command({"say": 5}), ("commands",
    '{"world": "room.yaml"}'),
    drive(), drive(drive=[{"v": 1, "for": 2}]), drive(drive=[]), drive(drive={"path": "heart"}),
    drive(drive=5),
    drive(drive={"path": "circle", "radius": -1}), drive(drive=[{"v": 1}]),
    drive(recording={"format": "mower"}),
    study(), study(runs=10.0), study(runs=0), study(runs=1.5), study(filters=["ekf", "ukf"]),
    study(filters=["akf"]),
    study(filters=[]), study(sweep={"noise.rangeSigmaRatio": []}),
    study(sweep={"noise.rangeSigmaRatio": [0.1, 0.2]}),
    study(set={"noise.rangeSigmaRatio": [1]}), study(set={"noise.rangeSigmaRatio": 0.1}),
    study(gate=2),
    study(reading="a"),
    study(seed=2**32), study(fast=1), study(world=5), study(colour=1),
]  # fmt: skip
CANNOT = [  # what the schema lets pass, and its own words that it does
    (
        text(world(start={"x": 12345, "y": 1, "theta": 0}), "12345", ".nan"),
        "numbers that are none (.nan)",
    ),
    (text(scene(gate=0.5), "0.5", ".nan"), "numbers that are none (.nan)"),
    (text(world(), '"noise": {', '"noise": {<<: {}, '), "merge keys ('<<')"),
    (text(world(), '"name": "a"', '"name": !!str "a"'), "tags"),
    (text(world(), '"name": "a"', '"name": "a", "name": "b"'), "a key that is given twice"),
    (scene(expect={"lost": [0.3, 0.05]}), "pairs whose first number is the larger"),
    (
        mower(sensors=[{"markers": {"views": [[30, -30]]}}]),
        "pairs whose first number is the larger",
    ),
    (scene(drive={"path": "circle"}, commands=None), "whether it fits the world"),
    (scene(world="nowhere.yaml"), "whether the files that are named are there"),
    (world(boundary=[[0, 0], [9, 9], [9, 0], [0, 9]]), "outlines that cross themselves"),
    (world(obstacles=[DESK, DESK]), "names, ids and sensors that stand twice"),
    (world(landmarks=[{"id": 1, "x": 1, "y": 1}] * 2), "names, ids and sensors that stand twice"),
    (
        world(obstacles=[{**DESK, "points": [[0, 0], [3, 0], [3, 3], [0, 3]]}]),
        "places where the robot cannot stand",
    ),
    (world(belief={"missing": ["desk"]}), "obstacles that are missing and not there"),
    (drive(drive={"path": "circle", "width": 3}), "Each path has some of these keys"),
    (drive(drive={"path": "square", "laps": 1.5}), "a whole number of squares"),
    (study(set={"noise.colour": 1}), "whether a key with dots is one of the files"),
    (study(sweep={"gate": [0.5, 0.5]}), "values that stand twice"),
    (study(a={"filter": "akf"}), "which filters a side names"),
    (study(study="nowhere"), "whether the files that are named are there"),
]
CANNOT[7] = (
    ("commands", json.dumps({"world": "room.yaml", "drive": {"path": "circle"}})),
    CANNOT[7][1],
)


@pytest.fixture
def place(tmp_path, monkeypatch):
    for name, held in {"room": ROOM, "mower": MOWER, "scene": SCENE}.items():
        (tmp_path / f"{name}.yaml").write_text(json.dumps(held))
    monkeypatch.chdir(tmp_path)
    return tmp_path


def is_sound(place, written):
    """What `ekfsim check` says."""
    (place / "f.yaml").write_text(written)
    return not check("f.yaml").mistakes


def passes(kind, written):
    """What an editor says that knows the schema, of the same values."""
    try:
        root, _ = parse(written, "f.yaml")
    except InputError:
        return False
    return Draft202012Validator(json_schema(kind)).is_valid(root.plain())


@pytest.mark.parametrize("kind", ["world", "commands", "study", "homework"])
def test_the_schema_is_one(kind):
    Draft202012Validator.check_schema(json_schema(kind))


@pytest.mark.parametrize(("kind", "written"), ALIKE)
def test_the_schema_and_check_agree(place, kind, written):
    assert passes(kind, written) == is_sound(place, written), check("f.yaml").mistakes


def test_both_verdicts_are_tried_often(place):
    verdicts = [is_sound(place, written) for _, written in ALIKE]
    assert len(verdicts) > 80
    assert 25 < sum(verdicts) < len(verdicts) - 25


@pytest.mark.parametrize(("pair", "words"), CANNOT)
def test_what_the_schema_cannot_say_it_says_so(place, pair, words):
    kind, written = pair
    assert not is_sound(place, written)
    assert passes(kind, written)
    assert words in json.dumps(json_schema(kind), ensure_ascii=False)
