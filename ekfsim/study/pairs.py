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
        return cls(*(int(np.count_nonzero(runs)) for runs in (a & b, a & ~b, ~a & b, ~a & ~b)))


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
        Σa, Σb, Σd, Σdd = (float(np.sum(numbers)) for numbers in (a, b, d, d * d))
        return cls(
            len(d), Σa, Σb, Σd, Σdd, int(np.count_nonzero(d < 0)), int(np.count_nonzero(d > 0))
        )


@dataclass(frozen=True, eq=False)
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
            self.a + other.a,
            self.b + other.b,
            Shared(*(one + another for one, another in zip(self.lost, other.lost, strict=True))),
            Shared(
                *(one + another for one, another in zip(self.inside, other.inside, strict=True))
            ),
            Sums._make(
                one + another for one, another in zip(self.position, other.position, strict=True)
            ),
            Sums._make(
                one + another for one, another in zip(self.heading, other.heading, strict=True)
            ),
            Counter(self.a_errors) + Counter(other.a_errors),
            Counter(self.b_errors) + Counter(other.b_errors),
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
        return functools.reduce(operator.add, (_pairs(a, b, *some) for some in portions))


def _pairs(a: Scene, b: Scene, first: int, runs: int) -> Pairs:
    under_a, under_b = watched(a, first, runs), watched(b, first, runs)
    one, other = under_a.ends(), under_b.ends()
    drawn = one.drawn & other.drawn
    return Pairs(
        under_a.tally(),
        under_b.tally(),
        Shared.of(one.lost, other.lost),
        Shared.of(one.inside[drawn], other.inside[drawn]),
        Sums.of(one.position, other.position),
        Sums.of(one.heading, other.heading),
        octaves(one.position),
        octaves(other.position),
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
