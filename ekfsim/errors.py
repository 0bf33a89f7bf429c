"""The two ways a run of the program can fail, each with the exit status it ends in."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Place:
    """Where in a file a mistake was made. line and column count from 1."""

    file: str
    line: int = 1
    column: int = 1

    def __str__(self) -> str:
        return f"{self.file}:{self.line}:{self.column}"


class EkfsimError(Exception):
    """An error that is told to the user in a sentence, without a traceback."""

    status = 1


class RunError(EkfsimError):
    """The run itself failed: a full disk, an expectation not kept. Exit status 1."""


class UsageError(EkfsimError):
    """Wrong usage: a missing file, a result that exists. Exit status 2."""

    status = 2


class InputError(UsageError):
    """Mistakes in a file that a person wrote, all of them at once.

    Each reads `file:line:col: field: what is wrong; what would be right`.
    """

    def __init__(self, mistakes: list["Mistake"]) -> None:
        super().__init__("\n".join(map(str, mistakes)))
        self.mistakes = mistakes


@dataclass(frozen=True, slots=True)
class Mistake:
    """One mistake: where, in which field ("" for the file itself), what is wrong, and what would be right."""

    place: Place
    field: str
    wrong: str
    right: str = ""

    def __str__(self) -> str:
        field = f"{self.field}: " if self.field else ""
        right = f"; {self.right}" if self.right else ""
        return f"{self.place}: {field}{self.wrong}{right}"
