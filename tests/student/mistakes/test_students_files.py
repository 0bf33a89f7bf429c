"""Files as students write them, each with one mistake of the table: the mistake is named."""

from itertools import islice
from types import SimpleNamespace

import numpy as np
import pytest
from textbook import (
    BY_LARGE_DIFFERENCES,
    FORMS,
    MISTAKES,
    OF_OTHERS,
    ONE_AFTER_THE_OTHER,
    SPELT_OTHERWISE,
    written,
    written_for_others,
)

from ekfsim import load_scene
from ekfsim.localization import filter_of, first_belief
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.landmarks import BearingOnly
from ekfsim.models.sensors.laser import Laser
from ekfsim.records import Reading
from ekfsim.simulation import simulate
from ekfsim.student.asked import Answer, Asked
from ekfsim.student.comparing.compare import compare
from ekfsim.student.comparing.difference import unit
from ekfsim.student.mistakes.guessing import guesses
from ekfsim.student.mistakes.known import KNOWN
from ekfsim.student.mistakes.working import right

ELSEWHERE = {
    "wall-by-reading": "diverge-06b-pillar-corridor",
    "another-wall": "proof-every-mistake",
}


class Student:
    """Calls the functions of a text; hands it the classroom's numbers, elsewhere the models."""

    def __init__(self, text):
        self.text = text

    def begin(self, x, P):
        self.names = {}
        exec(compile(self.text, "mine.py", "exec"), self.names)

    def call(self, asked):
        x, P, given = asked.x.copy(), asked.P.copy(), asked.given
        if isinstance(given, Reading):
            x, P = self.names["update"](x, P, given.z, handed_sensor(given.sensor))
        else:
            x, P = self.names["predict"](x, P, given.u, handed_motion(given.motion, asked.command))
        return Answer(np.array(x), np.array(P))


def handed_sensor(sensor):
    if not isinstance(sensor, Laser):
        return sensor
    return SimpleNamespace(
        bearing=sensor.bearing, range_ratio=sensor.range_ratio, walls=sensor.walls.segments
    )


def handed_motion(motion, command):
    if not isinstance(motion, MoveTurn):
        return motion
    return SimpleNamespace(
        distance_ratio=motion.distance_ratio,
        angle_ratio=motion.angle_ratio,
        command=(command.distance, command.angle),
    )


def compared(text, made):
    return compare(
        simulate(made), first_belief(made), Student(text), filter_of(made), made.world.layout
    )


def named(step):
    return [
        tuple(mistake.name for mistake in guess)
        for guess in guesses(step.asked, step.theirs, unit(step.right))
    ]


def test_every_mistake_of_the_table_has_its_file():
    assert {mistake.name for mistake in KNOWN} == {*MISTAKES, *(name for name, _ in OF_OTHERS)}


@pytest.mark.parametrize("form", FORMS)
@pytest.mark.parametrize("name", ["tour", "diverge-09-wrong-start"])
def test_a_right_file_differs_nowhere_however_it_is_written(name, form):
    steps = list(islice(compared(written(*FORMS[form]), load_scene(name)), 40))
    assert len(steps) > 20
    assert not any(step.differences for step in steps)


@pytest.mark.parametrize(
    ("name", "form"),
    [
        *((name, ()) for name in ("gnss", "landmarks", "mower", "pylon")),
        # where the noises of a reading's numbers have nothing in common
        *((name, ONE_AFTER_THE_OTHER) for name in ("gnss", "landmarks", "mower")),
    ],
)
def test_a_right_file_for_any_robot_differs_nowhere(name, form):
    steps = list(islice(compared(written_for_others(*form), load_scene(name)), 60))
    assert len(steps) == 60
    assert not any(step.differences for step in steps)


@pytest.mark.parametrize("name", MISTAKES)
def test_a_mistake_in_a_file_is_named(name):
    steps = compared(written(*MISTAKES[name]), load_scene(ELSEWHERE.get(name, "tour")))
    differing = list(islice((step for step in steps if step.differences), 2))
    assert differing
    for step in differing:
        assert (name,) in named(step)


@pytest.mark.parametrize("spelt", [*SPELT_OTHERWISE, *BY_LARGE_DIFFERENCES], ids=lambda one: one[0])
def test_it_is_named_however_it_is_written(spelt):
    name, *changes = spelt
    steps = compared(written(*changes), load_scene(ELSEWHERE.get(name, "tour")))
    assert (name,) in named(next(step for step in steps if step.differences))


@pytest.mark.parametrize(("name", "where"), OF_OTHERS)
def test_a_mistake_in_a_file_for_another_robot_is_named(name, where):
    if where == "behind":
        first_differing = behind(written_for_others(*OF_OTHERS[name, where]))
    else:
        steps = compared(written_for_others(*OF_OTHERS[name, where]), load_scene(where))
        first_differing = next(step for step in steps if step.differences)
    assert (name,) in named(first_differing)


def behind(text):
    """A landmark behind the robot: it is predicted at nearly 180° and read at nearly −180°."""
    sensor = BearingOnly(-4.0, 0.02, 0.01)
    asked = Asked(np.zeros(3), np.diag([0.04, 0.09, 0.01]), Reading(sensor, np.array([-3.1])))
    student = Student(text)
    student.begin(asked.x, asked.P)
    return SimpleNamespace(asked=asked, theirs=student.call(asked), right=right(asked))


@pytest.mark.parametrize(
    "pair",
    [
        ("turn-sign", "P_u-exchanged"),
        ("J_x-sign-x", "J_u-after-move"),
        ("command-in-P_u", "cross-dropped"),
        ("J_H-sign-theta", "C_v-of-the-reading"),
        ("bearing-sign", "K-without-S"),
        ("innovation-sign", "P-not-updated"),
        ("J_H-without-theta", "Joseph-without-noise"),
        ("P-plus", "C_v-of-its-own"),
    ],
    ids="+".join,
)
def test_two_mistakes_in_one_step_are_named_together(pair):
    changes = (line for name in pair for line in MISTAKES[name])
    differing = (s for s in compared(written(*changes), load_scene("tour")) if s.differences)
    assert any(set(pair) == set(guess) for step in differing for guess in named(step))


def test_what_fits_itself_to_the_numbers_is_named_last():
    reading = first_differing("C_v-of-the-reading")
    assert named(reading) == [("C_v-of-the-reading",), ("C_v-of-its-own",)]
    move = first_differing("ratios-exchanged", "sigma-in-P_u")
    assert ("ratios-exchanged",) not in named(move)
    assert {*named(move)[0]} == {"ratios-exchanged", "sigma-in-P_u"}
    assert named(move)[-1] == ("P_u-of-its-own",)


def first_differing(*names):
    changes = (line for name in names for line in MISTAKES[name])
    steps = compared(written(*changes), load_scene("tour"))
    return next(step for step in steps if step.differences and step.asked.index > 2)
