"""One step of N runs → counts and sums: how many lie above a quantile, inside the ellipse, inside
the cone.
"""

from typing import NamedTuple

import numpy as np

from ekfsim.diagnostics.coverage import inside_cone
from ekfsim.diagnostics.nees import OUTSIDE, ROUNDING, error, squared_mahalanobis
from ekfsim.diagnostics.verdict import LOST
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.chi_square import quantile
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.geometry.ellipse import radius_factor
from ekfsim.records import Step
from ekfsim.study.tally import Bin

COVERAGE = 0.954  # probability of the ellipse and the cone whose coverage is counted
SIDES = 0.025, 0.975  # the two-sided 95 % band of ΣNIS of a run, and of its last NEES
PER_OCTAVE = 32  # bins of the logarithm of NEES: 2 % wide
WIDEST = 64 * PER_OCTAVE  # what lies beyond ± so many bins belongs to the outermost
IMPOSSIBLE = WIDEST + 1  # the bin of impossible beliefs


class Judged(NamedTuple):
    """NEES of N runs, as a study counts it : (N,) each"""

    value: Array  # nan where the belief is impossible
    dof: Integers
    impossible: Booleans

    @classmethod
    def of(cls, step: Step, shape: tuple[int, ...]) -> "Judged":
        """The NEES after a step. An estimate that is no number is as impossible as one that is
        certain and wrong.
        """
        assert step.nees is not None
        number = np.isfinite(step.posterior.mean).all(axis=-1)
        impossible = np.broadcast_to(step.nees.impossible | ~number, shape)
        value = np.where(impossible, np.nan, step.nees.value)
        return cls(value, np.broadcast_to(step.nees.dof, shape), impossible)

    def above(self, probability: float) -> Booleans:
        """Which runs lie above a quantile of χ², each by its own degrees of freedom; the impossible
        ones do : (N,)
        """
        return self.impossible | (self.value > bounds(probability, self.dof))

    def below(self, probability: float) -> Booleans:
        """Which runs lie below a quantile : (N,)"""
        return self.value < bounds(probability, self.dof)

    @property
    def known(self) -> Booleans:
        """Which runs have a NEES that says something : (N,)"""
        known: Booleans = (self.dof > 0) & ~self.impossible
        return known


def bounds(probability: float, dof: Integers) -> Array:
    """The quantile of χ² for each of many degrees of freedom : (N,)"""
    kinds, which = np.unique(dof, return_inverse=True)
    table: Array = np.array([quantile(probability, int(kind)) for kind in kinds])
    return table[which]


def nees_counts(now: Judged) -> tuple[int, ...]:
    """Runs that are judged, impossible, above the three quantiles."""
    above = (now.above(probability) for probability in (0.5, 0.95, LOST))
    return tuple(
        int(np.count_nonzero(runs)) for runs in (now.known | now.impossible, now.impossible, *above)
    )


def coverage_counts(pose: Gaussian, truth: Array) -> tuple[int, ...]:
    """Runs inside their ellipse, that have one, inside their cone, that have one. An impossible one
    is outside.
    """
    e, P = error(pose, truth), pose.covariance
    unsure = (P[..., 2, 2] > ROUNDING**2) | ~(abs(e[..., 2]) <= OUTSIDE)
    held = unsure & inside_cone(pose, truth, COVERAGE)
    return tuple(int(np.count_nonzero(runs)) for runs in (*covered(e, P), held, unsure))


def covered(e: Array, P: Array) -> tuple[Booleans, Booleans]:
    """Which runs are inside their ellipse, and which have one that has an area, or are impossible :
    (N,) each
    """
    square, rank, off = squared_mahalanobis(e[..., :2], P[..., :2, :2])
    off = off | ~np.isfinite(square) | ~np.isfinite(e[..., :2]).all(axis=-1)
    drawn: Booleans = (rank == 2) | off
    return drawn & ~off & (square <= radius_factor(COVERAGE) ** 2), drawn


def nees_sums(now: Judged) -> tuple[float, ...]:
    """Runs with a NEES, its degrees of freedom, and its sum."""
    known = now.known
    return (
        int(np.count_nonzero(known)),
        int(np.sum(now.dof[known])),
        float(np.sum(now.value[known])),
    )


def error_squares(pose: Gaussian, truth: Array) -> tuple[float, float]:
    """Σ (ex² + ey²) m² and Σ eθ² rad²"""
    e = error(pose, truth)
    return float(np.sum(e[..., :2] ** 2)), float(np.sum(e[..., 2] ** 2))


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
