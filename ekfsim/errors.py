"""The two ways a run of the program can fail, each with the exit status it ends in."""

import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Self

from ekfsim.printable import in_a_line

MOST_TOLD = 50  # lines of one kind at once: nobody reads more


class LogRemark(UserWarning):
    """What is odd in a recorded log, or was taken for granted: told in Python as a warning."""


@dataclass(frozen=True, slots=True)
class Place:
    """Where in a file a mistake was made. line and column count from 1; 0 where there is no text,
    as in a dict.
    """

    file: str
    line: int = 1
    column: int = 1

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}" if self.line else self.file


class EkfsimError(Exception):
    """An error that is told to the user in a sentence, without a traceback; or in several, each a
    line of its own.
    """

    status = 1
    remarks: tuple[str, ...] = ()  # what was found to be odd before, and is told with it

    def __init__(self, *lines: str) -> None:
        super().__init__("\n".join(map(in_a_line, lines)))


class RunError(EkfsimError):
    """The run itself failed: a full disk, an expectation not kept. Exit status 1."""


class StepError(RunError):
    """A run that failed at one of its steps, which who raises it may not know."""

    def at(self, step: str) -> Self:
        """The same error, where the step is known at which it came."""
        return self


class UsageError(EkfsimError):
    """Wrong usage: a missing file, a result that exists. Exit status 2."""

    status = 2


class InputError(UsageError):
    """Mistakes in a file that a person wrote, all of them at once.

    Each reads `file:line:col: field: what is wrong; what would be right`.
    """

    def __init__(self, mistakes: list["Mistake"]) -> None:
        super().__init__(*told(mistakes))
        self.mistakes = mistakes


@dataclass(frozen=True, slots=True)
class Mistake:
    """One mistake: where, in which field ("" for the file itself), what is wrong, and what would be
    right.
    """

    place: Place
    field: str
    wrong: str
    right: str = ""

    @property
    def placed_alike(self) -> "Mistake":
        """The same mistake, however the way to its file is spelled."""
        place = Place(os.path.realpath(self.place.file), self.place.line, self.place.column)
        return Mistake(place, self.field, self.wrong, self.right)

    def __str__(self) -> str:
        field = f"{self.field}: " if self.field else ""
        right = f"; {self.right}" if self.right else ""
        return in_a_line(f"{self.place}: {field}{self.wrong}{right}")


def told(mistakes: Sequence[Mistake]) -> list[str]:
    """A line for each mistake; of very many the last line says how many more there are."""
    if len(mistakes) <= MOST_TOLD:
        return [str(mistake) for mistake in mistakes]
    lines = [str(mistake) for mistake in mistakes[: MOST_TOLD - 1]]
    more = f"{len(mistakes) - len(lines):,}".replace(",", " ")
    return [
        *lines,
        in_a_line(f"{mistakes[len(lines)].place}: and {more} more mistakes from here on"),
    ]


def first_of(warnings: Iterable[str], most: int = MOST_TOLD) -> list[str]:
    """The same for warnings, whose lines there are already."""
    lines = list(warnings)
    if len(lines) <= most:
        return lines
    if most < 1:
        return []
    return [*lines[: most - 1], f"and {len(lines) - most + 1:,} more warnings".replace(",", " ")]
