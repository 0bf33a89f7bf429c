"""How far two right forms of the same equations may be apart, by rounding alone.

P = (I − K H) P⁻, Joseph's form, a root of P and the information form P⁻¹ = (P⁻)⁻¹ + Hᵀ R⁻¹ H are
one number on paper. Each loses other digits: the first those that P has less than P⁻, the last
those that the inverse of a nearly singular P⁻ has not.
"""

from typing import NamedTuple

import numpy as np

from ekfsim.diagnostics.nees import RANK
from ekfsim.filters.belief import Correction, Prediction
from ekfsim.geometry import Array
from ekfsim.records import Control
from ekfsim.student.asked import Asked

DIGIT = 64 * float(np.finfo(float).eps)  # what the sums of a step may lose of their largest term


class Rounding(NamedTuple):
    """What is no difference."""

    x: Array | float  # (n,)
    P: Array | float  # (n, n)


NONE = Rounding(0.0, 0.0)


def rounding(asked: Asked, made: Prediction | Correction) -> Rounding:
    """How far right answers may be apart, by the sizes of the terms whose sum they are.

    made : what the reference did from the same belief
    """
    σ = deviations(asked.P)
    if isinstance(made, Prediction):
        assert isinstance(asked.given, Control)
        u = np.abs(asked.given.u)
        spread = np.abs(made.F) @ σ + np.abs(made.G) @ deviations(asked.given.motion.M(u))
        summed = np.abs(made.F) @ np.abs(asked.x) + np.abs(made.G) @ u
        return Rounding(DIGIT * (summed + np.pi), DIGIT * np.outer(spread, spread))
    H, K = np.abs(made.H), np.abs(made.K)
    terms = H @ σ
    spread = σ + K @ terms
    heard = H @ np.abs(asked.x) + np.abs(made.predicted) + np.abs(made.innovation)
    told, doubt = _turned_round(asked, made, σ)
    return Rounding(
        DIGIT * (np.abs(asked.x) + np.pi + K @ heard + spread * told),
        DIGIT * np.outer(spread, spread) * (1 + doubt),
    )


def deviations(P: Array) -> Array:
    """σ : (n,), 0 where a variance is negative by rounding"""
    σ: Array = np.sqrt(np.maximum(np.diagonal(P), 0.0))
    return σ


def _turned_round(asked: Asked, made: Correction, σ: Array) -> tuple[float, float]:
    """What is lost where P⁻ is turned round : in σ of x, and of P as a share; 0 where it is
    singular, for there it has no inverse.
    """
    per = np.divide(1.0, σ, out=np.zeros_like(σ), where=σ > 0)
    smallest = float(np.linalg.eigvalsh(asked.P * np.outer(per, per))[0])
    if smallest <= RANK:
        return 0.0, 0.0
    sharp = float(np.max(np.square(np.abs(made.H) @ σ) / np.diagonal(made.R)))
    doubt = 1 / smallest + sharp
    return doubt * float(np.sum(np.abs(asked.x) * per)), doubt
