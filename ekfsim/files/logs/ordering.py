"""What can be wrong with the times of a table's rows, and what a person would make of it."""

import numpy as np

from ekfsim.files.logs.table import Rows

LONG = 10  # a gap is longer than so many usual steps


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
