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
FOLDER = os.O_RDONLY | getattr(os, "O_DIRECTORY", 0) | getattr(os, "O_NOFOLLOW", 0)


def copy_of(submission: Path, shared: bool = False) -> Path:
    """A fresh folder with a copy of a file, or of all that is in a folder; links stay links.

    shared : whether other users are to read it
    Raises FaultError where it is too much or cannot be read.
    """
    folder = Path(tempfile.mkdtemp(prefix="ekfsim-code-"))
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
        for entry in list(os.scandir(source)):
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
    """Delete a folder, however deep it is and whatever may be read in it; as far as that can be.

    One folder is open at a time: the way down is a list of names, the way up is "..".
    """
    with suppress(OSError):
        here = os.open(folder, FOLDER)
        levels = [("", _emptied(here))]  # the name of each folder on the way, what is left in it
        while levels:
            name, left = levels[-1]
            if left:
                down = left.pop()
                with suppress(OSError):
                    os.chmod(down, stat.S_IRWXU, dir_fd=here)
                    below = os.open(down, FOLDER, dir_fd=here)
                    os.close(here)
                    here = below
                    levels.append((down, _emptied(here)))
                continue
            levels.pop()
            if levels:
                above = os.open("..", FOLDER, dir_fd=here)
                os.close(here)
                here = above
                with suppress(OSError):
                    os.rmdir(name, dir_fd=here)
        os.close(here)
        os.rmdir(folder)


def _emptied(folder: int) -> list[str]:
    """The folders in one, all else of which is deleted."""
    left = []
    with suppress(OSError):
        os.chmod(folder, stat.S_IRWXU)
    for name in os.listdir(folder):
        with suppress(OSError):
            if stat.S_ISDIR(os.lstat(name, dir_fd=folder).st_mode):
                left.append(name)
            else:
                os.unlink(name, dir_fd=folder)
    return left
