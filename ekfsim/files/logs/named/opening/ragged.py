"""Rows that are not equally long, and rows that tell several readings."""

from dataclasses import replace

from ekfsim.files.logs.named.tables import Table

OF_THE_ROW = ("t", "sensor")  # columns that stand once, whatever else comes again


def levelled(table: Table) -> Table:
    """The table without what stands behind the columns that are read, where its rows are not
    equally long.
    """
    needed = max(table.places.values(), default=-1) + 1
    rows = [text.split(table.separator) for text in table.lines.texts]
    if len({len(row) for row in rows}) < 2:
        return table
    return _cut(table, rows, list(range(len(rows))), needed)


def in_groups(table: Table, every: int) -> list[Table]:
    """A table for each reading of a row: its columns come again `every` columns further on, as far
    as the row goes.
    """
    again = {name: place for name, place in table.places.items() if name not in OF_THE_ROW}
    needed = max(again.values(), default=0) + 1
    rows = [text.split(table.separator) for text in table.lines.texts]
    rows = [row[:-1] if row and not row[-1].strip() else row for row in rows]
    groups = []
    for shift in range(0, max(map(len, rows), default=0), every):
        long = [n for n, row in enumerate(rows) if len(row) >= needed + shift]
        if long or not shift:
            places = {n: place + shift * (n in again) for n, place in table.places.items()}
            moved = replace(table, places=places)
            groups.append(_cut(moved, rows, long, needed + shift))
    return groups


def _cut(table: Table, rows: list[list[str]], kept: list[int], width: int) -> Table:
    """Some rows as far as a width."""
    texts = [(table.separator or " ").join(rows[n][:width]) for n in kept]
    numbers = [table.lines.numbers[n] for n in kept]
    return replace(table, lines=replace(table.lines, numbers=numbers, texts=texts), width=width)
