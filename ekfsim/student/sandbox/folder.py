"""The folder that a student's code runs in: a fresh copy of what was handed in, and its end."""

import os
import shutil
import stat
import tempfile
from collections import deque
from contextlib import suppress
from pathlib import Path

from ekfsim.student.fault import FaultError

MOST_FILES = 2000
MOST_BYTES = 64 * 2**20


def copy_of(submission: Path, shared: bool = False) -> Path:
    """A fresh folder with a copy of a file, or of all that is in a folder; links stay links.

    shared : whether other users are to read it
    Raises FaultError where it is too much or cannot be read.
    """
    folder = Path(tempfile.mkdtemp(prefix="ekfsim-"))
    try:
        if shared:
            folder.chmod(0o755)
        if submission.is_dir():
            _copy(submission, folder)
        else:
            shutil.copyfile(submission, folder / submission.name)
    except OSError as error:
        remove(folder)
        reason = error.strerror or type(error).__name__
        raise FaultError(submission.name, f"cannot be read: {reason}") from None
    except BaseException:
        remove(folder)
        raise
    return folder


def _copy(submission: Path, folder: Path) -> None:
    """All plain files, folders and links; sockets, pipes and devices stay where they are."""
    files = size = 0
    waiting = deque([(submission, folder)])
    while waiting:
        source, target = waiting.popleft()
        for entry in os.scandir(source):
            files += 1
            place = target / entry.name
            if entry.is_symlink():
                os.symlink(os.readlink(entry.path), place)
            elif entry.is_dir():
                place.mkdir()
                waiting.append((Path(entry.path), place))
            elif entry.is_file():
                size += entry.stat().st_size
                if size <= MOST_BYTES:
                    shutil.copyfile(entry.path, place)
            if files > MOST_FILES or size > MOST_BYTES:
                most = f"{MOST_FILES} files or {MOST_BYTES // 2**20} MiB"
                raise FaultError(submission.name, f"holds more than {most}; hand in the code alone")


def remove(folder: Path) -> None:
    """Delete a folder, however deep it is and whatever may be read in it.

    A folder in it is moved to the top before it is looked into: no path becomes long.
    """
    number = 0
    waiting = [str(folder)]
    while waiting:
        inner = waiting.pop()
        with suppress(OSError):
            os.chmod(inner, stat.S_IRWXU)
            for name in os.listdir(inner):
                path = os.path.join(inner, name)
                if not stat.S_ISDIR(os.lstat(path).st_mode):
                    os.unlink(path)
                elif inner == str(folder):
                    waiting.append(path)
                else:
                    number += 1
                    moved = os.path.join(str(folder), f"{number} {os.urandom(4).hex()}")
                    os.chmod(path, stat.S_IRWXU)
                    os.rename(path, moved)
                    waiting.append(moved)
            if inner != str(folder):
                os.rmdir(inner)
    with suppress(OSError):
        os.rmdir(folder)
