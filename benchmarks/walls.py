"""A building of 100 000 walls, beside an older build of ekfsim.

python benchmarks/walls.py [--older FOLDER] [--rounds N]

Processor time of whole processes, in turn: `check`, `play` to its first picture on a
pseudo-terminal, and a `study` of 2000 runs of 48 commands. The building is a hall with 2000 stairs
of 48 corners each, as a map of pixels has them, written with as many decimals as programs write.
"""

import argparse
import math
import tempfile
from collections.abc import Iterator
from pathlib import Path
from statistics import median

from builds import HERE, Build
from older import COMMIT, span
from terminal import to_the_first_picture

STAIRS, STEPS, PITCH = 2000, 11, 4.0  # how many, steps up and down of each, m from one to the next
STEP = 0.05  # m
RUNS = 2000
HEAD = f"{'100 000 walls, CPU of the process':44s} {'old':>9s} {'new':>9s} {'ratio':>6s} reach"
REACHES = {"check": 3.0, "play, to the first picture": 2.0, f"study of {RUNS} runs": 6.0}  # s


def stairs(x: float, y: float) -> Iterator[tuple[float, float]]:
    """The corners of a flight of stairs up and down, its foot at (x, y)."""
    yield x, y
    for step in range(2 * STEPS):
        x += STEP if step < STEPS else -STEP
        yield x, y
        y += STEP
        yield x, y
    yield x - 6 * STEP, y
    yield x - 6 * STEP, y - 2 * STEPS * STEP


def building(folder: Path) -> Path:
    """A world and a commands file in it; gives the latter."""
    side = math.ceil(math.sqrt(STAIRS))
    length = side * PITCH
    lines = [
        "name: building",
        f"boundary: [[0, 0], [{length}, 0], [{length}, {length}], [0, {length}]]",
    ]
    lines.append("obstacles:")
    for number in range(STAIRS):
        row, column = divmod(number, side)
        corners = stairs(column * PITCH + 1.7 + math.pi / 1e6, row * PITCH + 1.2 + math.e / 1e6)
        lines.append(f"  - {{name: o{number}, points: {[list(corner) for corner in corners]}}}")
    start = side // 2 * PITCH
    ratios = ("executionDst", "executionAng", "odometryDst", "odometryAng", "range")
    lines.append(f"start: {{x: {start}, y: {start}, theta: 90}}")
    lines.append(f"noise: {{{', '.join(f'{name}SigmaRatio: 0.02' for name in ratios)}}}")
    (folder / "building.yaml").write_text("\n".join(lines) + "\n", encoding="utf-8")
    commands = ["world: building.yaml", "commands:"]
    for move in range(12):
        turn = 90 if move % 3 == 2 else 0
        commands.append(f"  - move: {{distance: 1.5, angle: {turn}}}")
        commands += [f"  - sense: {{angle: {angle}}}" for angle in (0, 90, -90)]
    (folder / "walk.yaml").write_text("\n".join(commands) + "\n", encoding="utf-8")
    return folder / "walk.yaml"


def spent(build: Build, walk: Path) -> Iterator[float]:
    """Processor time of each command, in s."""
    yield build.process("check", str(walk)).processor
    yield to_the_first_picture(build, str(walk))[1]
    with tempfile.TemporaryDirectory() as out:
        yield build.process(
            "study", str(walk), "--runs", str(RUNS), "--workers", "1", "-o", f"{out}/study"
        ).processor


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--older", type=Path, metavar="FOLDER", help=f"a checkout of {COMMIT}")
    parser.add_argument("--rounds", type=int, default=5, help="of each build")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder, tempfile.TemporaryDirectory() as place:
        older = Build(given.older.resolve()) if given.older else Build.of(COMMIT, Path(folder))
        walk, newer = building(Path(place)), Build(HERE)
        print(HEAD)
        for build in (older, newer):  # what is compiled is now in its cache
            build.process("check", str(walk))
        rounds = [(list(spent(older, walk)), list(spent(newer, walk))) for _ in range(given.rounds)]
        for which, (what, reach) in enumerate(REACHES.items()):
            old, new = (median(each[i][which] for each in rounds) for i in (0, 1))
            ratio = median(b[which] / a[which] for a, b in rounds)
            print(f"{what:44s} {span(old):>9s} {span(new):>9s} {ratio:6.2f} {span(reach)}")


if __name__ == "__main__":
    main()
