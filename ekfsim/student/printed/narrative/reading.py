"""Lines of the assignment's narrative, as a program in any language prints them → its numbers."""

import re
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Literal

from ekfsim.files.logs.text import Lines, lines_of
from ekfsim.files.source import mistake
from ekfsim.student.printed.digits import Digits
from ekfsim.student.printed.table import number

N = r"([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?|[-+]?nan\b|[-+]?inf(?:inity)?\b)"
POSE = rf"\(\s*{N}[\s,;]+{N}[\s,;]+{N}\s*\)"
ROW = re.compile(rf"[\s\[\](),;]*(?:{N}[\s\[\](),;]*)+", re.IGNORECASE)
ONE = re.compile(N, re.IGNORECASE)
MATRIX = 9  # numbers
POINT, COMMA = re.compile(r"\d\.\d"), re.compile(r"(?<=\d),(?=\d)")  # of decimals

Kind = Literal["start", "move", "sense", "other"]
# what is printed of a step, by a name of ours; its numbers are of the kind whose digits it shares
FACTS: tuple[tuple[str, str, str], ...] = (
    ("commanded", "input", rf"==>.*moved.*distance\s*[=:]?\s*{N}.*angle\s*[=:]?\s*{N}"),
    ("bearing", "input", rf"==>.*sense.*angle\s*(?:of|=|:)?\s*{N}"),
    ("odometry", "input", rf"odometry.*distance\s*[=:]?\s*{N}.*angle\s*[=:]?\s*{N}"),
    ("first state", "state", rf"^\W*first state.*[=:]\s*{POSE}"),
    ("current state", "state", rf"^\W*current state.*[=:]\s*{POSE}"),
    ("new state", "state", rf"^\W*new state.*[=:]\s*{POSE}"),
    ("revised state", "state", rf"^\W*revised state.*[=:]\s*{POSE}"),
    ("minor radius", "radius", rf"^\W*minor radius\s*(?:is|=|:)\s*{N}"),
    ("major radius", "radius", rf"^\W*major radius\s*(?:is|=|:)\s*{N}"),
    ("orientation", "direction", rf"^\W*orientation\s*(?:is|=|:)\s*{N}"),
    ("cone", "cone", rf"^\W*{N}\s*\*?\s*sigma_?th(?:eta)?\s*(?:is|=|:)\s*{N}"),
    ("range", "range", rf"^\W*the range (?:is|was)\s*{N}"),
    ("predicted range", "range", rf"predicted range (?:is|was)\s*{N}"),
    ("derivatives", "derivative",
     rf"dh/dx\s*=\s*{N}.*dh/dy\s*=\s*{N}.*dh/d(?:th|theta|θ)\s*=\s*{N}"),
    ("innovation", "innovation", rf"^\W*the innovation is\s*{N}"),
    ("deviation", "innovation", rf"innovation.*standard deviation\s*(?:is)?\s*{N}"),
    ("NIS", "NIS", rf"innovation.*\bNIS is\s*{N}"),
    ("gain", "gain", rf"kalman gain.*=\s*{POSE}"),
    ("C_v", "noise", rf"^\W*C_v is\s*{N}"),
    ("S", "noise", rf"^\W*S is\s*{N}"),
)  # fmt: skip
PATTERNS = tuple((name, kind, re.compile(text, re.IGNORECASE)) for name, kind, text in FACTS)
COVARIANCE = re.compile(r"^\W*(first|new|revised)?\s*(state )?covariance( matrix)?\b.*:", re.I)
UNUSED = re.compile(r"reading is not used|reading is (left out|refused)", re.IGNORECASE)
NO_ECHO, NO_WALL = re.compile("there is no echo", re.I), re.compile("no range was predicted", re.I)


@dataclass(frozen=True, slots=True)
class Number:
    """A printed number, half a unit of its last digit, and its line."""

    value: float
    half: float
    line: int


@dataclass
class Block:
    """What is printed of one step."""

    kind: Kind
    line: int
    facts: dict[str, tuple[Number, ...]] = field(default_factory=dict)
    unused: bool = False  # it says that the reading is not used
    no_echo: bool = False
    no_wall: bool = False


@dataclass(frozen=True)
class Narrative:
    """What a file says, step by step."""

    file: str
    blocks: tuple[Block, ...]


@dataclass(frozen=True, slots=True)
class _Found:
    """A fact whose digits are not yet counted."""

    block: Block
    name: str
    kind: str
    texts: tuple[tuple[str, int], ...]  # each number and its line


def narrative(path: Path) -> Narrative:
    """The narrative in a file. Raises UsageError where it cannot be read, InputError where it is
    none.
    """
    lines = _with_points(lines_of(path))
    blocks = [Block("start", lines.numbers[0] if lines.numbers else 1)]
    found = list(_facts(lines, blocks))
    digits = _digits(found)
    for one in found:
        one.block.facts.setdefault(
            one.name,
            tuple(
                Number(number(text), digits[_digits_of(one, i)].half(number(text)), line)
                for i, (text, line) in enumerate(one.texts)
            ),
        )
    if not any(block.kind in ("move", "sense") for block in blocks):
        wrong = "no step of the assignment's narrative stands in it"
        raise mistake(lines.file, 1, 1, wrong, "each begins with a line like '==>The robot moved: "
                      "distance=1.75, angle=90'")  # fmt: skip
    return Narrative(lines.file, tuple(blocks))


def _with_points(lines: Lines) -> Lines:
    """The same lines; where decimals have commas throughout, with points."""
    if any(POINT.search(text) for text in lines.texts):
        return lines
    return replace(lines, texts=[COMMA.sub(".", text) for text in lines.texts])


def _facts(lines: Lines, blocks: list[Block]) -> Iterator[_Found]:
    """All facts, and a block for each step that begins."""
    rows = zip(lines.numbers, lines.texts, strict=True)
    for line, text in rows:
        if "==>" in text:
            blocks.append(Block(_kind(text), line))
        block = blocks[-1]
        block.unused |= UNUSED.search(text) is not None
        block.no_echo |= NO_ECHO.search(text) is not None
        block.no_wall |= NO_WALL.search(text) is not None
        for name, kind, pattern in PATTERNS:
            if match := pattern.search(text):
                yield _Found(block, name, kind, tuple((one, line) for one in match.groups()))
        if heading := COVARIANCE.search(text):
            told = (heading[1] or ("revised" if block.kind == "sense" else "new")).lower()
            yield from _matrix(block, f"{told} covariance", text[heading.end() :], line, rows)


def _matrix(
    block: Block, name: str, rest: str, line: int, rows: Iterator[tuple[int, str]]
) -> Iterator[_Found]:
    """The nine numbers that follow a heading."""
    texts = list[tuple[str, int]]()
    if ROW.fullmatch(rest):
        texts += [(one, line) for one in ONE.findall(rest)]
    while len(texts) < MATRIX:
        below, text = next(rows, (0, ""))
        if ROW.fullmatch(text) is None:
            return
        texts += [(one, below) for one in ONE.findall(text)]
    if len(texts) == MATRIX:
        yield _Found(block, name, "covariance", tuple(texts))


def _kind(text: str) -> Kind:
    if re.search(r"\bmoved\b", text, re.IGNORECASE):
        return "move"
    return "sense" if re.search(r"\bsense\b", text, re.IGNORECASE) else "other"


def _digits(found: list[_Found]) -> Mapping[str, Digits]:
    """How finely each kind of number is printed."""
    texts = dict[str, list[str]]()
    for one in found:
        for i, (text, _) in enumerate(one.texts):
            texts.setdefault(_digits_of(one, i), []).append(text)
    return {kind: Digits.of(of_kind) for kind, of_kind in texts.items()}


def _digits_of(one: _Found, place: int) -> str:
    """The kind of a number whose digits it shares; headings have a kind of their own."""
    return "heading" if one.kind == "state" and place == 2 else one.kind
