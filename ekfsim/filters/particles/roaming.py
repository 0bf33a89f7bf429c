"""Crowds whose number of particles varies, of many runs side by side."""

from dataclasses import dataclass, fields, replace
from typing import Any, TypeVar

import numpy as np

from ekfsim.filters.belief import Correction, Particles, Prediction
from ekfsim.filters.particles.kld import FEWEST
from ekfsim.geometry import Array, Integers
from ekfsim.geometry.soa import from_soa, soa_zeros, to_soa

Told = TypeVar("Told", Prediction, Correction)

Groups = list[tuple[Integers, int]]  # the rows of runs, and how many particles are theirs


@dataclass(frozen=True, slots=True)
class Roaming(Particles):
    """A crowd whose number varies. Of each run those behind its number have weight 0."""

    number: Integers  # (…) how many particles there are
    slow: Array  # (…) how well readings were explained, over long …
    fast: Array  # (…) … and lately

    @property
    def astray(self) -> Array:
        """(…) which share of the next crowd is drawn from anywhere: max(0, 1 − fast/slow)"""
        share: Array = np.maximum(1 - self.fast / self.slow, 0.0)
        return share

    def groups(self, most: int) -> Groups:
        """Runs with about as many particles, and the length of their crowds: a power of two times
        the fewest, or `most`. So none does the work of the largest, and its sums are the same alone
        as among others.
        """
        number = self.number.reshape(-1)
        length = FEWEST * 2 ** np.ceil(np.log2(np.maximum(number / FEWEST, 1))).astype(int)
        length = np.minimum(length, most)
        return [(np.flatnonzero(length == p), p) for p in np.unique(length).tolist()]

    def part(self, rows: Integers, p: int) -> Particles:
        """The crowds of some runs, of p particles each; those beyond its number weigh nothing."""
        n = self.mean.shape[-1]
        states = self.states.reshape(-1, *self.states.shape[-2:])
        states = from_soa(to_soa(states, 1)[:, rows, :p], 1)
        weights = self.weights.reshape(-1, self.weights.shape[-1])[rows, :p]
        if (more := p - weights.shape[-1]) > 0:
            padding = np.broadcast_to(states[:, :1], (len(rows), more, n))
            states = from_soa(np.concatenate([to_soa(states, 1), to_soa(padding, 1)], axis=-1), 1)
            weights = np.pad(weights, ((0, 0), (0, more)))
        return Particles(
            self.mean.reshape(-1, n)[rows], self.covariance.reshape(-1, n, n)[rows], states, weights
        )

    def whole(self, parts: list[Particles], groups: Groups) -> "Roaming":
        """The crowds of all runs, from those of its groups; nothing is learnt of itself."""
        axes, n = self.mean.shape[:-1], self.mean.shape[-1]
        N, p = self.number.size, int(self.number.max())
        x, P, states, weights = (
            np.empty((N, n)), np.empty((N, n, n)), soa_zeros((N, p), n), np.zeros((N, p)),
        )  # fmt: skip
        for part, (rows, _) in zip(parts, groups, strict=True):
            x[rows], P[rows] = part
            of_them = min(p, part.weights.shape[-1])
            states[rows, :of_them] = part.states[:, :of_them]
            states[rows, of_them:] = part.states[:, :1]
            weights[rows, :of_them] = part.weights[:, :of_them]
        return Roaming(
            x.reshape(*axes, n), P.reshape(*axes, n, n), states.reshape(*axes, p, n),
            weights.reshape(*axes, p), self.number, self.slow, self.fast,
        )  # fmt: skip


def together(parts: list[Told], groups: Groups, axes: tuple[int, ...]) -> Told:
    """What was told of groups of runs, of all of them : (…)"""
    told = dict[str, Any]()
    for field in fields(parts[0]):
        first: Any = getattr(parts[0], field.name)
        if not isinstance(first, np.ndarray):
            continue
        whole = np.empty((sum(len(rows) for rows, _ in groups), *first.shape[1:]), first.dtype)
        for part, (rows, _) in zip(parts, groups, strict=True):
            whole[rows] = getattr(part, field.name)
        told[field.name] = whole.reshape((*axes, *first.shape[1:]))
    return replace(parts[0], **told)
