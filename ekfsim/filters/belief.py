"""What a filter believes, and what it says of each step."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import NamedTuple, Protocol

import numpy as np

from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.layout import Layout
from ekfsim.models.protocols import Quantity


class Belief(Protocol):
    """What every kind of belief can say: `x, P = belief`."""

    @property
    def mean(self) -> Array:
        """(…, n)"""

    @property
    def covariance(self) -> Array:
        """(…, n, n)"""

    def __iter__(self) -> Iterator[Array]: ...


class Gaussian(NamedTuple):
    """A belief with a mean and a covariance: `x, P = belief`."""

    mean: Array  # x : (…, n)
    covariance: Array  # P : (…, n, n)          eq. 2


@dataclass(frozen=True, slots=True)
class Particles:
    """A belief that is a crowd of weighted states. Its mean and covariance stand for it where one
    is drawn or told.
    """

    mean: Array  # (…, n), circular where it is a heading
    covariance: Array  # (…, n, n)
    states: Array  # (…, p, n)
    weights: Array  # (…, p), their sum is 1

    def __iter__(self) -> Iterator[Array]:
        """`x, P = belief` takes any kind of belief."""
        return iter((self.mean, self.covariance))


@dataclass(frozen=True, slots=True)
class Mixture:
    """A belief that is a few Gaussians, each a hypothesis. Its mean and covariance are those of all
    together, and stand for it where one is drawn, told or judged.

    The heaviest comes first. A place of weight 0 is unused.
    """

    mean: Array  # (…, n), circular where it is a heading
    covariance: Array  # (…, n, n), what parts the hypotheses included
    means: Array  # (…, h, n)
    covariances: Array  # (…, h, n, n)
    weights: Array  # (…, h), their sum is 1
    walls: Integers  # (…, h) the wall that each took its last reading for, −1 where none is known
    merged: Integers  # (…, h) how many the last reading left, that are one in this one
    pruned: Integers  # (…) how many it left without a place, their weight being given to the others
    # (…, h) which of the hypotheses before that reading it came of, −1 where the filter sought the
    # robot everywhere and found it there
    parents: Integers
    memory: object = None  # what its filter remembers besides

    def __iter__(self) -> Iterator[Array]:
        """`x, P = belief` takes any kind of belief."""
        return iter((self.mean, self.covariance))


@dataclass(frozen=True, slots=True)
class Learning:
    """A Gaussian, and what its filter has learnt of its sensors so far."""

    mean: Array  # (…, n)
    covariance: Array  # (…, n, n)
    # by what a sensor reads, how many times the R that is told its noise is taken for : (…)
    factors: Mapping[tuple[Quantity, ...], Array]

    def __iter__(self) -> Iterator[Array]:
        """`x, P = belief` takes any kind of belief."""
        return iter((self.mean, self.covariance))


def parts(belief: Belief, layout: Layout) -> list[tuple[float, Gaussian]]:
    """The hypotheses of one run that are several, each with its weight, the lightest first, and
    what it believes of the pose; none of a belief that is one Gaussian, or no mixture.
    """
    if not isinstance(belief, Mixture) or np.count_nonzero(belief.weights) < 2:
        return []
    each = zip(belief.weights.tolist(), belief.means, belief.covariances, strict=True)
    made = [(w, posed(Gaussian(x, P), layout)) for w, x, P in each if w > 0]
    return sorted(made, key=lambda one: one[0])


def posed(belief: Belief, layout: Layout) -> Gaussian:
    """What is believed of the pose, whatever else the state holds : (…, 3), (…, 3, 3)"""
    x, P = belief
    return Gaussian(layout.pose(x), layout.pose_covariance(P))


@dataclass(frozen=True, slots=True)
class Prediction:
    """How a motion input was linearised; a filter without derivatives gives what stands for
    them.
    """

    F: Array  # ∂f/∂x : (…, n, n)
    G: Array  # ∂f/∂u : (…, n, m)


class Refused(IntEnum):
    """Why a reading was not used. The first reason that holds is told."""

    NOT = 0
    NO_ECHO = 1  # the sensor met nothing
    NO_WALL = 2  # the filter expected to meet nothing
    GUARD = 3  # the reading is ambiguous, and the guard skips those
    GATE = 4  # NIS beyond the gate

    @property
    def word(self) -> str | None:
        """As the trace has it: "gate", "no echo", …; None for a reading that was used."""
        return None if self is Refused.NOT else self.name.lower().replace("_", " ")


@dataclass(frozen=True, slots=True)
class Correction:
    """What a reading did to the belief, or would have done were it not refused. nan where a number
    is undefined.
    """

    predicted: Array  # h(x⁻) : (…, k)
    innovation: Array  # ν : (…, k)
    R: Array  # (…, k, k)
    S: Array  # (…, k, k)
    H: Array  # ∂h/∂x : (…, k, n); without derivatives what stands for it, P_zx P⁺
    K: Array  # (…, n, k), 0 where S = 0 or undefined
    nis: Array  # νᵀ S⁻¹ ν : (…), refused readings included; nan where S = 0
    refused: Integers  # (…) one of Refused
    settled: Booleans | bool = True  # (…) whether the search of an iterated filter came to rest
    # (…) how far a filter that weighs its readings believes this one, 0 to 1; nan where it is not
    # used; None of a filter that weighs none
    trust: Array | None = None
    # (…) how many times the told R a filter that learns it takes the noise for after this reading;
    # R above is with what it had learnt before. None of a filter that learns none
    noise_factor: Array | None = None
    # `predicted` is that of a tangent drawn elsewhere than at x⁻: it meets nothing of the map
    tangent: bool = False

    @property
    def used(self) -> Booleans:
        """(…) whether the reading could change the belief: not refused, and S is not 0."""
        used: Booleans = (self.refused == Refused.NOT) & ~np.isnan(self.nis)
        return used
