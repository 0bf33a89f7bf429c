"""Two settings side by side on the same draws: differences of pairs, each with its 95 %
interval.
"""

import functools
import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple, Self

from ekfsim.errors import UsageError
from ekfsim.files.scenes.checking.filter_checks import refuse_unread
from ekfsim.files.scenes.load_study import FILTER, Request
from ekfsim.files.scenes.settings import Setting, filters_in, setting
from ekfsim.study.code import of_same_code
from ekfsim.study.pairs import Pairs, Shared, Sums, run_pairs
from ekfsim.study.plan import Plan, Task, way_of
from ekfsim.study.results import Share, Z


@dataclass(frozen=True)
class Comparison:
    """A study of one case, twice."""

    request: Request
    a: Plan
    b: Plan

    @classmethod
    def of(cls, request: Request) -> Self:
        """What is asked, ready to be done. Raises UsageError or InputError where it is no
        comparison.
        """
        name = request.name
        if not request.a and not request.b:
            raise UsageError(
                f"{name}: nothing is compared; write e.g. --a guard=off --b guard=skip,gate=0.99"
            )
        if request.sweep or len(request.filters) > 1:
            raise UsageError(
                f"{name}: a study of several cells; compare two: say which by --a and --b"
            )
        a, b = (Plan.of(side(request, settings)) for settings in (request.a, request.b))
        if a.identity() == b.identity():
            raise UsageError(f"{name}: a and b are the same; let them differ")
        filters = (*a.filters, *b.filters)
        refuse_unread(request.settings, filters)  # what is set for both, one of them may read
        for settings, plan in ((request.a, a), (request.b, b)):
            refuse_unread((one for one in settings if one.key != FILTER), plan.filters)
        return cls(request, a, b)

    def block(self, case: int) -> Callable[[int, int], Pairs]:
        """What becomes of pairs of runs: a function of the first and of how many."""
        a, b = self.a.cases[case].scene, self.b.cases[case].scene
        block = functools.partial(run_pairs, a, b, way=way_of(self.a.request))
        return of_same_code(block, {**self.a.codes, **self.b.codes})

    def tasks(self) -> Iterator[Task]:
        """Every block, in order."""
        return self.a.tasks_of(0)

    @property
    def filters(self) -> tuple[str, ...]:
        """Of both sides, each once."""
        return tuple(dict.fromkeys((*self.a.filters, *self.b.filters)))

    @property
    def warnings(self) -> tuple[str, ...]:
        """Of both sides, each once."""
        return tuple(dict.fromkeys((*self.a.warnings, *self.b.warnings)))


def side(request: Request, settings: tuple[Setting, ...]) -> Request:
    """The study that is one side of a comparison."""
    filters = tuple(one.value for one in settings if one.key == FILTER)
    plain = tuple(one for one in settings if one.key != FILTER)
    asked = replace(request, a=(), b=()).overruled(plain, ()).checked()
    return replace(asked, filters=filters) if filters else asked


def with_sides(request: Request, a: str | None, b: str | None) -> Request:
    """The same request with what the command line sets for either side. Raises UsageError where
    that means nothing.
    """
    return replace(
        request,
        a=request.a if a is None else told_side(a, "--a"),
        b=request.b if b is None else told_side(b, "--b"),
    )


def told_side(text: str, option: str) -> tuple[Setting, ...]:
    """What KEY=VALUE,… sets: filter too. Raises UsageError where it means nothing."""
    found = []
    for part in text.split(","):
        if "," in text and "=" not in part:
            raise UsageError(
                f"{option} {text}: '{part}' is no KEY=VALUE; "
                f"write e.g. {option} guard=skip,gate=0.99"
            )
        key, _, value = (word.strip() for word in part.partition("="))
        if key == FILTER:
            (named,) = filters_in(value, f"{option} {FILTER}")
            found.append(Setting(FILTER, named, f"{option} {part}"))
        else:
            found.append(setting(part, option))
    for n, one in enumerate(found):
        if one.key in [other.key for other in found[:n]]:
            raise UsageError(f"{option} {text}: '{one.key}' is set twice; keep one of them")
    return tuple(found)


class Difference(NamedTuple):
    """A number under either setting, and b − a with its 95 % interval; nan where unknown."""

    a: float
    b: float
    value: float
    low: float
    high: float

    @property
    def clear(self) -> bool:
        """Whether the interval lies on one side of zero."""
        return self.low > 0 or self.high < 0


def of_shares(found: Shared) -> Difference:
    """The difference of two shares of the same runs: method 10 of Newcombe, Statistics in Medicine
    17, 1998, 2635.

    With Wilson's interval (l, u) of each share p and their correlation φ,

        low = p_b − p_a − √((p_b − l_b)² − 2 φ (p_b − l_b)(u_a − p_a) + (u_a − p_a)²)

    and high likewise, with l and u in each other's place.
    """
    n = sum(found)
    a, b = Share(found.both + found.only_a, n), Share(found.both + found.only_b, n)
    if not n:
        return Difference(*[math.nan] * 5)
    value, φ = (found.only_b - found.only_a) / n, correlation(found)

    def reach(down: float, up: float) -> float:
        return math.sqrt(max(down**2 - 2 * φ * down * up + up**2, 0.0))

    low = value - reach(b.value - b.low, a.high - a.value)
    high = value + reach(b.high - b.value, a.value - a.low)
    return Difference(a.value, b.value, value, low, high)


def correlation(found: Shared) -> float:
    """φ of a two-by-two table, corrected for continuity; 0 where one of the shares is 0 or 1."""
    n = sum(found)
    e, f, g, h = found
    margins = (e + f) * (g + h) * (e + g) * (f + h)
    product = e * h - f * g
    corrected = max(product - n / 2, 0.0) if product > 0 else product
    return corrected / math.sqrt(margins) if margins else 0.0


def of_means(found: Sums) -> Difference:
    """The mean of the differences, b − a, ± 1.96 s/√n."""
    n = found.runs
    if not n:
        return Difference(*[math.nan] * 5)
    mean = found.difference / n
    variance = max(found.squares - n * mean**2, 0.0) / (n - 1) if n > 1 else math.nan
    half = Z * math.sqrt(variance / n)
    return Difference(found.a / n, found.b / n, mean, mean - half, mean + half)
