"""A course, however it was driven, is the run of its commands: nothing is said of it twice."""

import math
from dataclasses import replace

import pytest
from courses import played, shown
from recordings import recording
from scenes import rich, scene, unbounded

from ekfsim.commands import Move, Repeat, Say, Sense, expand, first
from ekfsim.errors import StepError, UsageError
from ekfsim.filters import FILTERS
from ekfsim.filters.tuning import Tuning
from ekfsim.views.driving.course import Course

MANY = (Move(1.0, 0.5), Sense(0.2), Say("word"), Move(-0.5, 0.0), Sense(-2.0), Sense(3.0))
FEW = Tuning(particles=40)


def driven(place, *commands):
    """A course with all that is in its way: commands one by one, some taken back, some again."""
    course = Course(replace(place, commands=commands[:1]))
    for n, command in enumerate(commands[1:]):
        if n % 2:
            course.add(Sense(1.0), Move(0.3, 0.1))
            assert course.undo(2) == [Sense(1.0), Move(0.3, 0.1)]
        course.add(command)
        if n % 3 == 0:
            course.undo()
            assert course.redo() == [command]
    return course


@pytest.mark.parametrize("filter", FILTERS)
def test_a_course_is_the_run_of_its_commands_to_the_last_digit(filter):
    place = replace(rich(), filter=filter, tuning=FEW)
    commands = tuple(expand(place.commands))[:14]
    assert shown(driven(place, *commands)) == played(replace(place, commands=commands))


def test_another_run_of_another_seed_too():
    place = replace(unbounded(seed=9), run=1025, filter="ukf", gate=None, guard="skip")
    commands = tuple(expand(place.commands))[:12]
    assert shown(driven(place, *commands)) == played(replace(place, commands=commands))


def test_several_filters_watch_one_course():
    place = replace(scene(sigma=(0.1, 0.1, 0.1)), beside=("ukf", "pf"), tuning=FEW)
    assert shown(driven(place, *MANY)) == played(replace(place, commands=MANY))
    assert driven(place, *MANY).last.apart  # and it is told where they part


def test_a_scene_is_driven_on_from_any_of_its_commands():
    place = rich()
    commands = tuple(expand(place.commands))
    for length in (0, 1, 7, len(commands)):
        course = Course(place, length)
        assert course.commands == list(commands[:length])
        course.add(*MANY)
        there = replace(place, commands=(*commands[:length], *MANY))
        assert shown(course)[-9:] == played(there)[-9:]


def test_what_is_left_of_the_scene_waits_to_be_done_again():
    course = Course(scene(*MANY), 2)
    assert course.undone == 4
    assert course.redo() == [MANY[2]]
    assert course.unsaved == (1, 0)
    assert course.redo(9) == list(MANY[3:])
    assert shown(course) == played(scene(*MANY))


def test_undo_and_redo_go_as_far_as_there_is_something():
    course = Course(scene(*MANY[:2]))
    course.add(*MANY[2:])
    assert course.undo(4) == list(MANY[2:])
    assert course.undo(99) == list(MANY[:2])  # those of the file, too
    assert course.undo() == []
    assert course.last.number == 0
    assert course.redo(5) == list(MANY[:5])
    assert course.redo(5) == [MANY[5]]
    assert course.redo() == []
    assert shown(course) == played(scene(*MANY))


def test_what_was_undone_is_gone_once_something_else_is_done():
    course = Course(scene())
    course.add(*MANY)
    course.undo(2)
    course.add(Say("else"))
    assert course.redo() == []
    assert course.commands == [*MANY[:4], Say("else")]


def test_it_knows_what_was_not_saved():
    course = Course(scene(*MANY[:3]))
    assert course.unsaved == (0, 0)
    course.add(*MANY[3:5])
    assert course.unsaved == (2, 0)
    course.mark_as_saved()
    course.undo(3)
    assert course.unsaved == (0, 3)
    course.redo()
    assert course.unsaved == (0, 2)
    course.add(MANY[3], Say("else"))  # as it was saved, and then otherwise
    assert course.unsaved == (1, 1)
    course.undo()
    course.add(MANY[4])
    assert course.unsaved == (0, 0)


def test_repetitions_that_are_whole_stay_as_they_are():
    inner = Repeat(2, (Sense(0.0), Move(0.1, 0.2)))
    place = scene(Say("a"), Repeat(3, (inner, Say("b"))), Say("c"))
    course = Course(place)
    assert course.driven == place.commands
    course.undo()
    course.undo(2)  # the last b, and a move within
    course.add(Say("d"))
    third = Repeat(1, inner.commands), Sense(0.0)
    assert course.driven == (Say("a"), Repeat(2, (inner, Say("b"))), *third, Say("d"))
    assert list(expand(course.driven)) == course.commands


@pytest.mark.parametrize("n", range(14))
def test_the_first_commands_are_those_that_come_first(n):
    commands = (Say("a"), Repeat(2, (Say("b"), Repeat(2, (Say("c"), Say("d"))))), Repeat(3, ()))
    assert list(expand(first(commands, n))) == list(expand(commands))[:n]
    assert tuple(first(commands, None)) == commands


def test_the_verdict_is_that_of_the_course():
    course = Course(scene())
    course.add(*MANY)
    course.undo()
    assert course.summaries[0].updates == 2
    assert course.summaries[0].steps == 5


FAILING = """\
calls = 0
def predict(x, P, u, motion):
    global calls
    calls += 1
    if calls > 3: raise ValueError("enough")
    return motion.f(x, u), P + calls * 1e-9
def update(x, P, z, sensor):
    return x, P
"""


def test_a_filter_that_fails_is_told_and_undone(tmp_path):
    (tmp_path / "mine.py").write_text(FAILING)
    place = replace(scene(), filter=str(tmp_path / "mine.py"))
    course = Course(place)
    course.add(*(Move(0.1, 0.1) for _ in range(3)))
    assert course.failure is None
    course.add(Move(0.1, 0.1))
    assert isinstance(course.failure, StepError)
    assert "enough" in str(course.failure)
    assert course.last.number == 3
    course.undo()
    assert course.failure is None
    course.undo()
    course.add(Move(0.2, 0.0))  # what it remembers is what it would in a run of these commands
    assert course.failure is None
    moves = (Move(0.1, 0.1), Move(0.1, 0.1), Move(0.2, 0.0))
    assert shown(course) == played(replace(place, commands=moves))


@pytest.mark.parametrize("place", [recording(), replace(recording(), log=None)])
def test_only_a_robot_that_obeys_commands_is_driven(place):
    with pytest.raises(UsageError, match=r"cannot be driven: .*; drive a world of the classroom"):
        Course(place)


def test_angles_are_those_of_the_commands():
    course = Course(scene(start=(1, 1, 0)))
    course.add(Move(0.25, math.radians(15)))
    assert course.last.step.entry.command == Move(0.25, math.radians(15))
