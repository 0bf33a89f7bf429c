"""What can be wrong with the times of a table's rows, and what a person would make of it."""

from dataclasses import replace

import numpy as np

from ekfsim.files.keys.recorded.recording import SameTime
from ekfsim.files.logs.table import Rows
from ekfsim.geometry import Array, Booleans, Integers

LONG = 10  # a gap is longer than so many usual steps
NEARLY_ALL = 0.9  # of the times that stand in several rows


def in_order(rows: Rows, warnings: list[str]) -> Rows:
    """The rows by time, those of one instant as they stand in the file, and none twice."""
    if tell_back(rows, warnings):
        rows = rows[np.argsort(rows.t, kind="stable")]
    return _once(rows, warnings)


def tell_back(rows: Rows, warnings: list[str]) -> bool:
    """Whether a time lies before that of the row above;
    a warning says that the rows are put in order.
    """
    back = np.flatnonzero(np.diff(rows.t) < 0) + 1
    if not len(back):
        return False
    first, more = int(back[0]), f", and so do {len(back) - 1} more" if len(back) > 1 else ""
    told = (
        f"{rows.at(first)}: the time {rows.t[first]:.12g} lies before that of the row above{more}"
    )
    warnings.append(f"{told}: the rows are put in order of time")
    return True


def _once(rows: Rows, warnings: list[str]) -> Rows:
    """The rows without those that repeat another to the last number."""
    if not np.any(np.diff(rows.t) == 0):
        return rows
    first = np.sort(np.unique(rows.values, axis=0, return_index=True)[1])
    twice = np.setdiff1d(np.arange(len(rows)), first)
    if len(twice):
        more = f", as do {len(twice) - 1} more" if len(twice) > 1 else ""
        warnings.append(
            f"{rows.at(int(twice[0]))}: this row repeats another of the same time{more}: left out"
        )
    return rows[first]


def tell_repeated(rows: Rows, warnings: list[str], made: str = "") -> None:
    """Warn of rows that share a time where each should have its own,
    and of what is made of them.
    """
    repeated = np.flatnonzero(np.diff(rows.t) == 0) + 1
    if len(repeated):
        more = f", and so do {len(repeated) - 1} more" if len(repeated) > 1 else ""
        row = int(repeated[0])
        warnings.append(
            f"{rows.at(row)}: the time {rows.t[row]:.12g} is that of the row above, too{more}{made}"
        )


def tell_gaps(rows: Rows, warnings: list[str]) -> None:
    """Warn of the longest gap where it is much longer than the usual step."""
    if len(rows) < 3:
        return
    dt = np.diff(rows.t)
    usual = step_of(rows)
    long = np.flatnonzero(dt > LONG * usual)
    if len(long):
        row = int(np.argmax(dt))
        which = "" if len(long) == 1 else f", the longest of {len(long)}"
        gap = f"a gap of {dt[row]:.3g} s before this row{which}; the usual step is {usual:.3g} s"
        warnings.append(f"{rows.at(row + 1)}: {gap}")


def step_of(rows: Rows) -> float:
    """The usual time between two rows in s, 0 where there are no two."""
    dt = np.diff(rows.t)
    return float(np.median(dt[dt > 0])) if np.any(dt > 0) else 0.0


def apart(
    rows: Rows, warnings: list[str], asked: SameTime | None, until_next: bool = False
) -> Rows:
    """The rows of what drives the robot in order, each with a time of its own.

    Rows of one time and different numbers are no repetition. Where one says 0 of all that another
    tells (speed and turn rate in rows of their own, or a second program that tells of standstill)
    they are one row in several parts, and added up. Else they followed one another faster than the
    clock could tell, and share the time evenly: a clock that counts whole seconds tells when each
    began, so until the next time; else since the time before, at which a row is written that tells
    what was; or until the next, where a row tells what follows (`until_next`).

    asked : what the rows of one time are, where the commands file says so; repeated rows go then,
        too
    """
    if tell_back(rows, warnings):
        rows = rows[np.argsort(rows.t, kind="stable")]
    starts, counts = _times_of(rows)
    if len(starts) == len(rows):
        return rows
    if asked is None and _only_repeated(rows):
        return _once(rows, warnings)
    if asked in ("first", "last"):
        tell_repeated(rows, warnings, f": the {asked} row of one time holds")
        return rows[starts if asked == "first" else starts + counts - 1]
    parts = _in_parts(rows, starts) & (counts > 1) if asked != "add" else counts > 1
    if asked == "add" or (
        asked is None and np.count_nonzero(parts) >= NEARLY_ALL * np.count_nonzero(counts > 1)
    ):
        how = "" if asked else ", for one says 0 where the other does not"
        tell_repeated(rows, warnings, f": rows of one time are added up{how}{_otherwise(asked)}")
        rows = _added(rows, starts, parts)
        starts, counts = _times_of(rows)
        return rows if len(starts) == len(rows) else _spread(rows, starts, counts, until_next)
    cut = _unit_of(rows.t[starts], counts)
    since = "until the next" if until_next or cut else "since the one before"
    why = f"the times seem cut to {cut:g} s, and " if cut else ""
    made = f": {why}rows of one time share the span {since} evenly{_otherwise(asked)}"
    tell_repeated(rows, warnings, made)
    return _spread(rows, starts, counts, until_next or cut > 0)


def _otherwise(asked: SameTime | None) -> str:
    return "" if asked else " (otherwise: --set recording.sameTime=share, add, first or last)"


def _times_of(rows: Rows) -> tuple[Integers, Integers]:
    """The first row of each time, and how many there are of it : (n,)"""
    starts = np.flatnonzero(np.concatenate([[True], np.diff(rows.t) > 0])[: len(rows)])
    return starts, np.diff(np.append(starts, len(rows)))


def _only_repeated(rows: Rows) -> bool:
    """Whether all rows of one time are the same row."""
    return len(np.unique(rows.values, axis=0)) == len(np.unique(rows.t))


def _in_parts(rows: Rows, starts: Integers) -> Booleans:
    """At which times each number but one of every column is 0 : (n,)"""
    told = np.add.reduceat((rows.values[:, 1:] != 0).astype(int), starts, axis=0)
    return np.asarray((told <= 1).all(axis=1))


def _added(rows: Rows, starts: Integers, which: Booleans) -> Rows:
    """The rows, those of some times as one row, which has the sums."""
    counts = np.diff(np.append(starts, len(rows)))
    sums = np.add.reduceat(rows.values[:, 1:], starts, axis=0)
    values = np.where(
        np.repeat(which, counts)[:, None], np.repeat(sums, counts, axis=0), rows.values[:, 1:]
    )
    kept = ~np.repeat(which, counts)
    kept[starts] = True
    return replace(rows, values=np.column_stack([rows.t, values]))[kept]


def _unit_of(t: Array, counts: Integers) -> float:
    """The unit in s of a clock that cuts off what is less, 0 where these times are no such clock's.

    t : (n,) s, distinct and in order
    """
    if len(t) < 3 or np.median(counts) < 2:
        return 0.0
    unit = float(10 ** np.round(np.log10(np.min(np.diff(t)))))
    return unit if np.all(np.abs(t - np.rint(t / unit) * unit) <= 1e-3 * unit) else 0.0


def _spread(rows: Rows, starts: Integers, counts: Integers, until_next: bool) -> Rows:
    """The rows of one time evenly over the time until the next, or since the one before; over a
    gap no longer than it is usual.
    """
    t, usual = rows.t[starts], step_of(rows)
    gaps = np.diff(t)
    gaps = np.where(gaps > LONG * usual, usual, gaps)
    span = np.append(gaps, usual) if until_next else np.append(usual, gaps)
    which = np.arange(len(rows)) - np.repeat(starts, counts)  # of those of its time
    share = (
        which / np.repeat(counts, counts)
        if until_next
        else ((which + 1) / np.repeat(counts, counts) - 1)
    )
    apart = np.repeat(t, counts) + share * np.repeat(span, counts)
    return replace(rows, values=np.column_stack([apart, rows.values[:, 1:]]))
