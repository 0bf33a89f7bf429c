"""What is said when a run is over:
what was done, how far off it ended, and one plain verdict with its evidence.
"""

import math
from collections.abc import Sequence

from ekfsim.diagnostics.shutting_out import Weighing
from ekfsim.diagnostics.summary import Errors, Summary
from ekfsim.diagnostics.verdict import BAND, FIRST, LOST, Evidence, Verdict
from ekfsim.filters.arithmetic.chi_square import band, quantile
from ekfsim.filters.belief import Refused
from ekfsim.records import Nees
from ekfsim.scene import Scene
from ekfsim.smoothing.shares import Shares
from ekfsim.views.playback.parting import Apart
from ekfsim.views.playback.view import View
from ekfsim.views.words.narrative.trust import shut_briefly, shutting_out
from ekfsim.views.words.numbers import between, figure, number, turn
from ekfsim.views.words.text_table import aligned
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
    few = _count(min(evidence.nis_readings, FIRST), "reading")
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
        return _count(summary.steps, "command")
    given = f"{_count(summary.inputs, 'motion input')} and {_count(summary.readings, 'reading')}"
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


def sentence(evidence: Evidence) -> str:
    """The verdict on one run and its evidence."""
    verdict = evidence.verdict
    match verdict:
        case Verdict.LOST:
            assert evidence.last_nees is not None
            return (
                f"{verdict.value} from step {evidence.lost_from} on: "
                f"at the last step {_nees(evidence.last_nees)}"
            )
        case Verdict.NO_EVIDENCE:
            return f"{verdict.value}: not one reading could be held against a prediction"
        case Verdict.CONSISTENT:
            return f"{verdict.value}: {_nis(evidence, 'within')}{_also(evidence)}"
        case Verdict.OVER_CONFIDENT:
            return (
                f"{verdict.value}: {_nis(evidence, 'above')}: "
                "the filter trusts itself more than its readings allow"
            )
        case Verdict.OVER_CAUTIOUS:
            return (
                f"{verdict.value}: {_nis(evidence, 'below')}: "
                "the filter trusts itself less than it could"
            )


def meaning(view: View, scene: Scene) -> str:
    """What the verdict on the run comes to, in its last view: whether to believe the filter, and
    since when not. Nothing in any other, nor where several filters watch.
    """
    evidence = view.judged.closing
    if evidence is None or view.others:
        return ""
    match evidence.verdict:
        case Verdict.LOST:
            since = f"lost since step {evidence.lost_from}"
            shut = evidence.trusts.shut_out(Weighing.of(scene))
            if shut is not None:
                return f"not to be believed: {since}; {shut_briefly(shut)}"
            return f"not to be believed: {since}{_shown(evidence)}"
        case Verdict.OVER_CONFIDENT:
            return _but_for_refused(evidence) or (
                f"not to be believed since step {evidence.nis_outside_from}: "
                "it trusts itself more than its readings allow"
            )
        case Verdict.OVER_CAUTIOUS:
            return (
                "to be believed, and nearer to the truth than it says: "
                "it trusts itself less than it could"
            )
        case Verdict.CONSISTENT:
            errors = "" if evidence.last_nees is None else " or its last error"
            return f"to be believed: nothing in its readings{errors} speaks against it"
    return ""


def _shown(evidence: Evidence) -> str:
    """Whether the readings of a run that is lost show it; nothing where there were none."""
    if not evidence.nis_dof:
        return ""
    low, high = evidence.nis_band
    side = "above" if evidence.nis_sum > high else "below" if evidence.nis_sum < low else "within"
    told = (
        f"(ΣNIS {figure(evidence.nis_sum)} of {evidence.nis_readings}, {side} {between(low, high)})"
    )
    if side == "above":
        return f"; its readings say so since step {evidence.nis_outside_from} {told}"
    return f", though its readings do not say so {told}"


def _but_for_refused(evidence: Evidence) -> str:
    """That only readings which were refused speak against a filter, where it is so."""
    low, high = band(BAND, evidence.used_dof)
    if not evidence.nis_refused or evidence.used_sum > high:
        return ""
    side = "below" if evidence.used_sum < low else "within"
    used = _count(evidence.nis_readings - evidence.nis_refused, "reading")
    return (
        f"to be believed but for what it refused: ΣNIS of the {used} that it used is "
        f"{figure(evidence.used_sum)}, {side} {between(low, high)}"
    )


def _nis(evidence: Evidence, side: str) -> str:
    low, high = evidence.nis_band
    refused = f" ({evidence.nis_refused} of them refused)" if evidence.nis_refused else ""
    readings = (
        "1 reading is"
        if evidence.nis_readings == 1
        else f"{evidence.nis_readings} readings{refused} sums to"
    )
    mean = (
        ""
        if evidence.nis_dof == 1
        else f" ({evidence.nis_sum / evidence.nis_dof:.3g} per number read)"
    )
    freedom = (
        ""
        if evidence.nis_dof == evidence.nis_readings
        else f" ({_count(evidence.nis_dof, 'degree')} of freedom)"
    )
    return (
        f"the NIS of {readings} {number(evidence.nis_sum)}{mean}, {side} the {100 * BAND:.0f} % "
        f"band "
        f"{number(low)} to {number(high)}{freedom}"
    )


def _also(evidence: Evidence) -> str:
    return "" if evidence.last_nees is None else f"; at the last step {_nees(evidence.last_nees)}"


def _nees(measured: Nees) -> str:
    if measured.impossible:
        return (
            "the belief is impossible: the error has a part where the covariance claims certainty"
        )
    dof = int(measured.dof)
    bound = quantile(LOST, dof)
    side = "beyond" if measured.value > bound else "below"
    return (
        f"NEES is {number(float(measured.value))}, {side} its {100 * LOST:.1f} % bound "
        f"{number(bound)} "
        f"({_count(dof, 'degree')} of freedom)"
    )


def _readings(summary: Summary) -> str:
    refused = ", ".join(f"{n} {REASONS[reason]}" for reason, n in sorted(summary.refused.items()))
    told = (
        f"; {_count(sum(summary.refused.values()), 'reading')} not used ({refused})"
        if refused
        else ""
    )
    return f"{_count(summary.updates, 'update')}{told}"


def _metres(errors: Errors) -> str:
    if errors.rmse is None:
        return "unknown"
    return f"RMSE {number(errors.rmse)} m, at most {number(errors.largest)} m"


def _degrees(errors: Errors) -> str:
    if errors.rmse is None:
        return "unknown"
    return f"RMSE {turn(errors.rmse)} degrees, at most {turn(errors.largest)} degrees"


def _count(n: int, thing: str) -> str:
    return f"{n} {thing}" if n == 1 else f"{n} {thing}s"
