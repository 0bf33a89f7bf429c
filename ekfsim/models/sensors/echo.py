"""The envelope of an ultrasonic echo, which tells the time of flight (document 001, IV B)."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.noise import alike
from ekfsim.models.protocols import Quantity, Sensor

# no echo rises in a shorter T than this, in the times' unit, nor is there any before s is as large
TINY = 1e-12
STEEPEST = 100.0  # of the exponent: e¹⁰⁰ and its square are still far from what a float can hold


def envelope(
    t: Array, A0: Array | float, τ: Array | float, T: Array | float, α: Array | float
) -> Array:
    """A(t) = A₀ s^α e^(−s) with s = (t − τ)/T after τ, 0 before          eq. 38, corrected

    Eq. 38 is printed without the minus. τ is the time of flight; the echo is highest αT after it.

    >>> envelope(np.array([0.0, 1.0, 2.0, 3.0]), 2.0, 1.0, 0.5, 2.0).round(4).tolist()
    [0.0, 0.0, 1.0827, 0.5861]
    """
    A, _, _ = _envelope(t, A0, τ, T, α)
    return A


def printed_envelope(
    t: Array, A0: Array | float, τ: Array | float, T: Array | float, α: Array | float
) -> Array:
    """Eq. 38 to the letter, A₀ s^α e^s: an echo that grows without end."""
    s = np.maximum((t - τ) / T, 0.0)
    return A0 * s**α * np.exp(np.minimum(s, STEEPEST))


def _envelope(
    t: Array, A0: Array | float, τ: Array | float, T: Array | float, α: Array | float
) -> tuple[Array, Array, Array]:
    """A(t), and with it A/A₀ and s, 1 where there is no echo; no parameters are too wild for it.

    s^α e^(−s) = e^(α ln s − s), whose exponent is bounded.
    """
    rising = np.asarray(T) > TINY
    s = (t - τ) / np.where(rising, T, 1.0)
    after = rising & (s > TINY)
    s = np.where(after, s, 1.0)
    shape = np.where(after, np.exp(np.minimum(α * np.log(s) - s, STEEPEST)), 0.0)
    return A0 * shape, shape, s


@dataclass(frozen=True, slots=True, eq=False)
class Echo(Sensor):
    """x = (A₀, τ, T, α) in V, s, s, 1: parameters to be estimated, no pose.

    z : (…, k) the envelope at all sample times, which may as well be told in ms, if τ and T are.
    """

    times: Array  # (k,) s
    sigma: Array | float  # V, of each sample : (…)

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """A sample for each time."""
        return (Quantity("amplitude", "V"),) * len(self.times)

    def h(self, x: Array) -> Array:
        """A(t) at each time : (…, k) V          eq. 38"""
        A0, τ, T, α = (x[..., i, None] for i in range(4))
        return envelope(self.times, A0, τ, T, α)

    def H(self, x: Array) -> Array:
        """∂A/∂x : (…, k, 4); with s = (t − τ)/T, after τ:

        ∂A/∂A₀ = A/A₀        ∂A/∂τ = A (1 − α/s)/T        ∂A/∂T = A (s − α)/T        ∂A/∂α = A ln s
        """
        A0, τ, T, α = (x[..., i, None] for i in range(4))
        A, shape, s = _envelope(self.times, A0, τ, T, α)
        per_T = 1 / np.where(T > TINY, T, 1.0)
        return np.stack([shape, A * (1 - α / s) * per_T, A * (s - α) * per_T, A * np.log(s)], -1)

    def R(self, x: Array) -> Array:
        """σ² I : (…, k, k)"""
        R = np.asarray(self.sigma)[..., None, None] ** 2 * np.eye(len(self.times))
        return alike(R, x.shape[:-1])
