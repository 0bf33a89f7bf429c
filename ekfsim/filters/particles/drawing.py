"""Particles drawn anew of each run: by their weights, parted, and some of them from anywhere."""

import math
from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from ekfsim.filters.arithmetic.algebra import wrapped
from ekfsim.filters.arithmetic.square_root import square_root
from ekfsim.filters.particles.kld import FEWEST, bins, cells, enough, occupied
from ekfsim.filters.particles.roaming import Roaming
from ekfsim.filters.pf import silverman
from ekfsim.geometry import Array, Booleans, Integers

if TYPE_CHECKING:
    from numpy.random import Generator

NEAR = 1.5  # bins: σ of the kernel that parts particles, at most

# states that are drawn from all places where a robot can stand: (generator, number) → (p, n)
Anywhere = Callable[["Generator", int], Array]

ONE, NOWHERE = np.ones(1), np.zeros((1, 1))  # of a Gaussian: one particle, at its mean


class Source(NamedTuple):
    """What the particles of one run are drawn from."""

    ends: Array  # (p,) the weights laid end to end
    mean: Array  # (n,)
    away: Array  # (p, n) where the particles are from the mean
    L: Array  # (n, n) the root of their covariance
    wide: float  # the largest of their standard deviations, in widths of the widest kernel
    astray: float  # the share that is drawn from anywhere
    alike: float  # of how many alike ones they are worth: 1/Σ wᵢ²

    @classmethod
    def of_gaussian(cls, mean: Array, L: Array) -> "Source":
        """A Gaussian of which particles are drawn : (n,), (n, n)"""
        return cls(ONE, mean, NOWHERE, L, 0.0, 0.0, 1.0)

    def kernel(self, p: int) -> tuple[float, float]:
        """b and β of x' = x̄ + √(1 − b²) (x − x̄) + β e, e ~ N(0, P), where p are drawn.

        b by Silverman's rule, narrowed where the crowd is wide. β² = b² + c, and P grows by c: what
        N alike draws of n dimensions say of their mean and covariance is itself in doubt, and the
        next draw is of a t distribution whose covariance is (N + 1)/(N − n − 2) of theirs (Gelman
        et al., Bayesian Data Analysis, 2013, section 3.6). Without it a few hundred particles that
        are weighed again and again soon claim more than they know.
        """
        if len(self.ends) == 1:
            return 1.0, 1.0
        n = len(self.mean)
        b = float(silverman(p, n))
        narrowed = max(b * self.wide, 1.0)
        c = (n + 3) / max(self.alike - n - 2, n + 3)  # at most P doubled
        b /= narrowed
        return b, math.sqrt(b * b + c / narrowed**2)


def drawn_anew(
    generators: Sequence["Generator"],
    of_runs: Sequence[Source],
    headings: Sequence[int],
    most: int,
    anywhere: Anywhere,
) -> list[Array]:
    """Particles of each run : (p', n), as many as it needs, all of one weight. Their headings are
    not wrapped.

    The fewest are drawn of all runs side by side, and few need more: these go on one by one.
    """
    if not of_runs:
        return []
    widths, p = bins(len(of_runs[0].mean), headings), min(FEWEST, most)
    begun = _portions(generators, of_runs, p, anywhere)
    places = cells(begun, widths)
    drawn = list(begun)
    for i, k in enumerate(occupied(places).tolist()):
        there, wanted, found = p, enough(k), places[i]
        while there < min(wanted, most):
            more = min(max(there, FEWEST), wanted - there, most - there)
            (portion,) = _portions(generators[i : i + 1], of_runs[i : i + 1], more, anywhere)
            drawn[i] = np.concatenate([drawn[i], portion])
            found = np.concatenate([found, cells(portion, widths)])
            there, wanted = there + more, enough(int(occupied(found)))
    return drawn


def _portions(
    generators: Sequence["Generator"], of_runs: Sequence[Source], p: int, anywhere: Anywhere
) -> Array:
    """p particles of each run : (N, p, n). Each draws from its own generator, and all are parted
    side by side.
    """
    N, n = len(of_runs), len(of_runs[0].mean)
    away, noise = np.empty((N, n, p)), np.empty((N, p, n))
    astray = list[tuple[int, Booleans, Array]]()
    for i, (generator, source) in enumerate(zip(generators, of_runs, strict=True)):
        u = (np.arange(p) + generator.random()) / p
        hit = np.searchsorted(source.ends, u * source.ends[-1], side="right")
        # beyond the last end, by rounding, is the last particle
        away[i] = source.away.T.take(hit, axis=1, mode="clip")
        generator.standard_normal(out=noise[i])
        if source.astray > 0:
            lost = generator.random(p) < source.astray
            astray.append((i, lost, anywhere(generator, int(np.count_nonzero(lost)))))
    b, β = np.array([source.kernel(p) for source in of_runs]).T[..., None, None]
    mean, L = np.stack([s.mean for s in of_runs]), np.stack([s.L for s in of_runs])
    # one entry of the state of all particles side by side in memory
    drawn: Array = (np.sqrt(1 - b * b) * away + (β * L) @ noise.mT).mT
    drawn += mean[:, None]
    for i, lost, poses in astray:
        drawn[i, lost] = poses
    return drawn


def sources(crowd: Roaming, rows: Integers, headings: Sequence[int]) -> Iterator[Source]:
    """What the particles of these runs are drawn from, one run after another.

    Raises ValueError where weights say nothing: 0 or nan.
    """
    n, P = crowd.mean.shape[-1], crowd.covariance.reshape(-1, *crowd.covariance.shape[-2:])[rows]
    mean, numbers = crowd.mean.reshape(-1, n)[rows], crowd.number.reshape(-1)[rows].tolist()
    states = crowd.part(rows, crowd.states.shape[-2]).states
    weights = crowd.weights.reshape(-1, crowd.weights.shape[-1])[rows]
    away = wrapped(states - mean[:, None], tuple(headings))
    ends = np.cumsum(weights, axis=-1)
    σ = np.sqrt(np.maximum(np.diagonal(P, axis1=-2, axis2=-1), 0.0))
    wide = np.max(σ / (NEAR * bins(n, headings)), axis=-1)
    astray, roots = crowd.astray.reshape(-1)[rows], square_root(P)
    for i, p in enumerate(numbers):
        if not ends[i, p - 1] > 0:
            first = int(np.argmin(weights[i] > 0))
            raise ValueError(f"particle {first + 1} has the weight {weights[i, first]}")
        alike = 1 / float(np.vecdot(weights[i, :p], weights[i, :p]))
        yield Source(
            ends[i, :p], mean[i], away[i, :p], roots[i], float(wide[i]), float(astray[i]), alike
        )
