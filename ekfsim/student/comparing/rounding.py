"""How far two right forms of the same equations may be apart, by rounding alone.

P = (I − K H) P⁻, Joseph's form, a root of P and the information form P⁻¹ = (P⁻)⁻¹ + Hᵀ R⁻¹ H are
one number on paper. Each loses other digits: the first those that P has less than P⁻, the last
those that the inverse of a nearly singular P⁻ has not.
"""

from typing import NamedTuple

import numpy as np

from ekfsim.diagnostics.nees import RANK
from ekfsim.filters.arithmetic.algebra import inverse
from ekfsim.filters.arithmetic.square_root import covariance
from ekfsim.filters.belief import Correction, Prediction
from ekfsim.geometry import Array
from ekfsim.records import Control
from ekfsim.student.asked import Asked

DIGIT = 64 * float(np.finfo(float).eps)  # what the sums of a step may lose of their largest term
LEAST = 1e-6  # m, rad; a difference is counted in σ of at least so much
SLIGHT = 1e-4 * LEAST**2  # m², rad²; what P has less than this may be left of what was more
MOST = 1e-3  # σ, of what an inverse may lose: who loses more has no right answer left


class Rounding(NamedTuple):
    """What is no difference."""

    x: Array | float  # (n,)
    P: Array | float  # (n, n)


NONE = Rounding(0.0, 0.0)


def rounding(asked: Asked, made: Prediction | Correction, right: Array) -> Rounding:
    """How far right answers may be apart: as far as they go with what the belief before is not
    known to, and by the sizes of the terms whose sum they are.

    made : what the reference did from the same belief, right : the covariance that it came to
    """
    before = doubt(asked.P)
    if isinstance(made, Prediction):
        in_x, in_P = _of_a_move(asked, made, before)
    else:
        in_x, in_P = _of_a_reading(asked, made, before)
    σ = deviations(right)
    variances = np.diagonal(in_P)
    # of a variance that is smaller by so much a covariance may be smaller, too
    slack = np.minimum(np.sqrt(variances), 0.5 * variances / np.maximum(σ, LEAST * SLIGHT))
    return Rounding(in_x, in_P + np.outer(slack, σ) + np.outer(σ, slack))


def doubt(P: Array) -> Array:
    """To what a covariance is known that came of sums : (n, n)

    One that has become none by rounding tells how much that was.
    """
    σ = deviations(P)
    per = _per(σ)
    smallest = float(np.linalg.eigvalsh(P * np.outer(per, per))[0])
    share = DIGIT + 4 * max(0.0, -smallest)
    known: Array = share * np.outer(σ, σ) + 4 * np.abs(P - covariance(P)) + SLIGHT
    return known


def deviations(P: Array) -> Array:
    """σ : (n,), 0 where a variance is negative by rounding"""
    σ: Array = np.sqrt(np.maximum(np.diagonal(P), 0.0))
    return σ


def _of_a_move(asked: Asked, made: Prediction, before: Array) -> tuple[Array, Array]:
    """In x = f(x, u) and P = F P Fᵀ + G M Gᵀ + Q."""
    assert isinstance(asked.given, Control)
    motion, u = asked.given.motion, asked.given.u
    F, G = np.abs(made.F), np.abs(made.G)
    noise = G @ deviations(motion.M(u))
    return (
        DIGIT * (F @ np.abs(asked.x) + G @ np.abs(u) + np.pi),
        F @ before @ F.T + DIGIT * (np.outer(noise, noise) + np.abs(motion.Q(u))),
    )


def _of_a_reading(asked: Asked, made: Correction, before: Array) -> tuple[Array, Array]:
    """In x = x⁻ + K ν and P = (I − K H) P⁻."""
    σ = deviations(asked.P)
    H, K, ν = np.abs(made.H), np.abs(made.K), np.abs(made.innovation)
    kept = np.eye(len(σ)) + K @ H  # |I − K H| is no larger
    heard = H @ np.abs(asked.x) + np.abs(made.predicted) + ν
    in_x, in_P = _turned_round(asked, made, σ)
    return (
        DIGIT * (np.abs(asked.x) + np.pi + K @ heard)
        + kept @ (before @ H.T @ np.abs(inverse(made.S)) @ ν + in_x * σ),
        kept @ (before + in_P * np.outer(σ, σ)) @ kept.T,
    )


def _turned_round(asked: Asked, made: Correction, σ: Array) -> tuple[float, float]:
    """What is lost in x and in P where R, and P⁻ where it has an inverse, is turned round, in σ."""
    R, per = np.diagonal(made.R), _per(σ)
    if (R <= 0).any():
        return 0.0, 0.0
    smallest = float(np.linalg.eigvalsh(asked.P * np.outer(per, per))[0])
    lost = DIGIT * float(np.max(np.square(np.abs(made.H) @ σ) / R))
    lost += DIGIT / smallest if smallest > RANK else 0.0
    return min(lost * float(np.abs(asked.x) @ per), MOST), min(lost, MOST)


def _per(σ: Array) -> Array:
    """1/σ, 0 where nothing is uncertain"""
    return np.divide(1.0, σ, out=np.zeros_like(σ), where=σ > 0)
