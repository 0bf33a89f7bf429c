"""Assumes that what is uncertain turns with the robot: that its error is one of its own frame.

That holds of motions and of fixes of the position, not of what a landmark or a wall tells.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from ekfsim.filters.arithmetic.algebra import wrapped
from ekfsim.filters.arithmetic.square_root import covariance
from ekfsim.filters.belief import Belief, Correction, Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.filters.protocol import Beginning
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Sensor


@dataclass(frozen=True)
class Invariant(EKF):
    """Left-invariant extended Kalman filter on SE(2): Barrau & Bonnabel, The invariant extended
    Kalman filter as a stable observer, IEEE Transactions on Automatic Control 62(4), 2017.

    A pose is χ = (R, p), and what the estimate lacks is χ = χ̂ exp(ξ): a twist ξ in the robot's own
    frame. To first order ξ = (Rᵀ δp, δθ), so the belief stays a mean and a covariance of x, y, θ.
    A motion input carries ξ by a matrix that does not depend on where the robot is believed to be;
    in x, y, θ that is F P Fᵀ, and the prediction is the EKF's. What the state holds besides the
    pose is added to as ever. Where there is no heading it is the EKF.
    """

    pose: tuple[int, int, int] = (0, 1, 2)  # which entries of the state are x, y and θ

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so."""
        return cls(beginning.gate, beginning.headings, beginning.pose)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """δ = K ν      ξ = (Rᵀ δp, δθ)      χ = χ⁻ exp(ξ)      P_ξ = (I − K_ξ H_ξ) P_ξ⁻

        In x, y, θ, where K, ν and (I − K H) P⁻ are the EKF's, this is

            p = p⁻ + V(δθ) δp      θ = θ⁻ + δθ      P = B (I − K H) P⁻ Bᵀ

        V(φ) turns a chord into the arc that it begins, and B turns the position by δθ: P_ξ is
        that of the robot's own frame, which a reading has turned.
        """
        straight, told = super().update(prior, sensor, z, skip)
        if self.pose[2] not in self.headings:
            return straight, told
        used = told.used[..., None]
        δ = np.where(used, np.matvec(told.K, told.innovation), 0.0)
        mean = wrapped(prior.mean + along_arc(δ, self.pose), self.headings)
        B = turning(δ, self.pose)
        P = covariance(B @ straight.covariance @ B.mT)
        return Gaussian(mean, np.where(used[..., None], P, straight.covariance)), told


def along_arc(δ: Array, pose: tuple[int, int, int]) -> Array:
    """δ : (…, n) with V(δθ) δp in place of its δp

    V(φ) = ∫₀¹ R(sφ) ds = [[sin φ, −(1 − cos φ)], [1 − cos φ, sin φ]] / φ
    """
    x, y, θ = pose
    φ = δ[..., θ]
    along = np.sinc(φ / np.pi)  # sin φ / φ, 1 at 0
    across = np.sin(φ / 2) * np.sinc(φ / 2 / np.pi)  # (1 − cos φ) / φ, 0 at 0
    arc = δ.copy()
    arc[..., x] = along * δ[..., x] - across * δ[..., y]
    arc[..., y] = across * δ[..., x] + along * δ[..., y]
    return arc


def turning(δ: Array, pose: tuple[int, int, int]) -> Array:
    """B : (…, n, n), which turns the position by δθ and leaves all else"""
    x, y, θ = pose
    cos, sin = np.cos(δ[..., θ]), np.sin(δ[..., θ])
    B = np.zeros((*δ.shape, δ.shape[-1]))
    B[...] = np.eye(δ.shape[-1])
    B[..., x, x], B[..., x, y] = cos, -sin
    B[..., y, x], B[..., y, y] = sin, cos
    return B
