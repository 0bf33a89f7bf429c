"""Keys that drive: each is a command, and what it comes to is to be seen."""

import io
import math
from dataclasses import replace
from pathlib import Path

import pytest
from scenes import scene

from ekfsim.commands import Move, Say, Sense
from ekfsim.files.scenes.load import load_scene
from ekfsim.views.driving.course import Course
from ekfsim.views.driving.saving import Saving
from ekfsim.views.terminal.driving.driver import Driver
from ekfsim.views.terminal.driving.help import HELP
from ekfsim.views.terminal.driving.keys import Order
from ekfsim.views.terminal.keys.keyboard import NO_MORE
from ekfsim.views.terminal.screens.moment import Together
from ekfsim.views.terminal.screens.stream import Stream
from ekfsim.views.words.narrative.narrating import narrate

ROOM = replace(load_scene("square"), commands=())
FORWARD, LEFT = Move(0.25, 0.0), Move(0.0, math.radians(15))
BACKWARD, RIGHT = Move(-0.25, 0.0), Move(0.0, -math.radians(15))


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


class Screen:
    """Keeps every moment."""

    keeps = False

    def __init__(self):
        self.moments = []

    def show(self, moment):
        self.moments.append(moment)

    def arrange(self, action, count):
        return f"{action.value} {count}"

    def wait(self, note):
        raise AssertionError("none of these ways is long")


class Driven:
    """A course after some keys: letters, or names of keys between blanks."""

    def __init__(self, keys="", place=ROOM, quits=True, force=False):
        names = keys.split(" ") if " " in keys else list(keys)
        self.screen, self.out, self.course = Screen(), io.StringIO(), Course(place)
        self.saving = Saving(Path("drive.yaml"), force)
        self.driver = Driver(
            self.course.scene, (), Together([Stream(self.out, None), self.screen]),
            lambda view: f"saved view {view.number}", 0.954,
            course=self.course, saving=self.saving,
        )  # fmt: skip
        self.waiting = iter([*names, *(["q", "q"] if quits else [])])
        self.driver.play(lambda timeout: next(self.waiting))

    @property
    def last(self):
        """What was to be seen before it was quitted."""
        return [m for m in self.screen.moments if "q leaves without" not in m.note][-1]


def commands(keys, place=ROOM):
    return Driven(keys, place).course.commands


@pytest.mark.parametrize(
    ("keys", "expected"),
    [
        ("f", [FORWARD]), ("x", [BACKWARD]), ("<", [LEFT]), (">", [RIGHT]),
        ("up down left right", [FORWARD, BACKWARD, LEFT, RIGHT]),
        ("b", [Sense(0.0)]),
        ("90bb", [Sense(math.pi / 2), Sense(math.pi / 2)]),
        ("-45.5b", [Sense(math.radians(-45.5))]),
        ("90-b-30-b", [Sense(-math.pi / 2), Sense(math.radians(30))]),
        ("1.5f,5x", [Move(1.5, 0.0), Move(-0.5, 0.0)]),
        ("90<-30<", [Move(0.0, math.pi / 2), Move(0.0, math.radians(-30))]),
        ("-f.x", [FORWARD, BACKWARD]),  # no number
        ("9 0 backspace 1 b", [Sense(math.radians(91))]),
        ("9 0 escape b", [Sense(0.0)]),
        ("[f]]f", [Move(0.125, 0.0), Move(0.5, 0.0)]),
        ("{<}}<", [Move(0.0, math.radians(7.5)), Move(0.0, math.radians(30))]),
        ("0.1]f2}<", [Move(0.1, 0.0), Move(0.0, math.radians(2))]),
        ("fb<2uxU", [FORWARD, BACKWARD]),
        ("fb<3u2U", [FORWARD, Sense(0.0)]),
        ("f b u u ctrl+r", [FORWARD]),
        ("fb<pppd<", [FORWARD, LEFT]),  # from the view of the first command on
        ("fbpd", [FORWARD, Sense(0.0)]),  # the beam is its command's
        ("fb<pp<", [FORWARD, Sense(0.0), LEFT, LEFT]),  # to look back undoes nothing
        ("f0b-0b-0f", [FORWARD, Sense(0.0), Sense(0.0), Move(0.0, 0.0)]),
        ("fnpGr0g?ealjkvs", [FORWARD]),
        ("361b2000f400<", []),
    ],
)  # fmt: skip
def test_keys_are_commands(keys, expected):
    assert commands(keys) == expected
    assert all(math.copysign(1, one.angle) == 1 or one.angle for one in commands(keys))  # no −0


def test_each_command_is_told_and_shown():
    driven = Driven("fb")
    views = [driven.course.view(n) for n in range(4)]
    assert driven.last.view is views[3]
    assert driven.last.before == narrate(views[2], driven.course.scene)
    told = "".join(narrate(view, driven.course.scene) for view in views)
    assert driven.out.getvalue().startswith(told)
    assert "Verdict" not in driven.out.getvalue()  # it is not over


def test_what_was_undone_is_told():
    assert Driven("fbu").last.note == "Undone: step 2 (sense 0°)"
    assert Driven("fb2u").last.note == "Undone: 2 commands from step 1 (move 0.25 m, 0°) on"
    assert Driven("fb2uU").last.note == "Again: step 1 (move 0.25 m, 0°)"
    assert Driven("fbu").last.view.number == 1
    assert Driven("u").last.note == "There is nothing to undo"
    assert Driven("U").last.note == "There is nothing to redo"
    assert "<==Back at step 1" in Driven("fbu").out.getvalue()


def test_the_line_below_tells_what_the_keys_do():
    assert Driven("").last.place == "step 0 · move 0.25 m, turn 15°, beam 0°"
    told = "step 2, 1 before the last · move 0.5 m, turn 7.5°, beam -90° · not saved: 3 commands"
    assert Driven("]{f-90bfp").last.place == told
    assert Driven("-4").last.place.split(" · ")[1] == "-4"
    assert Driven("fw").last.place == "step 1 · move 0.25 m, turn 15°, beam 0°"
    assert Driven("ffwu").last.place.endswith("not saved: 1 command undone")
    assert Driven("").last.hints[:2] == ("arrows drive", "? keys")


def test_a_bump_is_told():
    driven = Driven("9f")
    assert driven.last.note == ""  # by the narrative
    assert "\nIt bumped into" in driven.last.narrative
    driven.driver.screen = driven.screen  # where that may be out of sight
    driven.driver.obey(Order.FORWARD)
    assert driven.last.note == "The robot bumped into the room's wall"


def test_it_is_written_when_asked_and_read_again(place):
    driven = Driven("f90bw<")
    assert load_scene("drive.yaml").commands == tuple(driven.course.commands[:2])
    notes = [moment.note for moment in driven.screen.moments]
    assert "Saved 2 commands: ekfsim play drive.yaml" in notes


def test_what_lies_there_stays(place):
    (place / "drive.yaml").write_text("mine")
    Driven("fw")
    assert (place / "drive.yaml").read_text() == "mine"
    assert load_scene("drive-2.yaml").commands == (FORWARD,)
    Driven("w", force=True)
    assert load_scene("drive.yaml").commands == ()


def test_it_asks_once_before_something_is_lost(place):
    driven = Driven("fqfqq", quits=False)
    asked = "not saved: 2 commands: w saves it to drive.yaml, q leaves without"
    notes = [moment.note for moment in driven.screen.moments]
    assert notes.count(asked) == 1
    assert driven.course.commands == [FORWARD, FORWARD]  # the first q was not the last word
    assert list(place.iterdir()) == []
    Driven("q", quits=False)
    Driven("fwq", quits=False)
    Driven("fuq", quits=False)


def test_where_the_input_ends_it_is_saved(place):
    driven = Driven("f f " + NO_MORE, quits=False)
    assert load_scene("drive.yaml").commands == (FORWARD, FORWARD)
    assert driven.out.getvalue().endswith("Saved 2 commands: ekfsim play drive.yaml\n")


def test_what_cannot_be_written_is_told(place):
    driven = Driven("fw", place=scene())
    assert "the world 'test' is no file's" in driven.last.note
    assert driven.course.unsaved == (1, 0)


def test_all_else_is_as_in_play():
    driven = Driven("fb<3p2n")
    assert driven.last.view.number == 3
    assert Driven("fb<1g").last.view.number == 1
    assert Driven("fb<gG").last.view.number == 4
    assert Driven("fj").last.note.startswith("Picture and numbers")
    assert Driven("fn").last.note == "This is where the run has come to: drive on"
    assert Driven("?").last.page == HELP
    assert Driven("z").last.note == "That key does nothing here; ? shows those that do"


FAILING = """\
def predict(x, P, u, motion):
    return motion.f(x, u), P
def update(x, P, z, sensor):
    raise ValueError("no")
"""


def test_a_filter_that_fails_is_told_and_undone(place):
    (place / "mine.py").write_text(FAILING)
    own = replace(ROOM, filter=str(place / "mine.py"))
    driven = Driven("fbf", place=own)
    assert driven.course.commands == [FORWARD, Sense(0.0)]
    assert driven.last.note == (
        "The filter failed: mine.py:4: step 2 (sense 0°): ValueError: no; u undoes the command"
    )
    assert Driven("fbU", place=own).last.note == "There is nothing to redo"
    assert Driven("fbuf", place=own).course.commands == [FORWARD, FORWARD]
    given = replace(own, commands=(FORWARD, Sense(0.0), FORWARD))
    assert Driven("", place=given).last.note == driven.last.note
    assert Driven("ud", place=given).course.commands == [FORWARD]


def test_commands_of_a_file_are_driven_on():
    given = replace(ROOM, commands=(Say("a"), FORWARD))
    driven = Driven("2u<", place=given)
    assert driven.course.commands == [LEFT]
    assert Driven("", place=given).last.view.number == 2


def test_the_help_fits_a_terminal():
    assert max(map(len, HELP.splitlines())) < 78
