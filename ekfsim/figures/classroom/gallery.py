"""The inputs that make the filter fail, side by side:
what a thousand runs of each find, as they stand and under each cure.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ekfsim.figures.album import Album
from ekfsim.figures.classroom.proofs import shipped
from ekfsim.files.packaged import packaged
from ekfsim.filters.belief import Refused
from ekfsim.geometry import Integers
from ekfsim.localization import play
from ekfsim.scene import Scene
from ekfsim.study.block import run_block
from ekfsim.study.results import Result
from ekfsim.version import VERSION
from ekfsim.views.gallery import cures
from ekfsim.views.study import shares
from ekfsim.views.study.words import shared

RUNS = 1000
RUNS_UNDER_A_CURE = 200  # of each: some take long
GATE = 0.99
HEAD = (
    *("input", *shares.HEAD),
    *("lost, gate 0.99", "left out by it", "lost, guard skip", "left out by it"),
    *(f"lost, {name}" for name in (cures.PLAIN, *cures.CURES)),
    *cures.HEAD[-2:],
)
CAPTION = """\
Of {runs} runs of seed {seed} of each `diverge-…` input that comes along. {meaning} \
The columns behind are the same runs, on the same draws, with
`--gate {gate}` and with `--guard skip`, and how many of a run's readings these leave out on \
average. The last columns are of the first {cured} of them. {cures} Each file's
description tells its mechanism, and `ekfsim run NAME` one of its runs.
"""


def draw_gallery(scene: Scene, album: Album) -> None:
    """Make the table of an album. scene : whose seed all inputs are run with"""
    album.source = (
        f"ekfsim {VERSION}, all inputs diverge-…, filter ekf, seed {scene.seed}, runs 0 to "
        f"{RUNS - 1}"
    )
    names = [name for name in packaged("commands") if name.startswith("diverge-")]
    rows = [row(name, scene.seed) for name in names]
    album.table(
        "gallery",
        "Scenarios that diverge",
        HEAD,
        rows,
        CAPTION.format(
            runs=RUNS,
            seed=scene.seed,
            meaning=shares.MEANING,
            gate=GATE,
            cured=RUNS_UNDER_A_CURE,
            cures=cures.MEANING,
        ),
    )


def row(name: str, seed: int) -> list[str]:
    """What is found of one input: as it stands, with gate or guard, and under each cure."""
    plain = replace(shipped(name), filter="ekf", seed=seed)
    cells = [name, *shares.shares(result(plain))]
    for cured, refused in (
        (replace(plain, gate=GATE), Refused.GATE),
        (replace(plain, guard="skip"), Refused.GUARD),
    ):
        cells += [
            shared(result(cured).last.lost),
            " of ".join(f"{n:.3g}" for n in left_out(cured, refused)),
        ]
    return [*cells, *cures.cured(plain, RUNS_UNDER_A_CURE).cells]


def result(scene: Scene) -> Result:
    """What is said of all runs of a scene."""
    return Result.alone(scene, run_block(scene, 0, RUNS))


def left_out(scene: Scene, why: Refused) -> tuple[float, float]:
    """How many readings of a run are refused for this reason,
    and how many there are, on average.
    """
    refused = list(_refused(scene))
    return sum(int(np.count_nonzero(one == why)) for one in refused) / RUNS, len(refused)


def _refused(scene: Scene) -> Iterator[Integers]:
    """Why each reading was refused, or was not : (N,)"""
    for step in play(scene, np.arange(RUNS)):
        if step.correction is not None:
            yield np.broadcast_to(step.correction.refused, (RUNS,))
