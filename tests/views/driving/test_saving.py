"""What was driven is a file, and the file is what was driven."""

from dataclasses import replace
from pathlib import Path

import pytest
from courses import played, shown

from ekfsim.commands import Kidnap, Move, Say, Sense
from ekfsim.errors import UsageError
from ekfsim.files.scenes.load import check, load_scene
from ekfsim.filters.tuning import Tuning
from ekfsim.views.driving.course import Course
from ekfsim.views.driving.saving import Saving

KEYS = (Move(0.25, 0.0), Sense(1.0), Move(0.0, 0.2617993877991494), Sense(-1.0), Move(9.0, 0.0))


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def course(name="square", length=None, **otherwise):
    return Course(replace(load_scene(name), **otherwise), length)


@pytest.mark.parametrize(
    ("name", "otherwise"),
    [
        ("square", {"seed": 5}),
        ("tour", {"filter": "ukf", "gate": 0.9}),
        ("diverge-01-wrong-wall", {"filter": "iekf", "guard": "skip"}),
        ("diverge-11-short-returns", {"seed": 2**32 - 1}),
        ("diverge-03a-wheel-scale", {"filter": "kf-nominal"}),
        ("diverge-05a-misplaced-wall", {"filter": "pf", "tuning": Tuning(particles=60)}),
        ("proof-unsure-start", {}),
    ],
)
def test_the_file_is_the_run_to_the_last_digit(name, otherwise, place):
    one = course(name, 3, **otherwise)
    one.add(*KEYS, Say("There!"), Kidnap(1.5, 1.25, -0.5), Sense(0.0))
    one.undo(2)
    one.add(Sense(2.0))
    Saving(place / "drive.yaml").save(one)
    found = check("drive.yaml")
    assert (found.mistakes, found.warnings) == ([], [])
    assert shown(one) == played(load_scene("drive.yaml"))


def test_it_says_where_and_what_plays_it():
    one = course(run=2, settings=("noise.rangeSigmaRatio=0.1",))
    one.undo(7)
    assert Saving(Path("a/b c.yaml")).save(one) == (
        "Saved 1 command: ekfsim play 'a/b c.yaml' --run 2 --set noise.rangeSigmaRatio=0.1"
    )
    assert (
        load_scene("a/b c.yaml").description
        == "Driven by hand from step 1 of commands/square.yaml on."
    )


def test_our_own_file_is_rewritten_and_no_other(place):
    (place / "drive.yaml").write_text("something else")
    one, saving = course(length=0), Saving(Path("drive.yaml"))
    for n in range(3):
        one.add(Say(f"{n}"))
        assert "drive-2.yaml" in saving.save(one)
        assert one.unsaved == (0, 0)
        assert load_scene("drive-2.yaml").commands == tuple(one.commands)
    assert (place / "drive.yaml").read_text() == "something else"
    assert sorted(path.name for path in place.iterdir()) == ["drive-2.yaml", "drive.yaml"]
    (place / "drive-2.yaml").write_text("edited meanwhile")
    assert "drive-2-2.yaml" in saving.save(one)
    assert (place / "drive-2.yaml").read_text() == "edited meanwhile"


def test_force_replaces_what_lies_there(place):
    (place / "drive.yaml").write_text("something else")
    one = course()
    assert "play drive.yaml" in Saving(Path("drive.yaml"), force=True).save(one)
    assert load_scene("drive.yaml").commands == load_scene("square").commands


def test_what_can_be_no_file_is_refused_at_once(place):
    (place / "folder").mkdir()
    for name in ("folder", "drive.py"):
        with pytest.raises(UsageError, match=name):
            Saving(Path(name))


def test_what_could_not_be_saved_is_not_taken_for_saved(place):
    (place / "file").write_text("")
    one = course(length=2)
    one.add(Say("a"))
    with pytest.raises(UsageError, match="is no folder"):
        Saving(Path("file/drive.yaml")).save(one)
    assert one.unsaved == (1, 0)
    assert sorted(path.name for path in place.iterdir()) == ["file"]
