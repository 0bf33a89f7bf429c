"""Assumes that start, motion, map and wall are right: what surprises is the sensor's noise.

A warning example: it learns R from its readings, and takes for noise whatever goes wrong.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from ekfsim.filters import kalman
from ekfsim.filters.belief import Belief, Correction, Gaussian, Learning, Prediction
from ekfsim.filters.protocol import Beginning
from ekfsim.filters.tuning import Tuning
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Quantity, Sensor

LEAST = 1e-6  # of the told R: readings that fit exactly would make it nothing


@dataclass(frozen=True)
class Adaptive:
    """Extended Kalman filter that learns R from its residuals: Mohamed & Schwarz, Adaptive Kalman
    filtering for INS/GPS, 1999, with the forgetting factor of Akhlaghi, Zhou & Huang, Adaptive
    adjustment of noise covariance in Kalman filter for dynamic state estimation, 2017.

    Learnt is a factor s on the R that is told, 1 at first: a range's noise goes on growing with the
    range. Sensors that read the same quantities share one.
    """

    remark: ClassVar[str] = ""
    gate: float | None = None  # probability; what it refuses teaches nothing
    headings: tuple[int, ...] = (2,)  # which entries of the state are headings, kept in (−π, π]
    forgetting: float = Tuning.adaptive  # α, how much of s a reading leaves; 1 makes it the EKF

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so."""
        return cls(beginning.gate, beginning.headings, beginning.tuning.adaptive)

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Learning, Prediction]:
        """x⁻ = f(x, u)      P⁻ = F P Fᵀ + G M Gᵀ + Q; u : (…, m). A motion teaches nothing."""
        x, P = belief
        f, F, G, M, Q = motion.linearize(x, u)
        return Learning(f, kalman.predict(P, F, G, M, Q), _factors(belief)), Prediction(F, G)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Learning, Correction]:
        """ν = z − h(x⁻)      S = H P⁻ Hᵀ + s R      K = P⁻ Hᵀ S⁻¹          z : (…, k)
        x = x⁻ + K ν      P = (I − KH) P⁻      s ← α s + (1 − α) `seen`

        R, S and NIS told are with the s that was learnt before. A reading that is not used leaves s
        as it is.
        """
        x, P = prior
        factors = _factors(prior)
        s = factors.get(sensor.outputs, np.ones(x.shape[:-1]))
        h, H, R = sensor.linearize(x)
        reading = kalman.Linearized(z, h, sensor.residual(z, h), H, s[..., None, None] * R)
        rule = kalman.Rule(self.gate, skip, self.headings)
        posterior, told = kalman.update(Gaussian(x, P), reading, rule)
        α = self.forgetting
        learnt = np.maximum(α * s + (1 - α) * seen(s, told), LEAST)
        s = np.where(told.used, learnt, s)
        after = Learning(*posterior, {**factors, sensor.outputs: s})
        return after, replace(told, noise_factor=s)


def seen(s: Array, told: Correction) -> Array:
    """tr(R⁻¹ (ε εᵀ + H P Hᵀ)) / k : (…), the factor on R that one reading speaks for, ε = z − h −
    H K ν being what it leaves of the innovation, and P what is left of P⁻.

    As ε = s R S⁻¹ ν and H P Hᵀ = s R − s R S⁻¹ s R, it is s + s (νᵀ W S⁻¹ ν − tr W) / k with
    W = S⁻¹ s R: no less than 0, and no R has to be inverted. Of one number it is
    s + s (s R/S) (NIS − 1).
    """
    R, S, ν, k = told.R, told.S, told.innovation, told.S.shape[-1]
    if k == 1:
        share = R[..., 0, 0] / np.where(told.used, S[..., 0, 0], 1.0)
        surprise = share * (told.nis - 1)
    else:
        inverse = np.linalg.pinv(np.where(told.used[..., None, None], S, 0.0), hermitian=True)
        W = inverse @ R
        surprise = (np.vecdot(ν, np.matvec(W @ inverse, ν)) - np.trace(W, axis1=-2, axis2=-1)) / k
    found: Array = s + s * surprise
    return found


def _factors(belief: Belief) -> Mapping[tuple[Quantity, ...], Array]:
    """What has been learnt so far; nothing where a run begins."""
    return belief.factors if isinstance(belief, Learning) else {}
