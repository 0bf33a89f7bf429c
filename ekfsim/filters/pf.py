"""The particle filter."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, ClassVar, Self

import numpy as np

from ekfsim.filters.arithmetic.algebra import (
    gain_of_moments,
    inverse,
    normalized_square,
    symmetric,
    wrapped,
)
from ekfsim.filters.arithmetic.square_root import square_root
from ekfsim.filters.arithmetic.unscented import weighted_mean
from ekfsim.filters.belief import Belief, Correction, Particles, Prediction, Refused
from ekfsim.filters.kalman import Rule, refusal
from ekfsim.filters.protocol import Beginning
from ekfsim.filters.tuning import CROWDS
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.protocols import Motion, Sensor, angles

if TYPE_CHECKING:
    from numpy.random import Generator

KEPT = 10  # particles that even the sharpest reading leaves, or so


@dataclass(frozen=True)
class PF:
    """Bootstrap particle filter: Gordon, Salmond & Smith, 1993; Thrun, Burgard & Fox, 2005, Tables
    4.3 and 4.4; the particles that are drawn anew are parted by a kernel (regularised).

    The one filter that is not pure: it draws, and each draw advances the generator of its run. Each
    run has its own, and draws as many numbers whatever they are, so that a run is the same alone as
    among others.
    """

    remark: ClassVar[str] = ""
    generators: tuple["Generator", ...]  # one for each run, in the order of the leading axes
    # probability; a reading whose NIS lies beyond that χ² quantile is refused
    gate: float | None = None
    headings: tuple[int, ...] = (2,)  # which entries of the state are headings, kept in (−π, π]
    count: int = CROWDS["pf"]  # particles of each run

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so, with generators of its own."""
        if beginning.generators is None:
            raise ValueError("a particle filter needs generators to draw from")
        generators = tuple(beginning.generators())
        return cls(generators, beginning.gate, beginning.headings, beginning.tuning.crowd("pf"))

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Particles, Prediction]:
        """xᵢ⁻ = f(xᵢ, u) + G(xᵢ, u) wᵢ + qᵢ      wᵢ ~ N(0, M)      qᵢ ~ N(0, Q)          u : (…, m)

        The input's noise goes through the model's own G, for a model may mean another way for its
        noise than for its input (document 000: the gyro turns, the wheels err). F and G told are
        those at the mean.
        """
        crowd = self._crowd(belief)
        _, F, G, M, Q = motion.linearize(crowd.mean, u)
        each = u[..., None, :]
        noise = self._normals(M, crowd.mean)
        G_each = motion.G(crowd.states, each)
        states = motion.f(crowd.states, each) + sum(
            G_each[..., j] * noise[..., j, None] for j in range(noise.shape[-1])
        )
        if np.ndim(Q):
            states = states + self._normals(np.asarray(Q), crowd.mean)
        return self._summed(wrapped(states, self.headings), crowd.weights), Prediction(F, G)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Particles, Correction]:
        """wᵢ ∝ wᵢ⁻ exp(−½ νᵢᵀ Rᵢ⁻¹ νᵢ) / √|Rᵢ|      νᵢ = z − h(xᵢ)          z : (…, k)

        A particle that predicts no reading explains none: its weight becomes 0. If all do so, the
        reading is refused. Where fewer than half of the particles count, 1/Σ wᵢ² < p/2, they are
        drawn anew by their weights, and parted.

        What is told are the moments of the prior's readings: ẑ = Σ wᵢ h(xᵢ), S = their spread + Σ
        wᵢ Rᵢ, K = P_xz S⁻¹, and P_zx P⁺ for H. They judge the reading; they do not move the
        particles.
        """
        crowd = self._crowd(prior)
        weights, used, told = self._weighed(crowd, sensor, z, skip)
        few = used & (1 / np.sum(weights**2, axis=-1, keepdims=True) < self.count / 2)
        weighted = self._summed(crowd.states, weights)
        states = np.where(few[..., None], self._drawn_anew(weighted), crowd.states)
        posterior = self._summed(states, np.where(few, 1 / self.count, weights))
        return Particles(
            np.where(used, posterior.mean, crowd.mean),
            np.where(used[..., None], posterior.covariance, crowd.covariance),
            posterior.states,
            posterior.weights,
        ), told

    def _weighed(
        self,
        crowd: Particles,
        sensor: Sensor,
        z: Array,
        skip: Booleans | bool,
        about: Array | None = None,
    ) -> tuple[Array, Booleans, Correction]:
        """The weights after a reading : (…, p), where it could be used : (…, 1), and what is told
        of it.

        about : (…, n, n), the covariance of the states about its own that a particle stands for,
        which makes the reading H C Hᵀ less sure; None: for none but its own
        """
        h, H, R = sensor.linearize(crowd.states)
        R = np.broadcast_to(R, (*h.shape, h.shape[-1]))
        told, spread = self._told(crowd, sensor, z, h, R, skip)
        share = KEPT / self._number(crowd)
        grain = spread * (share ** (2 / min(h.shape[-1], crowd.mean.shape[-1])))[..., None]
        if about is not None:
            R = R + H @ about[..., None, :, :] @ H.mT
        log = _log_likelihood(sensor.residual(z[..., None, :], h), R, grain)
        seen = np.where(crowd.weights > 0, log, -np.inf)
        best = seen.max(axis=-1, keepdims=True)
        # the best of them is not 0
        weights = crowd.weights * np.exp(seen - np.where(np.isfinite(best), best, 0.0))
        used: Booleans = np.isfinite(best) & (np.asarray(told.refused)[..., None] == Refused.NOT)
        weights = np.where(used, weights, crowd.weights)
        return weights / weights.sum(axis=-1, keepdims=True), used, told

    def _number(self, crowd: Particles) -> Array:
        """Of how many particles each crowd is : (…, 1)"""
        return np.full((*crowd.weights.shape[:-1], 1), float(self.count))

    def _told(
        self, crowd: Particles, sensor: Sensor, z: Array, h: Array, R: Array, skip: Booleans | bool
    ) -> tuple[Correction, Array]:
        """The correction in numbers that people know, and the spread of the particles' readings :
        (…, k, k)
        """
        met: Booleans = np.asarray(~np.isnan(h).any(axis=-1))
        weights = np.where(met, crowd.weights, 0.0)
        total = weights.sum(axis=-1, keepdims=True)
        weights = np.divide(weights, total, out=np.full_like(weights, np.nan), where=total > 0)
        likeliest = np.argmax(np.nan_to_num(weights), axis=-1)[..., None, None]
        about = np.take_along_axis(h, likeliest, axis=-2)
        h, R = np.where(met[..., None], h, about), np.where(met[..., None, None], R, 0.0)
        predicted = weighted_mean(h, weights, angles(sensor.outputs), about[..., 0, :])
        δz = sensor.residual(h, predicted[..., None, :])
        δx = wrapped(crowd.states - crowd.mean[..., None, :], self.headings)
        weighted = weights[..., None] * δz
        spread, noise = symmetric(δz.mT @ weighted), np.sum(weights[..., None, None] * R, axis=-3)
        cross, S, innovation = δx.mT @ weighted, spread + noise, sensor.residual(z, predicted)
        nis = normalized_square(innovation, S)
        refused = refusal(z, predicted, nis, Rule(self.gate, skip, self.headings))
        H = np.nan_to_num(cross).mT @ inverse(crowd.covariance)
        K = gain_of_moments(cross, S)
        return Correction(predicted, innovation, noise, S, H, K, nis, refused), spread

    def _crowd(self, belief: Belief) -> Particles:
        """The belief as particles; those of a Gaussian are drawn from it, and stand for its own
        mean and covariance.
        """
        if isinstance(belief, Particles):
            return belief
        x, P = belief
        states = wrapped(x[..., None, :] + self._normals(P, x), self.headings)
        return Particles(x, P, states, np.full(states.shape[:-1], 1 / self.count))

    def _drawn_anew(self, crowd: Particles) -> Array:
        """Particles of equal weight in place of a weighted crowd : (…, p, n), no two of them the
        same.

        x' = x̄ + √(1 − b²) (x − x̄) + b e      e ~ N(0, P)      b by Silverman's rule

        Copies alone would leave few different particles after a sharp reading. A kernel of the
        crowd's own shape parts them; moved towards the mean by as much, they keep mean and
        covariance: Musso, Oudjane & Le Gland, 2001, and Liu & West, 2001, in: Doucet et al.,
        Sequential Monte Carlo Methods in Practice, chapters 12 and 10.
        """
        b = float(silverman(*crowd.states.shape[-2:]))
        hit = systematic(crowd.weights, self._uniforms(crowd.mean))
        x_mean = crowd.mean[..., None, :]
        away = wrapped(
            np.take_along_axis(crowd.states, hit[..., None], axis=-2) - x_mean, self.headings
        )
        kernel = self._normals(crowd.covariance, crowd.mean)
        return wrapped(x_mean + math.sqrt(1 - b * b) * away + b * kernel, self.headings)

    def _summed(self, states: Array, weights: Array) -> Particles:
        """A crowd with its mean, circular where it is a heading, and its covariance."""
        mean = weighted_mean(states, weights, self.headings)
        δ = wrapped(states - mean[..., None, :], self.headings)
        return Particles(mean, symmetric(δ.mT @ (weights[..., None] * δ)), states, weights)

    def _normals(self, covariance: Array, x: Array) -> Array:
        """One draw from N(0, covariance) for each particle : (…, p, m). covariance : (…, m, m), x :
        (…, n)
        """
        m = covariance.shape[-1]
        drawn = np.empty((len(self.generators), self.count, m))
        for generator, of_run in zip(self.generators, drawn, strict=True):
            generator.standard_normal(out=of_run)
        drawn = drawn.reshape(*x.shape[:-1], self.count, m)
        # each column of L by each number drawn; a product of matrices, for there are many
        noise: Array = (square_root(covariance) @ drawn.mT).mT
        return noise

    def _uniforms(self, x: Array) -> Array:
        """One number in [0, 1) for each run : (…)"""
        return np.array([generator.random() for generator in self.generators]).reshape(x.shape[:-1])


def silverman(p: Integers | int, n: int) -> Array:
    """b = (4/((n + 2) p))^(1/(n + 4)) : (…), how wide a kernel parts p particles of n dimensions,
    by the standard deviations of the crowd: Silverman's rule. p : (…)
    """
    b: Array = (4 / ((n + 2) * np.asarray(p, float))) ** (1 / (n + 4))
    return b


def systematic(weights: Array, u: Array) -> Integers:
    """Which particle each of p pointers (i + u)/p, i = 0 … p − 1, hits on the weights laid end to
    end : (…, p)

    Systematic resampling: Thrun, Burgard & Fox, Table 4.4. weights : (…, p), u : (…) in [0, 1)

    >>> systematic(np.array([0.4, 0.0, 0.3, 0.3]), np.array(0.9)).tolist()
    [0, 2, 3, 3]
    """
    p = weights.shape[-1]
    ends = np.cumsum(weights, axis=-1)
    # pointers before each end
    before = np.ceil(p * (ends / ends[..., -1:]) - u[..., None]).astype(np.int64)
    runs = math.prod(weights.shape[:-1])
    tally = np.bincount(
        (before.reshape(runs, p) + (p + 1) * np.arange(runs)[:, None]).ravel(),
        minlength=(p + 1) * runs,
    )
    hit: Integers = np.cumsum(tally.reshape(*weights.shape[:-1], p + 1), axis=-1)[..., :p]
    return hit


def _log_likelihood(ν: Array, R: Array, grain: Array) -> Array:
    """log N(ν; 0, R) but for a constant : (…, p), −∞ where nothing was predicted. ν : (…, p, k),
    grain : (…, k, k)

    The grain is the covariance of what holds some ten of p particles, in d dimensions their spread
    by (10/p)^(2/d). It is added to R: a sensor that is sharper than the crowd is dense leaves the
    ten nearest in place of one, from which no crowd could recover.
    """
    R = R + np.nan_to_num(grain)[..., None, :, :]
    if R.shape[-1] == 1:
        # all particles alike, and no noise: nothing to tell
        r = np.where(R[..., 0, 0] > 0, R[..., 0, 0], 1.0)
        log: Array = -0.5 * (ν[..., 0] ** 2 / r + np.log(r))
    else:
        sign, log_det = np.linalg.slogdet(np.where(np.isnan(R), 0.0, R))
        log = -0.5 * (np.vecdot(ν, np.matvec(inverse(R), ν)) + np.where(sign > 0, log_det, 0.0))
    return np.where(np.isnan(log), -np.inf, log)
