"""What is written is read again as it was, to the last digit."""

import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scenes import scene

from ekfsim.commands import Kidnap, Move, Repeat, Say, Sense
from ekfsim.errors import UsageError
from ekfsim.files.packaged import packaged
from ekfsim.files.scene_text import replay, scene_text
from ekfsim.files.scenes.load import check, load_scene, read_scene
from ekfsim.files.source import UNPRINTABLE
from ekfsim.filters.tuning import Tuning
from ekfsim.geometry.angles import wrap
from ekfsim.twins import taking

WRITTEN = "commands", "seed", "filter", "tuning", "gate", "guard", "description", "world_source"
MADE = [
    name
    for name in packaged("commands")
    if not name.endswith(("log", "bag")) and load_scene(name).commanded
]


def write(place, folder, name="drive.yaml"):
    path = folder / name
    path.write_text(scene_text(place, path), encoding="utf-8")
    return path


def read_again(place, folder):
    path = write(place, folder)
    found = read_scene(path)
    assert found.warnings == []
    return found.get()


def fields(place):
    return [getattr(place, name) for name in WRITTEN]


@pytest.mark.parametrize("name", MADE)
def test_all_that_comes_along_is_read_again_as_it_was(name, tmp_path):
    place = load_scene(name)
    path = write(place, tmp_path)
    assert fields(read_scene(path).get()) == fields(place)


ROOM = load_scene("square")
TENTHS = st.integers(-3600, 3600).map(lambda tenths: tenths / 10)
DEGREES = st.floats(-360, 360) | st.integers(-720, 720).map(float) | TENTHS
TEXTS = st.text(st.characters(codec="utf-8"), min_size=1, max_size=30).filter(
    lambda text: not re.search(UNPRINTABLE, text)
)
METRES = st.floats(-100, 100)


@given(st.lists(st.tuples(METRES, DEGREES, DEGREES, DEGREES, st.floats(0, 1)), max_size=20))
@settings(deadline=None, max_examples=60)
def test_every_number_of_a_file_is_written_as_it_was_read(tmp_path_factory, rows):
    told = []
    for d, a, b, theta, slip in rows:
        heading = float(wrap(np.radians(theta)))
        turn, beam = float(np.radians(a)), float(np.radians(b))
        told += [Move(d, turn, slip), Sense(beam), Kidnap(d, -d, heading), Move(d, 0.0)]
    place = replace(ROOM, commands=tuple(told))
    path = write(place, tmp_path_factory.mktemp("drives"))
    assert check(path).value.commands == place.commands


@given(TEXTS)
@settings(deadline=None, max_examples=60)
def test_every_text_is_read_again_as_it_was(tmp_path_factory, text):
    place = replace(ROOM, commands=(Say(text),), description=text)
    got = load_scene(write(place, tmp_path_factory.mktemp("drives")))
    assert (got.commands, got.description) == (place.commands, place.description)


ODD = ["# no", "a: b", "yes", "null", "1e3", "- x", " x", "x ", "don't", "a\nb", "[x]", "*x", "é"]


@pytest.mark.parametrize("text", ODD)
def test_a_text_is_no_yaml(text, tmp_path):
    assert read_again(replace(ROOM, commands=(Say(text),)), tmp_path).commands == (Say(text),)


def test_it_is_written_as_a_person_would(tmp_path):
    fifteen = float(np.radians(15))
    commands = (
        Move(0.25, 0.0), Move(0.0, fifteen), Sense(-math.pi / 2), Say("Look: a wall."),
        Repeat(2, (Move(1.0, 0.0, 0.5), Repeat(3, (Sense(0.0),)))), Kidnap(1.0, 2.5, math.pi),
    )  # fmt: skip
    place = replace(
        ROOM, commands=commands, gate=0.99, guard="off", seed=4, filter="pf", description="",
        tuning=Tuning(particles=50, cross_covariances="dropped"),
    )  # fmt: skip
    head, *told = scene_text(place, tmp_path / "a b.yaml").splitlines()
    assert head.startswith("# Driven by hand with ekfsim ")
    assert told == [
        "#   ekfsim play 'a b.yaml'",
        "world: room",
        "seed: 4",
        "filter: pf",
        "gate: 0.99",
        "guard: off",
        "filterSettings: {particles: 50, crossCovariances: dropped}",
        "commands:",
        "  - move: {distance: 0.25, angle: 0}",
        "  - move: {distance: 0, angle: 15}",
        "  - sense: {angle: -90}",
        '  - say: "Look: a wall."',
        "  - repeat:",
        "      times: 2",
        "      commands:",
        "        - move: {distance: 1, angle: 0, slip: 0.5}",
        "        - repeat:",
        "            times: 3",
        "            commands:",
        "              - sense: {angle: 0}",
        "  - kidnap: {x: 1, y: 2.5, theta: 180}",
    ]
    assert fields(read_again(place, tmp_path)) == fields(place)


def test_nothing_is_a_file_too(tmp_path):
    assert read_again(replace(ROOM, commands=()), tmp_path).commands == ()


def test_a_world_and_a_filter_are_named_from_where_the_file_lies(tmp_path):
    (tmp_path / "worlds").mkdir()
    (tmp_path / "drives").mkdir()
    (tmp_path / "mine.py").write_text("def predict(): ...\n")
    world = tmp_path / "worlds/my room.yaml"
    world.write_text(packaged("worlds")["room"].read_text())
    place = replace(ROOM, world_file=world, filter=f"{tmp_path}/mine.py:My")
    text = scene_text(place, tmp_path / "drives/one.yaml")
    assert "\nworld: ../worlds/my room.yaml\n" in text
    assert '\nfilter: "../mine.py:My"\n' in text
    got = load_scene(write(place, tmp_path / "drives"))
    assert got.filter == place.filter
    assert Path(got.world_source).samefile(world)


def test_beside_a_file_of_that_name_what_comes_along_is_named_by_its_way(tmp_path):
    (tmp_path / "room").write_text("not a world")
    got = read_again(ROOM, tmp_path)
    assert got.world_source == ROOM.world_source


def test_what_no_file_holds_is_told_as_the_command_that_plays_it():
    place = replace(
        ROOM, run=3, settings=("noise.rangeSigmaRatio=0.1", "gate=0.5", "filter.particles=9"),
        beside=("ukf", "/home/anna/my own.py"),
    )  # fmt: skip
    told = "--run 3 --filter 'ekf,ukf,/home/anna/my own.py' --set noise.rangeSigmaRatio=0.1"
    assert replay(place, Path("x.yaml")) == f"ekfsim play x.yaml {told}"
    with taking("plain"):
        assert replay(ROOM, Path("a\nb")) == "ekfsim play 'a\\x0ab' --plain"
    assert f"\n#   ekfsim play x.yaml {told}\nworld:" in scene_text(place, Path("dir/x.yaml"))


def test_a_world_of_no_file_cannot_be_named():
    with pytest.raises(UsageError, match="the world 'test' is no file's"):
        scene_text(scene(), Path("x.yaml"))


def test_what_has_no_name_in_text_cannot_be_named(tmp_path):
    place = replace(ROOM, world_file=tmp_path / "w\udcff.yaml")
    with pytest.raises(UsageError, match="no file in it can name"):
        scene_text(place, tmp_path / "x.yaml")
