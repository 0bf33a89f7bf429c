"""The unscented Kalman filter: a statistical linearisation, by arithmetic/unscented.py."""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

from ekfsim.filters import kalman
from ekfsim.filters.arithmetic.unscented import unscented_transform, weights
from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction
from ekfsim.filters.protocol import Beginning
from ekfsim.filters.tuning import Tuning
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Sensor, angles


@dataclass(frozen=True)
class UKF:
    """Unscented Kalman filter: Tamás et al., II.C (document 001); Wan & van der Merwe, 2001."""

    remark: ClassVar[str] = ""
    gate: float | None = None  # as in the EKF
    headings: tuple[int, ...] = (2,)
    alpha: float = Tuning.alpha  # the points lie √(α² (n + κ)) standard deviations from the mean
    beta: float = Tuning.beta  # what is known of the shape: 2 for a Gaussian, where α is small
    kappa: float | None = Tuning.kappa  # None: max(3 − n, 0), so that no weight is negative

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so."""
        own = beginning.tuning
        return cls(beginning.gate, beginning.headings, own.alpha, own.beta, own.kappa)

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Gaussian, Prediction]:
        """Xᵢ = sigma points of x, P      x⁻ = Σ Wᵢᵐ f(Xᵢ, u)          eqs 14, 20; u : (…, m)
        P⁻ = Σ Wᵢᶜ (f(Xᵢ, u) − x⁻)(f(Xᵢ, u) − x⁻)ᵀ + G M Gᵀ + Q, G at x          eq. 21
        """
        x, P = belief
        _, F, G, M, Q = motion.linearize(x, u)
        W = weights(x.shape[-1], self.alpha, self.beta, self.kappa)
        f = lambda X: motion.f(X, u[..., None, :])  # noqa: E731
        moved = unscented_transform(x, P, f, W, self.headings, F, self.headings)
        P_new = W.definite(kalman.noisy(moved.covariance, G, M, Q))
        return Gaussian(moved.mean, P_new), Prediction(moved.jacobian, G)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """Zᵢ = h(Xᵢ)      ẑ = Σ Wᵢᵐ Zᵢ      S = P_zz + R      K = P_xz S⁻¹          eqs 22 to 26
        x = x⁻ + K (z − ẑ)      P = P⁻ − K S Kᵀ          eqs 27, 28
        P⁻ = L Lᵀ, P_xz = L Dᵀ, P_zz = D Dᵀ + Ω: what bends, Ω, is one more noise of the reading.
        """
        x, P = prior
        _, H, R = sensor.linearize(x)
        W = weights(x.shape[-1], self.alpha, self.beta, self.kappa)
        seen = unscented_transform(x, P, sensor.h, W, angles(sensor.outputs), H, self.headings)
        ν, noise = sensor.residual(z, seen.mean), W.definite(seen.bend + R)
        reading = kalman.Linearized(z, seen.mean, ν, seen.jacobian, noise)
        rule = kalman.Rule(self.gate, skip, self.headings)
        posterior, told = kalman.revise(Gaussian(x, P), reading, rule, seen.root, seen.slope)
        return posterior, replace(told, R=R)
