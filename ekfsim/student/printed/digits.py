"""How much a printed number leaves open, and what that makes of a step that begins with it.

half      half a unit of the last digit that was printed
carried   what such halves, of each number that a step begins with, make of its result
"""

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass

import numpy as np

from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap

NUMBER = re.compile(r"[-+]?(\d*)\.?(\d*)(?:[eEdD]([-+]?\d+))?", re.ASCII)
SLACK = 1.01  # times a half; a tie may be rounded either way
NOTHING = -400  # less than the power of any float


@dataclass(frozen=True, slots=True)
class Digits:
    """How finely a program prints numbers of one kind: at least as finely as it is seen to.

    Trailing zeros are often left out: 0.05 among numbers of six digits is 0.0500000, and among
    numbers of four decimals 0.0500. Smaller numbers have as many decimals as larger ones or more,
    and one more a power of ten at most.
    """

    decimals: Mapping[int, int]  # the most that are seen, of numbers of each power of ten

    @classmethod
    def of(cls, texts: Iterable[str]) -> "Digits":
        """Those of all numbers of one kind."""
        seen = dict[int, int]()
        for value, decimals in map(_counted, texts):
            power = _power(value)
            if not value and not decimals:
                continue  # a bare 0 tells nothing
            seen[power] = max(decimals, seen.get(power, decimals))
        return cls(seen)

    def half(self, value: float) -> float:
        """Half a unit of the last digit of a number that is printed so.

        >>> six, fixed = Digits.of(["0.05", "12.3457", "1e-3"]), Digits.of(["0.0500", "12.3457"])
        >>> six.half(0.05), six.half(12.3457), fixed.half(0.05)
        (5e-05, 5e-05, 5e-05)
        >>> Digits.of(["0.0512345", "0.05"]).half(1.5)
        5e-06
        """
        if not self.decimals:
            return 0.0
        power = _power(value)
        finest = max(
            decimals if above >= power else decimals - (power - above)
            for above, decimals in self.decimals.items()
        )
        return 10.0**-finest / 2


def _counted(text: str) -> tuple[float, int]:
    """A number, and how many decimals it has."""
    text = text.strip().lower().replace("d", "e")
    found = NUMBER.fullmatch(text)
    if found is None:
        return 0.0, 0
    return float(text), len(found[2]) - int(found[3] or 0)


def _power(value: float) -> int:
    """The power of ten of a number; of 0 that of one too small to be printed."""
    return math.floor(math.log10(abs(value))) if value and math.isfinite(value) else NOTHING


@dataclass(frozen=True, slots=True)
class Halves:
    """Half a unit of each number of a belief."""

    x: Array  # (n,)
    P: Array  # (n, n)


def exact(n: int) -> Halves:
    """Those of a belief that was not printed."""
    return Halves(np.zeros(n), np.zeros((n, n)))


def carried(
    step: Callable[[Gaussian], Gaussian | None], belief: Gaussian, halves: Halves,
    headings: tuple[int, ...],
) -> Halves:  # fmt: skip
    """What the halves of a belief make of a step's result, at worst : (n,), (n, n)

    Each number is moved by its half in turn, to the side where that changes more, and what it
    changes is summed. Infinite where the step then leads nowhere, as where another wall is met, or
    none.
    """
    base, n = step(belief), len(belief.mean)
    open_x, open_P = np.zeros(n), np.zeros((n, n))
    for moves in _moves(belief, halves):
        both = [_apart(step(moved), base, headings) for moved in moves]
        open_x += np.maximum(*(apart.mean for apart in both))
        open_P += np.maximum(*(apart.covariance for apart in both))
    return Halves(open_x, open_P)


def _moves(belief: Gaussian, halves: Halves) -> Iterator[list[Gaussian]]:
    """The beliefs in which one number is larger, and smaller, by its half."""
    x, P = belief
    for i in range(len(x)):
        if half := halves.x[i]:
            step = half * np.eye(len(x))[i]
            yield [Gaussian(x + step, P), Gaussian(x - step, P)]
        for j in range(i, len(x)):
            if half := max(halves.P[i, j], halves.P[j, i]):
                one = np.zeros_like(P)
                one[i, j] = one[j, i] = half
                yield [Gaussian(x, P + one), Gaussian(x, P - one)]


def _apart(moved: Gaussian | None, base: Gaussian | None, headings: tuple[int, ...]) -> Gaussian:
    """How far a moved result lies from the base, in each of its numbers."""
    if moved is None or base is None:
        return Gaussian(np.array(np.inf), np.array(np.inf))
    apart = moved.mean - base.mean
    for i in headings:
        apart[i] = wrap(apart[i])
    return Gaussian(
        np.nan_to_num(np.abs(apart), nan=np.inf),
        np.nan_to_num(np.abs(moved.covariance - base.covariance), nan=np.inf),
    )
