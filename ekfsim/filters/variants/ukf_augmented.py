"""The unscented Kalman filter whose sigma points hold the noise, too."""

from dataclasses import dataclass, replace

import numpy as np

from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction
from ekfsim.filters.ukf import UKF
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Quantity, Sensor


@dataclass(frozen=True)
class AugmentedUKF(UKF):
    """Unscented Kalman filter with augmented sigma points: Tamás et al., eq. 22 (document 001); Wan
    & van der Merwe, 2001, table 7.3.

    State and noise make one vector, Xᵃ = (Xˣ, Xʷ, Xⁿ), and so one set of sigma points: what a noise
    of the input does to the state is unscented, too, where the UKF of ukf.py has G M Gᵀ. The points
    are more, and lie further out: at √nᵃ deviations, where none is to count negatively. They are
    drawn afresh for the reading, with its noise alone.
    """

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Gaussian, Prediction]:
        """x⁻ = Σ Wᵢᵐ (f(Xˣᵢ, u + Xʷᵢ) + Xᵠᵢ), Xʷ of covariance M, Xᵠ of Q
        eqs 12, 20, 21; u : (…, m)
        """
        x, P = belief
        n, m = x.shape[-1], u.shape[-1]
        Q = motion.Q(u)
        noises = [motion.M(u)] if np.ndim(Q) == 0 else [motion.M(u), np.asarray(Q)]
        after, told = UKF.predict(self, augmented(x, P, *noises), NoisyMotion(motion, n), u)
        return after, Prediction(told.F[..., :n], told.F[..., n : n + m])

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """Zᵢ = h(Xˣᵢ) + Xⁿᵢ, Xⁿ of covariance R
        eq. 22; then eqs 23 to 28 as in ukf.py; z : (…, k)
        """
        x, P = prior
        n = x.shape[-1]
        R = sensor.R(x)
        (mean, covariance), told = UKF.update(
            self, augmented(x, P, np.nan_to_num(R)), NoisySensor(sensor, n), z, skip
        )
        return Gaussian(mean[..., :n], covariance[..., :n, :n]), replace(
            told, R=R, H=told.H[..., :n], K=told.K[..., :n, :]
        )


def augmented(x: Array, P: Array, *noises: Array) -> Gaussian:
    """(x, 0, …) and P with the noises' covariances beside it, all independent : (…, nᵃ), (…, nᵃ,
    nᵃ)
    """
    blocks = [P, *noises]
    axes = np.broadcast_shapes(x.shape[:-1], *(block.shape[:-2] for block in blocks))
    size = sum(block.shape[-1] for block in blocks)
    mean, covariance = np.zeros((*axes, size)), np.zeros((*axes, size, size))
    mean[..., : x.shape[-1]] = x
    start = 0
    for block in blocks:
        end = start + block.shape[-1]
        covariance[..., start:end, start:end] = block
        start = end
    return Gaussian(mean, covariance)


@dataclass(frozen=True, slots=True)
class NoisyMotion(Motion):
    """A motion of (x, w, q): f(x, u + w) + q, with no noise but that."""

    motion: Motion
    n: int  # entries of x

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """Those of the motion."""
        return self.motion.inputs

    def f(self, x: Array, u: Array) -> Array:
        """(…, n)"""
        m = u.shape[-1]
        after = self.motion.f(x[..., : self.n], u + x[..., self.n : self.n + m])
        return after + x[..., self.n + m :] if x.shape[-1] > self.n + m else after

    def F(self, x: Array, u: Array) -> Array:
        """(F, G, 1) : (…, n, nᵃ)"""
        inner, m = x[..., : self.n], u.shape[-1]
        parts = [self.motion.F(inner, u + x[..., self.n : self.n + m]), self.G(x, u)]
        if x.shape[-1] > self.n + m:
            parts.append(np.broadcast_to(np.eye(self.n), parts[0].shape))
        return np.concatenate(parts, axis=-1)

    def G(self, x: Array, u: Array) -> Array:
        """∂f/∂u : (…, n, m)"""
        return self.motion.G(x[..., : self.n], u + x[..., self.n : self.n + u.shape[-1]])

    def M(self, u: Array) -> Array:
        """None besides w."""
        return np.zeros((u.shape[-1], u.shape[-1]))

    def Q(self, u: Array) -> float:
        """None besides q."""
        return 0.0


@dataclass(frozen=True, slots=True)
class NoisySensor(Sensor):
    """A sensor of (x, n): h(x) + n, with no noise but that."""

    sensor: Sensor
    n: int  # entries of x

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """Those of the sensor."""
        return self.sensor.outputs

    def h(self, x: Array) -> Array:
        """(…, k)"""
        return self.sensor.h(x[..., : self.n]) + x[..., self.n :]

    def H(self, x: Array) -> Array:
        """(H, 1) : (…, k, n + k)"""
        H, k = self.sensor.H(x[..., : self.n]), x.shape[-1] - self.n
        return np.concatenate([H, np.broadcast_to(np.eye(k), (*H.shape[:-1], k))], axis=-1)

    def R(self, x: Array) -> Array:
        """None besides n : (…, k, k)"""
        k = x.shape[-1] - self.n
        return np.zeros((*x.shape[:-1], k, k))

    def residual(self, z: Array, h: Array) -> Array:
        """That of the sensor."""
        return self.sensor.residual(z, h)
