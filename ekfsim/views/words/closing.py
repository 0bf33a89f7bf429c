"""What is said when a run is over:
what was done, how far off it ended, and one plain verdict.
"""

import math
from collections.abc import Sequence

from ekfsim.diagnostics.summary import Errors, Summary
from ekfsim.diagnostics.verdict import FIRST
from ekfsim.filters.belief import Refused
from ekfsim.scene import Scene
from ekfsim.smoothing.shares import Shares
from ekfsim.views.playback.parting import Apart
from ekfsim.views.words.narrative.trust import shutting_out
from ekfsim.views.words.numbers import count, figure, number, turn
from ekfsim.views.words.text_table import aligned
from ekfsim.views.words.verdict import sentence
from ekfsim.views.words.whiteness import sentence as whiteness

REASONS = {
    Refused.NO_ECHO: "without an echo",
    Refused.NO_WALL: "where no wall was predicted",
    Refused.GUARD: "left out by the guard",
    Refused.GATE: "refused by the gate",
}


HEAD = (
    *("filter", "updates", "position", "heading", "ΣNIS", "99 % band", "last NEES"),
    *("innovations", "verdict"),
)


def conclude(summary: Summary) -> str:
    """The closing lines, each ended by a newline."""
    lines = [f"The run is over after {_done(summary)}: {_readings(summary)}", *_errors(summary)]
    if summary.path.rmse is not None:
        lines += [f"Distance to the expected path: {_metres(summary.path)}"]
    if summary.innovations.of:
        lines += [f"Innovations: {whiteness(summary.innovations.found())}"]
    lines += [f"Verdict: {sentence(summary.evidence)}", *_cause([summary]), *_shut_out(summary)]
    return "".join(f"{line}\n" for line in lines)


def conclude_all(
    scene: Scene,
    summaries: Sequence[Summary],
    quiet: bool = False,
    parted: Sequence[Apart] = (),
    shares: Sequence[Shares] = (),
) -> str:
    """The same where several filters watched:
    side by side, where they parted, and a verdict on each unless it is to be quiet.
    shares : of the steps of each, where one is smoothed: at the last it is what it is smoothed from
    """
    if len(summaries) == 1:
        return conclude(summaries[0])
    names, first = scene.watching, summaries[0]
    lines = [
        f"The run is over after {_done(first)}; "
        f"{len(names)} filters side by side (RMSE in m, degrees):",
        *_table(names, summaries),
        *(apart.told for apart in parted),
        *_on_the_way(names, shares),
    ]
    verdicts = (
        f"{name}: {sentence(summary.evidence)}"
        for name, summary in zip(names, summaries, strict=True)
    )
    shut = [
        f"{name}: {told[:1].lower()}{told[1:]}"
        for name, summary in zip(names, summaries, strict=True)
        for told in _shut_out(summary)
    ]
    said = lines if quiet else [*lines, "", *verdicts]
    said += [*_cause(summaries), *shut]
    return "".join(f"{line}\n" for line in said)


def _on_the_way(names: Sequence[str], shares: Sequence[Shares]) -> list[str]:
    """How honest each filter was at all steps together, in a line."""
    told = (
        f"{name} {100 * share.above / share.judged:.0f} %"
        + (f" ({share.lost} beyond 99.9 %)" if share.lost else "")
        for name, share in zip(names, shares, strict=False)
        if share.judged
    )
    joined = ", ".join(told)
    return [f"NEES above its χ² median, of all steps (half is right): {joined}"] if joined else []


def _cause(summaries: Sequence[Summary]) -> list[str]:
    """What is the likely cause of a verdict, where it is the start: no other number is to blame."""
    first = summaries[0]
    if first.start_known or not all(summary.evidence.doubts_start for summary in summaries):
        return []
    evidence = first.evidence
    mean = figure(evidence.first_sum / evidence.first_dof)
    few = count(min(evidence.nis_readings, FIRST), "reading")
    return [
        f"Likely cause: the start, which no truth bears out: NIS is {mean} per number read in the "
        f"first {few}; say where it is with --set start.x=… (y, theta), and how surely with "
        "--set belief.sigma.x=… (y, theta)"
    ]


def _shut_out(summary: Summary) -> list[str]:
    """That the filter believes its readings no more, where it is so: of one that weighs them it is
    the way to get lost.
    """
    if (found := summary.shut_out) is None:
        return []
    lost = summary.evidence.lost_from is not None
    return [f"{'How it was lost' if lost else 'Doubted'}: {shutting_out(found, lost)}"]


def _table(names: Sequence[str], summaries: Sequence[Summary]) -> list[str]:
    """A row for each filter, and one for the odometry alone."""
    rows: list[Sequence[str]] = [HEAD, *map(_row, names, summaries)]
    first = summaries[0]
    if first.position.n:
        reckoned = (
            _cell(first.reckoned_position.rmse),
            _cell(first.reckoned_heading.rmse, math.degrees(1)),
        )
        rows.append(("odometry alone", "", *reckoned, *[""] * 5))
    return aligned(rows, 1)


def _row(name: str, summary: Summary) -> tuple[str, ...]:
    evidence, last = summary.evidence, summary.evidence.last_nees
    low, high = evidence.nis_band
    known = evidence.nis_dof > 0
    nees = (
        "-"
        if last is None
        else "impossible"
        if last.impossible
        else f"{float(last.value):.3g} ({int(last.dof)})"
    )
    return (
        name,
        f"{summary.updates} of {summary.readings}",
        _cell(summary.position.rmse),
        _cell(summary.heading.rmse, math.degrees(1)),
        f"{evidence.nis_sum:.3g}" if known else "-",
        f"{low:.3g} to {high:.3g}" if known else "-",
        nees,
        summary.innovations.found().word,
        evidence.verdict.value,
    )


def _cell(value: float | None, scale: float = 1.0) -> str:
    """A number of the table; a dash where it is unknown."""
    return "-" if value is None else f"{scale * value:.3g}"


def _done(summary: Summary) -> str:
    """What was done: commands obeyed one by one,
    or a clock's time of motion inputs and readings.
    """
    if summary.duration is None:
        return count(summary.steps, "command")
    given = f"{count(summary.inputs, 'motion input')} and {count(summary.readings, 'reading')}"
    return f"{given} over {number(summary.duration)} s"


def _errors(summary: Summary) -> list[str]:
    """How far off the filter was, and how far off it would have been without readings."""
    if not summary.position.n:
        return []
    if summary.position.rmse is None or summary.heading.rmse is None:
        return ["The errors are unknown: the estimate is no number"]
    alone = "by odometry alone" if summary.duration is None else "by the motion inputs alone"
    return [
        f"Position error: {_metres(summary.position)}; {alone} "
        f"{_metres(summary.reckoned_position)}",
        f"Heading error: {_degrees(summary.heading)}; {alone} {_degrees(summary.reckoned_heading)}",
    ]


def _readings(summary: Summary) -> str:
    refused = ", ".join(f"{n} {REASONS[reason]}" for reason, n in sorted(summary.refused.items()))
    told = (
        f"; {count(sum(summary.refused.values()), 'reading')} not used ({refused})"
        if refused
        else ""
    )
    return f"{count(summary.updates, 'update')}{told}"


def _metres(errors: Errors) -> str:
    if errors.rmse is None:
        return "unknown"
    return f"RMSE {number(errors.rmse)} m, at most {number(errors.largest)} m"


def _degrees(errors: Errors) -> str:
    if errors.rmse is None:
        return "unknown"
    return f"RMSE {turn(errors.rmse)} degrees, at most {turn(errors.largest)} degrees"
