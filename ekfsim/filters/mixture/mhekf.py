"""Assumes that the map is right and each reading of one of its walls, whichever that is.

The multiple-hypothesis extended Kalman filter: an EKF for every answer to "which wall?".
"""

from dataclasses import dataclass, replace
from typing import ClassVar, Self

import numpy as np

from ekfsim.filters import kalman
from ekfsim.filters.belief import Belief, Correction, Gaussian, Mixture, Prediction, Refused
from ekfsim.filters.mixture.answers import answered, picked
from ekfsim.filters.mixture.merging import Few, moments, reduced
from ekfsim.filters.mixture.places import inserted, mixed, part, placed, where_used
from ekfsim.filters.mixture.relocating import Found, Memory, sought, span
from ekfsim.filters.protocol import Beginning
from ekfsim.filters.tuning import Tuning
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.protocols import Motion, Sensor

PLACES = 2048  # from which a robot that was carried away is sought


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
        answers = answered(before, sensor, z, self.headings)
        few = reduced(*answers.posterior, answers.weights, self.hypotheses, self.headings)
        told = picked(answers.correction, few.heaviest[..., 0])
        rule = kalman.Rule(self.gate, skip, self.headings)
        refused = kalman.refusal(z, told.predicted, told.nis, rule)
        walls, parents = (
            np.take_along_axis(of, few.heaviest, axis=-1) for of in (answers.walls, answers.parents)
        )
        after = self._mixture(few, walls, parents)
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
