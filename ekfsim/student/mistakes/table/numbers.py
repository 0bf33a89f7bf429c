"""Noise of other numbers than the model's: what they are, the student's own numbers tell."""

from collections.abc import Iterator
from functools import cache

import numpy as np

from ekfsim.filters.arithmetic.algebra import symmetric
from ekfsim.geometry import Array
from ekfsim.student.asked import Answer, Asked
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.table.beams import Choice, ways_to
from ekfsim.student.mistakes.table.slopes import bent
from ekfsim.student.mistakes.table.steps import (
    beams,
    everywhere,
    move_turn,
    moves,
    of_one,
    readings,
)
from ekfsim.student.mistakes.working import Piece, Pieces, Working

SMALL = tuple(10.0**-k for k in (2, 6, 9, 12, 3, 8, 10, 4, 1, 5, 7, 15, 14, 13))


def _instead(value: Array) -> Piece:
    return lambda s, _: value


def _variance(asked: Asked, theirs: Answer) -> Iterator[Pieces]:
    """C_v from what a reading left of P, P⁻ − P = c cᵀ/S with c = P⁻ J_H'; and from how the mean
    has moved, by c ν/S.
    """
    s = Working(asked)
    c = s.cross[:, 0]
    less = c @ (s.P - theirs.P) @ c
    if less > 0:
        yield {"R": _instead(np.square(c @ c) / less - (s.S - s.R))}
    moved = c @ (theirs.x - s.x)
    if moved != 0:
        yield {"R": _instead(c @ c * s.innovation / moved - (s.S - s.R))}


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


def _bend(asked: Asked, theirs: Answer) -> Iterator[Pieces]:
    """∂x/∂θ and ∂y/∂θ in J_x from P_xθ and P_yθ, which are linear in them."""
    s = Working(asked)
    F, θ = np.array(s.F), s.places[2]
    turned = s.P @ F[θ]
    if turned[θ] <= 0:
        return
    for i in s.places[:2]:
        F[i, θ] = 0.0
        F[i, θ] = ((theirs.P - s.noise - s.Q)[i, θ] - F[i] @ turned) / turned[θ]
    yield {"F": _instead(F)}


def _row(asked: Asked, theirs: Answer) -> Iterator[Pieces]:
    """J_H from what a reading left of P: P⁻ − P = c cᵀ with c = P⁻ J_H'/√S."""
    s = Working(asked)
    try:
        lost, directions = np.linalg.eigh(symmetric(s.P - theirs.P))
    except np.linalg.LinAlgError:  # P is too large to calculate with
        return
    if lost[-1] <= 0:
        return
    c = np.sqrt(lost[-1]) * directions[:, -1]
    h = np.linalg.pinv(s.P, hermitian=True) @ c  # J_H/√S
    if h @ c < 1:  # S − C_v is so much of S
        H = np.sqrt(s.R[0, 0] / (1 - h @ c)) * h[None]
        yield from ({"H": _instead(H)}, {"H": _instead(-H)})


def _scaled(asked: Asked, theirs: Answer) -> Iterator[Pieces]:
    """By which number all of P is multiplied, or what it was before a move."""
    s = Working(asked)
    yield {"covariance": _times(_ratio(theirs.P, s.covariance))}
    if moves(asked):
        yield {"spread": _times(_ratio(theirs.P - s.noise - s.Q, s.spread))}


def _ratio(theirs: Array, right: Array) -> float:
    """The number that the one is of the other, as near as may be."""
    return float(np.vdot(theirs, right) / max(np.vdot(right, right), np.finfo(float).tiny))


def _times(by: float) -> Piece:
    return lambda s, right: by * right()


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
        "J_H-of-its-own",
        "your J_H has other numbers than the derivatives of h",
        "eq 11: the derivatives of h; hold yours against (h(x + e) − h(x − e)) / 2e, e = 1e-5",
        of_one,
        ({"H": lambda s, right: 1.1 * right()},),
        _row,
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
        "J_x-of-its-own",
        "your J_x has other numbers than the derivatives of x and y by θ",
        "eq 6: the derivatives by θ; hold yours against (Φ(θ + e) − Φ(θ − e)) / 2e, e = 1e-5",
        moves,
        ({"F": bent(1.1)},),
        _bend,
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
        "your P_u has other numbers than the model's, perhaps the same for all moves",
        "eq 1: σ_d = odometryDstSigmaRatio * d, σ_a = odometryAngSigmaRatio * a",
        move_turn,
        ({"M": _instead(np.diag([0.01, 0.01]))},),
        _variances,
    ),
    Mistake(
        "P-scaled",
        "your P is multiplied by a number",
        "eqs 7, 12: P grows by the noise of a move alone, and shrinks by a reading alone",
        everywhere,
        ({"covariance": _times(1.1)},),
        _scaled,
    ),
)
