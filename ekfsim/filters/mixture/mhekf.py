"""Assumes that the map is right and each reading of one of its walls, whichever that is.

The multiple-hypothesis extended Kalman filter: an EKF for every answer to "which wall?".
"""

import math
from dataclasses import dataclass, replace
from typing import ClassVar, NamedTuple, Self

import numpy as np

from ekfsim.filters import kalman
from ekfsim.filters.belief import Belief, Correction, Gaussian, Mixture, Prediction, Refused
from ekfsim.filters.mixture.merging import Few, moments, reduced
from ekfsim.filters.mixture.places import inserted, mixed, part, placed, where_used
from ekfsim.filters.mixture.relocating import Found, Memory, sought, span
from ekfsim.filters.protocol import Beginning
from ekfsim.filters.tuning import Tuning
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.protocols import Alternatives, Motion, Parting, Sensor

PLACES = 2048  # from which a robot that was carried away is sought


class Answers(NamedTuple):
    """What a reading would make of each hypothesis and each of its walls, c in all."""

    posterior: Gaussian  # (…, c, n), (…, c, n, n)
    correction: Correction
    weights: Array  # (…, c), their sum is 1
    walls: Integers  # (…, c)
    log: Array  # (…) of the density that the mixture has for the reading
    parting: bool  # whether the sensor's reading may be of one thing or another


@dataclass(frozen=True)
class MHEKF:
    """Gaussian sum filter: Alspach & Sorenson, Nonlinear Bayesian estimation using Gaussian sum
    approximations, 1972; hypotheses that are many merged as by Salmond, 1990.

    Every hypothesis is filtered as the EKF does. Where a beam may meet several walls it parts into
    as many, each weighed by the share of its belief that sees the wall and by the reading.
    """

    remark: ClassVar[str] = ""
    gate: float | None = None  # probability; as the EKF's, of the heaviest hypothesis
    headings: tuple[int, ...] = (2,)  # which entries of the state are headings, kept in (−π, π]
    hypotheses: int = Tuning.hypotheses  # at most
    places: Array | None = None  # (p, n) where a robot that was carried away may be; None: unknown

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so."""
        places = None if beginning.places is None else beginning.places(PLACES)
        return cls(beginning.gate, beginning.headings, beginning.tuning.hypotheses, places)

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Mixture, Prediction]:
        """xᵢ⁻ = f(xᵢ, u)      Pᵢ⁻ = F Pᵢ Fᵀ + G M Gᵀ + Q, of each hypothesis. F and G told are
        those of the heaviest; u : (…, m)
        """
        before = mixed(belief)
        if before.weights.shape[-1] == 1:
            f, F, G, M, Q = motion.linearize(before.mean, u)
            P = kalman.predict(before.covariance, F, G, M, Q)
            after = replace(mixed(Gaussian(f, P)), memory=_moved(before, motion, u))
            return after, Prediction(F, G)
        f, F, G, M, Q = motion.linearize(before.means, u[..., None, :])
        P = kalman.predict(before.covariances, F, G, M, Q)
        memory = _moved(before, motion, u)
        after = self._together(replace(before, means=f, covariances=P, memory=memory))
        return after, Prediction(F[..., 0, :, :], G[..., 0, :, :])

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Mixture, Correction]:
        """wᵢⱼ ∝ wᵢ · share of wall j · N(z − hⱼ; 0, Sⱼ), each Gaussian revised by its own wall. The
        correction told is that of the heaviest after it. A reading that is refused changes neither
        hypotheses nor weights. z : (…, k)
        """
        before = mixed(prior)
        answers = self._answers(before, sensor, z)
        few = reduced(*answers.posterior, answers.weights, self.hypotheses, self.headings)
        told = _picked(answers.correction, few.heaviest[..., 0])
        rule = kalman.Rule(self.gate, skip, self.headings)
        refused = kalman.refusal(z, told.predicted, told.nis, rule)
        many = answers.weights.shape[-1] // before.weights.shape[-1]  # walls of each hypothesis
        walls = np.take_along_axis(answers.walls, few.heaviest, axis=-1)
        after = self._mixture(few, walls, few.heaviest // many)
        after = replace(where_used(refused, after, before), memory=before.memory)
        if self.places is not None and answers.parting:
            after = self._relocated(after, before, sensor, z, answers.log, refused)
        return after, replace(told, refused=refused)

    def _relocated(
        self,
        after: Mixture,
        before: Mixture,
        sensor: Sensor,
        z: Array,
        log: Array,
        refused: Integers,
    ) -> Mixture:
        """After a reading, whose density in the mixture has this log : (…); where the robot was
        probably carried away since, with hypotheses of where it may be now.
        """
        assert self.places is not None
        memory = before.memory
        if not isinstance(memory, Memory):
            memory = Memory.empty(before.mean.shape[:-1])
        surprise = span(sensor.h(self.places)) - log
        memory = memory.read(sensor, z, surprise, refused == Refused.NOT)
        lost = memory.lost
        if not lost.any():
            return replace(after, memory=memory)
        after = placed(after, self.hypotheses)
        for readings in np.unique(memory.since[lost]).tolist():
            rows = lost & (memory.since == readings)
            found = sought(memory.last(readings, rows), self.places, self.headings)
            more = self._with(found, memory.doubt[rows], part(after, rows))
            after = inserted(after, rows, more)
        return replace(after, memory=memory.calmed(lost))

    def _with(self, found: Found, doubt: Array, before: Mixture) -> Mixture:
        """Hypotheses of r runs, and with them those of places that were found, which weigh as much
        as the doubt : (r,) says.
        """
        share = 1 / (1 + np.exp(-doubt))[..., None]
        likely = np.exp(found.log - found.log.max(axis=-1, keepdims=True))
        likely = share * likely / likely.sum(axis=-1, keepdims=True)
        few = reduced(
            np.concatenate([before.means, found.means], axis=-2),
            np.concatenate([before.covariances, found.covariances], axis=-3),
            np.concatenate([(1 - share) * before.weights, likely], axis=-1),
            self.hypotheses,
            self.headings,
        )
        known = few.heaviest < before.weights.shape[-1]
        at = np.where(known, few.heaviest, 0)
        walls, parents = (
            np.where(known, np.take_along_axis(of, at, axis=-1), -1)
            for of in (before.walls, before.parents)
        )
        return placed(self._mixture(few, walls, parents), self.hypotheses)

    def _answers(self, before: Mixture, sensor: Sensor, z: Array) -> Answers:
        """Every hypothesis revised by every line that the sensor may be taken for there."""
        alone = before.weights.shape[-1] == 1
        x, P = (before.mean, before.covariance) if alone else (before.means, before.covariances)
        may = sensor.alternatives(x, P) if isinstance(sensor, Parting) else None
        parting = may is not None
        if may is None:
            h, H, R = sensor.linearize(x)
            none = np.full((*h.shape[:-1], 1), -1)
            may = Alternatives(
                h[..., None, :], H[..., None, :, :], R[..., None, :, :], np.ones(none.shape), none
            )
        one = alone and may.share.shape[-1] == 1
        z = z if alone else z[..., None, :]
        rule = kalman.Rule(None, False, self.headings)
        if one:  # an EKF
            line = may.h[..., 0, :], may.H[..., 0, :, :], may.R[..., 0, :, :]
            reading = kalman.Linearized(z, line[0], sensor.residual(z, line[0]), *line[1:])
            (x, P), correction = kalman.update(Gaussian(x, P), reading, rule)
            posterior = Gaussian(x[..., None, :], P[..., None, :, :])
            log = _log_likelihood(correction)
            return Answers(posterior, _spread(correction), before.weights, may.wall, log, parting)
        z = z[..., None, :]
        ν = sensor.residual(z, may.h)
        z = np.broadcast_to(z, ν.shape)
        a = may.share.shape[-1]
        x = np.repeat(x[..., None, :], a, axis=-2)
        P = np.repeat(P[..., None, :, :], a, axis=-3)
        reading = kalman.Linearized(z, may.h, ν, may.H, may.R)
        (x, P), correction = kalman.update(Gaussian(x, P), reading, rule)
        weights = before.weights[..., None] if not alone else before.weights[..., :1]
        log = _log_likelihood(correction) + _log(np.asarray(weights * may.share))
        top = np.max(log, axis=tuple(range(before.mean.ndim - 1, log.ndim)), keepdims=True)
        likely = np.exp(log - np.where(np.isfinite(top), top, 0.0))
        axes, c = before.mean.shape[:-1], int(np.prod(log.shape[before.mean.ndim - 1 :]))
        w = likely.reshape(*axes, c)
        total = w.sum(axis=-1, keepdims=True)
        prior_weights = np.zeros_like(w)
        prior_weights[..., ::a] = before.weights
        w = np.where(total > 0, w / np.where(total > 0, total, 1.0), prior_weights)
        n = x.shape[-1]
        return Answers(
            Gaussian(x.reshape(*axes, c, n), P.reshape(*axes, c, n, n)),
            _flat(correction, axes, c),
            w,
            may.wall.reshape(*axes, c),
            _log(total[..., 0]) + top.reshape(axes),
            parting,
        )

    def _mixture(self, few: Few, walls: Integers, parents: Integers) -> Mixture:
        """A few Gaussians with mean and covariance of all; the wall of each, and which it came of :
        (…, h)
        """
        x, P = moments(few.means, few.covariances, few.weights, self.headings)
        return Mixture(
            x, P, few.means, few.covariances, few.weights, walls, few.merged, few.pruned, parents
        )

    def _together(self, mixture: Mixture) -> Mixture:
        """The same with mean and covariance of all its hypotheses."""
        x, P = moments(mixture.means, mixture.covariances, mixture.weights, self.headings)
        return replace(mixture, mean=x, covariance=P)


def _moved(before: Mixture, motion: Motion, u: Array) -> Memory | None:
    """What is remembered after a motion input."""
    return before.memory.moved(motion, u) if isinstance(before.memory, Memory) else None


def _log_likelihood(correction: Correction) -> Array:
    """log N(ν; 0, S) : (…), −∞ where nothing was predicted or read; 0 where nothing is uncertain

    As a logarithm: an impossible reading must not make all hypotheses equal.
    """
    sign, log_det = np.linalg.slogdet(np.nan_to_num(correction.S))
    k = correction.S.shape[-1]
    log_det = np.where(sign > 0, log_det, 0.0)
    log = -0.5 * (np.nan_to_num(correction.nis) + log_det + k * math.log(2 * math.pi))
    return np.where(np.isnan(correction.innovation).any(axis=-1), -np.inf, log)


def _log(share: Array) -> Array:
    """log share, −∞ of none."""
    return np.where(share > 0, np.log(np.where(share > 0, share, 1.0)), -np.inf)


def _spread(correction: Correction) -> Correction:
    """A correction with an axis of one hypothesis."""
    return _flat(correction, correction.nis.shape, 1)


def _flat(correction: Correction, axes: tuple[int, ...], c: int) -> Correction:
    """Corrections of hypotheses and their walls on one axis c."""
    k, n = correction.H.shape[-2:]
    return Correction(
        correction.predicted.reshape(*axes, c, k),
        correction.innovation.reshape(*axes, c, k),
        correction.R.reshape(*axes, c, k, k),
        correction.S.reshape(*axes, c, k, k),
        correction.H.reshape(*axes, c, k, n),
        correction.K.reshape(*axes, c, n, k),
        correction.nis.reshape(*axes, c),
        np.asarray(correction.refused).reshape(*axes, c),
    )


def _picked(correction: Correction, which: Integers) -> Correction:
    """The correction of one hypothesis and wall. which : (…)"""

    def of(numbers: Array) -> Array:
        index = np.asarray(which).reshape(*which.shape, *(1,) * (numbers.ndim - which.ndim))
        return np.take_along_axis(numbers, index, axis=which.ndim).squeeze(which.ndim)

    return Correction(
        of(correction.predicted), of(correction.innovation), of(correction.R), of(correction.S),
        of(correction.H), of(correction.K), of(correction.nis),
        np.take_along_axis(correction.refused, which[..., None], axis=-1)[..., 0],
    )  # fmt: skip
