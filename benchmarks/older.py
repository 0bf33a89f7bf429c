"""ekfsim beside an older build of it, both in one process, by the commands that a user gives.

python benchmarks/older.py [--only WORDS] [--older FOLDER] [--million] [--quick]

Processor time of whole commands, in turn; of whole processes the time on the wall. The studies are
asked whether they keep a promise that none can break: of others the older build makes pictures.
Without --older that build is unpacked from git, which takes a checkout with its history.
"""

import argparse
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path
from statistics import median

from builds import HERE, Build
from timing import ratios

COMMIT = "1571a8e"
RUNS = 20_480  # that the study's table and its start take no part to speak of
STUDY = "study TOUR --expect"


@dataclass(frozen=True)
class Row:
    """A command, and by which factor of the older build's time it is to be done."""

    what: str
    words: str
    reach: float
    aim: float
    runs: int = 1  # how many it plays: the time told is that of one
    rounds: int = 7


ROWS = [
    Row("study tour, CPU per run", f"{STUDY} --runs {RUNS}", 0.48, 0.35, RUNS),
    Row("study tour --fast, CPU per run", f"{STUDY} --runs {RUNS} --fast", 0.28, 0.2, RUNS),
    Row("run mower", "run mower", 0.5, 0.3, rounds=5),
    Row("render tour to a GIF", "render tour -o GIF --force", 0.7, 0.6),
    Row("100 runs of study mower", "study MOWER --expect --runs 100", 0.4, 0.25, rounds=2),
]
WALL = Row("run tour, whole process", "run tour", 0.7, 0.5, rounds=15)
MANY = "a million runs, --fast, two workers"
MILLION = Row(MANY, f"{STUDY} --runs 1000000 --fast --workers 2", 0.35, 0.25, rounds=3)
HEAD = f"{'what':50s} {'old':>10s} {'new':>10s} {'ratio':>6s} {'reach':>6s} {'aim':>6s}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", default="", metavar="WORDS", help="only what bears these words")
    parser.add_argument("--older", type=Path, metavar="FOLDER", help=f"a checkout of {COMMIT}")
    parser.add_argument("--million", action="store_true", help="also a million runs on two workers")
    parser.add_argument("--quick", action="store_true", help="fewer rounds")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        older = Build(given.older.resolve()) if given.older else Build.of(COMMIT, Path(folder))
        scenes = {
            name.upper(): promising(older.folder / "commands" / f"{name}.yaml", Path(folder))
            for name in ("tour", "mower")
        }
        scenes["GIF"] = str(Path(folder) / "tour.gif")
        print(HEAD)
        for row in (*ROWS, WALL, *([MILLION] if given.million else [])):
            if given.only not in row.what:
                continue
            if "--fast" in row.words and find_spec("numba") is None:
                print(f"skipped: {row.what}: numba is not installed")
                continue
            rounds = row.rounds // 2 if given.quick else row.rounds
            compare = in_turn if row in (WALL, MILLION) else within
            words = [scenes.get(word, word) for word in row.words.split()]
            for line in compare(row, words, older, Build(HERE), rounds):
                print(line, flush=True)


def promising(commands: Path, folder: Path) -> str:
    """The older build's commands file, which both can read, with a promise that is always kept."""
    text = commands.read_text(encoding="utf-8")
    text = text.replace("../worlds", str(commands.parent.parent / "worlds"))
    path = folder / f"{commands.stem}-promising.yaml"
    path.write_text(text + "expect: {lost: [0, 1]}\n", encoding="utf-8")
    return str(path)


def within(row: Row, words: list[str], older: Build, newer: Build, rounds: int) -> Iterator[str]:
    """Both in this process."""
    (found,) = ratios(newer.task(*words), {"older": older.task(*words)}, rounds, parts=row.runs)
    yield told(row, found.seconds, found.ours, 1 / found.ratio)


def in_turn(row: Row, words: list[str], older: Build, newer: Build, rounds: int) -> Iterator[str]:
    """Each in a process of its own: the best and the middle one, and what it took beside time."""
    newer.process(*words)  # what is compiled is now in its cache
    older.process(*words)
    spent = [(older.process(*words), newer.process(*words)) for _ in range(rounds)]
    old, new = min(a.wall for a, _ in spent), min(b.wall for _, b in spent)
    yield told(row, old, new, new / old, ", best wall")
    for which, of in ((", wall", "wall"), (", CPU", "processor")):
        times = [(getattr(a, of), getattr(b, of)) for a, b in spent]
        old, new = median(a for a, _ in times), median(b for _, b in times)
        yield told(row, old, new, median(b / a for a, b in times), which)
    if row is MILLION:
        was, now = max(a.memory for a, _ in spent), max(b.memory for _, b in spent)
        yield f"{'memory of the largest process':50s} {was:7.0f} MB {now:7.0f} MB {now / was:6.2f}"


def told(row: Row, old: float, new: float, ratio: float, which: str = "") -> str:
    """A line of the table."""
    times = f"{span(old):>10s} {span(new):>10s} {ratio:6.2f}"
    return f"{row.what + which:50s} {times} {row.reach:6.2f} {row.aim:6.2f}"


def span(seconds: float) -> str:
    """A time, in the unit that suits it."""
    for unit, size in (("s", 1.0), ("ms", 1e-3)):
        if seconds >= size:
            return f"{seconds / size:.2f} {unit}"
    return f"{seconds * 1e6:.1f} µs"


if __name__ == "__main__":
    main()
