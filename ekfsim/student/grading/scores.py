"""Points: what each test is worth, what a submission earned of it, and what was not judged.

Points are counted in hundredths, as whole numbers: shares of them add up to the last digit. A score
begins at 0 and "not run", and is written once, by a share that is a finite number from 0 to 1;
whatever else is handed over is a failure of the grader's, told as such, and costs that test alone.
"""

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field, replace
from typing import Any, Literal, Self

from ekfsim.files.keys.homework import (
    CENTS,
    HomeworkKeys,
    HonestyKeys,
    InputsKeys,
    JacobiansKeys,
    StepsKeys,
    Visibility,
)

Status = Literal["passed", "failed", "not run"]
NOT_RUN: Status = "not run"


class ScoreError(Exception):
    """What was handed over as a share is none: a failure of the grader's, not of a student's."""


@dataclass(frozen=True, slots=True)
class Check:
    """A row of a report: what is looked at, and for how many points."""

    number: str  # 1.2: the part, and which of its tests
    part: str
    kind: str  # steps, jacobians, honesty, inputs
    about: str  # a scene, a function, or what of the inputs
    cents: int  # at most
    visibility: Visibility = "visible"

    @property
    def name(self) -> str:
        """What it is called; no two of a homework are called alike."""
        return f"{self.part}: {self.about}"


def checks_of(keys: HomeworkKeys) -> tuple[Check, ...]:
    """Every test of a homework, in its order. Their points add up to the total."""
    return tuple(_checks_of(keys))


def _checks_of(keys: HomeworkKeys) -> Iterator[Check]:
    for n, part in enumerate(keys.parts, 1):
        match part.asks_for:
            case StepsKeys(scenes=scenes):
                kind, about = "steps", scenes
            case JacobiansKeys(functions=functions):
                kind, about = "jacobians", [*functions]
            case HonestyKeys(scenes=scenes):
                kind, about = "honesty", scenes
            case InputsKeys(files=files, exposed=exposed):
                asked = {"promises": files, "exposed mistakes": exposed}
                kind, about = "inputs", [name for name, least in asked.items() if least is not None]
        shares = shared_out(round(part.points * CENTS), len(about))
        for k, (name, cents) in enumerate(zip(about, shares, strict=True), 1):
            yield Check(f"{n}.{k}", part.name, kind, name, cents, part.visibility)


def shared_out(cents: int, among: int) -> list[int]:
    """Points in even shares; what is left over goes to the first, a hundredth each.

    >>> shared_out(1000, 3)
    [334, 333, 333]
    """
    share, left = divmod(cents, among)
    return [share + (n < left) for n in range(among)]


@dataclass(frozen=True, slots=True)
class Shown:
    """A known mistake, and where a submission showed it."""

    mistake: str  # its name
    scene: str
    steps: int  # at how many


@dataclass(frozen=True, slots=True)
class Scored:
    """What became of a test."""

    check: Check
    status: Status = NOT_RUN
    cents: int = 0
    words: tuple[str, ...] = ()  # to the student, a line each
    fault: str = ""  # what ended the student's code
    first_wrong: str = ""  # the first step that is wrong
    shown: tuple[Shown, ...] = ()

    @property
    def judged(self) -> bool:
        """Whether the score says something of the submission."""
        return self.status != NOT_RUN

    def earned(self, share: object) -> Self:
        """The same with a share of its points, rounded down: full points are for what is right
        throughout.

        Raises ScoreError for what is no plain number from 0 to 1.
        """
        if isinstance(share, bool) or not isinstance(share, int | float):  # NumPy's float is one
            raise ScoreError(f"a share is handed over as {type(share).__name__}")
        if not (math.isfinite(share) and 0 <= share <= 1):
            raise ScoreError(f"a share of points is {share:g}, which does not lie in [0, 1]")
        cents = self.check.cents if share == 1 else math.floor(self.check.cents * share + 1e-9)
        return replace(self, status="passed" if share == 1 else "failed", cents=cents)

    def failed(self, told: str, fault: str) -> Self:
        """The same where the student's code or files failed: no points, and why."""
        return replace(self, words=(told,), fault=fault).earned(0.0)

    def lost(self, why: str) -> Self:
        """The same where the grader itself failed: no points, and not the student's failure."""
        return replace(self, status=NOT_RUN, cents=0, words=(why,))

    def plain(self) -> dict[str, Any]:
        """Numbers and texts, fit for JSON."""
        check = self.check
        return {
            "number": check.number, "name": check.name, "part": check.part, "kind": check.kind,
            "about": check.about, "visibility": check.visibility, "status": self.status,
            "score": self.cents / CENTS, "max_score": check.cents / CENTS,
            "words": list(self.words), "fault": self.fault, "first_wrong": self.first_wrong,
            "shown": [
                {"mistake": one.mistake, "scene": one.scene, "steps": one.steps}
                for one in self.shown
            ],
        }  # fmt: skip

    @classmethod
    def of_plain(cls, check: Check, plain: Mapping[str, Any]) -> Self:
        """What `plain` came from."""
        return cls(
            check, plain["status"], round(plain["score"] * CENTS), tuple(plain["words"]),
            plain["fault"], plain["first_wrong"], tuple(Shown(**one) for one in plain["shown"]),
        )  # fmt: skip


@dataclass(frozen=True)
class Grade:
    """What became of a submission: every test of the homework, whatever happened to it."""

    submission: str  # its name
    scores: tuple[Scored, ...]
    digest: str = field(default="", compare=False)  # of all that it depends on

    @classmethod
    def begun(cls, submission: str, checks: Iterable[Check], digest: str = "") -> Self:
        """Nothing is judged yet."""
        return cls(submission, tuple(map(Scored, checks)), digest)

    @property
    def cents(self) -> int:
        """All that was earned."""
        return sum(score.cents for score in self.scores)

    @property
    def most(self) -> int:
        """All that could be."""
        return sum(score.check.cents for score in self.scores)

    @property
    def judged(self) -> int:
        """Of that, what was judged: less where the grader failed."""
        return sum(score.check.cents for score in self.scores if score.judged)

    @property
    def is_whole(self) -> bool:
        """Whether everything was judged."""
        return all(score.judged for score in self.scores)

    @property
    def first_wrong(self) -> str:
        """The first wrong step of the first scene that has one."""
        return next((score.first_wrong for score in self.scores if score.first_wrong), "")

    @property
    def mistakes(self) -> tuple[str, ...]:
        """The names of the known mistakes that were found, each once."""
        return tuple(dict.fromkeys(one.mistake for score in self.scores for one in score.shown))

    @property
    def faults(self) -> tuple[str, ...]:
        """What ended the student's code, each once."""
        return tuple(dict.fromkeys(score.fault for score in self.scores if score.fault))

    def plain(self) -> dict[str, Any]:
        """Numbers and texts, fit for JSON."""
        return {
            "submission": self.submission, "digest": self.digest, "score": self.cents / CENTS,
            "max_score": self.most / CENTS, "judged": self.judged / CENTS,
            "first_wrong": self.first_wrong, "mistakes": list(self.mistakes),
            "tests": [score.plain() for score in self.scores],
        }  # fmt: skip

    @classmethod
    def of_plain(cls, checks: Iterable[Check], plain: Mapping[str, Any]) -> Self:
        """What `plain` came from. Raises KeyError, TypeError or ValueError where it is none."""
        scores = (
            Scored.of_plain(check, one) for check, one in zip(checks, plain["tests"], strict=True)
        )
        return cls(plain["submission"], tuple(scores), plain["digest"])


def points(cents: int) -> str:
    """Points as people write them.

    >>> points(1250), points(4000)
    ('12.5', '40')
    """
    return f"{cents / CENTS:.2f}".rstrip("0").rstrip(".")
