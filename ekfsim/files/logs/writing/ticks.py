"""The Entries of a driven robot, tick by tick, as the files of a log hold them."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.geometry import Array
from ekfsim.records import Control, Entry, Reading


@dataclass(frozen=True)
class Tick:
    """One motion input, and the readings that follow it at the same time."""

    t: float  # s
    u: Array  # (m,)
    truth: Array  # (3,)
    fix: Array | None
    readings: list[Reading] = field(default_factory=list)


@dataclass(frozen=True)
class Run:
    """A whole run of one robot."""

    truth: Array  # (3,) the true pose at the start
    t: float  # s, of the start
    ticks: list[Tick]

    @classmethod
    def of(cls, entries: Iterable[Entry]) -> "Run":
        """Gather the entries of a drive."""
        run: Run | None = None
        for entry in entries:
            assert entry.truth is not None
            assert entry.t is not None
            if run is None:
                run = cls(entry.truth, entry.t, [])
            match entry.given:
                case Control(_, u):
                    run.ticks.append(Tick(entry.t, u, entry.truth, entry.fix))
                case Reading():
                    run.ticks[-1].readings.append(entry.given)
        assert run is not None
        return run


def numbered(reading: Reading, kinds: tuple[str, ...], path: Path) -> tuple[str, int]:
    """The kind and the number in a sensor's name: "beam 3" → beam, 3.

    Raises UsageError where the format has no place for what this sensor tells.
    """
    kind, _, number = reading.name.partition(" ")
    if kind not in kinds:
        wrong = f"the log of this robot has no place for readings of {reading.name!r}"
        raise UsageError(f"{path}: {wrong}; take that sensor out of the world")
    return kind, int(number or 0)


def as_written(
    rows: Iterable[Iterable[float | int]], separator: str, header: str = "", ending: str = ""
) -> str:
    """A table with 17 digits, from which every number can be read back as it was."""
    lines = [separator.join(number(value) for value in row) + ending for row in rows]
    return "\n".join([*([header] if header else []), *lines, ""])


def number(value: float | int) -> str:
    """A number that is read back as it was.

    >>> number(0.1), number(7)
    ('0.10000000000000001', '7')
    """
    return str(value) if isinstance(value, int) else f"{value:.17g}"
