"""What a student's code may take, and how a process is kept to it."""

import os
import sys
from contextlib import nullcontext, suppress
from dataclasses import dataclass

LEAST_MEMORY = 512  # MiB; with less NumPy itself does not start everywhere
OPEN_FILES = 128
MEBI = 2**20
LINUX = sys.platform == "linux"
# One thread: each of OpenBLAS's takes its share of the memory, and waits for the others. To be set
# before NumPy is imported.
ALONE = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


@dataclass(frozen=True)
class Limits:
    """What one process with a student's code may take until it ends.

    The defaults leave a parent 200 MB in a container of 768 MB.
    """

    seconds: float = 60.0  # on the wall, while it is waited for, once it has started
    cpu_seconds: int = 60  # of each process
    memory_mb: int = LEAST_MEMORY  # MiB of address space, of each process
    file_mb: int = 16  # MiB, of each file that it writes
    processes: int = 64  # and threads, itself among them; see `_tasks`
    printed: int = 2000  # characters that are kept of what it prints

    def __post_init__(self) -> None:
        if self.memory_mb < LEAST_MEMORY:
            raise ValueError(f"memory_mb is {self.memory_mb}; {LEAST_MEMORY} is the least")

    @property
    def too_long(self) -> str:
        """What is told of who took longer."""
        return f"took longer than {self.seconds:g} s"

    @property
    def too_busy(self) -> str:
        """What is told of who calculated longer."""
        return f"took more than {self.cpu_seconds} s of CPU"


def keep_to(limits: Limits) -> None:
    """Keep this process, and what it starts, to the limits. Who has no privileges cannot raise
    them again.
    """
    import resource

    def keep(what: int, soft: int, hard: int) -> None:
        _, most = resource.getrlimit(what)
        if most != resource.RLIM_INFINITY:  # only the superuser can raise what is set already
            soft, hard = min(soft, most), min(hard, most)
        with nullcontext() if LINUX else suppress(ValueError, OSError):  # see kernel.lacking
            resource.setrlimit(what, (soft, hard))

    keep(resource.RLIMIT_CPU, limits.cpu_seconds, limits.cpu_seconds + 1)  # SIGXCPU, then SIGKILL
    keep(resource.RLIMIT_AS, *(limits.memory_mb * MEBI,) * 2)
    keep(resource.RLIMIT_FSIZE, *(limits.file_mb * MEBI,) * 2)
    keep(resource.RLIMIT_NOFILE, OPEN_FILES, OPEN_FILES)
    keep(resource.RLIMIT_CORE, 0, 0)
    if hasattr(resource, "RLIMIT_NPROC"):
        keep(resource.RLIMIT_NPROC, *(_tasks() + limits.processes,) * 2)


def _tasks() -> int:
    """Processes and threads that this user has already: they are counted in the limit, too, and
    those that he starts afterwards.
    """
    tasks, user = 0, os.getuid()
    for name in os.listdir("/proc") if LINUX else ():
        if name.isdigit():
            try:
                told = os.stat(f"/proc/{name}/task")
            except OSError:  # it has ended meanwhile
                continue
            if told.st_uid == user:
                tasks += max(1, told.st_nlink - 2)
    return tasks
