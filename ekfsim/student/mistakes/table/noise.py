"""Mistakes of P_u, and of what is made of P by a motion."""

from collections.abc import Callable

import numpy as np

from ekfsim.geometry import Array
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.table.moves import angle, command
from ekfsim.student.mistakes.table.steps import commanded, everywhere, move_turn, moves, wandering
from ekfsim.student.mistakes.working import Piece, Pieces, Working


def deviations(_: Working, right: Callable[[], Array]) -> Array:
    """σ where σ² belongs."""
    M = right()
    return np.sign(M) * np.sqrt(np.abs(M))


def _signed(s: Working, right: Callable[[], Array]) -> Array:
    """σ where σ² belongs, with the sign of what it is a share of: ratio * a"""
    return deviations(s, right) * np.sign(s.u_M)


def squares(_: Working, right: Callable[[], Array]) -> Array:
    """σ⁴ where σ² belongs."""
    return right() ** 2


def _variances(of: Callable[[float, float, float, float], tuple[float, float]]) -> Piece:
    """P_u from d, a and their ratios."""

    def M(s: Working, _: Callable[[], Array]) -> Array:
        d, a = s.u_M
        return np.diag(np.array(of(d, a, s.robot.distance_ratio, s.robot.angle_ratio)))

    return M


def _each_or_one(wrong: Piece) -> tuple[Pieces, ...]:
    """P_u with wrong variances, or with a single one: of the first input, of the second."""
    return {"M": wrong}, *({"M": _one(i, wrong)} for i in (0, 1))


def _one(i: int, wrong: Piece) -> Piece:
    """P_u with one wrong variance."""

    def M(s: Working, right: Callable[[], Array]) -> Array:
        P_u = np.array(right())
        P_u[i, i] = wrong(s, right)[i, i]
        return P_u

    return M


def _padded(s: Working, _: Callable[[], Array]) -> Array:
    """The variances of the input on the first places of the diagonal."""
    n, M = len(s.x), s.M[: len(s.x), : len(s.x)]
    return np.pad(M, (0, n - len(M)))


def _on_diagonal(places: tuple[int, ...]) -> Piece:
    """σ_d² at these places, and σ_a² at that of θ; elsewhere as `_padded`."""

    def noise(s: Working, right: Callable[[], Array]) -> Array:
        if not move_turn(s.asked):
            return _padded(s, right)
        noise = np.diag([0.0, 0.0, s.M[1, 1]])
        noise[places, places] = s.M[0, 0]
        return noise

    return noise


def shadows(s: Working, right: Callable[[], Array]) -> Array:
    """P without what the heading has in common with the rest."""
    θ = s.places[2]
    kept = np.ones((len(s.x), len(s.x)))
    kept[θ, :] = kept[:, θ] = 0.0
    kept[θ, θ] = 1.0
    return right() * kept


def diagonal(_: Working, right: Callable[[], Array]) -> Array:
    """P with its variances alone."""
    return np.diag(np.diag(right()))


OF_NOISE = (
    Mistake(
        "sigma-in-P_u",
        "your P_u holds σ where σ² belongs",
        "eq 1: the diagonal of P_u holds variances, the squares of σ",
        moves,
        (*_each_or_one(deviations), {"M": _signed}),
    ),
    Mistake(
        "noise-without-J_u",
        "your P is the one with P_u added as it is, without J_u and J_u' on its sides",
        "eq 7: J_u P_u J_u'",
        moves,
        (
            {"noise": _on_diagonal((0,))},
            {"noise": _on_diagonal((0, 1))},
            {"noise": _padded},
        ),
    ),
    Mistake(
        "command-in-P_u",
        "your P_u is that of the commanded motion, not of the measured one",
        "eq 1: P_u is of u, which the odometry measured",
        commanded,
        ({"u_M": command},),
    ),
    Mistake(
        "degrees-in-P_u",
        "your σ_a in P_u is in degrees",
        "eq 1: σ_a = odometryAngSigmaRatio * a, a in radians",
        move_turn,
        ({"u_M": angle(np.degrees)},),
    ),
    Mistake(
        "no-noise",
        "your P is the one without P_u: a move adds no uncertainty of its own",
        "eq 7: J_x P J_x' + J_u P_u J_u'",
        moves,
        ({"noise": lambda s, _: np.zeros_like(s.P)},),
    ),
    Mistake(
        "P-not-predicted",
        "your P stays as it was before the move",
        "eq 7: J_x P J_x' + J_u P_u J_u'",
        moves,
        ({"covariance": lambda s, _: s.P},),
    ),
    Mistake(
        "P-forgotten",
        "your P is the one of this move alone: J_u P_u J_u', without J_x P J_x'",
        "eq 7: J_x P J_x' + J_u P_u J_u'",
        moves,
        ({"spread": lambda s, _: np.zeros_like(s.P)},),
    ),
    Mistake(
        "P-predicted-twice",
        "your P is predicted twice",
        "eq 7: once for each move",
        moves,
        ({"covariance": lambda s, right: s.F @ right() @ s.F.T + s.noise + s.Q},),
    ),
    Mistake(
        "noise-before-J_x",
        "your P is the one with the noise added before it is moved: J_x (P + J_u P_u J_u') J_x'",
        "eq 7: J_x P J_x' + J_u P_u J_u'",
        moves,
        ({"covariance": lambda s, _: s.F @ (s.P + s.noise) @ s.F.T + s.Q},),
    ),
    Mistake(
        "noise-twice",
        "your P is the one with J_u P_u J_u' added twice",
        "eq 7: J_x P J_x' + J_u P_u J_u'",
        moves,
        ({"noise": lambda s, right: 2 * right()},),
    ),
    Mistake(
        "noise-subtracted",
        "your P is the one with J_u P_u J_u' subtracted",
        "eq 7: J_x P J_x' + J_u P_u J_u'",
        moves,
        ({"noise": lambda s, right: -right()},),
    ),
    Mistake(
        "noise-uncorrelated",
        "your P is the one with the diagonal of J_u P_u J_u' alone",
        "eq 7: J_u P_u J_u' is a whole matrix: an error of the way moves x and y together",
        moves,
        ({"noise": diagonal},),
    ),
    Mistake(
        "P_u-without-way",
        "your P_u holds the ratios squared, without the way d and the turn a",
        "eq 1: σ_d = odometryDstSigmaRatio * d, σ_a = odometryAngSigmaRatio * a",
        move_turn,
        ({"M": _variances(lambda d, a, ρ_d, ρ_a: (ρ_d**2, ρ_a**2))},),
    ),
    Mistake(
        "P_u-ratio-not-squared",
        "your P_u is the one with the ratios not squared: ratio * d²",
        "eq 1: σ_d² = (odometryDstSigmaRatio * d)^2",
        move_turn,
        _each_or_one(_variances(lambda d, a, ρ_d, ρ_a: (ρ_d * d**2, ρ_a * a**2))),
    ),
    Mistake(
        "P_u-way-not-squared",
        "your P_u is the one with d and a not squared: ratio² * d",
        "eq 1: σ_d² = (odometryDstSigmaRatio * d)^2",
        move_turn,
        _each_or_one(_variances(lambda d, a, ρ_d, ρ_a: (ρ_d**2 * abs(d), ρ_a**2 * abs(a)))),
    ),
    Mistake(
        "P_u-squared-twice",
        "your P_u holds σ⁴: its variances are squared once more",
        "eq 1: the diagonal of P_u holds variances, the squares of σ",
        moves,
        ({"M": squares},),
    ),
    Mistake(
        "P_u-exchanged",
        "your P_u has σ_a² in the place of σ_d², and σ_d² in that of σ_a²",
        "eq 1: σ_d² stands first, as d does in u",
        move_turn,
        ({"M": lambda s, right: right()[::-1, ::-1]},),
    ),
    Mistake(
        "ratios-exchanged",
        "your two ratios are exchanged: that of angles times d, and that of distances times a",
        "eq 1: σ_d = odometryDstSigmaRatio * d, σ_a = odometryAngSigmaRatio * a",
        move_turn,
        ({"M": _variances(lambda d, a, ρ_d, ρ_a: ((ρ_a * d) ** 2, (ρ_d * a) ** 2))},),
    ),
    Mistake(
        "one-ratio",
        "your P_u is the one with the same ratio for d and for a",
        "eq 1: σ_d = odometryDstSigmaRatio * d, σ_a = odometryAngSigmaRatio * a",
        move_turn,
        (
            {"M": _variances(lambda d, a, ρ_d, _: ((ρ_d * d) ** 2, (ρ_d * a) ** 2))},
            {"M": _variances(lambda d, a, _, ρ_a: ((ρ_a * d) ** 2, (ρ_a * a) ** 2))},
        ),
    ),
    Mistake(
        "turn-noise-of-the-way",
        "your σ_a is proportional to the way d, not to the turn a",
        "eq 1: σ_a = odometryAngSigmaRatio * a",
        move_turn,
        ({"M": _variances(lambda d, a, ρ_d, ρ_a: ((ρ_d * d) ** 2, (ρ_a * d) ** 2))},),
    ),
    Mistake(
        "way-noise-of-the-turn",
        "your σ_d is proportional to the turn a, not to the way d",
        "eq 1: σ_d = odometryDstSigmaRatio * d",
        move_turn,
        ({"M": _variances(lambda d, a, ρ_d, ρ_a: ((ρ_d * a) ** 2, (ρ_a * a) ** 2))},),
    ),
    Mistake(
        "P_u-correlated",
        "your P_u has σ_d σ_a beside its diagonal",
        "eq 1: the errors of d and of a are independent, so σ_da = 0",
        move_turn,
        ({"M": lambda s, right: np.sqrt(np.outer(np.diag(right()), np.diag(right())))},),
    ),
    Mistake(
        "no-process-noise",
        "your P is the one without the process noise Q",
        "F P F' + G M G' + Q",
        wandering,
        ({"Q": lambda s, _: np.zeros_like(s.P)},),
    ),
    Mistake(
        "cross-dropped",
        "your P has 0 for σ_xθ and σ_yθ, or in every place beside its diagonal",
        "eq 2: P is a whole matrix; σ_xθ and σ_yθ say how x and y err with the heading",
        everywhere,
        ({"covariance": shadows}, {"covariance": diagonal}),
    ),
)
