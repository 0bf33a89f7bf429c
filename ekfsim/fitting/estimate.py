"""The numbers of noise that make a log most likely, and how sure that is."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from ekfsim.fitting.likelihood import Likelihood, refused_by
from ekfsim.fitting.noises import NoiseNumber, Retold
from ekfsim.geometry import Array
from ekfsim.scene import Scene

Z = 1.96  # of a 95 % interval
FAR = math.log(1e3)  # from where it begins a number is looked for up to so many times as far
LOOK = math.log(3.0)  # how far a number is moved to see whether it matters
MATTERS = 2.0  # of −ln p: what moves it less than this is not to be found in the log
STEP = 1e-3  # of a derivative, in the logarithm
CURVE = 0.05  # of a second derivative
ROUNDS = 4  # of gate and fit in turn
VAGUE = 1.2  # σ of a logarithm beyond which the curvature says nothing
HALVINGS = 4  # of a step across the end of an interval
HALF_BELOW = 1.92  # of −ln p: half of the 95 % quantile of χ² of one freedom


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
    retold: Retold, until: int, gate: float | None, heard: Callable[[], None] = lambda: None
) -> Fit:
    """The most likely numbers on the first `until` entries of a log; `heard` hears of each trial.

    Outliers are looked for with what was fitted, at first to all readings, so that a number that
    was told too small does not call sound readings outliers.
    """
    zero = tuple(one for one in retold.numbers if one.value <= 0)
    asked = tuple(one for one in retold.numbers if one.value > 0)
    search = Search(Retold(retold.scene, asked), until, heard)
    out = frozenset[int]()
    start = np.log([one.value for one in asked])
    kept = search.of_matter(start) if asked else []
    best = start
    for _ in range(ROUNDS if gate is not None else 1):
        search.likelihood = Likelihood(out, gate if out else None)
        best = search.best(best, kept)
        if gate is None:
            break
        now = refused_by(gate, search.scene(best))
        if now == out:
            break
        out = now
    found = search.intervals(best, kept)
    idle = tuple(one for i, one in enumerate(asked) if i not in kept)
    return Fit(tuple(found), idle, zero, out, search.trials)


class Search:
    """A search in the logarithms of numbers, each trial one run of the filter."""

    def __init__(self, retold: Retold, until: int, heard: Callable[[], None]) -> None:
        self.retold, self.until, self.heard = retold, until, heard
        self.likelihood, self.trials = Likelihood(), 0

    def scene(self, logs: Array) -> Scene:
        """The part of the log that is looked at, under these numbers."""
        return self.retold.with_(np.exp(logs).tolist(), self.until)

    def cost(self, logs: Array) -> float:
        """−ln p of that."""
        self.heard()
        self.trials += 1
        return self.likelihood.of(self.scene(logs))

    def of_matter(self, logs: Array) -> list[int]:
        """Which of the numbers the log depends on."""
        here, kept = self.cost(logs), list[int]()
        for i in range(len(logs)):
            moved = (self.cost(logs + way * LOOK * unit(i, len(logs))) for way in (1, -1))
            if max(abs(cost - here) for cost in moved) > MATTERS:
                kept.append(i)
        return kept

    def best(self, logs: Array, kept: Sequence[int]) -> Array:
        """Where the cost is least; the other numbers stay as they are."""
        from scipy.optimize import minimize

        def cost(part: Array) -> float:
            return self.cost(within(logs, kept, part))

        if not kept:
            return logs
        start = logs[list(kept)]
        bounds = [(x - FAR, x + FAR) for x in start]
        found = minimize(
            cost, start, method="L-BFGS-B", bounds=bounds,
            options={"eps": STEP, "ftol": 1e-9, "maxiter": 60, "maxls": 12},
        )  # fmt: skip
        return within(logs, kept, found.x)

    def intervals(self, logs: Array, kept: Sequence[int]) -> list[Estimate]:
        """The numbers with their intervals: how far each can be moved, the others along with it as
        the curvature of the cost has it, until the cost has risen by half the 95 % quantile of χ².

        The curvature alone would not do: where a number may as well be 0 the cost is far from a
        parabola.
        """
        if not kept:
            return []
        here, covariance = self.cost(logs), np.linalg.pinv(self.curvature(logs, kept))
        found = []
        for place, i in enumerate(kept):
            variance, ridge = float(covariance[place, place]), unit(i, len(logs))
            if 0 < variance < VAGUE**2:
                ridge[list(kept)] = covariance[:, place] / variance
            first = Z * math.sqrt(variance) if 0 < variance < VAGUE**2 else 1.0
            up = self.reach(logs, ridge, here, first)
            down = self.reach(logs, -ridge, here, first)
            value = math.exp(logs[i])
            low = value * math.exp(-down) if down < FAR else 0.0
            found.append(Estimate(self.retold.numbers[i], value, low, value * math.exp(up)))
        return found

    def reach(self, logs: Array, way: Array, here: float, first: float) -> float:
        """How far along a way the cost has risen by half the quantile; FAR where it has not."""
        near, far = 0.0, first
        while self.cost(logs + far * way) < here + HALF_BELOW:
            near, far = far, 1.6 * far
            if far > FAR:
                return FAR
        for _ in range(HALVINGS):
            middle = (near + far) / 2
            risen = self.cost(logs + middle * way) > here + HALF_BELOW
            near, far = (near, middle) if risen else (middle, far)
        return (near + far) / 2

    def curvature(self, logs: Array, kept: Sequence[int]) -> Array:
        """The second derivatives of the cost by the logarithms : (n, n)"""
        n = len(kept)
        H, here = np.empty((n, n)), self.cost(logs)
        steps = [CURVE * unit(i, len(logs)) for i in kept]
        up = [self.cost(logs + step) for step in steps]
        down = [self.cost(logs - step) for step in steps]
        for i in range(n):
            H[i, i] = (up[i] - 2 * here + down[i]) / CURVE**2
            for j in range(i):
                both = self.cost(logs + steps[i] + steps[j])
                neither = self.cost(logs - steps[i] - steps[j])
                mixed = both + neither + 2 * here - up[i] - down[i] - up[j] - down[j]
                H[i, j] = H[j, i] = mixed / (2 * CURVE**2)
        return H


def unit(i: int, n: int) -> Array:
    """1 at the place i : (n,)"""
    one = np.zeros(n)
    one[i] = 1.0
    return one


def within(logs: Array, kept: Sequence[int], part: Array) -> Array:
    """Numbers of which some are others."""
    whole = logs.copy()
    whole[list(kept)] = part
    return whole
