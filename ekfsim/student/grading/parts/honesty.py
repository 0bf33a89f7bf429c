"""Many runs of a student's filter, the same for everybody: whether it is as sure as it may be.

The verdict is that of a study. Few runs say little: points are lost only where it is decided, and a
right filter is condemned about as seldom as the intervals' 95 % and the width of the bands allow.
"""

import functools
import operator
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ekfsim.files.keys.homework import HonestyKeys
from ekfsim.filters.protocol import Beginning
from ekfsim.geometry import Integers
from ekfsim.localization import entries_of, first_belief, localize
from ekfsim.scene import Scene
from ekfsim.student.fault import FaultError
from ekfsim.student.grading.bench import Bench
from ekfsim.student.grading.parts.pupil import Pupil
from ekfsim.student.grading.scores import Scored
from ekfsim.student.own.filter import OwnFilter
from ekfsim.study.block import run_blocks, watched_along
from ekfsim.study.results import Result, Share
from ekfsim.study.tally import Tally
from ekfsim.study.verdict import COVERED, MEDIAN, MOST_LOST, NIS, Verdict, Word

AT_ONCE = 256  # runs


def graded_honesty(score: Scored, keys: HonestyKeys, bench: Bench, pupil: Pupil) -> Scored:
    """Half of the points for the end of the runs, half for the way there."""
    scene = bench.scene(score.check.about)
    try:
        pupil.begin(*first_belief(scene))  # what cannot be loaded fails at no step
        tally = tally_of(scene, keys.runs, pupil)
    except FaultError as fault:
        return score.failed(f"the code failed: {fault}", str(fault))
    verdict = Verdict(Result.alone(scene, tally))
    share = (not condemned_at_end(verdict)) / 2 + (not condemned_on_the_way(verdict)) / 2
    return replace(score, words=tuple(words(verdict))).earned(share)


def tally_of(scene: Scene, runs: int, pupil: Pupil) -> Tally:
    """What becomes of runs 0 … under the student's filter. Raises FaultError where it fails."""
    blocks = (
        _block(scene, np.arange(first, min(first + AT_ONCE, runs)), pupil)
        for first in range(0, runs, AT_ONCE)
    )
    return functools.reduce(operator.add, blocks)


def _block(scene: Scene, numbers: Integers, pupil: Pupil) -> Tally:
    """The same of some runs side by side."""
    layout = scene.world.layout
    beginning = Beginning(first_belief(scene), layout.headings, pose=layout.places)
    filter = OwnFilter.around(pupil.new_caller, beginning, pupil.together)
    first = first_belief(scene, numbers.shape)
    steps = localize(entries_of(scene, numbers), filter, first, scene.guard, scene.world.layout)
    return watched_along(scene, numbers, steps).tally()


def of_reference(scene: Scene, runs: int) -> Verdict:
    """The verdict on the reference, in the same runs."""
    return Verdict(Result.alone(scene, run_blocks(scene, runs)))


def condemned_at_end(verdict: Verdict) -> bool:
    """Whether the runs end as those of an honest filter do not, beyond doubt; or say nothing."""
    end = verdict.at_end
    return end.word is Word.NO_EVIDENCE or (end.word is not Word.CONSISTENT and end.decided)


def condemned_on_the_way(verdict: Verdict) -> bool:
    """Whether the readings, or too many lost runs at a step, speak against it, beyond doubt."""
    return verdict.on_the_way.word is not None and verdict.on_the_way.decided


def words(verdict: Verdict) -> Iterator[str]:
    """Both halves, each with its evidence."""
    end, way = verdict.at_end, verdict.on_the_way
    leaning = "" if end.decided or end.word is Word.NO_EVIDENCE else " (not decided)"
    yield (
        f"at the end of {end.runs} runs: {end.word.value}{leaning}: "
        f"{_percent(end.above_median.share)} of them above the median NEES (right: "
        f"{100 * MEDIAN[0]:g} to {100 * MEDIAN[1]:g} %), {_percent(end.covered.share)} inside the "
        f"ellipse ({100 * COVERED[0]:g} to {100 * COVERED[1]:g} %), {_percent(end.lost.share)} "
        f"lost (below {100 * MOST_LOST:g} %)"
    )
    if way.word is None:
        told = "nothing against it"
    else:
        told = way.word.value + ("" if way.decided else " (not decided)")
    nis = f"NIS {way.nis.value:.3g} per number read (right: {NIS[0]:g} to {NIS[1]:g})"
    lost = ""
    if way.steps:
        lost = f"; most lost at step {way.worst.step}: {_percent(way.worst.above_999)}"
    yield f"on the way: {told}: {nis}{lost}"


def _percent(share: Share) -> str:
    return f"{100 * share.value:.3g} %" if share.of else "none"
