"""Noise of other numbers than the model's: what they are, the student's own numbers tell."""

from collections.abc import Iterator
from functools import cache

import numpy as np

from ekfsim.geometry import Array
from ekfsim.student.asked import Answer, Asked
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.table.beams import Choice, ways_to
from ekfsim.student.mistakes.table.steps import (
    beams,
    everywhere,
    move_turn,
    moves,
    of_one,
    readings,
)
from ekfsim.student.mistakes.working import Piece, Pieces, Working

SMALL = tuple(10.0**-k for k in (2, 6, 9, 12, 3, 8, 10, 4, 1))


def _instead(value: Array) -> Piece:
    return lambda s, _: value


def _variance(asked: Asked, theirs: Answer) -> Iterator[Pieces]:
    """C_v from what a reading left of P: P⁻ − P = c cᵀ/S with c = P⁻ J_H'."""
    s = Working(asked)
    c = s.cross[:, 0]
    less = c @ (s.P - theirs.P) @ c
    if less > 0:
        yield {"R": _instead(np.square(c @ c) / less - (s.S - s.R))}


def _variances(asked: Asked, theirs: Answer) -> Iterator[Pieces]:
    """P_u from what a move has added to P: along the way, and to the heading."""
    s = Working(asked)
    added = s.G.T @ (theirs.P - s.spread) @ s.G
    yield {"M": _instead(np.diag(np.diag(added)))}


def _diagonals(asked: Asked, theirs: Answer) -> Iterator[Pieces]:
    """What a motion has added to the diagonal of P, in place of its noise or besides."""
    s = Working(asked)
    added = theirs.P - s.spread
    yield {"noise": _instead(np.diag(np.diag(added)))}
    yield {"noise": _instead(s.noise + np.diag(np.diag(added - s.noise)))}


def _innovation(asked: Asked, theirs: Answer) -> Iterator[Pieces]:
    """ν from how the mean has moved along K."""
    s = Working(asked)
    K = s.K[:, 0]
    if K @ K > 0:
        yield {"innovation": _instead(np.array([K @ (theirs.x - s.x) / (K @ K)]))}


def _every_wall(asked: Asked, _: Answer) -> Iterator[Pieces]:
    """The line of each wall in turn."""
    for i in range(len(Working(asked).laser.walls.segments)):
        yield from ways_to(choice=_numbered(i))[:2]


@cache
def _numbered(i: int) -> Choice:
    return lambda crossed, s: i


def _more(by: float) -> Piece:
    """With a small number on the diagonal."""
    return lambda s, right: right() + by * np.eye(len(right()))


OF_NUMBERS = (
    Mistake(
        "P-inflated",
        "your P has a number added on its diagonal",
        "eqs 7, 12: all noise is in P_u and C_v; P may be singular, and is so at the start",
        everywhere,
        tuple({"covariance": _more(by)} for by in SMALL),
    ),
    Mistake(
        "S-inflated",
        "your S has a small number added",
        "eq 11: S = J_H P J_H' + C_v",
        readings,
        tuple({"S": _more(by)} for by in SMALL),
    ),
    Mistake(
        "C_v-of-its-own",
        "your C_v is another number than the model's, perhaps the same for all ranges",
        "eq 11: C_v = (rangeSigmaRatio * h)^2",
        of_one,
        ({"R": _instead(np.array([[0.01]]))},),
        _variance,
    ),
    Mistake(
        "another-wall",
        "your h is the distance to another wall than the first one on the beam's way",
        "eq 8: h is the distance to the first wall",
        beams,
        ways_to(choice=_numbered(0)),
        _every_wall,
    ),
    Mistake(
        "innovation-of-its-own",
        "your x is corrected along K, but by another number than the innovation",
        "eqs 8 to 10: h, r = z − h, and x + K r",
        of_one,
        ({"innovation": lambda s, right: right() + 0.1},),
        _innovation,
    ),
    Mistake(
        "diagonal-of-its-own",
        "your P has variances of its own on its diagonal, in place of J_u P_u J_u' or besides",
        "eq 7: J_x P J_x' + J_u P_u J_u'; all noise of a move is in P_u",
        moves,
        ({"noise": lambda s, _: 0.01 * np.eye(len(s.x))},),
        _diagonals,
    ),
    Mistake(
        "P_u-of-its-own",
        "your P_u has other numbers than the model's, perhaps the same for all motions",
        "eq 1: σ_d = odometryDstSigmaRatio * d, σ_a = odometryAngSigmaRatio * a",
        move_turn,
        ({"M": _instead(np.diag([0.01, 0.01]))},),
        _variances,
    ),
)
