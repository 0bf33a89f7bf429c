"""Assumes that whoever cannot explain a reading was carried away, and may be anywhere.

Adaptive Monte Carlo localization: particles as in pf.py, as many as the doubt asks for, and some of
them drawn anew from anywhere when readings cannot be explained.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Self

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.filters.arithmetic.algebra import wrapped
from ekfsim.filters.arithmetic.chi_square import survival
from ekfsim.filters.arithmetic.square_root import square_root
from ekfsim.filters.belief import Belief, Correction, Particles, Prediction, Refused
from ekfsim.filters.particles.drawing import NEAR, Anywhere, Source, drawn_anew, sources
from ekfsim.filters.particles.kld import bins
from ekfsim.filters.particles.roaming import Roaming, together
from ekfsim.filters.pf import PF, silverman
from ekfsim.filters.protocol import Beginning
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.geometry.soa import soa_zeros
from ekfsim.models.protocols import Motion, Sensor, of_rows

if TYPE_CHECKING:
    from numpy.random import Generator

UNEXPLAINED = 1e-3  # a reading that is less probable than this is not wholly explained
SLOW, FAST = 0.01, 0.5  # how quickly the two averages of Table 8.3 follow


@dataclass(frozen=True)
class AMCL(PF):
    """Particle filter with an adaptive number (KLD sampling: Fox, 2003; Thrun, Burgard & Fox, 2005,
    Table 8.4) and with random particles (augmented: Table 8.3).

    `count` is the largest number. Table 8.3 follows the mean likelihood of readings, which falls
    with distance, noise and doubt as well. Here it is how far a reading is explained, min(1, p/p₀),
    p being the probability of a NIS as large as its own, p₀ = 0.001: 1 of what is usual, whatever
    the sensor, and almost 0 of a robot that was carried away.
    """

    anywhere: Anywhere | None = None

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so. Raises UsageError where there is no floor."""
        if beginning.generators is None:
            raise ValueError("a particle filter needs generators to draw from")
        if beginning.anywhere is None:
            raise UsageError(
                "amcl: draws poses from the floor of a map with a boundary, and there is none; "
                "take pf"
            )
        return cls(
            tuple(beginning.generators()),
            beginning.gate,
            beginning.headings,
            beginning.tuning.crowd("amcl"),
            beginning.anywhere,
        )

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Roaming, Prediction]:
        """As in pf.py, of as many particles as there are."""
        crowd = self._crowd(belief)
        axes, N = crowd.mean.shape[:-1], math.prod(crowd.mean.shape[:-1])
        u = np.broadcast_to(u, (*axes, u.shape[-1])).reshape(N, -1)
        moved, made = list[Particles](), list[Prediction]()
        groups = crowd.groups(self.count)
        for rows, p in groups:
            theirs = of_rows(motion, rows)
            alike, prediction = PF.predict(self._of(rows, p), crowd.part(rows, p), theirs, u[rows])
            moved.append(alike)
            made.append(prediction)
        return crowd.whole(moved, groups), together(made, groups, axes)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Roaming, Correction]:
        """w_slow += α_slow (w − w_slow)      w_fast += α_fast (w − w_fast)
        w = min(1, P(χ² > NIS)/p₀)

        The particles are weighed as in pf.py. Where few of them count, or some are to be drawn from
        anywhere, all are drawn anew: each with probability max(0, 1 − w_fast/w_slow) from anywhere,
        else by the weights; as many as KLD sampling asks for.
        """
        crowd = self._crowd(prior)
        axes, N = crowd.mean.shape[:-1], math.prod(crowd.mean.shape[:-1])
        z = np.broadcast_to(z, (*axes, z.shape[-1])).reshape(N, -1)
        skip = np.broadcast_to(skip, axes).reshape(N)
        weighed, corrections = list[Particles](), list[Correction]()
        used = np.zeros(N, bool)
        groups = crowd.groups(self.count)
        for rows, p in groups:
            alike, of_them = crowd.part(rows, p), self._of(rows, p)
            about = self._about(alike, crowd.number.reshape(N)[rows])
            theirs = of_rows(sensor, rows)
            weights, were, told = of_them._weighed(alike, theirs, z[rows], skip[rows], about)
            used[rows] = were[..., 0]
            weighted = of_them._summed(alike.states, weights)
            x, P = np.where(were, weighted.mean, alike.mean), weighted.covariance
            P = np.where(were[..., None], P, alike.covariance)
            weighed.append(Particles(x, P, alike.states, weights))
            corrections.append(told)
        told = together(corrections, groups, axes)
        seen = self._averaged(crowd.whole(weighed, groups), used.reshape(axes), told, z.shape[-1])
        counted = 1 / np.sum(seen.weights**2, axis=-1)
        few = (counted < seen.number / 2) | (seen.astray > 1 / self.count)
        return self._redrawn(seen, used.reshape(axes) & few), told

    def _about(self, crowd: Particles, number: Integers) -> Array | None:
        """C = b² P : (N, n, n), the covariance of the states that each particle stands for in
        crowds so wide that their kernels are narrowed, 0 in all others; None where all are such.

        Of a robot that may be anywhere no particle is as near to the truth as the beam is sharp.
        Weighed as if it stood for itself alone, one of the wrong place would be taken for the
        nearest.
        """
        n = crowd.mean.shape[-1]
        b = silverman(number, n)
        σ = np.sqrt(np.maximum(np.diagonal(crowd.covariance, axis1=-2, axis2=-1), 0.0))
        wide = b * np.max(σ / (NEAR * bins(n, self.headings)), axis=-1)
        if not np.any(wide > 1):
            return None
        share = np.where(wide > 1, b / np.maximum(wide, 1.0), 0.0)
        return np.square(share)[:, None, None] * crowd.covariance

    def _averaged(self, crowd: Roaming, used: Booleans, told: Correction, k: int) -> Roaming:
        """The crowd with its two averages after a reading of k numbers; what the gate refused was
        not explained, either.
        """
        judged = (used | (np.asarray(told.refused) == Refused.GATE)) & ~np.isnan(told.nis)
        now = np.where(judged, np.minimum(survival(told.nis, k) / UNEXPLAINED, 1.0), np.nan)
        return replace(
            crowd, slow=followed(crowd.slow, now, SLOW), fast=followed(crowd.fast, now, FAST)
        )

    def _of(self, rows: Integers, count: int) -> PF:
        """The particle filter of some of the runs, with crowds of so many."""
        generators = tuple(self.generators[row] for row in rows.tolist())
        return PF(generators, self.gate, self.headings, count)

    def _crowd(self, belief: Belief) -> Roaming:
        """The belief as a crowd whose number may vary; of a Gaussian as many are drawn as the bins
        ask for, and they stand for its own mean and covariance.
        """
        if isinstance(belief, Roaming):
            return belief
        axes, n = belief.mean.shape[:-1], belief.mean.shape[-1]
        if isinstance(belief, Particles):
            x, P, states, weights = *belief, belief.states, belief.weights
            number = np.full(axes, weights.shape[-1])
        else:
            x, P = belief
            roots = square_root(P).reshape(-1, n, n)
            drawn = self._drawn(
                self.generators, list(map(Source.of_gaussian, x.reshape(-1, n), roots))
            )
            number = np.array([len(of_run) for of_run in drawn]).reshape(axes)
            p = int(number.max())
            states = soa_zeros((len(drawn), p), n)
            for crowd, of_run in zip(states, drawn, strict=True):
                crowd[: len(of_run)], crowd[len(of_run) :] = of_run, of_run[-1]
            states = wrapped(states, self.headings).reshape(*axes, p, n)
            weights = (np.arange(p) < number[..., None]) / number[..., None]
        return Roaming(x, P, states, weights, number, np.ones(axes), np.ones(axes))

    def _redrawn(self, crowd: Roaming, anew: Booleans) -> Roaming:
        """The crowd, drawn anew in those runs : (…); each draws as many as it needs."""
        if not anew.any():
            return crowd
        axes, n = crowd.mean.shape[:-1], crowd.mean.shape[-1]
        N, number = math.prod(axes), crowd.number.reshape(-1).copy()
        rows = np.flatnonzero(anew)
        drawn = self._drawn(
            [self.generators[row] for row in rows.tolist()],
            list(sources(crowd, rows, self.headings)),
        )
        number[rows] = [len(of_run) for of_run in drawn]
        p = int(number.max())
        states, weights = soa_zeros((N, p), n), np.zeros((N, p))
        kept = min(p, crowd.states.shape[-2])
        states[:, :kept] = crowd.states.reshape(N, -1, n)[:, :kept]
        weights[:, :kept] = crowd.weights.reshape(N, -1)[:, :kept]
        for row, of_run in zip(rows.tolist(), drawn, strict=True):
            states[row], states[row, : len(of_run)] = of_run[0], of_run
            weights[row], weights[row, : len(of_run)] = 0.0, 1 / len(of_run)
        states = wrapped(states, self.headings)
        made = Roaming(
            crowd.mean, crowd.covariance, states.reshape(*axes, p, n), weights.reshape(*axes, p),
            number.reshape(axes), crowd.slow, crowd.fast,
        )  # fmt: skip
        x, P = crowd.mean.reshape(N, n).copy(), crowd.covariance.reshape(N, n, n).copy()
        for rows, length in made.groups(self.count):
            if (these := rows[anew.reshape(N)[rows]]).size:
                alike = made.part(these, length)
                x[these], P[these] = self._summed(alike.states, alike.weights)
        return replace(made, mean=x.reshape(*axes, n), covariance=P.reshape(*axes, n, n))

    def _drawn(self, generators: Sequence["Generator"], of_runs: Sequence[Source]) -> list[Array]:
        assert self.anywhere is not None
        return drawn_anew(generators, of_runs, self.headings, self.count, self.anywhere)


def followed(average: Array, now: Array, α: float) -> Array:
    """average + α (now − average) : (…), as it was where there is nothing to follow"""
    return np.where(np.isnan(now), average, average + α * (now - average))
