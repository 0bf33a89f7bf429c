"""N runs held against the truth → counts and sums: how many lie above a quantile, inside the
ellipse, inside the cone.
"""

from functools import lru_cache
from typing import NamedTuple, Self

import numpy as np

from ekfsim.diagnostics.coverage import within_cone
from ekfsim.diagnostics.nees import OUTSIDE, ROUNDING, error, squared_mahalanobis
from ekfsim.diagnostics.verdict import LOST
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.geometry.ellipse import radius_factor
from ekfsim.records import Nees
from ekfsim.study.tally import AtSteps, Bin, Extreme

COVERAGE = 0.954  # probability of the ellipse and the cone whose coverage is counted
SIDES = 0.025, 0.975  # the two-sided 95 % band of ΣNIS of a run, and of its last NEES
PER_OCTAVE = 32  # bins of the logarithm of NEES: 2 % wide
WIDEST = 64 * PER_OCTAVE  # what lies beyond ± so many bins belongs to the outermost
IMPOSSIBLE = WIDEST + 1  # the bin of impossible beliefs
RANKS = 4  # of the covariance of a pose: 0, 1, 2, 3


class Judged(NamedTuple):
    """NEES of N runs, as a study counts it : (N,) each"""

    value: Array  # nan where the belief is impossible
    dof: Integers
    impossible: Booleans

    @classmethod
    def of(cls, measured: Nees, estimate: Array) -> Self:
        """The NEES after a step. An estimate (N, n) that is no number is as impossible as one that
        is certain and wrong.
        """
        impossible = measured.impossible | ~np.isfinite(estimate).all(axis=-1)
        value = np.where(impossible, np.nan, measured.value)
        return cls(value, np.broadcast_to(measured.dof, value.shape), impossible)

    def above(self, probability: float) -> Booleans:
        """Which runs lie above a quantile of χ², each by its own degrees of freedom; the impossible
        ones do : (N,)
        """
        return self.impossible | (self.value > by_rank(probability)[self.dof])

    def below(self, probability: float) -> Booleans:
        """Which runs lie below a quantile : (N,)"""
        return self.value < by_rank(probability)[self.dof]

    @property
    def known(self) -> Booleans:
        """Which runs have a NEES that says something : (N,)"""
        known: Booleans = (self.dof > 0) & ~self.impossible
        return known


@lru_cache
def by_rank(probability: float) -> Array:
    """The quantile of χ² for every rank that P of a pose may have : (4,)"""
    return np.array([quantile(probability, rank) for rank in range(RANKS)])


def bounds(probability: float, dof: Integers) -> Array:
    """The quantile of χ² for each of many degrees of freedom, however large : (N,)"""
    kinds = np.flatnonzero(np.bincount(dof))
    table = np.zeros(dof.max(initial=0) + 1)
    table[kinds] = [quantile(probability, kind) for kind in kinds.tolist()]
    bounds: Array = table[dof]
    return bounds


def count(runs: Booleans) -> Integers:
    """How many runs something is true of : ()"""
    return np.array(np.count_nonzero(runs))


def total(values: Array, runs: Booleans | bool = True) -> Array:
    """The sum of what these runs have : ()"""
    return np.array(np.sum(values, where=runs))


class Ends(NamedTuple):
    """How each of N runs stands at a step : (N,) each"""

    nees: Judged
    e: Array  # (N, 3) estimate − truth of the pose, in m, m, rad
    inside: Booleans  # the truth is inside the ellipse
    drawn: Booleans  # the ellipse has an area, or is impossible
    in_cone: Booleans
    unsure: Booleans  # of the heading: there is a cone, or it is impossible

    @classmethod
    def of(cls, nees: Judged, pose: Gaussian, truth: Array) -> Self:
        """Hold beliefs against the truth. An impossible one is outside. truth : (N, 3)"""
        e, P = error(pose, truth), pose.covariance
        square, rank, off = squared_mahalanobis(e[..., :2], P[..., :2, :2])
        off = off | ~np.isfinite(square) | ~np.isfinite(e[..., :2]).all(axis=-1)
        drawn = (rank == 2) | off
        inside = drawn & ~off & (square <= radius_factor(COVERAGE) ** 2)
        eθ, variance = e[..., 2], P[..., 2, 2]
        unsure = (variance > ROUNDING**2) | ~(abs(eθ) <= OUTSIDE)
        in_cone = unsure & within_cone(eθ, variance, COVERAGE)
        return cls(nees, e, inside, drawn, in_cone, unsure)

    @classmethod
    def unknown(cls, runs: int) -> Self:
        """Of runs that have not begun."""
        no, nan = np.zeros(runs, bool), np.full(runs, np.nan)
        nees = Judged(nan, np.zeros(runs, np.int64), no)
        return cls(nees, np.full((runs, 3), np.nan), no, no, no, no)

    @property
    def lost(self) -> Booleans:
        """Whose NEES lies beyond its χ² 99.9 % quantile, or is impossible : (N,)"""
        return self.nees.above(LOST)

    @property
    def position(self) -> Array:
        """From the truth to the estimate in m : (N,)"""
        distance: Array = np.hypot(self.e[..., 0], self.e[..., 1])
        return distance

    @property
    def heading(self) -> Array:
        """Its error in rad, without its sign : (N,)"""
        return abs(self.e[..., 2])


def counted(ends: Ends) -> AtSteps:
    """What is counted of one step : () each"""
    nees, known, squares = ends.nees, ends.nees.known, ends.e * ends.e
    return AtSteps(
        judged=count(known | nees.impossible),
        impossible=count(nees.impossible),
        above_50=count(nees.above(0.5)),
        above_95=count(nees.above(0.95)),
        above_999=count(ends.lost),
        in_ellipse=count(ends.inside),
        ellipse_runs=count(ends.drawn),
        in_cone=count(ends.in_cone),
        cone_runs=count(ends.unsure),
        nees_runs=count(known),
        nees_dof=np.array(np.sum(nees.dof, where=known)),
        nees_sum=total(nees.value, known),
        position_square=total(squares[..., :2]),
        heading_square=total(squares[..., 2]),
    )


def worst(last: Judged, numbers: Integers) -> Extreme:
    """The run that ended worst, of equals the lowest number."""
    i = int(np.argmax(np.where(last.impossible, np.inf, last.value)))
    impossible = bool(last.impossible[i])
    return Extreme(impossible, 0.0 if impossible else float(last.value[i]), int(numbers[i]))


def spread(last: Judged, numbers: Integers) -> dict[int, Bin]:
    """Runs by the logarithm of their NEES: enough to find the median and a run that is near it."""
    with np.errstate(divide="ignore", invalid="ignore"):
        octaves = PER_OCTAVE * np.log2(last.value)
    bins = np.where(
        last.impossible, IMPOSSIBLE, np.clip(np.floor(np.nan_to_num(octaves)), -WIDEST, WIDEST)
    )
    keys, first, counts = np.unique(bins.astype(np.int64), return_index=True, return_counts=True)
    lowest = numbers[first]
    return {
        key: Bin(n, run)
        for key, n, run in zip(keys.tolist(), counts.tolist(), lowest.tolist(), strict=True)
    }
