"""Two builds of ekfsim in one process: either may be the one that `import ekfsim` finds."""

import io
import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stderr, redirect_stdout
from dataclasses import dataclass, field
from pathlib import Path
from time import perf_counter
from types import ModuleType

HERE = Path(__file__).parent.parent


@dataclass(frozen=True)
class Spent:
    """What a process took, its workers included."""

    wall: float  # s
    processor: float  # s
    memory: float  # MB, of the largest of them


@dataclass(frozen=True)
class Build:
    """A checkout of ekfsim."""

    folder: Path  # that holds the package, and its worlds and commands
    modules: dict[str, ModuleType] = field(
        default_factory=dict
    )  # those that have been imported of it

    @classmethod
    def of(cls, commit: str, folder: Path) -> "Build":
        """The build of a commit, unpacked into a folder."""
        archive = subprocess.run(
            ["git", "archive", commit], cwd=HERE, stdout=subprocess.PIPE, check=True
        ).stdout
        subprocess.run(["tar", "-x", "-C", folder], input=archive, check=True)
        return cls(folder)

    @contextmanager
    def in_place(self) -> Iterator[None]:
        """Let `import ekfsim` find this build, also where it stands inside a function."""
        others = taken()
        sys.modules.update(self.modules)
        sys.path.insert(0, str(self.folder))
        try:
            yield
        finally:
            sys.path.remove(str(self.folder))
            self.modules.update(taken())
            sys.modules.update(others)

    def task(self, *words: str) -> Callable[[], object]:
        """A command of this build, as a task that is timed."""

        def call() -> None:
            with self.in_place():
                obey(*words)

        return call

    def process(self, *words: str) -> Spent:
        """A command in a process of its own."""
        program = [sys.executable, "-P", "-c", "from ekfsim.cli import main; main()", *words]
        path = os.pathsep.join([str(self.folder), *filter(None, [os.environ.get("PYTHONPATH")])])
        start = perf_counter()
        started = subprocess.Popen(
            program,
            env={**os.environ, "PYTHONPATH": path},
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        _, status, used = os.wait4(started.pid, 0)
        started.returncode = os.waitstatus_to_exitcode(status)
        if started.returncode:
            raise subprocess.CalledProcessError(started.returncode, program)
        wall = perf_counter() - start
        return Spent(wall, used.ru_utime + used.ru_stime, used.ru_maxrss / 1024)


def taken() -> dict[str, ModuleType]:
    """The modules of ekfsim that have been imported, taken out of the process."""
    names = [name for name in sys.modules if name.partition(".")[0] == "ekfsim"]
    return {name: sys.modules.pop(name) for name in names}


def obey(*words: str) -> None:
    """Do what a command line says; what the program says is thrown away."""
    from ekfsim.cli import ekfsim

    with redirect_stdout(io.StringIO()), redirect_stderr(io.StringIO()):
        ekfsim(words, prog_name="ekfsim", standalone_mode=False)
