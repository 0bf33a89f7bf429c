"""The numbers of noise that make a log most likely, and how sure that is."""

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace

import numpy as np

from ekfsim.fitting.likelihood import Likelihood
from ekfsim.fitting.noises import NoiseNumber, Retold
from ekfsim.fitting.search import Bowl, Costs, ends, lowest
from ekfsim.geometry import Array, Integers
from ekfsim.records import Reading

FAR = math.log(1e3)  # from where it begins a number is looked for up to so many times as far
NOTHING = math.log(50.0)  # a number so many times less than the best is as good as 0
LOOK = math.log(3.0)  # how far a number is moved to see whether it matters
MATTERS = 2.0  # of −ln p: what moves it less than this is not to be found in the log
ROUNDS = 4  # of gate and fit in turn, and of intervals where a lower cost is met on the way
LOWER = 0.05  # of −ln p
ABREAST = 64  # sets of numbers that are tried in one run
AS_IT_IS = Likelihood()  # with all readings
LEVEL = 0.95  # of an interval


@dataclass(frozen=True, slots=True)
class Estimate:
    """What a log says of one number. In m and rad."""

    number: NoiseNumber
    value: float
    low: float  # 0 where the log says only that it is no larger than `high`
    high: float


@dataclass(frozen=True)
class Fit:
    """What a log says of all that was asked."""

    found: tuple[Estimate, ...]
    idle: tuple[NoiseNumber, ...]  # the log does not depend on them
    zero: tuple[NoiseNumber, ...]  # told as 0, which no factor changes
    left_out: frozenset[int]  # entries that the gate refuses under what was found
    trials: int

    @property
    def values(self) -> list[float]:
        """Of the numbers that were found."""
        return [one.value for one in self.found]


def fit(
    retold: Retold, until: int, gate: float | None,
    heard: Callable[[int], None] = lambda _: None, likelihood: Likelihood = AS_IT_IS,
) -> Fit:  # fmt: skip
    """The most likely numbers on the first `until` entries of a log; `heard` hears how many sets
    of numbers were tried, each time.

    Outliers are looked for with what was fitted, at first to all readings, so that a number that
    was told too small does not call sound readings outliers.
    """
    zero = tuple(one for one in retold.numbers if one.value <= 0)
    asked = tuple(one for one in retold.numbers if one.value > 0)
    trials = Trials(Retold(retold.scene, asked), until, heard, likelihood)
    start = np.log([one.value for one in asked])
    kept = of_matter(trials.costs, start)
    idle = tuple(one for i, one in enumerate(asked) if i not in kept)
    if not len(kept):
        return Fit((), idle, zero, frozenset(), trials.count)
    costs = among(trials.costs, start, kept)
    best = lowest(costs, start[kept], FAR)
    for _ in range(ROUNDS if gate is not None else 0):
        assert gate is not None
        out = trials.refused(gate, within(start, kept, best.at))
        if out == trials.likelihood.out:
            break
        trials.likelihood = replace(trials.likelihood, out=out, gate=gate if out else None)
        best = lowest(costs, best.at, FAR)
    numbers = [asked[i] for i in kept]
    found = tuple(intervals(numbers, costs, best, risen(read(trials), len(kept))))
    return Fit(found, idle, zero, trials.likelihood.out, trials.count)


class Trials:
    """How unlikely a log is under sets of numbers; it counts them."""

    def __init__(
        self, retold: Retold, until: int, heard: Callable[[int], None], likelihood: Likelihood
    ) -> None:
        self.retold, self.until, self.heard = retold, until, heard
        self.likelihood, self.count = likelihood, 0

    def refused(self, gate: float, logs: Array) -> frozenset[int]:
        """The indices of the entries that a gate refuses under numbers of these logarithms."""
        return self.likelihood.refused(gate, self.retold, np.exp(logs).tolist(), self.until)

    def costs(self, logs: Array) -> Array:
        """−ln p under each of m sets of numbers, by their logarithms (m, n) : (m)"""
        found = []
        for first in range(0, len(logs), ABREAST):
            some = np.exp(logs[first : first + ABREAST])
            found.append(self.likelihood.of_all(self.retold, some, self.until))
            self.count += len(some)
            self.heard(len(some))
        return np.concatenate(found)


def of_matter(costs: Costs, logs: Array) -> Integers:
    """Which of the numbers the log depends on."""
    ways = LOOK * np.eye(len(logs))
    if not len(ways):
        return np.arange(0)
    here, *moved = costs(np.concatenate([logs[None], logs + ways, logs - ways]))
    by_number = np.abs(np.array(moved).reshape(2, -1) - here).max(axis=0)
    return np.flatnonzero(by_number > MATTERS)


def among(costs: Costs, logs: Array, kept: Integers) -> Costs:
    """The cost of those that are kept, the others being as they are."""
    return lambda parts: costs(np.array([within(logs, kept, part) for part in parts]))


def within(logs: Array, kept: Integers, part: Array) -> Array:
    """Numbers of which some are others : (n,)"""
    whole = logs.copy()
    whole[kept] = part
    return whole


def read(trials: Trials) -> int:
    """How many numbers were read and not left out."""
    assert trials.retold.scene.log is not None
    return sum(
        one.given.z.size
        for one in trials.retold.scene.log.entries[: trials.until]
        if isinstance(one.given, Reading) and one.index not in trials.likelihood.out
    )


def risen(read: int, fitted: int) -> float:
    """By how much −ln p has risen at the end of an interval: half of the quantile of F of one
    freedom and of as many as numbers were read beyond those fitted; with many, of χ².

    >>> round(risen(10_000, 2), 2), round(risen(20, 3), 2)
    (1.92, 2.23)
    """
    from scipy.stats import f

    return float(f.ppf(LEVEL, 1, max(read - fitted, 1))) / 2


def intervals(
    numbers: list[NoiseNumber], costs: Costs, best: Bowl, rise: float
) -> Iterator[Estimate]:
    """The numbers with their intervals, by the profile of the likelihood: the curvature alone would
    not do, for where a number may as well be 0 the cost is far from a parabola.
    """
    for _ in range(ROUNDS):
        found, lower = ends(costs, best, rise, (NOTHING, FAR))
        if lower.cost > best.cost - LOWER:
            break
        best = lowest(costs, lower.at, FAR)
    for i, number in enumerate(numbers):
        down, up = (found[2 * i + side].at[i] for side in (0, 1))
        low = 0.0 if found[2 * i].open else math.exp(down)
        yield Estimate(number, math.exp(best.at[i]), low, math.exp(up))
