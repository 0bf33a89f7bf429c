"""1024 runs, each of them once under either of two settings → Pairs: the unit of work of a
comparison.
"""

import functools
import operator
from collections import Counter
from collections.abc import Mapping
from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from ekfsim.geometry import Array, Booleans
from ekfsim.scene import Scene
from ekfsim.study.block import at_once, watched
from ekfsim.study.tally import Tally
from ekfsim.twins import Way, taken, taking

PER_OCTAVE = 4  # bins of the logarithm of the position error
NARROWEST = -40  # octaves of a metre: what is smaller belongs to the first bin


class Shared(NamedTuple):
    """Of how many runs something is so under both settings, under one alone, under none."""

    both: int
    only_a: int
    only_b: int
    neither: int

    @classmethod
    def of(cls, a: Booleans, b: Booleans) -> Self:
        """Count N runs. a, b : (N,)"""
        return cls(
            both=int(np.count_nonzero(a & b)),
            only_a=int(np.count_nonzero(a & ~b)),
            only_b=int(np.count_nonzero(~a & b)),
            neither=int(np.count_nonzero(~a & ~b)),
        )

    def plus(self, other: "Shared") -> "Shared":
        """Of both."""
        return Shared(*map(operator.add, self, other))


class Sums(NamedTuple):
    """Sums over runs of a number that each has under both settings."""

    runs: int  # in which both are numbers
    a: float
    b: float
    difference: float  # Σ (b − a)
    squares: float  # Σ (b − a)²
    b_less: int  # runs in which b's is less
    a_less: int

    @classmethod
    def of(cls, a: Array, b: Array) -> Self:
        """Sum over N runs. a, b : (N,)"""
        known = np.isfinite(a) & np.isfinite(b)
        a, b = a[known], b[known]
        d = b - a
        return cls(
            runs=len(d),
            a=float(np.sum(a)),
            b=float(np.sum(b)),
            difference=float(np.sum(d)),
            squares=float(np.sum(d * d)),
            b_less=int(np.count_nonzero(d < 0)),
            a_less=int(np.count_nonzero(d > 0)),
        )

    def plus(self, other: "Sums") -> "Sums":
        """Of both."""
        return Sums(*map(operator.add, self, other))


@dataclass(frozen=True, eq=False, kw_only=True)
class Pairs:
    """What a comparison keeps of its pairs of runs; its size knows no runs."""

    a: Tally
    b: Tally
    lost: Shared
    inside: Shared  # the ellipse, of those that have one under both settings
    position: Sums  # m, from the truth to the estimate at the end
    heading: Sums  # rad, without its sign
    a_errors: Mapping[int, int]  # runs by the logarithm of their last position error
    b_errors: Mapping[int, int]

    def __add__(self, other: "Pairs") -> "Pairs":
        """The pairs of both."""
        return Pairs(
            a=self.a + other.a,
            b=self.b + other.b,
            lost=self.lost.plus(other.lost),
            inside=self.inside.plus(other.inside),
            position=self.position.plus(other.position),
            heading=self.heading.plus(other.heading),
            a_errors=Counter(self.a_errors) + Counter(other.a_errors),
            b_errors=Counter(self.b_errors) + Counter(other.b_errors),
        )


def run_pairs(a: Scene, b: Scene, first: int, runs: int, way: Way | None = None) -> Pairs:
    """What becomes of the runs first … first + runs − 1 under either of two settings, on the same
    draws.

    way : of twins.py; None: as all else in this process
    """
    with taking(way or taken()):
        portions = min(
            at_once(a, first, runs), at_once(b, first, runs), key=lambda some: some[0][1]
        )
        return functools.reduce(operator.add, (pairs_of(a, b, *some) for some in portions))


def pairs_of(a: Scene, b: Scene, first: int, runs: int) -> Pairs:
    """The same, all of them side by side."""
    under_a, under_b = watched(a, first, runs), watched(b, first, runs)
    one, other = under_a.ends, under_b.ends
    drawn = one.drawn & other.drawn
    return Pairs(
        a=under_a.tally(),
        b=under_b.tally(),
        lost=Shared.of(one.lost, other.lost),
        inside=Shared.of(one.inside[drawn], other.inside[drawn]),
        position=Sums.of(one.position, other.position),
        heading=Sums.of(one.heading, other.heading),
        a_errors=octaves(one.position),
        b_errors=octaves(other.position),
    )


def octaves(errors: Array) -> dict[int, int]:
    """Runs by the logarithm of their error, those without a number left out. errors : (N,) m

    >>> found = octaves(np.array([1.0, 1.1, 2.0, 0.0, np.nan]))
    >>> found == {0: 2, PER_OCTAVE: 1, NARROWEST * PER_OCTAVE: 1}
    True
    """
    known = np.maximum(errors[np.isfinite(errors)], 2.0**NARROWEST)
    keys, counts = np.unique(
        np.floor(PER_OCTAVE * np.log2(known)).astype(np.int64), return_counts=True
    )
    return dict(zip(keys.tolist(), counts.tolist(), strict=True))
