"""Bytes → the numbered lines of a log file."""

from dataclasses import dataclass, replace
from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.files.foreign import of_bytes
from ekfsim.files.looking import contents, read_from
from ekfsim.files.source import mistake, position

MAX_BYTES = 400_000_000
HEAD_BYTES = 65536  # in which a first line ends
COMMENTS = ("#", "%")


@dataclass(frozen=True)
class Lines:
    """What a file says, without comments and empty lines."""

    file: str  # as messages name it
    numbers: list[int]  # of each line, from 1
    texts: list[str]
    ended: bool  # whether the last line has its line break
    # the comment before the first of them, which may name the columns, as numpy and rostopic write
    remark: str = ""

    def __len__(self) -> int:
        return len(self.texts)

    def __getitem__(self, part: slice) -> "Lines":
        return replace(self, numbers=self.numbers[part], texts=self.texts[part])


def lines_of(path: Path) -> Lines:
    """The lines of a file that hold something.

    Raises UsageError where it cannot be read, InputError where it holds no text.
    """
    shown = str(path)
    with read_from(path):
        try:
            raw = contents(path, MAX_BYTES)
        except FileNotFoundError:
            raise UsageError(f"{shown}: no such file") from None
        except IsADirectoryError:
            raise UsageError(f"{shown}: is a folder, where a file of the log belongs") from None
    if len(raw) > MAX_BYTES:
        raise mistake(
            shown,
            1,
            1,
            f"the file is larger than {MAX_BYTES // 10**6} MB",
            "cut the log into parts",
        )
    if foreign := of_bytes(raw):
        raise mistake(shown, 1, 1, f"this is {foreign.what}, no text", foreign.cure)
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise mistake(shown, 1, 1, "the file is UTF-16, not UTF-8", "save it as UTF-8")
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line, column = position(raw[: error.start].decode("utf-8-sig"))
        wrong = f"the byte 0x{raw[error.start]:02x} is not UTF-8"
        raise mistake(shown, line, column, wrong, "a log is plain text in UTF-8") from None
    return _numbered(shown, text)


def first_line(path: Path) -> str:
    """What a file begins with, a comment, too. Raises UsageError where it cannot be read."""
    with read_from(path):
        start = contents(path, HEAD_BYTES)
    return start.decode("utf-8-sig", "replace").partition("\n")[0].strip()


def _numbered(shown: str, text: str) -> Lines:
    if "\r" in text:
        text = text.replace("\r\n", "\n").replace("\r", "\n")
    texts = text.split("\n")
    ended = texts[-1] == ""
    if ended:
        texts.pop()
    kept = [
        (n, line)
        for n, line in enumerate(texts, 1)
        if line.strip() and line.lstrip()[0] not in COMMENTS
    ]
    ended = ended or not kept or kept[-1][0] != len(texts)
    before = texts[: kept[0][0] - 1] if kept else []
    remark = next((line for line in reversed(before) if line.strip()), "").strip()
    return Lines(
        shown, [n for n, _ in kept], [line for _, line in kept], ended,
        remark.lstrip("#% \t") if remark[:1] in COMMENTS else "",
    )  # fmt: skip
