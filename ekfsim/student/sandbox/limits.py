"""What a student's code may take, and how a process is kept to it."""

import math
import os
import signal
import sys
import time
from contextlib import nullcontext, suppress
from dataclasses import dataclass

LEAST_MEMORY = 512  # MiB; with less NumPy itself does not start everywhere
OPEN_FILES = 128
MEBI = 2**20
LINUX = sys.platform == "linux"
AGAIN = 0.1  # s of CPU after which who did not heed it is told again that its time is over
# One thread: each of OpenBLAS's takes its share of the memory, and waits for the others. To be set
# before NumPy is imported.
ALONE = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")


class TimeOverError(BaseException):
    """Raised in the midst of code whose time is over: neither `except OSError`, as os.path.exists
    has it, nor `except Exception` holds it up.
    """


@dataclass(frozen=True)
class Limits:
    """What one process with a student's code may take until it ends.

    It is charged what it calculates itself, however busy the machine is; the wall only ends who
    sleeps. The defaults leave a parent 200 MB in a container of 768 MB.
    """

    cpu_seconds: float = 60.0  # of each process, once Python and NumPy have started
    wall_seconds: float = 260.0  # in which it is waited for, all together; see `patience`
    memory_mb: int = LEAST_MEMORY  # MiB of address space, of each process
    file_mb: int = 16  # MiB, of each file that it writes
    processes: int = 64  # and threads, itself among them; see `_tasks`
    printed: int = 2000  # characters that are kept of what it prints

    def __post_init__(self) -> None:
        if self.memory_mb < LEAST_MEMORY:
            raise ValueError(f"memory_mb is {self.memory_mb}; {LEAST_MEMORY} is the least")

    @property
    def too_busy(self) -> str:
        """What is told of who calculated longer."""
        return f"took longer than {self.cpu_seconds:g} s of CPU"

    @property
    def too_long(self) -> str:
        """What is told of who calculated less, and did not answer."""
        return f"was waited for longer than {self.wall_seconds:g} s"


def patience(cpu_seconds: float) -> float:
    """Seconds to wait in all for code that may calculate so long: enough on a busy machine."""
    return 4 * cpu_seconds + 20


def keep_to(limits: Limits) -> None:
    """Keep this process, and what it starts, to the limits. Who has no privileges cannot raise
    them again.
    """
    import resource

    _keep(resource.RLIMIT_AS, *(limits.memory_mb * MEBI,) * 2)
    _keep(resource.RLIMIT_FSIZE, *(limits.file_mb * MEBI,) * 2)
    _keep(resource.RLIMIT_NOFILE, OPEN_FILES, OPEN_FILES)
    _keep(resource.RLIMIT_CORE, 0, 0)
    if hasattr(resource, "RLIMIT_NPROC"):
        _keep(resource.RLIMIT_NPROC, *(_tasks() + limits.processes,) * 2)


def charge(limits: Limits) -> None:
    """Count what this process calculates from now on: SIGPROF when that is too much; SIGXCPU, then
    SIGKILL, for who does not heed it, in whole seconds.
    """
    import resource

    signal.setitimer(signal.ITIMER_PROF, limits.cpu_seconds, AGAIN)
    whole = math.ceil(time.process_time() + limits.cpu_seconds)
    _keep(resource.RLIMIT_CPU, whole, whole + 1)


def _keep(what: int, soft: int, hard: int) -> None:
    import resource

    _, most = resource.getrlimit(what)
    if most != resource.RLIM_INFINITY:  # only the superuser can raise what is set already
        soft, hard = min(soft, most), min(hard, most)
    with nullcontext() if LINUX else suppress(ValueError, OSError):  # see kernel.lacking
        resource.setrlimit(what, (soft, hard))


def _tasks() -> int:
    """Processes and threads that this user has already: they are counted in the limit, too, and
    those that are started afterwards.
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
