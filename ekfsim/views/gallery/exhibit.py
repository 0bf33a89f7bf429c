"""One scenario of the gallery: its page and its picture in files, and all that is told of it."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from ekfsim.printable import in_a_line
from ekfsim.scene import Scene
from ekfsim.study.block import run_block
from ekfsim.study.results import Result
from ekfsim.views.gallery.cures import Cured, cured
from ekfsim.views.gallery.still import draw_last
from ekfsim.views.page.writing import write
from ekfsim.views.picture.look import STANDARD
from ekfsim.views.study.shares import shares
from ekfsim.views.words.judgement import judgement, warns
from ekfsim.views.words.verdict import sentence


@dataclass(frozen=True)
class Exhibit:
    """What the gallery tells of a scenario."""

    name: str
    title: str  # the first line of its description
    told: str  # the rest of it
    seed: int
    run: int
    verdict: str  # on the run that is shown
    warns: bool  # whether that warns
    judged: str  # what its last view says, in a line
    size: tuple[int, int]  # of its picture, in px
    runs: int  # that the figures rest on
    figures: tuple[str, ...]  # beneath the HEAD of shares.py
    cured: Cured | None  # where it is asked what becomes of it under each cure


class Wing(NamedTuple):
    """Scenarios that serve one purpose."""

    name: str
    title: str
    exhibits: Sequence[Exhibit]


def exhibit(
    name: str, scene: Scene, folder: Path, paged: bool, cures: int, first: int, runs: int
) -> Exhibit:
    """Make the page and the picture of a scenario; what is told of it.

    paged : whether it has a page at all; cures : how many runs each cure watches, 0 for none;
    first, runs : which runs the figures rest on
    """
    if paged:
        write(scene, folder / f"{name}.html")
    last, size = draw_last(scene, folder / f"{name}.png")
    assert last.judged.closing is not None
    title, *rest = scene.description.strip().splitlines()
    return Exhibit(
        name=name,
        title=in_a_line(title),
        told=in_a_line(" ".join(line.strip() for line in rest)),
        seed=scene.seed,
        run=scene.run,
        verdict=sentence(last.judged.closing),
        warns=warns(last, STANDARD.probability),
        judged=judgement(last, scene, STANDARD.probability),
        size=size,
        runs=runs,
        figures=shares(Result.alone(scene, run_block(scene, first, runs))),
        cured=cured(scene, cures) if cures else None,
    )
