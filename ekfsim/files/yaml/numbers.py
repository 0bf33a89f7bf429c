"""Long lists of points in a long file, each read in one go and not value by value.

A map of a building is some 100 000 points under a few hundred keys. What YAML makes of such a list
is what JSON makes of it, a hundred times as quickly; so each is cut out of the text before PyYAML
reads the rest, and stands in the tree as one value. It grows into values with places only where a
mistake in it must be told.

What is cut out leaves a short word and spaces, so that all else keeps its place. Where the word
does not come back as a value of its own, the list was none (it stood in a text, or among other
values): then nothing is cut out, and the text is read as it stands.
"""

import json
import re
from collections.abc import Callable, Iterator
from typing import NamedTuple

from ekfsim.files.yaml.marked import Mark, Node, Path

LONG = 20_000  # characters, below which PyYAML is quick enough
SHORTEST = 40  # characters of a list that is worth it
PRIVATE = range(0xE000, 0xF900)  # signs that no person writes

NUMBER = r"-?(?:0|[1-9][0-9]*)(?:\.[0-9]+)?(?:[eE][-+]?[0-9]+)?"
POINT = r"\[[-+0-9eE., ]++\]"
# [[0, 0], [10, 0], …], over any number of lines
FLOW = re.compile(rf"\[[ \n]*+{POINT}(?:[ \n]*+,[ \n]*+{POINT})++[ \n]*+\]")
# - [0, 0]
# - [10, 0]
ROWS = re.compile(rf"^( *+)- {POINT} *+\n(?:\1- {POINT} *+\n)++", re.MULTILINE)
# - - 0
#   - 0
DASHES = re.compile(rf"^( *+)- - {NUMBER}\n(?:\1(?:- |  )- {NUMBER}\n)++", re.MULTILINE)


class Numbers(Node):
    """A list of points, that grows into values with places when it is looked into."""

    __slots__ = ("_grow", "_grown", "_held")

    def __init__(self, mark: Mark, held: list[list[float]], grow: Callable[[], Node]) -> None:
        self.mark, self.written, self.quoted, self.faulty = mark, "", False, False
        self.keys = {}
        self._held, self._grow = held, grow
        self._grown: list[Node] | None = None
        self.values, self.levels = 1 + len(held) + sum(map(len, held)), 3

    @property
    def value(self) -> "list[Node]":  # type: ignore[override]
        """The points, each with its place."""
        if self._grown is None:
            grown = self._grow().value
            assert isinstance(grown, list)
            self._grown = grown
        return self._grown

    def plain(self) -> object:
        """The numbers, without places."""
        return self._held

    def walk(self, path: Path = ()) -> Iterator[tuple[Path, Node]]:
        """Itself alone: nothing in it has a key."""
        yield path, self


class Place(NamedTuple):
    """Where a list was cut out of a text."""

    held: list[list[float]]
    start: int  # of the list, or of the line on which it begins
    end: int
    margin: int  # from there to the word


class Cut:
    """A text without its long lists of numbers."""

    def __init__(self, text: str) -> None:
        self.whole = self.text = text
        self.places: list[Place] = []
        self.sign = next((chr(code) for code in PRIVATE if chr(code) not in text), "")
        if len(text) >= LONG and self.sign:
            for pattern in (FLOW, ROWS, DASHES):
                self.text = pattern.sub(self._without, self.text)

    def _without(self, found: re.Match[str]) -> str:
        """A word and spaces in place of a list; the text itself where it is none, or short."""
        text = found[0]
        if len(text) < SHORTEST:
            return text
        try:
            held = json.loads(JSON[found.re](text))
        except (ValueError, RecursionError):
            return text
        # of a list in lines the word stands where its first value stands, right of any key above
        margin = 0 if found.re is FLOW else len(found[1]) + 2
        word = f"{self.sign}{len(self.places)}"
        self.places.append(Place(held, found.start(), found.end(), margin))
        spaces = "\n".join(" " * len(line) for line in text.split("\n"))
        return spaces[:margin] + word + spaces[margin + len(word) :]

    def numbers(self, word: str, mark: Mark, grow: Callable[[str], Node]) -> Numbers | None:
        """What a word stands for, None where it stands for nothing.
        grow : the tree of a text
        """
        number = word.removeprefix(self.sign)
        if not number.isdecimal() or int(number) >= len(self.places):
            return None
        place = self.places[int(number)]
        line, column = mark
        if place.margin and column == place.margin + 1:  # and not that of an anchor above
            column -= 2

        def grown() -> Node:
            """With lines and spaces above, so that all in it has its own place."""
            begin = self.whole.rfind("\n", 0, place.start) + 1
            above = "\n" * self.whole.count("\n", 0, begin) + " " * (place.start - begin)
            return grow(above + self.whole[place.start : place.end])

        return Numbers((line, column), place.held, grown)


def _of_rows(text: str) -> str:
    return "[" + ",".join(line.strip().removeprefix("- ") for line in text.splitlines()) + "]"


def _of_dashes(text: str) -> str:
    rows = text.split("- - ")[1:]
    return "[" + ",".join(f"[{','.join(row.split('- '))}]" for row in rows) + "]"


JSON: dict[re.Pattern[str], Callable[[str], str]] = {FLOW: str, ROWS: _of_rows, DASHES: _of_dashes}
