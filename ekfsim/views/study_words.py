"""A study for a person: a table, a verdict on each row with its evidence, and how to see the runs behind it."""

import math
import shlex
from collections.abc import Sequence

from ekfsim.files.filter_checks import unread
from ekfsim.study.plan import Plan
from ekfsim.study.results import AtStep, Result, Share
from ekfsim.study.verdict import MOST_LOST, Word, agrees, covers, proven, verdict
from ekfsim.views.numbers import instant
from ekfsim.views.text_table import aligned, folded

MOST_TOLD = 6  # rows, each with what its verdict rests on
IN_TABLE = "What each verdict rests on, and the worst and a typical run of each row, stand in summary.csv (-o)."
HEAD = ("filter", "position", "heading", "> 50 %", "> 95 %", "> 99.9 %", "ellipse", "cone", "lost", "NIS", "verdict")


def conclude(plan: Plan, results: Sequence[Result], width: int | None = None) -> str:
    """All that is printed when a study is over. width : of the terminal; None where there is none"""
    request = plan.request
    lines = [
        *folded(f"{request.commands_name}: {request.runs} runs of seed {plan.seed}, at the last step", width),
        *folded("(RMSE in m and degrees; NEES above quantiles of χ², and the other shares, in %)", width),
        *aligned([[*plan.keys, *HEAD], *map(_row, results)], len(plan.keys) + 1, width),
    ]
    if len(results) > MOST_TOLD:  # the table is what is wanted
        worst = max(results, key=lambda result: (result.tally.worst.impossible, result.tally.worst.nees))
        lines += ["", *folded(IN_TABLE, width), *plays(plan, worst)[:1]]
        return "\n".join(lines) + "\n"
    for result in results:
        lines += ["", *folded(f"{title(result)}: {sentence(result)}", width)]
        lines += [line for told in evidence(result.last) for line in folded(f"  {told}", width)]
        lines += [f"  {line}" for line in plays(plan, result)]  # whole, to be copied
    return "\n".join(lines) + "\n"


def _row(result: Result) -> list[str]:
    last, nis = result.last, result.nis
    shares = (last.above_50, last.above_95, last.above_999, last.ellipse, last.cone, last.lost)
    return [
        *(one.value for one in result.case.values),
        result.case.filter,
        f"{last.position_rmse:.3g}",
        f"{math.degrees(last.heading_rmse):.3g}",
        *map(percent, shares),
        "-" if math.isnan(nis.value) else f"{nis.value:.3g}",
        verdict(result).word.value,
    ]


def title(result: Result) -> str:
    """Which row a sentence is about."""
    return ", ".join([*map(str, result.case.values), result.case.filter])


def sentence(result: Result) -> str:
    """The verdict, and since when."""
    found = verdict(result)
    if found.word is Word.NO_EVIDENCE:
        return f"{found.word.value}: at the last step no run is uncertain of anything"
    since = "" if found.since is None else f" from {when(found.since)} on"
    doubt = "" if proven(result.last) else "; so few runs are no proof, run more"
    return f"{found.word.value}{since}{doubt}"


def when(at: AtStep) -> str:
    """How a person names a step."""
    return f"step {at.step}" if math.isnan(at.t) else f"t = {instant(at.t)} s"


def evidence(last: AtStep) -> list[str]:
    """What the verdict rests on, each with its 95 % interval and what it should be."""
    told = list[str]()
    if last.above_50.of:
        held = _held("45 to 55 %", agrees(last.above_50))
        told.append(f"{shared(last.above_50)} end with a NEES above the χ² median{held}")
    if last.ellipse.of:
        held = _held("93.4 to 97.4 %", covers(last.ellipse))
        told.append(f"{shared(last.ellipse)} end inside the 95.4 % ellipse{held}")
    told.append(f"{shared(last.lost)} are lost{_held('fewer than 2 %', last.lost.value < MOST_LOST)}")
    return told


def _held(right: str, agrees: bool) -> str:
    """Whether what is right for a share is so."""
    return f" ({right} is right)" if agrees else f", not {right}"


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
    """The commands that play the worst run and a typical one."""
    worst = result.tally.worst
    how = "its belief is impossible" if worst.impossible else f"its last NEES is {worst.nees:.3g}"
    return [
        f"the worst run: {played(plan, result, worst.run)}  # {how}",
        f"a typical run: {played(plan, result, result.typical)}",
    ]


def played(plan: Plan, result: Result, run: int) -> str:
    """The command that plays one run of a row."""
    request, scene = plan.request, result.case.scene
    words = ["ekfsim", "play", request.commands_name]
    words += [] if request.world_name is None else ["--world", request.world_name]
    words += ["--seed", str(scene.seed), "--run", str(run), "--filter", scene.filter]
    words += [] if scene.reading == "corrected" else ["--reading", scene.reading]
    settings = (*request.settings, *result.case.values)
    others = unread(settings, [scene.filter])  # what only another filter of the study reads: `play` would refuse it
    for one in settings:
        words += [] if one in others else ["--set", str(one)]
    return shlex.join(words)
