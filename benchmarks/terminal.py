"""`play` in a terminal, beside an older build: to its first picture, and from a key to the redrawn
screen.

python benchmarks/terminal.py [--older FOLDER] [--rounds N]

Each build runs in a process of its own on a pseudo-terminal of 120 × 40, in turn; what it takes is
the processor time of that process, as the kernel counts it.
"""

import argparse
import fcntl
import os
import select
import struct
import subprocess
import sys
import tempfile
import termios
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median
from time import perf_counter

from builds import HERE, Build
from older import COMMIT, span

COLUMNS, ROWS = 120, 40
PICTURED = b"\x1b[0m cone"  # of the legend, which is drawn last: no narrative has it in colour
QUIET = 0.08  # s without a byte, after which the screen is drawn
PRESSES = 40
HEAD = f"{'play tour --show text, 120 × 40':44s} {'old':>9s} {'new':>9s} {'ratio':>6s} reach"
START, KEY = 0.7, 0.015  # what is to be reached: of the older build's time, and s


@dataclass
class Played:
    """`play SCENE --show text` of a build, on a terminal of its own."""

    build: Build
    scene: str = "tour"
    began: float = field(default_factory=perf_counter)

    def __post_init__(self) -> None:
        self.ours, its = os.openpty()
        fcntl.ioctl(its, termios.TIOCSWINSZ, struct.pack("HHHH", ROWS, COLUMNS, 0, 0))
        program = [sys.executable, "-P", "-c", "from ekfsim.cli import main; main()"]
        environment = {**os.environ, "PYTHONPATH": str(self.build.folder), "TERM": "xterm"}
        environment.pop("DISPLAY", None)
        # whoever has installed it has it compiled
        environment.pop("PYTHONDONTWRITEBYTECODE", None)
        self.process = subprocess.Popen(
            [*program, "play", self.scene, "--show", "text"], stdin=its, stdout=its,
            stderr=subprocess.DEVNULL, env=environment, start_new_session=True,
        )  # fmt: skip
        os.close(its)

    def read(self, until: bytes = b"") -> None:
        """Read what is drawn until it is quiet, or until something stands there."""
        shown = b""
        while until not in shown if until else select.select([self.ours], [], [], QUIET)[0]:
            shown += os.read(self.ours, 1 << 16)

    def press(self, key: bytes) -> None:
        os.write(self.ours, key)
        select.select([self.ours], [], [])
        self.read()

    @property
    def processor(self) -> float:
        """The processor time of the process so far, in s."""
        running = Path(f"/proc/{self.process.pid}/schedstat").read_text(encoding="ascii")
        return int(running.split()[0]) * 1e-9

    def end(self) -> None:
        self.process.kill()
        self.process.wait()
        os.close(self.ours)


def to_the_first_picture(build: Build, scene: str = "tour") -> tuple[float, float]:
    """Wall and processor time until the first picture stands there, in s."""
    played = Played(build, scene)
    played.read(PICTURED)
    taken = perf_counter() - played.began, played.processor
    played.end()
    return taken


def of_a_key(build: Build) -> float:
    """Processor time from a key to the redrawn screen, in s: the middle one of many."""
    played = Played(build)
    played.read(PICTURED)
    played.read()
    taken = []
    for _ in range(PRESSES):
        before = played.processor
        played.press(b"n")
        taken.append(played.processor - before)
    played.end()
    return median(taken)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--older", type=Path, metavar="FOLDER", help=f"a checkout of {COMMIT}")
    parser.add_argument("--rounds", type=int, default=15, help="starts of each build")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        older = Build(given.older.resolve()) if given.older else Build.of(COMMIT, Path(folder))
        newer = Build(HERE)
        print(f"{HEAD}")
        for build in (older, newer):  # what is compiled is now in its cache
            to_the_first_picture(build)
        spent = [
            (to_the_first_picture(older), to_the_first_picture(newer)) for _ in range(given.rounds)
        ]
        for which, name in enumerate(("wall", "CPU")):
            old, new = (median(each[i][which] for each in spent) for i in (0, 1))
            ratio = median(b[which] / a[which] for a, b in spent)
            told = f"from start to first picture, {name}"
            print(f"{told:44s} {span(old):>9s} {span(new):>9s} {ratio:6.2f} {START:5.2f}")
        old, new = of_a_key(older), of_a_key(newer)
        told = "a key to the redrawn terminal, CPU"
        print(f"{told:44s} {span(old):>9s} {span(new):>9s} {new / old:6.2f} {span(KEY)}")


if __name__ == "__main__":
    main()
