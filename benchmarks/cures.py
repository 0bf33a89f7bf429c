"""What the cures cost in a study of `tour`, beside the filters that they are cures of, in one
process.

python benchmarks/cures.py [--only WORDS] [--older FOLDER] [--quick]

huber, pdaf and mhekf beside the ekf of this build and of the build before there were any cures; the
particle filters, of 1000 particles, beside the pf of that one. It is unpacked from git where no
folder is named. huber and pdaf once more with --fast, where Numba is installed.
"""

import argparse
import tempfile
from importlib.util import find_spec
from pathlib import Path
from statistics import median

from builds import HERE, Build
from older import promising
from timing import _time as timed  # one task after the other, in every round

COMMIT = "fa35536"
ROWS = (  # which filter, beside which, of how many runs, and the most that it may cost
    ("ekf", "ekf before", 20_480, 1.05),
    ("huber", "ekf", 20_480, 1.3),
    ("huber", "ekf before", 20_480, 1.3),
    ("pdaf", "ekf", 20_480, 1.3),
    ("pdaf", "ekf before", 20_480, 1.3),
    ("huber", "ekf --fast", 20_480, 1.3),
    ("pdaf", "ekf --fast", 20_480, 1.3),
    ("mhekf", "ekf", 2048, 15.0),
    ("pf", "pf before", 100, 1.0),
    ("amcl", "pf before", 100, 0.5),
)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--only", default="", metavar="WORDS", help="only what bears these words")
    parser.add_argument("--older", type=Path, metavar="FOLDER", help=f"a checkout of {COMMIT}")
    parser.add_argument("--quick", action="store_true", help="fewer rounds")
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        newer = Build(HERE)
        older = Build(given.older.resolve()) if given.older else Build.of(COMMIT, Path(folder))
        scene = promising(older.folder / "commands" / "tour.yaml", Path(folder))
        print(f"{'filter':8s} {'beside':10s} {'runs':>6s} {'its CPU':>8s} {'ours':>8s} ratio reach")
        for name, beside, runs, reach in ROWS:
            if given.only not in f"{name} {beside}":
                continue
            fast = [word for word in beside.split() if word == "--fast"]
            if fast and find_spec("numba") is None:
                continue
            words = ("study", scene, *fast, "--expect", "--runs", str(runs), "--filter")
            crowd = ("--particles", "1000") if name in ("pf", "amcl") else ()
            ours = newer.task(*words, name, *crowd)
            theirs = (older if "before" in beside else newer).task(*words, beside.split()[0])
            theirs()
            ours()
            times = [(timed(theirs, 1), timed(ours, 1)) for _ in range(3 if given.quick else 9)]
            it, us = (median(column) for column in zip(*times, strict=True))
            ratio = median(b / a for a, b in times)
            print(
                f"{name:8s} {beside:10s} {runs:6d} {it:7.2f}s {us:7.2f}s {ratio:5.2f} {reach:5.2f}"
            )


if __name__ == "__main__":
    main()
