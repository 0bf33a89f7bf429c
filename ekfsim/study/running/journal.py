"""Each finished block at once on disk: what a study has done survives whatever ends it.

A JSON Lines file: first what decides the numbers of the study, then a line for each block. A last
line that is torn was never finished; its block is done again.
"""

import hashlib
import json
import os
import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import Any, BinaryIO

from ekfsim.errors import UsageError
from ekfsim.files.packaged import PACKAGE
from ekfsim.files.results.writing import told
from ekfsim.filters.place import label
from ekfsim.study.plan import Plan, Task
from ekfsim.study.tally import Tally
from ekfsim.version import VERSION

NAME = "journal.jsonl"
FORMAT = 1
SECOND = 1.0  # s: waiting for the disk at every block would take longer than the blocks


class Journal:
    """The blocks that are done. Of each only its place in the file is held in memory."""

    def __init__(
        self, path: Path, file: BinaryIO, places: dict[tuple[int, int], tuple[int, int]]
    ) -> None:
        self.path = path
        self._file = file
        self._places = places  # (case, block) → where its line begins, and its length
        self._safe = -SECOND  # s: when all of it was last on disk

    def __contains__(self, task: Task) -> bool:
        return (task.case, task.block) in self._places

    def __len__(self) -> int:
        return len(self._places)

    def add(self, task: Task, tally: Tally) -> None:
        """Keep a finished block. When this returns, this process may end; a power cut costs what
        was done in the last second. Raises RunError where the disk is full.
        """
        line = _line({"case": task.case, "block": task.block, "tally": tally.plain()})
        with told(self.path):
            place = self._file.seek(0, os.SEEK_END)
            self._file.write(line)
            self._file.flush()
            if (now := time.monotonic()) > self._safe + SECOND:
                os.fsync(self._file.fileno())
                self._safe = now
        self._places[task.case, task.block] = place, len(line)

    def tally(self, task: Task) -> Tally:
        """The tally of a block that is done."""
        place, length = self._places[task.case, task.block]
        self._file.seek(place)
        return Tally.of_plain(json.loads(self._file.read(length))["tally"])

    def total(self, plan: Plan, case: int) -> Tally:
        """All blocks of a case together, always in their order: sums of floating numbers depend on
        it.
        """
        tallies = map(self.tally, plan.tasks_of(case))
        total = next(tallies)
        for tally in tallies:
            total = total + tally
        return total


@contextmanager
def journal_in(folder: Path, plan: Plan, resume: bool, force: bool) -> Iterator[Journal]:
    """The journal of a study in its folder of work, begun or gone on with; removed where nothing
    came to be in it.

    Raises UsageError where there is one that must not be touched, or another study is at work.
    """
    path = folder / NAME
    with told(folder):
        folder.mkdir(parents=True, exist_ok=True)
        file = os.fdopen(
            os.open(path, os.O_RDWR | os.O_CREAT | getattr(os, "O_BINARY", 0), 0o666), "r+b"
        )
    journal, ours = None, False
    try:
        hold(file, folder, "study")  # before anything in it is touched: it may be another's
        if os.fstat(file.fileno()).st_size and not (resume or force):
            right = "go on with --resume, or begin anew with --force"
            raise UsageError(f"{folder}: holds what was done of a study that did not end; {right}")
        ours = True
        with told(path):
            if not resume:
                file.truncate(0)
            journal = Journal(path, file, _begun(file, plan, path))
        yield journal
    finally:
        with suppress(OSError):  # what a full disk did not take is told already
            file.close()
        if ours and not (path.stat().st_size if journal is None else len(journal)):
            remove(folder)


def remove(folder: Path) -> None:
    """Remove the journal, and its folder where nothing else lies in it."""
    with suppress(OSError):
        (folder / NAME).unlink()
        folder.rmdir()


def hold(file: BinaryIO, folder: Path, kind: str) -> None:
    """Keep a file in the folder of what is half done for this process alone.

    Raises UsageError where another holds it, a study or what the kind is. Where nothing can be
    locked, nothing is.
    """
    with suppress(ImportError, OSError):
        import fcntl

        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except BlockingIOError:
            raise UsageError(
                f"{folder}: another {kind} is at work there; wait for it, or choose another name"
            ) from None


def _begun(file: BinaryIO, plan: Plan, path: Path) -> dict[tuple[int, int], tuple[int, int]]:
    """Where the lines of an older journal stand, after what was torn of it is cut off; a new one
    gets its head.
    """
    places: dict[tuple[int, int], tuple[int, int]] = {}
    end = 0
    for number, line in enumerate(file):
        held = _held(line)
        if number == 0 and held is not None:
            _compare(held, plan, path)
        elif held is not None and held.keys() >= {"case", "block", "tally"}:
            places[held["case"], held["block"]] = end, len(line)
        else:
            break
        end += len(line)
    file.seek(end)
    file.truncate()
    if end == 0:
        file.write(_line({"journal": FORMAT, "program": program(), "study": plan.identity()}))
        file.flush()
    return places


def _compare(head: Mapping[str, Any], plan: Plan, path: Path) -> None:
    """Raises UsageError where a journal is of another study, with the first thing that differs."""
    was, now = head.get("study"), plan.identity()
    if head.get("journal") != FORMAT or not isinstance(was, dict):
        raise UsageError(f"{path}: is no journal of this version; begin anew with --force")
    for name, value in now.items():
        if was.get(name) != value:
            what = f"{name} was {was.get(name) or 'not given'}, and is now {value or 'not given'}"
            if name in ("commands", "world"):
                what = f"the {name} file was another"
            elif name == "code":
                what = f"the code of {' or '.join(map(label, plan.codes))} was another"
            raise UsageError(
                f"{path.parent}: was begun as another study: {what}; begin anew with --force"
            )
    if head.get("program") != program():
        raise UsageError(
            f"{path.parent}: was begun by a program that was not this one to the letter, though "
            f"of version {VERSION}, "
            "too; its numbers may be others: begin anew with --force"
        )


def program() -> str:
    """The program itself as a word: between two releases its numbers change, and its version does
    not.
    """
    whole = hashlib.sha256()
    for path in sorted(PACKAGE.rglob("*.py")):
        whole.update(path.read_bytes())
    return whole.hexdigest()[:16]


def _held(line: bytes) -> Mapping[str, Any] | None:
    """What a line says, None where it is torn or damaged."""
    try:
        held = json.loads(line) if line.endswith(b"\n") else None
    except ValueError:
        return None
    return held if isinstance(held, dict) else None


def _line(held: Mapping[str, Any]) -> bytes:
    return json.dumps(held, separators=(",", ":")).encode() + b"\n"
