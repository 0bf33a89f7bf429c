"""Rows without times: what the robot did is in order, and so is what its sensors told."""

from dataclasses import replace

import numpy as np

from ekfsim.files.logs.named.tables import Table

STEP = 1  # s that each row of the motion is said to last


def numbered(motion: Table, warnings: list[str]) -> Table:
    """The motion, its n-th row at n s; which is told."""
    told = "no column tells the time (t): its rows follow one another, and each is taken as 1 s"
    warnings.append(f"{motion.file}: {told}; noise that grows with the time is by that second")
    return _at(motion, range(1, 1 + len(motion.lines)))


def after(table: Table, motion: Table) -> Table:
    """A table without times beside such a motion: a row of the same file comes after the motion
    above it; of another with as many rows, the n-th belongs to the n-th. Any other stays without.
    """
    if table.has("t") or not motion.has("t"):
        return table
    if table.file == motion.file:
        above = np.searchsorted(motion.lines.numbers, table.lines.numbers, side="right")
        return _at(table, above.tolist())
    if len(table.lines) == len(motion.lines):
        return _at(table, range(1, 1 + len(table.lines)))
    return table


def _at(table: Table, times: range | list[int]) -> Table:
    """The rows with these times, STEP s each."""
    mark = table.separator or " "
    texts = [
        mark.join([text.rstrip().removesuffix(mark), str(n * STEP)])
        for text, n in zip(table.lines.texts, times, strict=True)
    ]
    places = {**table.places, "t": table.width}
    lines = replace(table.lines, texts=texts)
    return replace(table, lines=lines, width=table.width + 1, places=places)
