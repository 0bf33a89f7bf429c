"""What is found of filters that are wrong in one way or two."""

import math

import numpy as np
import pytest
from scenes import scene
from two_functions import compared, predict, update

from ekfsim import load_scene
from ekfsim.commands import Move, Sense
from ekfsim.student.comparing.found import found
from ekfsim.student.fault import FaultError

WAY = tuple(
    command
    for angle in (90, 70, 80, -60, 100)
    for command in (
        Move(1.5, math.radians(angle)), Sense(math.radians(20)), Sense(math.radians(-80))
    )
)  # fmt: skip
MADE = scene(*WAY, start=(4, 3, 0.3), sigma=(0.1, 0.1, 0.05))


def of(runs=1, made=MADE, **code):
    return found((run, compared(made, run=run, **code)) for run in range(runs))


def names(guesses):
    return [tuple(mistake.name for mistake in guess) for guess in guesses]


def counted(found):
    return {mistake.name: seen.steps for mistake, seen in found.named.items()}


def after_the_move(x, P, u, motion):
    new = motion.f(x, u)
    F, G = motion.F(new, u), motion.G(x, u)
    return new, F @ P @ F.T + G @ motion.M(u) @ G.T


def other_way(x, P, z, sensor):
    H = sensor.H(x)
    K = P @ H.T / (H @ P @ H.T + sensor.R(x))
    return x - K @ (z - sensor.h(x)), P - K @ H @ P


def test_right_equations_are_equal():
    result = of(3)
    assert result.equal
    assert (result.runs, result.steps, result.differing) == (3, 45, 0)
    assert 0 < result.largest < 1e-9
    assert (result.first, result.guesses, result.named, result.unnamed) == (None, (), {}, ())


def test_the_first_wrong_step_is_named():
    result = of(predict=after_the_move)
    assert not result.equal
    assert (result.first.run, result.first.step.asked.index) == (0, 1)
    assert names(result.guesses) == [("J_x-after-move",)]
    assert counted(result) == {"J_x-after-move": 5}
    assert result.differing == 5
    assert result.unnamed == ()


def test_moves_and_readings_that_are_both_wrong_are_two_findings():
    result = of(predict=after_the_move, update=other_way)
    assert names(result.guesses) == [("J_x-after-move",)]
    told = {mistake.name: (seen.steps, seen.first.step.asked.index)
            for mistake, seen in result.named.items()}  # fmt: skip
    assert told == {"J_x-after-move": (5, 1), "innovation-sign": (10, 2)}


def test_two_mistakes_in_one_function_are_named_both():
    def both(x, P, u, motion):
        new, P = after_the_move(x, P, u, motion)
        G, M = motion.G(x, u), motion.M(u)
        return new, P + G @ (np.sqrt(M) - M) @ G.T

    result = of(predict=both)
    assert names(result.guesses) == [("J_x-after-move", "sigma-in-P_u")]
    assert counted(result) == {"J_x-after-move": 5, "sigma-in-P_u": 5}


def test_what_is_right_elsewhere_speaks_against_a_guess():
    """A mistake in left turns alone is no mistake of all moves."""
    result = of(predict=lambda x, P, u, m: (after_the_move if u[1] > 0 else predict)(x, P, u, m))
    assert counted(result) == {"J_x-after-move": 4}
    assert result.differing == 4


def test_what_nobody_knows_stays_without_a_name():
    def strange(x, P, z, sensor):
        x, P = update(x, P, z, sensor)
        return x, P + 0.0123 * P.max()

    result = of(2, update=strange)
    assert (result.guesses, result.named) == ((), {})
    (unnamed,) = result.unnamed
    assert (unnamed.steps, unnamed.first.run, unnamed.first.step.asked.index) == (20, 0, 2)


def test_a_filter_that_is_another_by_nature_has_no_mistake():
    result = of(against="ukf")
    assert result.differing > 10
    assert (result.guesses, result.named) == ((), {})


def test_a_fault_ends_it_and_what_was_found_before_is_told():
    def fails(x, P, z, sensor):
        if fails.calls == 12:
            raise FaultError("mine.py:3", "ZeroDivisionError: float division by zero")
        fails.calls += 1
        return update(x, P, z, sensor)

    fails.calls = 0
    result = of(4, predict=after_the_move, update=fails)
    assert (result.runs, result.fault_run) == (2, 1)
    assert str(result.fault).startswith("mine.py:3: step 5 (sense 20°): ")
    assert names(result.guesses) == [("J_x-after-move",)]
    fails.calls = 0
    assert not of(4, update=fails).equal


def test_what_comes_after_a_belief_that_can_be_none_is_looked_for_in_the_next_run():
    def negative(x, P, z, sensor):
        x, P = update(x, P, z, sensor)
        return x, -P

    result = of(3, update=negative)
    assert (result.runs, result.steps) == (3, 6)
    assert result.ended.run == 0
    assert result.ended.step.unusable


@pytest.mark.parametrize("by", [1e30, 1e300, 1e307])
def test_numbers_that_are_too_large_to_calculate_with_end_it(by):
    result = of(update=lambda x, P, z, sensor: (x, by * P))
    assert result.steps == 2
    assert result.ended.step.unusable.endswith(": nothing is so uncertain")


@pytest.mark.parametrize("runs", [1, 3])
def test_the_first_difference_is_that_of_the_first_run(runs):
    result = of(runs, update=other_way)
    assert (result.first.run, result.first.step.asked.index) == (0, 2)
    assert counted(result) == {"innovation-sign": 10 * runs}


@pytest.mark.parametrize("name", ["proof-two-beams", "tour"])
def test_an_update_that_does_nothing_is_told_before_what_comes_to_the_same(name):
    result = of(made=load_scene(name), update=lambda x, P, z, sensor: (x, P))
    assert names(result.guesses) == [("reading-refused",)]
    assert counted(result) == {"reading-refused": result.differing}
