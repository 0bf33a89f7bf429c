"""What a scene promises of its runs, held against what became of them: `expect` in its commands
file.
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Literal

from ekfsim.errors import UsageError
from ekfsim.scene import Expect, Level
from ekfsim.study.plan import Plan
from ekfsim.study.results import Result, Share

NIS, NEES = 0.4, 0.2  # the share of runs outside a band from which on it is no longer silent
Side = Literal["", "above", "below", "outside"]


@dataclass(frozen=True)
class Finding:
    """What a scene promises of one share of its runs, and what that share is."""

    name: Literal["lost", "coverage", "nis", "nees"]
    share: Share
    low: float  # where it is to lie
    high: float
    # of ΣNIS and NEES: on which side of their 95 % band the runs lie that are counted
    side: Side = ""

    @property
    def kept(self) -> bool:
        """Whether it lies there. A band that is silent keeps below its bound; no share lies
        nowhere.
        """
        if self.side == "outside":
            return self.share.value < self.high
        return self.low <= self.share.value <= self.high


def promised(plan: Plan, runs: int | None) -> Plan:
    """The plan with as many runs as its scene's promise asks for, where none are told.

    Raises UsageError where the scene promises nothing, and where there are several.
    """
    if len(plan.cases) > 1:
        raise UsageError(
            "--expect verifies what one scene promises of one filter; "
            "leave --sweep out, and name one"
        )
    expect, name = plan.cases[0].scene.expect, plan.request.commands_name
    if expect is None or not list(findings(expect, None)):
        raise UsageError(
            f"{name}: promises nothing; write e.g. expect: {{lost: [0, 0.02], nis: silent}} into it"
        )
    return replace(plan, request=replace(plan.request, runs=runs or expect.runs))


def verified(result: Result) -> list[Finding]:
    """Everything that the scene of a case promises, and what became of it."""
    expect = result.case.scene.expect
    return [] if expect is None else list(findings(expect, result))


def findings(expect: Expect, result: Result | None) -> Iterator[Finding]:
    """Every promise, in its order; without a result nothing is found yet."""
    none = Share(0, 0)
    if expect.lost is not None:
        yield Finding("lost", none if result is None else result.last.lost, *expect.lost)
    if expect.coverage is not None:
        yield Finding("coverage", none if result is None else result.last.ellipse, *expect.coverage)
    of, runs = (None, 0) if result is None else (result.tally.of, result.tally.runs)
    if expect.nis is not None:
        yield _level("nis", expect.nis, NIS, (of.nis_above, of.nis_below) if of else (0, 0), runs)
    if expect.nees is not None:
        yield _level(
            "nees", expect.nees, NEES, (of.nees_above, of.nees_below) if of else (0, 0), runs
        )


def _level(
    name: Literal["nis", "nees"], level: Level, bound: float, counts: tuple[int, int], runs: int
) -> Finding:
    """A promise about the runs above and below a band."""
    above, below = counts
    match level:
        case "silent":
            return Finding(name, Share(above + below, runs), 0.0, bound, "outside")
        case "high":
            return Finding(name, Share(above, runs), bound, 1.0, "above")
        case "low":
            return Finding(name, Share(below, runs), bound, 1.0, "below")
