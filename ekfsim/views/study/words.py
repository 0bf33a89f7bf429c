"""A study for a person: a table, a verdict on each row with its evidence,
and how to see the runs behind it.
"""

import math
import shlex
from collections.abc import Sequence

from ekfsim.files.scenes.checking.filter_checks import unread
from ekfsim.files.yaml.marked import scalar
from ekfsim.filters.place import is_smoothed
from ekfsim.printable import in_a_line
from ekfsim.study.plan import Plan
from ekfsim.study.results import AtStep, Result, Share
from ekfsim.study.verdict import (
    COVERED,
    MEDIAN,
    MOST_LOST,
    NIS,
    AtEnd,
    Measure,
    OnTheWay,
    Verdict,
    Word,
)
from ekfsim.views.study.all_steps import over_all_steps
from ekfsim.views.words.numbers import instant
from ekfsim.views.words.text_table import aligned, folded

MOST_TOLD = 6  # rows, each with what its verdict rests on
IN_TABLE = "What each verdict rests on, and the worst and a typical run of each row, stand in {}."
HEAD = (
    *(
        "filter",
        "position",
        "heading",
        "> 50 %",
        "> 95 %",
        "> 99.9 %",
        "ellipse",
        "cone",
        "lost",
        "NIS",
    ),
    *("at the end", "on the way"),
)
MOST_RUNS = 10**9  # that are worth being told of


def conclude(
    plan: Plan, results: Sequence[Result], width: int | None = None, pace: float = 0.0
) -> str:
    """All that is printed when a study is over.

    width : of the terminal; None where there is none; pace : runs a second, 0 where it is not asked
    """
    request = plan.request
    asked = f"{in_a_line(request.commands_name)}: {request.runs} runs of seed {plan.seed}"
    lines = [
        *folded(f"{asked}, at the last step{paced(pace)}", width),
        *folded(
            "(RMSE in m and degrees; NEES above quantiles of χ², and the other shares, in %)", width
        ),
        *aligned([[*plan.keys, *HEAD], *map(_row, results)], len(plan.keys) + 1, width),
        *over_all_steps(plan, results, width),
    ]
    if len(results) > MOST_TOLD:  # the table is what is wanted
        where = "table()" if request.in_python else "summary.csv (-o)"
        worst = max(
            results, key=lambda result: (result.tally.worst.impossible, result.tally.worst.nees)
        )
        lines += ["", *folded(IN_TABLE.format(where), width), *plays(plan, worst)[:1]]
        return "\n".join(lines) + "\n"
    for result in results:
        lines += ["", *folded(f"{title(result)}: {sentence(Verdict(result))}", width)]
        lines += [line for told in evidence(Verdict(result)) for line in folded(f"  {told}", width)]
        lines += [f"  {line}" for line in plays(plan, result)]  # whole, to be copied
    return "\n".join(lines) + "\n"


def paced(pace: float) -> str:
    """How many runs were done a second, in two digits.

    >>> paced(118432.0), paced(0.0)
    ('; 120000 runs a second', '')
    """
    return f"; {float(format(pace, '.2g')):.0f} runs a second" if pace else ""


def _row(result: Result) -> list[str]:
    last, nis = result.last, result.nis
    found = Verdict(result)
    shares = (last.above_50, last.above_95, last.above_999, last.ellipse, last.cone, last.lost)
    return [
        *(one.value for one in result.case.values),
        result.case.filter,
        f"{last.position_rmse:.3g}",
        f"{math.degrees(last.heading_rmse):.3g}",
        *map(percent, shares),
        "-" if math.isnan(nis.value) else f"{nis.value:.3g}",
        at_end(found.at_end),
        way_word(found.on_the_way),
    ]


def title(result: Result) -> str:
    """Which row a sentence is about."""
    return ", ".join([*map(str, result.case.values), result.case.filter])


def sentence(found: Verdict) -> str:
    """The verdict: at the end, and on the way where there is something to say of it."""
    end, way = found.at_end, found.on_the_way
    told = f"{at_end(end)} at the end"
    if end.word is Word.NO_EVIDENCE:
        told = f"{told}: no run is uncertain of anything;"
    elif not end.decided:
        told = f"{told}; {enough(end.runs_to_tell)};"
    if way.word is None:
        return told.removesuffix(";")
    if told.endswith(";"):
        return f"{told} {way_word(way)} {where_and_why(way, found.result.last)}"
    again = "and" if way_word(way) == at_end(end) else way_word(way)
    return f"{told}, {again} {where_and_why(way, found.result.last)}"


def at_end(end: AtEnd) -> str:
    """The word at the end, and whether it is more than a leaning."""
    return (
        end.word.value if end.decided or end.word is Word.NO_EVIDENCE else f"leans {end.word.value}"
    )


def enough(runs: float) -> str:
    """How many runs would decide, in one digit.

    >>> enough(379.4), enough(4001.0), enough(math.inf)
    ('about 400 runs would tell', 'about 5000 runs would tell', 'more runs may tell')
    """
    if runs > MOST_RUNS:
        return "more runs may tell"
    digit = 10 ** int(math.log10(runs))
    return f"about {math.ceil(runs / digit) * digit} runs would tell"


def way_word(way: OnTheWay) -> str:
    """The word on the way, a dash where there is none; it leans where chance could do so much."""
    if way.word is None:
        return "-"
    return way.word.value if way.decided else f"leans {way.word.value}"


def where_and_why(way: OnTheWay, last: AtStep) -> str:
    """Where a word on the way holds, and what tells."""
    where = stretch(way.steps, last) if way.steps else "on the way"
    low, high = NIS
    by_nis = not low <= way.nis.value <= high and (way.word is Word.OVER_CAUTIOUS) == (
        way.nis.value < low
    )
    why = (
        f"NIS {way.nis.value:.3g}"
        if by_nis
        else f"up to {percent(way.worst.above_999)} % beyond 99.9 %"
    )
    return f"{where}: {why}"


def stretch(steps: Sequence[AtStep], last: AtStep) -> str:
    """From the first of some steps to the last; how many there are is told with the evidence."""
    first, final = steps[0], steps[-1]
    if len(steps) == 1:
        return f"at {when(first)}"
    if final.step == last.step:
        return f"from {when(first)} on"
    return f"from {when(first)} to {when(final).removeprefix('step ').removeprefix('t = ')}"


def when(at: AtStep) -> str:
    """How a person names a step."""
    return f"step {at.step}" if math.isnan(at.t) else f"t = {instant(at.t)} s"


def evidence(found: Verdict) -> list[str]:
    """What the verdict rests on, each with its 95 % interval and what it should be."""
    end, way = found.at_end, found.on_the_way
    told = list[str]()
    if end.above_median.share.of:
        told.append(_held(end.above_median, "end with a NEES above the χ² median", _range(MEDIAN)))
    if end.covered.share.of:
        told.append(_held(end.covered, "end inside the 95.4 % ellipse", _range(COVERED)))
    elif end.above_median.share.of:
        told.append("no run ends with an ellipse that has an area: nothing is said of its coverage")
    told.append(_held(end.lost, "are lost", f"fewer than {100 * MOST_LOST:.0f} %"))
    if not math.isnan(way.nis.value):
        low, high = NIS
        right, held = f"{low} to {high}", low <= way.nis.value <= high
        word = (
            ""
            if held
            else f": {(Word.OVER_CAUTIOUS if way.nis.value < low else Word.OVER_CONFIDENT).value}"
        )
        told.append(
            f"NIS is {way.nis.value:.3g} per number read, where {way.nis.low:.3g} to "
            f"{way.nis.high:.3g} is chance"
            f"{_right(right, held)}{word}"
        )
        of = found.result.tally.of
        above, below = (percent(Share(runs, of.nis_runs)) for runs in (of.nis_above, of.nis_below))
        told.append(
            f"{above} % of the runs have a sum of NIS above its 95 % band, "
            f"{below} % below (2.5 % each is chance)"
        )
    if way.steps:
        share, steps = way.worst.above_999, len(way.steps)
        many = (
            ""
            if steps == 1
            else f", the most of {steps} steps with more than {100 * MOST_LOST:.0f} %"
        )
        told.append(f"{shared(share)} lie beyond the χ² 99.9 % quantile at {when(way.worst)}{many}")
    if unsettled := found.result.tally.of.unsettled:
        readings = found.result.tally.of.nis_readings
        told.append(
            f"at {unsettled} of {readings} readings the search for the most probable state did "
            f"not settle"
        )
    return told


def _held(measure: Measure, what: str, right: str) -> str:
    """A share, whether it is as it should be, and what it says where it is not."""
    held = measure.word is Word.CONSISTENT
    return f"{shared(measure.share)} {what}{_right(right, held)}" + (
        "" if held else f": {measure.word.value}"
    )


def _right(right: str, held: bool) -> str:
    """Whether what is right is so."""
    return f" ({right} is right)" if held else f", not {right}"


def _range(edges: tuple[float, float]) -> str:
    return " to ".join(f"{100 * edge:g}" for edge in edges) + " %"


def shared(share: Share) -> str:
    """A share with its interval."""
    return f"{percent(share)} % [{_percent(share.low)}, {_percent(share.high)}]"


def percent(share: Share) -> str:
    """A share in percent, a dash where there is none."""
    return _percent(share.value) if share.of else "-"


def _percent(value: float) -> str:
    """A decimal, of what is small two; none where it is exact.

    >>> _percent(0.5012), _percent(0.96), _percent(0.0004), _percent(0.0), _percent(1.0)
    ('50.1', '96.0', '0.04', '0', '100')
    """
    if value in (0.0, 1.0):
        return f"{100 * value:.0f}"
    return f"{100 * value:.{1 if value >= 0.01 else 2}f}"


def plays(plan: Plan, result: Result) -> list[str]:
    """The commands that play the worst run and a typical one, and where runs are lost the one that
    says why the worst was.
    """
    worst = result.tally.worst
    how = "its belief is impossible" if worst.impossible else f"its last NEES is {worst.nees:.3g}"
    return [
        f"the worst run: {played(plan, result, worst.run)}  # {how}",
        f"a typical run: {played(plan, result, result.typical)}",
        *([f"why it was lost: {asked_why(plan, result, worst.run)}"] if explained(result) else []),
    ]


def explained(result: Result) -> bool:
    """Whether it is told why the worst run of a row was lost: of a robot that obeys commands, where
    more are lost than chance does.
    """
    last = result.last.lost
    if is_smoothed(result.case.scene.filter):  # its filter's row tells it
        return False
    return last.runs > MOST_LOST * last.of and result.case.scene.commanded


def asked_why(plan: Plan, result: Result, run: int) -> str:
    """The command that says why a run of a row was lost."""
    return played(plan, result, run).replace("play", "why", 1)


def played(plan: Plan, result: Result, run: int) -> str:
    """The command that plays one run of a row."""
    request, scene = plan.request, result.case.scene
    if request.in_python:
        return _replayed(plan, result, run)
    words = ["ekfsim", "play", request.commands_name]
    words += [] if request.world_name is None else ["--world", request.world_name]
    words += ["--seed", str(scene.seed), "--run", str(run), "--filter", scene.filter]
    words += [] if scene.reading == "corrected" else ["--reading", scene.reading]
    settings = (*request.settings, *result.case.values)
    # what only another filter of the study reads: `play` would refuse it
    others = unread(settings, [scene.filter])
    for one in settings:
        words += [] if one in others else ["--set", str(one)]
    return in_a_line(shlex.join(words))


def _replayed(plan: Plan, result: Result, run: int) -> str:
    """The same in Python, of the scene that was studied."""
    scene = result.case.scene
    own = [f"seed={scene.seed}", f"run={run}"]
    own += [f"filter={scene.filter!r}"] if len(plan.filters) > 1 else []
    swept = [f"{one.key!r}, {scalar(one.value)!r}" for one in result.case.values]
    return in_a_line(f"ekfsim.play(scene.with_({', '.join([*swept, *own])}))")
