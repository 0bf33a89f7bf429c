"""The inputs that make the filter fail, side by side:
what a thousand runs of each find, as they stand and cured.
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
from ekfsim.study.results import Result, Share
from ekfsim.version import VERSION
from ekfsim.views.study.words import percent, shared

RUNS = 1000
GATE = 0.99
HEAD = (
    *(
        "input",
        "lost",
        "ΣNIS above / below",
        "NEES above / below",
        "inside the ellipse",
        "NIS per number read",
    ),
    *("lost, gate 0.99", "left out by it", "lost, guard skip", "left out by it"),
)
CAPTION = """\
Shares of {runs} runs of seed {seed} of each `diverge-…` input that comes along, in percent, with \
the 95 % interval
(Wilson) of each share in brackets. Lost: the last NEES lies beyond its χ² 99.9 % quantile, or the \
belief is impossible.
ΣNIS: runs whose sum of NIS lies above / below its two-sided 95 % band; NEES: runs whose last NEES \
does. Inside: the
true position, of the ellipses of 95.4 % that have an area. The last columns are the same runs, on \
the same draws, with
`--gate {gate}` and with `--guard skip`, and how many of a run's readings these leave out on \
average. Each file's
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
        CAPTION.format(runs=RUNS, seed=scene.seed, gate=GATE),
    )


def row(name: str, seed: int) -> list[str]:
    """What is found of one input: as it stands, with a gate, and with the guard."""
    plain = replace(shipped(name), filter="ekf", seed=seed)
    found = result(plain)
    of, runs, last = found.tally.of, found.tally.runs, found.last
    cells = [
        *(
            name,
            shared(last.lost),
            sides(of.nis_above, of.nis_below, runs),
            sides(of.nees_above, of.nees_below, runs),
        ),
        *(shared(last.ellipse) if last.ellipse.of else "–", f"{found.nis.value:.3g}"),
    ]
    for cured, refused in (
        (replace(plain, gate=GATE), Refused.GATE),
        (replace(plain, guard="skip"), Refused.GUARD),
    ):
        cells += [
            shared(result(cured).last.lost),
            " of ".join(f"{n:.3g}" for n in left_out(cured, refused)),
        ]
    return cells


def result(scene: Scene) -> Result:
    """What is said of all runs of a scene."""
    return Result.alone(scene, run_block(scene, 0, RUNS))


def sides(above: int, below: int, runs: int) -> str:
    """Two shares of runs, in percent."""
    return " / ".join(percent(Share(n, runs)) for n in (above, below))


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
