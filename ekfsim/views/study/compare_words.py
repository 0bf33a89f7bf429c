"""A comparison for a person: a table, and a plain sentence for each measure."""

import math
from collections.abc import Iterator
from typing import NamedTuple

from ekfsim.printable import in_a_line
from ekfsim.study.comparison import Comparison, Difference, of_means, of_shares
from ekfsim.study.pairs import Pairs
from ekfsim.study.plan import Plan
from ekfsim.views.words.text_table import aligned, folded

HEAD = ("at the last step", "a", "b", "b − a", "95 % interval", "a alone", "b alone")


class Measure(NamedTuple):
    """One thing that is compared, and how it is told."""

    name: str  # in the table of numbers
    unit: str  # there; a share has none
    called: str  # for a person
    told_unit: str
    scale: float  # from the one unit to the other
    claim: str  # how a difference is told: how much, and on which side
    words: tuple[str, str]  # of that side: b is less, b is more
    found: Difference
    runs: int
    a_alone: int | None = None  # runs in which it is so under a alone
    b_alone: int | None = None


def measures(found: Pairs) -> tuple[Measure, ...]:
    """All that is compared, in its order."""
    lost, inside, position, heading = found.lost, found.inside, found.position, found.heading
    few, near = ("fewer", "more"), ("nearer to", "farther from")
    return (
        Measure("lost", "", "lost runs", "%", 100, "b loses {1} runs, by {0}", few, of_shares(lost),
        sum(lost),
                lost.only_a, lost.only_b),
        Measure("ellipse", "", "runs inside the 95.4 % ellipse", "%", 100,
                "b has the truth inside its 95.4 % ellipse in {1} runs, by {0}", few,
                of_shares(inside), sum(inside),
                inside.only_a, inside.only_b),
        Measure("position", "m", "mean position error", "m", 1,
        "b ends on average {} {} the true position", near,
                of_means(position), position.runs),
        Measure("heading", "rad", "mean heading error", "degrees", math.degrees(1),
                "b ends on average {} {} the true heading", near, of_means(heading), heading.runs),
    )  # fmt: skip


def conclude(comparison: Comparison, found: Pairs, width: int | None = None) -> str:
    """All that is printed when a comparison is over.
    width : of the terminal; None where there is none
    """
    request = comparison.request
    what = (
        f"{found.a.runs} runs of seed {comparison.a.seed}, "
        "each under either setting on the same draws"
    )
    head = (
        f"{in_a_line(request.commands_name)}: {what}",
        f"  a: {settings(comparison.a, comparison)}",
        f"  b: {settings(comparison.b, comparison)}",
    )
    lines = [
        *(line for told in head for line in folded(told, width)),
        *aligned([HEAD, *map(_row, measures(found))], 1, width),
        "",
        *(line for told in sentences(found) for line in folded(told, width)),
    ]
    return "".join(f"{line}\n" for line in lines)


def settings(plan: Plan, comparison: Comparison) -> str:
    """What one side sets: its filter where the two differ in it, and its own settings."""
    common = set(comparison.request.settings)
    told = [str(one) for one in plan.request.settings if one not in common]
    if comparison.a.filters != comparison.b.filters:
        told.insert(0, f"filter={plan.cases[0].filter}")
    return ", ".join(told) or "as the file stands"


def _row(measure: Measure) -> tuple[str, ...]:
    found, alone = measure.found, (measure.a_alone, measure.b_alone)
    a, b, value, low, high = (_digits(measure.scale * number) for number in found)
    counts = ("" if runs is None else str(runs) for runs in alone)
    return (f"{measure.called} ({measure.told_unit})", a, b, value, f"{low} to {high}", *counts)


def sentences(found: Pairs) -> Iterator[str]:
    """What the measures say, each with its interval."""
    if not (
        found.lost.only_a + found.lost.only_b or found.position.squares or found.heading.squares
    ):
        yield "a and b end alike in every run"
        return
    for measure in measures(found):
        if not math.isnan(measure.found.value):
            yield sentence(measure)
    position = found.position
    if position.runs:
        nearer, farther = (
            100 * position.b_less / position.runs,
            100 * position.a_less / position.runs,
        )
        yield (
            f"b ends nearer to the truth than a in {nearer:.1f} % of the runs, "
            f"and farther from it in {farther:.1f} %"
        )
    if left_out := found.a.runs - position.runs:
        yield f"{left_out} runs are left out of the means: an estimate of theirs is no number"


def sentence(measure: Measure) -> str:
    """By how much b differs from a, with the interval;
    where that holds zero, that nothing is to be seen.
    """
    a, b, value, low, high = (measure.scale * number for number in measure.found)
    unit = measure.told_unit
    apart = "percentage points" if unit == "%" else unit  # 37 of them fewer are not 37 % fewer
    both = f"a {_digits(a)} {unit}, b {_digits(b)} {unit}"
    if not measure.found.clear:
        difference = f"b − a = {_digits(value)} {apart} ({_digits(low)} to {_digits(high)})"
        return f"no difference in {measure.called} is to be seen: {both}, {difference}"
    told = measure.claim.format(f"{_digits(abs(value))} {apart}", measure.words[value > 0])
    least, most = sorted((abs(low), abs(high)))
    return f"{told} ({_digits(least)} to {_digits(most)}): {both}"


def _digits(value: float) -> str:
    """Three digits with a minus sign; a dash for what is unknown."""
    return "-" if math.isnan(value) else f"{value:.3g}".replace("-", "−")
