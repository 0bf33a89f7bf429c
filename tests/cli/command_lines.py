"""The command lines of README.md and of docs/, as a reader finds them."""

import re
from dataclasses import dataclass
from pathlib import Path

from ekfsim.cli import ekfsim

ROOT = Path(__file__).parents[2]
PAGES = [ROOT / "README.md", *sorted((ROOT / "docs").rglob("*.md"))]
COMMAND = re.compile(rf"(?:^|(?<=[\s/]))ekfsim\s+(?=(?:{'|'.join(ekfsim.commands)})\b)")
PIECE = re.compile(
    r"^```(?P<kind>\w*)\n(?P<block>.*?)^```$"
    r"|^    (?P<indented>\S[^\n]*)$"
    r"|(?<!`)`(?P<span>[^`\n]+(?:\n[^`\n]+)*)`(?!`)",
    re.MULTILINE | re.DOTALL,
)  # a block, an indented line, or code among words, which may go on over an end of line
COMMENTED = {"python", "yaml", "toml"}  # command lines stand in their comments


@dataclass(frozen=True)
class Line:
    """What a page tells to type."""

    text: str
    kind: str | None  # of its block; None among words

    @property
    def is_one(self) -> bool:
        """Whether it is a command line of the program, and no line that a command prints."""
        return COMMAND.search(self.text) is not None and not self.text.startswith("#")


@dataclass(frozen=True)
class File:
    """What a page tells to write, with its name in the first line."""

    name: str
    text: str


def read_through(page: Path) -> list[Line | File]:
    """What a page tells to type and to write, in its order."""
    found: list[Line | File] = []
    for piece in PIECE.finditer(page.read_text(encoding="utf-8")):
        kind, block, indented, span = piece.group("kind", "block", "indented", "span")
        if block is None:
            found.append(Line(" ".join((indented or span).split()).replace(r"\|", "|"), None))
            continue
        if name := re.match(r"# ([\w.-]+\.\w+)\n", block):
            found.append(File(name[1], block))
        if kind in COMMENTED:
            found += [Line(text, None) for text in re.findall(r"#.*?`([^`\n]+)`", block)]
        else:
            lines = re.sub(r"\\\n\s*", "", block).splitlines()
            found += [Line(line, kind) for line in lines if line]
    return found


def named_in(text: str) -> int:
    """How many times a command of the program is named in a text."""
    return len(COMMAND.findall(re.sub(r"`", " ", text)))
