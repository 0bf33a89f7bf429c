"""Bytes → text: what can be wrong with a file before anything in it is read."""

import os
import re
from pathlib import Path

from ekfsim.errors import InputError, Mistake, Place, UsageError
from ekfsim.files.foreign import of_bytes, of_folder
from ekfsim.files.looking import contents, current_folder, read_from

MAX_BYTES = 10_000_000

# What YAML does not allow in a file: all but printable characters, tab and line breaks. The whole
# class takes long to compile, and most files are ASCII.
UNPRINTABLE_ASCII = "[^\t\n\r\x20-\x7e]"
UNPRINTABLE = "[^\t\n\r\x20-\x7e\x85\xa0-\ud7ff\ue000-\ufefe\uff00-\ufffd\U00010000-\U0010ffff]"


def as_written(path: Path, shown: str) -> str:
    """The text of a file that a person wrote; `shown` is how messages name it.

    Raises UsageError where there is no such file to read, InputError where it holds no text.
    """
    raw = bytes_of(path, shown)
    if len(raw) > MAX_BYTES:
        raise mistake(
            shown,
            1,
            1,
            "the file is larger than 10 MB",
            "write a smaller one: no world needs that much",
        )
    if foreign := of_bytes(raw):
        raise mistake(shown, 1, 1, f"this is {foreign.what}, no text", foreign.cure)
    if raw[:2] in (b"\xff\xfe", b"\xfe\xff"):
        raise mistake(
            shown, 1, 1, "the file is UTF-16, not UTF-8", "save it as UTF-8 in your editor"
        )
    try:
        text = raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line, column = position(raw[: error.start].decode("utf-8-sig"))
        wrong = f"the byte 0x{raw[error.start]:02x} is not UTF-8"
        raise mistake(shown, line, column, wrong, "save the file as UTF-8 in your editor") from None
    return readable(text, shown)


def unprintable(text: str) -> re.Match[str] | None:
    """The first character of a text that cannot stand in a file, None where all can."""
    return re.search(UNPRINTABLE_ASCII if text.isascii() else UNPRINTABLE, text)


def readable(text: str, shown: str) -> str:
    """The same text. Raises InputError where no file may hold it."""
    if found := unprintable(text):
        line, column = position(text[: found.start()])
        raise mistake(
            shown, line, column, f"{character(found[0])} cannot stand in a text file", "delete it"
        )
    if not text.strip():
        raise mistake(shown, 1, 1, "the file is empty", "see `ekfsim new` for one to start from")
    return text


def bytes_of(path: Path, shown: str) -> bytes:
    """At most MAX_BYTES + 1 bytes of a file. Raises UsageError where it cannot be read."""
    with read_from(shown):
        try:
            return contents(path, MAX_BYTES)
        except FileNotFoundError:
            if current_folder() is None and not path.is_absolute():
                raise UsageError(
                    f"{shown}: cannot be read: the current folder was deleted; go to another"
                ) from None
            raise UsageError(f"{shown}: no such file" + nearest_file(path, shown)) from None
        except IsADirectoryError:
            with read_from(shown):
                found = of_folder(os.listdir(path), shown)
            right = f"with {found.what}: {found.cure}" if found else "name a file in it"
            raise UsageError(f"{shown}: is a folder{' ' if found else '; '}{right}") from None


def nearest_file(path: Path, shown: str) -> str:
    """`; did you mean '…'?` where a file beside the missing one has nearly its name,
    else nothing.
    """
    try:
        neighbours = {
            Path(name).stem: name
            for name in sorted(os.listdir(path.parent))
            if name.endswith(".yaml")
        }
    except (OSError, ValueError):
        return ""
    import difflib

    near = difflib.get_close_matches(path.stem, neighbours, 1)
    return (
        f"; did you mean '{os.path.join(os.path.dirname(shown), neighbours[near[0]])}'?"
        if near
        else ""
    )


def position(before: str) -> tuple[int, int]:
    """Line and column, from 1, of the character that follows the text `before`."""
    lines = re.split("\r\n|\r|\n", before)
    return len(lines), len(lines[-1]) + 1


def character(char: str) -> str:
    """How messages name a character that cannot be shown."""
    return f"the character U+{ord(char):04X}" + (" (NUL)" if char == "\0" else "")


def mistake(file: str, line: int, column: int, wrong: str, right: str) -> InputError:
    """One mistake in the file as a whole."""
    return InputError([Mistake(Place(file, line, column), "", wrong, right)])
