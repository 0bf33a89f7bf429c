"""The unscented Kalman filter."""

from dataclasses import dataclass
from functools import lru_cache
from typing import ClassVar, Self

import numpy as np

from ekfsim.filters.algebra import refusal
from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction
from ekfsim.filters.conditioning import conditioned, covariance
from ekfsim.filters.correcting import revised, where_used
from ekfsim.filters.protocol import Beginning
from ekfsim.filters.tuning import Tuning
from ekfsim.filters.unscented import (
    Weights,
    nearest_definite,
    statistical_slope,
    unscented_transform,
    weights,
)
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Sensor, angles

_weights = lru_cache(maxsize=64)(weights)


@dataclass(frozen=True)
class UKF:
    """Unscented Kalman filter: Tamás et al., section II.C (document 001); Wan & van der Merwe,
    2001, table 7.3.2.

    Noise is added (eqs 21, 24); eq. 22 draws it into the sigma points, as ukf_augmented.py does.
    Headings, and readings that are angles, are averaged as turns from where the mean goes, so that
    a heading may be as uncertain as one likes. As they come, α, β and κ give Julier's points, and
    no weight is negative.

    A point whose heading would lie more than a quarter of a turn away is taken there, see
    unscented.reach.
    """

    remark: ClassVar[str] = ""
    # probability; a reading whose NIS lies beyond that χ² quantile is refused
    gate: float | None = None
    headings: tuple[int, ...] = (2,)  # which entries of the state are headings, kept in (−π, π]
    # how far the points lie from the mean: √(α² (n + κ)) standard deviations
    alpha: float = Tuning.alpha
    beta: float = Tuning.beta  # what is known of the shape: 2 for a Gaussian, where α is small
    kappa: float | None = Tuning.kappa  # None: max(3 − n, 0)

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so."""
        told = beginning.tuning
        return cls(beginning.gate, beginning.headings, told.alpha, told.beta, told.kappa)

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Gaussian, Prediction]:
        """Xᵢ = sigma points of x, P      x⁻ = Σ Wᵢᵐ f(Xᵢ, u)          eqs 14, 20; u : (…, m)
        P⁻ = Σ Wᵢᶜ (f(Xᵢ, u) − x⁻)(f(Xᵢ, u) − x⁻)ᵀ + G M Gᵀ + Q          eq. 21

        The input's noise is spread by G, taken at x: only what the state's own uncertainty does is
        unscented. F told is P_x⁻x P⁺.
        """
        x, P = belief
        _, F, G, M, Q = motion.linearize(x, u)
        moved = unscented_transform(
            x,
            P,
            lambda X: motion.f(X, u[..., None, :]),
            self._weights(x),
            self.headings,
            self._turning(F),
            self.headings,
        )
        P_new = self._definite(x, covariance(moved.covariance + G @ M @ G.mT + Q))
        return Gaussian(moved.mean, P_new), Prediction(
            statistical_slope(moved.slope, moved.root), G
        )

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """Zᵢ = h(Xᵢ)      ẑ = Σ Wᵢᵐ Zᵢ      S = Σ Wᵢᶜ (Zᵢ − ẑ)(Zᵢ − ẑ)ᵀ + R
        eqs 22 to 24; z : (…, k)
        P_xz = Σ Wᵢᶜ (Xᵢ − x⁻)(Zᵢ − ẑ)ᵀ      K = P_xz S⁻¹          eqs 25, 26
        x = x⁻ + K (z − ẑ)      P = P⁻ − K S Kᵀ          eqs 27, 28

        Xᵢ are the sigma points of the prior, drawn afresh; P⁻ = L Lᵀ, P_xz = L Dᵀ, S = D Dᵀ + Ω +
        R. What bends, Ω, is to the filter one more noise. R is taken at x⁻; H told is P_zx P⁺.
        Where any Zᵢ predicts no reading (nan), neither ẑ nor S is known, for the points that are
        left no longer have the prior's mean and covariance: then the reading is refused as one that
        meets no wall.
        """
        x, P = prior
        _, H, R = sensor.linearize(x)
        directions = angles(sensor.outputs)
        seen = unscented_transform(
            x, P, sensor.h, self._weights(x), directions, self._turning(H), self.headings
        )
        D, noise = seen.slope, self._definite(x, seen.bend + R)
        innovation = sensor.residual(z, seen.mean)
        learnt = conditioned(seen.root, D, noise, seen.mean)
        nis = learnt.nis(innovation)
        refused = refusal(z, seen.mean, nis, skip, self.gate)
        posterior = revised(Gaussian(x, P), learnt, innovation, self.headings)
        return where_used(refused, posterior, Gaussian(x, P)), Correction(
            seen.mean,
            innovation,
            R,
            learnt.S(D, noise),
            statistical_slope(D, seen.root),
            learnt.K,
            nis,
            refused,
        )

    def _turning(self, J: Array) -> Array | None:
        """What of a Jacobian (…, k, n) the headings of the state do, None where it has none."""
        if not self.headings:
            return None
        turning = np.zeros_like(J)
        turning[..., self.headings] = J[..., self.headings]
        return turning

    def _weights(self, x: Array) -> Weights:
        return _weights(x.shape[-1], self.alpha, self.beta, self.kappa)

    def _definite(self, x: Array, P: Array) -> Array:
        """P, which need not be a covariance where the first point counts negatively."""
        return nearest_definite(P) if self._weights(x).covariance[0] < 0 else P
