"""Mistakes of S, K, x and P, the last lines of an update."""

from collections.abc import Callable

import numpy as np

from ekfsim.filters.arithmetic.algebra import gain_of_moments
from ekfsim.geometry import Array
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.table.repeated import again, anew, iterated
from ekfsim.student.mistakes.table.steps import of_many, readings
from ekfsim.student.mistakes.working import Piece, Working


def _I_KH(s: Working) -> Array:
    return np.eye(len(s.x)) - s.K @ s.H


def _gain_of(P: Array, s: Working) -> Array:
    """K of another P."""
    return gain_of_moments(P @ s.H.T, s.H @ P @ s.H.T + s.R)


def _number(s: Working) -> float:
    """K and H multiplied as if they were lists of numbers: K·H"""
    return float(np.sum(s.K[:, 0] * s.H[0]))


def _heading_kept(s: Working, right: Callable[[], Array]) -> Array:
    after, θ = np.array(right()), s.places[2]
    after[θ] = s.x[θ]
    return after


def _gain(of: Callable[[Working], Array]) -> tuple[dict[str, Piece], ...]:
    return ({"K": lambda s, _: of(s)},)


def _covariance(*of: Callable[[Working], Array]) -> tuple[dict[str, Piece], ...]:
    def piece(P: Callable[[Working], Array]) -> Piece:
        return lambda s, _: P(s)

    return tuple({"covariance": piece(P)} for P in of)


def _mean(of: Callable[[Working], Array]) -> tuple[dict[str, Piece], ...]:
    return ({"mean": lambda s, _: of(s)},)


OF_GAINS = (
    Mistake(
        "P-not-updated",
        "your P stays as it was before the reading",
        "eq 12: (I − K J_H) P",
        readings,
        _covariance(lambda s: s.P),
    ),
    Mistake(
        "K-without-inverse",
        "your K is P J_H' S, without the inverse of S",
        "eq 11: K = P J_H' S^-1; the inverse of a number S is 1/S",
        readings,
        _gain(lambda s: s.cross @ s.S),
    ),
    Mistake(
        "K-without-S",
        "your K is P J_H', without S",
        "eq 11: K = P J_H' S^-1",
        readings,
        _gain(lambda s: s.cross),
    ),
    Mistake(
        "K-by-C_v",
        "your K is P J_H' / C_v, without J_H P J_H' in S",
        "eq 11: S = J_H P J_H' + C_v",
        readings,
        _gain(lambda s: gain_of_moments(s.cross, s.R)),
    ),
    Mistake(
        "K-by-root",
        "your K is P J_H' divided by the root of S",
        "eq 11: K = P J_H' S^-1, S itself a variance",
        readings,
        _gain(lambda s: s.cross @ np.diag(1 / np.sqrt(np.diag(s.S)))),
    ),
    Mistake(
        "K-entry-by-entry",
        "your S is inverted entry by entry, 1/S, not as a matrix",
        "eq 11: S^-1 is the inverse of a matrix",
        of_many,
        _gain(lambda s: s.cross @ (1 / s.S)),
    ),
    Mistake(
        "K-without-P",
        "your K is J_H' S^-1, without P",
        "eq 11: K = P J_H' S^-1",
        readings,
        ({"cross": lambda s, _: s.H.T},),
    ),
    Mistake(
        "S-without-P",
        "your S is J_H J_H' + C_v, without P",
        "eq 11: S = J_H P J_H' + C_v",
        readings,
        ({"S": lambda s, _: s.H @ s.H.T + s.R},),
    ),
    Mistake(
        "x-not-updated",
        "your x stays as it was before the reading; only P changes",
        "eq 10: x + K r",
        readings,
        _mean(lambda s: s.x),
    ),
    Mistake(
        "x-is-the-correction",
        "your x is the correction K r alone",
        "eq 10: x + K r",
        readings,
        _mean(lambda s: s.K @ s.innovation),
    ),
    Mistake(
        "x-corrected-twice",
        "your x is corrected twice: x + 2 K r",
        "eq 10: x + K r",
        readings,
        _mean(lambda s: s.x + 2 * s.K @ s.innovation),
    ),
    Mistake(
        "heading-not-corrected",
        "your θ stays as it was before the reading; only x and y are corrected",
        "eq 10: x + K r, all three entries: K has a row for θ",
        readings,
        ({"mean": _heading_kept},),
    ),
    Mistake(
        "x-by-the-new-P",
        "your x is updated after P, with the K of the new P",
        "eqs 10, 11: K is of the P before the reading; x + K r, and then (I − K J_H) P",
        readings,
        (
            *_mean(lambda s: s.x + _gain_of(s.covariance, s) @ s.innovation),
            *_mean(lambda s: s.x + gain_of_moments(s.covariance @ s.H.T, s.S) @ s.innovation),
        ),
    ),
    Mistake(
        "Joseph-without-noise",
        "your P is (I − K J_H) P (I − K J_H)', without K C_v K'",
        "eq 12: (I − K J_H) P; Joseph's form of it has + K C_v K'",
        readings,
        _covariance(lambda s: _I_KH(s) @ s.P @ _I_KH(s).T),
    ),
    Mistake(
        "P-updated-twice",
        "your P is updated twice",
        "eq 12: once for each reading",
        readings,
        (
            {"covariance": lambda s, right: right() - _gain_of(right(), s) @ s.H @ right()},
            {"covariance": lambda s, right: right() - s.K @ s.H @ right()},
        ),
    ),
    Mistake(
        "reading-used-twice",
        "your reading is used twice, for x and for P",
        "eqs 10, 12: once for each reading",
        readings,
        (
            {
                "mean": lambda s, _: again(s).mean,
                "covariance": lambda s, _: again(s).covariance,
            },
        ),
    ),
    Mistake(
        "J_H-after-update",
        "your P is the one with J_H taken at the estimate after the update",
        "eqs 11, 12: K and J_H are those of the estimate before the reading",
        readings,
        _covariance(
            lambda s: s.P - anew(s)[0] @ anew(s)[1] @ s.P,
            lambda s: s.P - s.K @ anew(s)[1] @ s.P,
        ),
    ),
    Mistake(
        "iterated-update",
        "your update is iterated: h and J_H are taken again at the estimate that comes of it",
        "eqs 8 to 12: once for each reading; the filter iekf is the iterated one",
        readings,
        tuple(
            iterated(times, noise)
            for times in (5, 2, 3, 4, 10, 20)
            for noise in (lambda s, _: s.R, lambda s, at: s.model.R(at))
        ),
    ),
    Mistake(
        "P-plus",
        "your P grows with the reading: (I + K J_H) P",
        "eq 12: (I − K J_H) P",
        readings,
        _covariance(lambda s: s.P + s.K @ s.H @ s.P),
    ),
    Mistake(
        "P-is-the-decrease",
        "your P is K J_H P, which is what the reading takes off P",
        "eq 12: (I − K J_H) P",
        readings,
        _covariance(lambda s: s.K @ s.H @ s.P),
    ),
    Mistake(
        "P-wrong-side",
        "your P is P (I − K J_H): the factor stands on the wrong side",
        "eq 12: (I − K J_H) P",
        readings,
        _covariance(lambda s: s.P @ _I_KH(s)),
    ),
    Mistake(
        "P-without-P",
        "your P is I − K J_H, without the P before",
        "eq 12: (I − K J_H) P",
        readings,
        _covariance(_I_KH),
    ),
    Mistake(
        "P-minus-K-H",
        "your P is P − K J_H, without P behind K J_H",
        "eq 12: (I − K J_H) P = P − K J_H P",
        readings,
        _covariance(lambda s: s.P - s.K @ s.H),
    ),
    Mistake(
        "P-of-ones",
        "your P is (1 − K J_H) P with a 1 in every entry, where I has them on its diagonal alone",
        "eq 12: I is the identity, np.eye",
        readings,
        _covariance(lambda s: (1 - s.K @ s.H) @ s.P),
    ),
    Mistake(
        "P-elementwise",
        "your P is (I − K J_H) * P, entry by entry and not as matrices",
        "eq 12: (I − K J_H) P is a product of matrices (in NumPy @)",
        readings,
        _covariance(lambda s: _I_KH(s) * s.P),
    ),
    Mistake(
        "K-H-a-number",
        "your K J_H is a number, the sum of products: K and J_H are lists, not column and row",
        "eq 12: K is a column, J_H a row, and K J_H a matrix: np.outer(K, H)",
        readings,
        _covariance(
            lambda s: (1 - _number(s)) * s.P,
            lambda s: (np.eye(len(s.x)) - _number(s)) @ s.P,
        ),
    ),
    Mistake(
        "Joseph-sign",
        "your P is (I − K J_H) P (I − K J_H)' − K C_v K'",
        "eq 12: (I − K J_H) P; Joseph's form of it has + K C_v K'",
        readings,
        _covariance(lambda s: _I_KH(s) @ s.P @ _I_KH(s).T - s.K @ s.R @ s.K.T),
    ),
    Mistake(
        "P-minus-K-R-K",
        "your P is P − K C_v K' or P − K K' where P − K S K' belongs",
        "eq 12: (I − K J_H) P, which is P − K S K'",
        readings,
        _covariance(lambda s: s.P - s.K @ s.R @ s.K.T, lambda s: s.P - s.K @ s.K.T),
    ),
)
