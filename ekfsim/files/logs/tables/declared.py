"""A format of logs: its files, their columns, and what each number is in.

The one place from which come what a reader looks for, what a refusal says is wanted,
`ekfsim schema recording`, and the pages in docs/reference/logs.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace

WITH_MORE = range(0, 1000)  # how many columns a table may have beside those that are read
SCHEMA = "ekfsim schema recording"


@dataclass(frozen=True)
class Column:
    """One column of a file."""

    name: str  # in the first line and in messages
    unit: str  # s, m, rad, rad/s, degrees, …; empty for a number that names something
    told: str  # what it holds
    also: tuple[str, ...] = ()  # other names in a first line
    place: int | None = None  # from 0, in a file without a first line of names
    maybe: bool = False  # whether it may say nan
    positive: bool = False  # a range: where nothing answers, many sensors say 0 or −1
    largest: float = 1e6  # beyond which a number cannot be meant
    most: float = float("inf")  # rad or rad/s; where many lie beyond, they are degrees
    per_row: bool = False  # a turn since the row before: judged by the time between them

    def but(self, **changes: object) -> "Column":
        """The same column with other particulars."""
        return replace(self, **changes)  # type: ignore[arg-type]

    @property
    def names(self) -> tuple[str, ...]:
        """All names that a first line may give it, in small letters."""
        return tuple(name.lower() for name in (self.name, *self.also))

    @property
    def with_unit(self) -> str:
        """Its name and unit, as messages tell them."""
        return f"{self.name} in {self.unit}" if self.unit else self.name


@dataclass(frozen=True)
class Table:
    """One file of a log."""

    what: str  # what it holds
    files: tuple[str, ...]  # patterns of its name, the first that fits any
    columns: tuple[Column, ...]
    example: str  # its first line and five rows
    named: bool = True  # whether the first line names the columns
    widths: range = WITH_MORE  # of a file without names: how many columns a row may have
    needed: bool = True
    told: str = ""  # what else is to be known

    def but(self, **changes: object) -> "Table":
        """The same table with other particulars."""
        return replace(self, **changes)  # type: ignore[arg-type]

    @property
    def places(self) -> tuple[int, ...]:
        """Where its columns stand in a file without a first line, from 0."""
        return tuple(
            n if column.place is None else column.place for n, column in enumerate(self.columns)
        )

    @property
    def wanted(self) -> str:
        """Which columns it wants, in a line."""
        listed = ", ".join(column.with_unit for column in self.columns)
        if self.named:
            return f"wanted are {listed}"
        if self.places == tuple(range(len(self.columns))):
            return f"wanted are {listed}, in this order"
        placed = sorted(zip(self.places, self.columns, strict=True), key=lambda one: one[0])
        width = f"{self.widths[0]}{'' if len(self.widths) == 1 else ' or more'} columns"
        return f"wanted are {width}: " + ", ".join(
            f"{column.with_unit} ({place + 1})" for place, column in placed
        )


@dataclass(frozen=True)
class Format:
    """A kind of log."""

    name: str  # as `recording: {format: …}` has it
    told: str  # who writes it, and what a row is
    tables: tuple[Table, ...]
    alone: bool = False  # whether one file is the whole log
    example: str = ""  # how a commands file names it, where more is to be said than its path
    notes: tuple[str, ...] = ()  # what else is to be known, in Markdown
    maps: tuple[tuple[str, str], ...] = ()  # files of other make, and how the recording tells of it

    @property
    def holds(self) -> str:
        """The files of its folder, in a line."""
        needed = [table.files[0] for table in self.tables if table.needed]
        others = [table.files[0] for table in self.tables if not table.needed]
        known = f" and, where there are any, {_listed(others)}" if others else ""
        return _listed(needed) + known


def _listed(names: Iterable[str]) -> str:
    *first, last = names
    return f"{', '.join(first)} and {last}" if first else last
