"""Assumes that whoever cannot explain a reading was carried away, and may be anywhere.

Adaptive Monte Carlo localization: particles as in pf.py, as many as the doubt asks for, and some of
them drawn anew from anywhere when readings cannot be explained.
"""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, fields, replace
from typing import TYPE_CHECKING, Any, NamedTuple, Self, TypeVar

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.filters.arithmetic.algebra import wrapped
from ekfsim.filters.arithmetic.chi_square import survival
from ekfsim.filters.arithmetic.square_root import square_root
from ekfsim.filters.belief import Belief, Correction, Particles, Prediction, Refused
from ekfsim.filters.pf import PF, silverman
from ekfsim.filters.protocol import Beginning
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.protocols import Motion, Sensor, of_rows

if TYPE_CHECKING:
    from numpy.random import Generator

Told = TypeVar("Told", Prediction, Correction)

MIXED = 1_000_003  # more than there are bins along any axis
FEWEST = 300  # particles, however sure they are
BIN, BIN_ANGLE = 0.2, math.radians(5.0)  # m, rad: what KLD sampling counts as another place
KLD = 0.05  # how far the crowd may be from what it stands for, in nats …
Z_99 = 2.3263478740408408  # … in 99 % of draws: the normal quantile
UNEXPLAINED = 1e-3  # a reading that is less probable than this is not wholly explained
SLOW, FAST = 0.01, 0.5  # how quickly the two averages of Table 8.3 follow
NEAR = 1.5  # bins: σ of the kernel that parts particles, at most

ONE, NOWHERE = np.ones(1), np.zeros((1, 1))  # of a Gaussian: one particle, at its mean

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

    def groups(self, most: int) -> "Groups":
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
        states = self.states.reshape(-1, *self.states.shape[-2:])[rows, :p]
        weights = self.weights.reshape(-1, self.weights.shape[-1])[rows, :p]
        if (more := p - weights.shape[-1]) > 0:
            states = np.concatenate([states, np.repeat(states[:, :1], more, axis=1)], axis=1)
            weights = np.pad(weights, ((0, 0), (0, more)))
        return Particles(
            self.mean.reshape(-1, n)[rows], self.covariance.reshape(-1, n, n)[rows], states, weights
        )

    def whole(self, parts: list[Particles], groups: "Groups") -> "Roaming":
        """The crowds of all runs, from those of its groups; nothing is learnt of itself."""
        axes, n = self.mean.shape[:-1], self.mean.shape[-1]
        N, p = self.number.size, int(self.number.max())
        x, P, states, weights = (
            np.empty((N, n)), np.empty((N, n, n)), np.zeros((N, p, n)), np.zeros((N, p)),
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


class Source(NamedTuple):
    """What the particles of one run are drawn from."""

    ends: Array  # (p,) the weights laid end to end
    mean: Array  # (n,)
    away: Array  # (p, n) where the particles are from the mean
    L: Array  # (n, n) the root of their covariance
    wide: float  # the largest of their standard deviations, in widths of the widest kernel
    astray: float  # the share that is drawn from anywhere
    b: float | None = None  # how wide the kernel is; None: by how many are drawn


@dataclass(frozen=True)
class AMCL(PF):
    """Particle filter with an adaptive number (KLD sampling: Fox, 2003; Thrun, Burgard & Fox, 2005,
    Table 8.4) and with random particles (augmented: Table 8.3).

    `count` is the largest number. Table 8.3 follows the mean likelihood of readings, which falls
    with distance, noise and doubt as well. Here it is how far a reading is explained, min(1, p/p₀),
    p being the probability of a NIS as large as its own, p₀ = 0.001: 1 of what is usual, whatever
    the sensor, and almost 0 of a robot that was carried away.
    """

    # states that are drawn from all places where a robot can stand: (generator, number) → (p, n)
    anywhere: "Callable[[Generator, int], Array] | None" = None

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
            alike, prediction = PF.predict(self._of(rows, p), crowd.part(rows, p), motion, u[rows])
            moved.append(alike)
            made.append(prediction)
        return crowd.whole(moved, groups), _together(made, groups, axes)

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
        told = _together(corrections, groups, axes)
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
        wide = b * np.max(σ / (NEAR * self.bins(n)), axis=-1)
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
            (x, P), bins = belief, self.bins(n)
            roots = square_root(P).reshape(-1, n, n)
            drawn = [
                self._one_drawn(generator, Source(ONE, mean, NOWHERE, L, 0.0, 0.0, 1.0), bins)
                for generator, mean, L in zip(self.generators, x.reshape(-1, n), roots, strict=True)
            ]
            number = np.array([len(of_run) for of_run in drawn]).reshape(axes)
            p = int(number.max())
            states = np.stack(
                [of_run[np.minimum(np.arange(p), len(of_run) - 1)] for of_run in drawn]
            )
            states = wrapped(states, self.headings).reshape(*axes, p, n)
            weights = (np.arange(p) < number[..., None]) / number[..., None]
        return Roaming(x, P, states, weights, number, np.ones(axes), np.ones(axes))

    def _redrawn(self, crowd: Roaming, anew: Booleans) -> Roaming:
        """The crowd, drawn anew in those runs : (…), one by one: each draws as many as it needs."""
        if not anew.any():
            return crowd
        axes, n = crowd.mean.shape[:-1], crowd.mean.shape[-1]
        N, number = math.prod(axes), crowd.number.reshape(-1).copy()
        rows, bins = np.flatnonzero(anew), self.bins(n)
        drawn = dict[int, Array]()
        for row, source in zip(rows.tolist(), self._sources(crowd, rows), strict=True):
            drawn[row] = self._one_drawn(self.generators[row], source, bins)
            number[row] = len(drawn[row])
        p = int(number.max())
        states, weights = np.zeros((N, p, n)), np.zeros((N, p))
        kept = min(p, crowd.states.shape[-2])
        states[:, :kept] = crowd.states.reshape(N, -1, n)[:, :kept]
        weights[:, :kept] = crowd.weights.reshape(N, -1)[:, :kept]
        for row, of_run in drawn.items():
            states[row], states[row, : len(of_run)] = of_run[0], of_run
            weights[row], weights[row, : len(of_run)] = 0.0, 1 / len(of_run)
        states = wrapped(states, self.headings)
        made = Roaming(
            crowd.mean, crowd.covariance, states.reshape(*axes, p, n), weights.reshape(*axes, p),
            number.reshape(axes), crowd.slow, crowd.fast,
        )  # fmt: skip
        x, P = crowd.mean.reshape(N, n).copy(), crowd.covariance.reshape(N, n, n).copy()
        for rows, length in made.groups(self.count):
            alike, these = made.part(rows, length), anew.reshape(N)[rows]
            summed = self._summed(alike.states, alike.weights)
            x[rows[these]], P[rows[these]] = summed.mean[these], summed.covariance[these]
        return replace(made, mean=x.reshape(*axes, n), covariance=P.reshape(*axes, n, n))

    def _sources(self, crowd: Roaming, rows: Integers) -> Iterator[Source]:
        """What the particles of these runs are drawn from, one run after another."""
        n, P = crowd.mean.shape[-1], crowd.covariance.reshape(-1, *crowd.covariance.shape[-2:])
        mean, numbers = crowd.mean.reshape(-1, n)[rows], crowd.number.reshape(-1)[rows].tolist()
        states = crowd.states.reshape(-1, *crowd.states.shape[-2:])[rows]
        away = wrapped(states - mean[:, None], self.headings)
        ends = np.cumsum(crowd.weights.reshape(-1, crowd.weights.shape[-1])[rows], axis=-1)
        σ = np.sqrt(np.maximum(np.diagonal(P[rows], axis1=-2, axis2=-1), 0.0))
        wide, astray = np.max(σ / (NEAR * self.bins(n)), axis=-1), crowd.astray.reshape(-1)[rows]
        roots = square_root(P[rows])
        for i, p in enumerate(numbers):
            if not ends[i, p - 1] > 0:
                weights = crowd.weights.reshape(-1, crowd.weights.shape[-1])[rows[i]]
                first = int(np.argmin(weights > 0))
                raise ValueError(f"particle {first + 1} has the weight {weights[first]}")
            yield Source(
                ends[i, :p], mean[i], away[i, :p], roots[i], float(wide[i]), float(astray[i])
            )

    def _one_drawn(self, generator: "Generator", source: Source, bins: Array) -> Array:
        """Particles of one run : (p', n), as many as it needs, all of one weight. Their headings
        are not wrapped.
        """
        ends, n = source.ends, len(source.mean)
        portions, found = list[Array](), set[int]()
        there, wanted = 0, FEWEST
        while there < min(wanted, self.count):
            p = min(max(there, FEWEST), max(wanted, FEWEST) - there, self.count - there)
            b = source.b
            if b is None:
                b = float(silverman(p, n))
                b /= max(b * source.wide, 1.0)
            u = (np.arange(p) + generator.random()) / p
            hit = np.searchsorted(ends, u * ends[-1], side="right")
            # beyond the last end, by rounding, is the last particle
            drawn = math.sqrt(1 - b * b) * source.away.take(hit, axis=0, mode="clip")
            drawn = drawn + generator.standard_normal((p, n)) @ (b * source.L.T)
            drawn += source.mean
            if source.astray > 0:
                lost = generator.random(p) < source.astray
                assert self.anywhere is not None
                drawn[lost] = self.anywhere(generator, int(np.count_nonzero(lost)))
            portions.append(drawn)
            found.update(cells(drawn, bins).tolist())
            there, wanted = there + p, enough(len(found))
        return np.concatenate(portions)

    def bins(self, n: int) -> Array:
        """How wide a bin is in each of n entries of the state : (n,)"""
        widths = np.full(n, BIN)
        widths[list(self.headings)] = BIN_ANGLE
        return widths


def enough(k: int) -> int:
    """How many particles are enough for k occupied bins: (k − 1)/2ε (1 − a + √a z)³, a = 2/(9 (k −
    1)): Fox, 2003, eq. 7

    >>> enough(1), enough(10), enough(100)
    (300, 300, 1347)
    """
    if k <= 1:
        return FEWEST
    a = 2 / (9 * (k - 1))
    return max(FEWEST, math.ceil((k - 1) / (2 * KLD) * (1 - a + math.sqrt(a) * Z_99) ** 3))


def cells(states: Array, bins: Array) -> Integers:
    """In which bin each of the particles (p, n) lies, as one number : (p,)"""
    digits = np.floor(states / bins).astype(np.int64)
    # may overflow: it only tells bins apart
    number: Integers = digits @ np.multiply.accumulate(np.full(len(bins), MIXED))
    return number


def followed(average: Array, now: Array, α: float) -> Array:
    """average + α (now − average) : (…), as it was where there is nothing to follow"""
    return np.where(np.isnan(now), average, average + α * (now - average))


def _together(parts: "list[Told]", groups: "Groups", axes: tuple[int, ...]) -> "Told":
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
