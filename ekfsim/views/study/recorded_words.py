"""A study of a recorded log for a person, and as a table: a row for each cell and filter."""

import csv
import math
from collections.abc import Sequence
from typing import TextIO

from ekfsim.fitting.noises import noises_of, told_by_readings
from ekfsim.printable import cell, in_a_line
from ekfsim.study.recorded import Played, Recorded
from ekfsim.version import VERSION
from ekfsim.views.fitting.words import OWN
from ekfsim.views.study.words import MOST_TOLD
from ekfsim.views.words.text_table import aligned, folded
from ekfsim.views.words.whiteness import sentence

FORMAT = 1  # of the table; grows when a column changes its meaning, or goes
HEAD = ("filter", "updates", "NIS", "99 % band", "innovations", "p", "position", "heading")
COLUMNS = (
    *("readings", "updates", "nis_mean", "nis_low", "nis_high", "nis_dof"),
    *("innovations", "innovations_p", "position_rmse", "heading_rmse", "lost_from", "verdict"),
)
ORIGIN = ("log", "gate", "guard", "reading", "set", "ekfsim", "format")


def conclude(plan: Recorded, found: Sequence[Played], width: int | None = None) -> str:
    """All that is printed when it is over. width : of the terminal; None where there is none"""
    log = plan.cases[0].scene.log_source
    head = f"{in_a_line(plan.request.commands_name)}: one run, recorded in {in_a_line(str(log))}"
    lines = [
        *folded(head, width),
        *folded("(NIS per number read and its band; RMSE in m and degrees)", width),
        *aligned([[*plan.keys, *HEAD, "verdict"], *map(_row, found)], len(plan.keys) + 1, width),
    ]
    for key in _idle(plan):
        lines += ["", *folded(f"{key} changes nothing: {OWN}", width)]
    for one in found if len(found) <= MOST_TOLD else ():
        told = sentence(one.summary.innovations.found())
        lines += ["", *folded(f"{title(one)}: innovations are {told}", width)]
    return "\n".join(lines) + "\n"


def _idle(plan: Recorded) -> list[str]:
    """The swept numbers of sensors whose readings tell by themselves how sure they are."""
    scene = plan.cases[0].scene
    theirs = told_by_readings(scene)
    keys = {one.key for one in noises_of(scene) if one.part in theirs} if theirs else set()
    return [key for key in plan.keys if key.removeprefix("belief.") in keys]


def title(one: Played) -> str:
    """Which row a sentence is about."""
    return ", ".join([*map(str, one.case.values), one.case.filter])


def _row(one: Played) -> list[str]:
    summary, evidence = one.summary, one.summary.evidence
    white = summary.innovations.found()
    mean, low, high = nis(one)
    heading = summary.heading.rmse
    return [
        *(value.value for value in one.case.values),
        one.case.filter,
        f"{summary.updates} of {summary.readings}",
        *(("-", "-") if mean is None else (f"{mean:.3g}", f"{low:.3g} to {high:.3g}")),
        white.word,
        "-" if math.isnan(white.p) else f"{float(white.p):.2g}",
        *("-" if e is None else f"{e:.3g}"
          for e in (summary.position.rmse, None if heading is None else math.degrees(heading))),
        evidence.verdict.value,
    ]  # fmt: skip


def nis(one: Played) -> tuple[float | None, float | None, float | None]:
    """NIS per number read and its two-sided 99 % band; None where nothing was read."""
    evidence = one.summary.evidence
    if not evidence.nis_dof:
        return None, None, None
    low, high = evidence.nis_band
    dof = evidence.nis_dof
    return evidence.nis_sum / dof, low / dof, high / dof


def write_summary(file: TextIO, plan: Recorded, found: Sequence[Played]) -> None:
    """A row for each cell and filter: m and rad, nothing where unknown."""
    origin = [name for name in ORIGIN if name not in plan.keys]
    table = csv.writer(file, lineterminator="\n")
    table.writerow([*plan.keys, "filter", *COLUMNS, *origin])
    settings = " ".join(map(str, plan.request.settings))
    for one in found:
        scene, summary, evidence = one.case.scene, one.summary, one.summary.evidence
        white = summary.innovations.found()
        made_by = dict(zip(ORIGIN, (
            scene.log_source, scene.gate, scene.guard, scene.reading, settings, VERSION, FORMAT,
        ), strict=True))  # fmt: skip
        measured = (
            summary.readings, summary.updates, *nis(one), evidence.nis_dof, white.word,
            None if math.isnan(white.p) else float(white.p), summary.position.rmse,
            summary.heading.rmse, evidence.lost_from, evidence.verdict.value,
        )  # fmt: skip
        table.writerow([
            *(value.value for value in one.case.values), cell(one.case.filter),
            *map(_cell, (*measured, *(made_by[name] for name in origin))),
        ])  # fmt: skip


def _cell(value: object) -> str:
    """A number as it stands in a table: six digits; nothing where it is unknown."""
    if value is None:
        return ""
    return f"{value:.6g}" if isinstance(value, float) else str(value)
