"""ekfsim world: a plan of another program becomes a world file, with a picture of both."""

import sys
from pathlib import Path

import pytest
from program import ekfsim

sys.path.append(str(Path(__file__).parents[1] / "files/maps"))
from ros_maps import room, text, write


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write(tmp_path, room(40, 60))
    return tmp_path


def test_a_map_becomes_a_world_that_plays_and_a_picture(place):
    told = ekfsim("world", "map.yaml", "-o", "out/hall.yaml")
    assert told.status == 0
    assert told.out == ("out/hall.yaml: a room; 4 corners; out/hall.png shows it over the plan\n")
    assert told.err == (
        "ekfsim: map.yaml: walls are straight within 0.1 m of the cells, 0 m from them at most; "
        "--tolerance says otherwise\n"
        "ekfsim: map.yaml: the robot starts at (1.5, 1), where it has most room, 0.95 m; --start "
        "X,Y,THETA says otherwise\n"
    )
    assert (place / "out/hall.png").read_bytes().startswith(b"\x89PNG")
    assert ekfsim("check", "out/hall.yaml").out == "out/hall.yaml: ok\n"
    (place / "go.yaml").write_text("world: out/hall.yaml\ncommands: [{sense: {angle: 0}}]\n")
    assert ekfsim("run", "go.yaml").status == 0


def test_results_are_whole_or_absent_and_not_replaced_unasked(place):
    (place / "hall.png").write_text("mine")
    told = ekfsim("world", "map.yaml", "-o", "hall.yaml")
    assert (told.status, told.err) == (
        2,
        "ekfsim: hall.png: exists already; choose another name, or replace it with --force\n",
    )
    assert not (place / "hall.yaml").exists()
    assert ekfsim("world", "map.yaml", "-o", "hall.yaml", "--force").status == 0
    text(place, image="gone.pgm")
    assert ekfsim("world", "map.yaml", "-o", "next.yaml").status == 2
    assert not (place / "next.yaml").exists()
    assert not (place / "next.png").exists()


def test_check_says_what_makes_a_world_of_a_map(place):
    told = ekfsim("check", "map.yaml")
    assert (told.status, told.err) == (
        2,
        "ekfsim: map.yaml: this is a ROS map; `ekfsim world map.yaml -o world.yaml` makes a world "
        "of it\n",
    )


def test_a_picture_names_its_map(place):
    told = ekfsim("world", "map.pgm", "-o", "hall.yaml")
    assert (told.status, told.err) == (
        2,
        "ekfsim: map.pgm: a picture does not tell how large its pixels are; name the map.yaml of "
        "it, 'map.yaml'\n",
    )


def test_commands_that_name_a_map_as_their_world_are_told_what_makes_one(place):
    (place / "go.yaml").write_text("world: map.yaml\ncommands: [{sense: {angle: 0}}]\n")
    told = ekfsim("run", "go.yaml")
    assert (told.status, told.err) == (
        2,
        "map.yaml:1:1: this is a ROS map; `ekfsim world map.yaml -o world.yaml` makes a world of "
        "it\n",
    )
