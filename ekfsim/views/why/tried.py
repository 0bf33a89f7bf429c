"""The changes that were tried: a table for a person, and all of them as CSV."""

import csv
import math
from collections.abc import Iterator, Sequence
from itertools import groupby
from typing import TextIO

from ekfsim.printable import cell, in_a_line
from ekfsim.provenance import provenance
from ekfsim.views.why.changes import PLURALS, ends, named, ringed
from ekfsim.views.words.numbers import figure
from ekfsim.views.words.text_table import aligned, folded
from ekfsim.why.records import Explanation, Tried

FORMAT = 1  # of the table; grows when a column changes its meaning, or goes
HEAD = ("kind", "name", "step", "told", "cures", "in_cure", "outcome", "nees_end", "lost_from")
TOLD = 3  # changes of one kind that are told each by itself
NONE = "–"  # where no truth is known
MOST = 10  # changes that cure, in the table


def table(explanation: Explanation, width: int | None = None) -> list[str]:
    """Those that cure, and the others by their kinds where they are many."""
    rows = [("", "change", "NEES", "ends")]
    steps = explanation.lost_steps
    judged = not explanation.scene.log or any(step.nees is not None for step in steps)
    cures = [one for one in explanation.tried if one.cures]
    rows += [_row(one, "cures", judged) for one in cures[:MOST]]
    left = len(cures) - MOST
    notes = [f"{left} more cure as well"] if left > 0 else []
    others = sorted(
        (one for one in explanation.tried if not one.cures), key=lambda one: one.change.kind
    )
    for kind, some in groupby(others, key=lambda one: one.change.kind):
        each = list(some)
        if len(each) <= TOLD:
            rows += [_row(one, "", judged) for one in each]
        else:
            rows.append(("", f"{len(each)} {PLURALS[kind]}", *_range(each, judged)))
    lines = [*aligned_rows(rows, width)]
    return [*lines, *(line for note in notes for line in folded(note, width))]


def aligned_rows(rows: Sequence[tuple[str, str, str, str]], width: int | None) -> list[str]:
    """A table whose names are cut where they leave no room for what became of them."""
    if width is not None:
        other = sum(max(len(row[i]) for row in rows) + 2 for i in (0, 2, 3))
        room = max(width - 1 - other, 12)
        rows = [(a, _cut(name, room), c, d) for a, name, c, d in rows]
    return aligned(rows, 2, width)


def _row(one: Tried, mark: str, judged: bool) -> tuple[str, str, str, str]:
    obvious = one.change.kind in ("reading", "move")  # what becomes of them is always the same
    told = f" ({ringed(one.change)})" if one.change.told and not obvious else ""
    at_end = NONE if one.outcome == "recorded" or not judged else nees(one.nees_end)
    return mark, in_a_line(f"{named(one.change)}{told}"), at_end, ends(one)


def _range(each: Sequence[Tried], judged: bool) -> tuple[str, str]:
    """The NEES of many, from the least to the most, and that none of them cures."""
    if not judged:
        return NONE, "none cures"
    known = [one.nees_end for one in each if not math.isnan(one.nees_end)]
    span = f"{figure(min(known))} … {figure(max(known))}" if known else "impossible"
    return span, "none cures"


def _cut(name: str, room: int) -> str:
    """A name with as much of what was put right as there is room for: none, or all of it."""
    if len(name) <= room:
        return name
    alone = name.partition(" (")[0]
    return alone if len(alone) <= room else f"{alone[: room - 1].rstrip()}…"


def nees(value: float) -> str:
    """The NEES at the end; a belief that is certain of what is not so has none."""
    return "impossible" if math.isnan(value) else figure(value)


def write_csv(file: TextIO, explanation: Explanation) -> None:
    """Every change that was tried, a row each, and what made the table."""
    out = csv.writer(file, lineterminator="\n")
    origin = provenance(explanation.scene)
    out.writerow([*HEAD, *origin, "format"])
    for row in rows(explanation):
        out.writerow([*map(cell, row), *("" if v is None else cell(v) for v in origin.values()),
                      FORMAT])  # fmt: skip


def rows(explanation: Explanation) -> Iterator[tuple[str | int | float, ...]]:
    """The cells beneath HEAD; empty where there is nothing."""
    for one in explanation.tried:
        change = one.change
        yield (
            change.kind, change.name, "" if change.step is None else change.step, change.told,
            int(one.cures), int(change in explanation.cure), one.outcome,
            "" if math.isnan(one.nees_end) else f"{one.nees_end:.9g}",
            "" if one.lost_from is None else one.lost_from,
        )  # fmt: skip
