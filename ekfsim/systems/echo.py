"""When an ultrasonic echo arrives, by an unscented Kalman filter (document 001, IV B).

The three steps of the document: acquire the echo, take the modulus of its Hilbert transform,
estimate A₀, τ, T and α of eq. 38 from that. And what it is measured against: a threshold detector,
and the Cramér-Rao bound.
"""

import math
from dataclasses import dataclass

import numpy as np

from ekfsim.filters.belief import Belief, Gaussian
from ekfsim.filters.ukf import UKF
from ekfsim.geometry import Array, Integers
from ekfsim.models.motions.constant import Constant
from ekfsim.models.sensors.echo import Echo, envelope

SOUND = 343.0  # m/s, in air of 20 °C
PASSES = 5  # over the samples, each trusting them more
COMBS = 24  # each pass takes every 24th sample, then every 24th of the next ones, …
WIDER = 25.0  # of the covariance from pass to pass: what a pass has learnt counts 1/25 in the next
# √Q per comb, in ms, 1 and shares of the peak: so little that it only keeps P from closing
WANDER = 1e-6
SHARE = 0.2  # of the peak, for a threshold: the best of 5 to 70 % between 10 and 20 dB
BEFORE, AFTER = 4.0, 6.0  # √α T, around the highest sample: the part of the envelope that is fitted


@dataclass(frozen=True)
class Pair:
    """An SR40 emitter and its receiver: what is known of an echo before it is heard.

    T and α are specific to a pair.
    """

    rise: float = 1.5e-4  # s, T
    power: float = 2.0  # α
    spread: float = 0.1  # σ of T and of α from echo to echo, per unit of them
    carrier: float = 40e3  # Hz
    rate: float = 200e3  # samples per s
    nearest: float = 0.1  # m; before its echo there is only noise
    farthest: float = 2.0  # m

    @property
    def times(self) -> Array:
        """When samples are taken : (k,) s

        From the emission until an echo from the farthest has passed.
        """
        last = self.flight(self.farthest) + (self.power + AFTER * math.sqrt(self.power)) * self.rise
        return np.arange(math.ceil(last * self.rate)) / self.rate

    @property
    def typical(self) -> Array:
        """(A₀, τ, T, α) of an echo of height 1 V that arrives at 0 s : (4,)"""
        return np.array([1 / height(1.0, self.power), 0.0, self.rise, self.power])

    def flight(self, distance: Array | float) -> Array | float:
        """τ = 2 r / c in s, there and back"""
        return 2 * distance / SOUND

    def received(self, echo: Array) -> Array:
        """A(t) cos 2πf (t − τ) : (…, k) V, without noise

        echo = (A₀, τ, T, α) : (…, 4) in V, s, s, 1
        """
        A0, τ, T, α = (echo[..., i, None] for i in range(4))
        carried: Array = envelope(self.times, A0, τ, T, α) * np.cos(
            2 * math.pi * self.carrier * (self.times - τ)
        )
        return carried


def height(A0: Array | float, α: Array | float) -> Array | float:
    """A₀ α^α e^(−α), the envelope's highest point, αT after its beginning.

    >>> height(2.0, 1.0).round(4)
    np.float64(0.7358)
    """
    return A0 * np.float64(α) ** α * np.exp(-α)


def hilbert_envelope(samples: Array) -> Array:
    """|s + i ŝ|, ŝ the Hilbert transform of the samples : (…, k)"""
    from scipy.signal import hilbert

    return np.abs(hilbert(samples, axis=-1))


def noise_of(samples: Array, pair: Pair) -> Array:
    """σ of the noise, from the samples before any echo : (…)"""
    quiet = samples[..., pair.times < pair.flight(pair.nearest)]
    sigma: Array = np.sqrt(np.mean(quiet**2, axis=-1))
    return sigma


def without_noise(measured: Array, sigma: Array) -> Array:
    """√max(e² − 2σ², 0): noise lifts an envelope, for E e² = A² + 2σ².

    measured : (…, k), sigma : (…)
    """
    return np.sqrt(np.maximum(measured**2 - 2 * sigma[..., None] ** 2, 0.0))


def highest(measured: Array, pair: Pair) -> Integers:
    """The sample around which an envelope is highest, averaged over αT : (…)"""
    wide = max(round(pair.power * pair.rise * pair.rate), 1) | 1
    sums = np.cumsum(
        np.concatenate([np.zeros_like(measured[..., :1]), measured**2], axis=-1), axis=-1
    )
    peak: Integers = np.argmax(sums[..., wide:] - sums[..., :-wide], axis=-1) + wide // 2
    return peak


def estimate_echo(measured: Array, sigma: Array, pair: Pair) -> Gaussian:
    """(A₀, τ, T, α) in V, s, s, 1 and their covariance, of a Hilbert envelope (…, k).

    sigma : (…), of the noise in the signal.

    The first guess is the pair's typical echo, put where the envelope is highest. The parameters
    are a state that does not move (models/constant), the samples its readings (models/echo): combs
    of samples, each seeing the whole echo. The first pass takes them as if their σ were a tenth of
    the peak, which covers what the guess is wrong by; each further pass a tenth of that, until it
    is the noise. Within, times are ms from the highest sample and amplitudes shares of the peak:
    all four numbers near 1.
    """
    scale, peak, z = _cut(without_noise(measured, sigma), pair)
    times = (np.arange(z.shape[-1]) - _reach(pair)[0]) / pair.rate * 1e3
    # twice the variance: a Hilbert envelope's noise has half the band
    noise = math.sqrt(2) * sigma / scale[..., 0]
    first = pair.typical * [1, 1, 1e3, 1]
    first[1] = -first[2] * first[3]
    P_first = (
        np.diag([0.5 * first[0], 0.5 * first[1], pair.spread * first[2], pair.spread * first[3]])
        ** 2
    )
    axes = z.shape[:-1]
    belief: Belief = Gaussian(
        np.broadcast_to(first, (*axes, 4)), np.broadcast_to(P_first, (*axes, 4, 4))
    )
    ukf, still = UKF(headings=()), Constant(np.eye(4) * WANDER**2)
    for number in range(1, PASSES + 1):
        trusted = np.maximum(noise, 0.1**number)
        if number > 1:  # never less certain than at first
            P = np.linalg.inv(np.linalg.inv(WIDER * belief.covariance) + np.linalg.inv(P_first))
            belief = Gaussian(belief.mean, P)
        for comb in range(COMBS):
            belief, _ = ukf.predict(belief, still, np.zeros((*axes, 0)))
            belief, _ = ukf.update(belief, Echo(times[comb::COMBS], trusted), z[..., comb::COMBS])
    x = belief.mean * scale
    x[..., 1] += pair.times[peak]
    return Gaussian(x, belief.covariance * (scale[..., :, None] * scale[..., None, :]))


def threshold_crossing(measured: Array, sigma: Array, pair: Pair, share: float = SHARE) -> Array:
    """When an envelope last rose through a share of its peak, before that peak : (…) s, between
    samples by a line.
    """
    z = without_noise(measured, sigma)
    peak = highest(z, pair)[..., None]
    level = share * np.take_along_axis(z, peak, axis=-1)
    below = (z < level) & (np.arange(z.shape[-1]) < peak)
    last = z.shape[-1] - 1 - np.argmax(below[..., ::-1], axis=-1)[..., None]
    low, high = (
        np.take_along_axis(z, np.minimum(last + i, z.shape[-1] - 1), axis=-1) for i in (0, 1)
    )
    rise = np.divide(level - low, high - low, out=np.zeros_like(low), where=high > low)
    crossing: Array = ((last + rise) / pair.rate)[..., 0]
    return crossing


def typical_delay(pair: Pair, share: float = SHARE) -> float:
    """How long after its arrival the pair's typical echo reaches a share of its peak, in s."""
    t = np.linspace(0.0, pair.power * pair.rise, 2001)
    return float(np.interp(share, envelope(t, *pair.typical), t))


def flight_bound(echo: Array, sigma: float, pair: Pair) -> Array:
    """σ of τ that no unbiased estimator undercuts, T and α known as they are : (…) s

    The bound of Cramér and Rao.

    (Σ Hᵀ H/2σ² + P⁻¹)⁻¹: the carrier lets through half of the envelope's information.
    """
    _, H, _ = Echo(pair.times, 1.0).linearize(echo)
    known = np.diag(
        [0.0, 0.0, 1 / (pair.spread * pair.rise) ** 2, 1 / (pair.spread * pair.power) ** 2]
    )
    unit = np.array([1.0, 1e-3, 1e-3, 1.0])  # s become ms, so that the inverse loses no digits
    information = (H.mT @ H / (2 * sigma**2) + known) * unit[:, None] * unit
    return np.sqrt(np.linalg.inv(information)[..., 1, 1]) * 1e-3


def _reach(pair: Pair) -> tuple[int, int]:
    """How many samples before and after the highest one are fitted."""
    wide = math.sqrt(pair.power) * pair.rise * pair.rate
    return math.ceil(BEFORE * wide), math.ceil(AFTER * wide)


def _cut(measured: Array, pair: Pair) -> tuple[Array, Integers, Array]:
    """What makes V and s of the filter's parameters : (…, 4), the highest sample : (…), the part to
    fit : (…, m)
    """
    before, after = _reach(pair)
    peak = np.clip(highest(measured, pair), before, measured.shape[-1] - after)
    z = np.take_along_axis(measured, peak[..., None] + np.arange(-before, after), axis=-1)
    top = np.max(z, axis=-1, keepdims=True)
    one = np.ones_like(top)
    top = np.where(top > 0, top, 1.0)
    return np.concatenate([top, 1e-3 * one, 1e-3 * one, one], axis=-1), peak, z / top
