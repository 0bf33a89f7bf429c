"""A study of a filter of one's own, per run, against one run of the built-in filter.

The filter is the twelve lines that `ekfsim new --complete` writes, called once for each run. Its
peer is what `ekfsim run --plain --quiet` does once it has begun: the run, and its closing summary.

python benchmarks/own_filter.py [--quick]
"""

import argparse
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

from timing import ratios

from ekfsim import Scene, load_scene
from ekfsim.diagnostics.summary import Summary
from ekfsim.files.template import template
from ekfsim.localization import play
from ekfsim.study.block import run_block
from ekfsim.twins import taking
from ekfsim.views.words.closing import conclude_all

SCENES = ("tour", "square", "diverge-01-wrong-wall")
BLOCK = 512  # runs side by side; a study makes twice as many


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="fewer rounds, smaller blocks")
    quick = parser.parse_args().quick
    runs = BLOCK // 4 if quick else BLOCK
    with TemporaryDirectory() as folder:
        file = Path(folder, "mine.py")
        file.write_text(template("filter-complete"), encoding="utf-8")
        for name in SCENES:
            scene = load_scene(name)
            own = replace(scene, filter=str(file))
            peers = {"as `run --plain --quiet` of the ekf": alone(scene)}
            (found,) = ratios(
                lambda own=own: run_block(own, 0, runs), peers, 3 if quick else 5, parts=runs,
                calls=dict.fromkeys(peers, runs),
            )  # fmt: skip
            print(
                f"{name:22} a run in a study of one's own takes {1 / found.ratio:4.2f} × what it "
                f"takes alone and plain ({found.ours * 1e3:.2f} ms, {found.seconds * 1e3:.2f} ms)"
            )


def alone(scene: Scene) -> Callable[[], str]:
    """One run of a scene as `ekfsim run --plain --quiet` makes it."""

    def run() -> str:
        with taking("plain"):
            summary = Summary.of(scene)
            for _ in summary.following(play(scene)):
                pass
            return conclude_all(scene, [summary], quiet=True)

    return run


if __name__ == "__main__":
    main()
