"""Mistakes of the belief that a step begins with, and of whether it is revised at all."""

import numpy as np

from ekfsim.filters.belief import Gaussian
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.table.steps import after_a_move, everywhere, first, readings
from ekfsim.student.mistakes.working import Working


def _earlier(s: Working) -> Gaussian:
    earlier = s.asked.earlier
    assert earlier is not None
    return Gaussian(earlier.x, earlier.P)


OF_BELIEFS = (
    Mistake(
        "reading-refused",
        "your step leaves the belief as it was: a gate, perhaps, refuses good readings",
        "eqs 10, 12: a gate refuses r² / S beyond a high quantile, not below it",
        readings,
        ({"mean": lambda s, _: s.x, "covariance": lambda s, _: s.P},),
    ),
    Mistake(
        "P-before-move",
        "your update is the one with the P of before the move: the predicted P is not used",
        "eqs 11, 12: P is that of eq 7",
        after_a_move,
        ({"P": lambda s, _: _earlier(s).covariance},),
    ),
    Mistake(
        "x-before-move",
        "your update is the one with the x of before the move: the predicted x is not used",
        "eqs 8, 10: x is that of eq 4",
        after_a_move,
        (
            {"x": lambda s, _: _earlier(s).mean},
            {"x": lambda s, _: _earlier(s).mean, "P": lambda s, _: _earlier(s).covariance},
        ),
    ),
    Mistake(
        "P-is-zero",
        "your P is 0: your filter is certain of everything",
        "eqs 7, 12: P grows with every move, and no reading makes all of it 0",
        everywhere,
        ({"covariance": lambda s, _: np.zeros((len(s.x), len(s.x)))},),
    ),
    Mistake(
        "own-first-P",
        "your run begins with a P of its own, not with the one that it is given",
        "eq 2: at the start P is what is given: 0 where the start is known exactly",
        first,
        (
            {"P": lambda s, _: np.eye(len(s.x))},
            {"P": lambda s, _: np.zeros((len(s.x), len(s.x)))},
        ),
    ),
    Mistake(
        "own-first-x",
        "your run begins at an x of 0, not at the start that it is given",
        "eq 4: the first estimate is the given start",
        first,
        ({"x": lambda s, _: np.zeros_like(s.asked.x)},),
    ),
)
