"""What statistics of many runs alone would see of a filter with a known mistake.

Its own numbers go on from step to step; ν, S and NIS are those of the right equations at its own
prior, as whoever judges it would calculate them.
"""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ekfsim.diagnostics.nees import nees
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Booleans, Integers
from ekfsim.localization import advance, entries_of, filter_of, first_belief
from ekfsim.records import Control, Reading, Step
from ekfsim.scene import Scene
from ekfsim.student.asked import Asked
from ekfsim.student.comparing.compare import believed
from ekfsim.student.exposing.exposed import of_the_textbook
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.mutant import Mutant
from ekfsim.study.block import run_block, watched_along
from ekfsim.study.results import Result
from ekfsim.study.verdict import Verdict, Word


def without_mistake(scene: Scene, runs: int) -> Result:
    """What a study says of the runs 0 … runs − 1 of the right filter."""
    played = of_the_textbook(scene)
    return Result.alone(played, run_block(played, 0, runs))


def with_mistake(scene: Scene, mistake: Mistake, runs: int) -> Result:
    """What it says of the same runs of a filter with a mistake."""
    played, numbers = of_the_textbook(scene), np.arange(runs)
    with np.errstate(all="ignore"):  # of beliefs that are none
        watched = watched_along(played, numbers, _steps(played, mistake, numbers))
    return Result.alone(played, watched.tally())


def seen(result: Result) -> str:
    """What its verdict says against a filter, and is sure of; "" where it says nothing."""
    verdict = Verdict(result)
    end, way = verdict.at_end, verdict.on_the_way
    if end.decided and end.word is not Word.CONSISTENT:
        return str(end.word.value)
    return f"{way.word.value} on the way" if way.word is not None and way.decided else ""


def _steps(scene: Scene, mistake: Mistake, numbers: Integers) -> Iterator[Step]:
    """The steps of N runs side by side under a filter with a mistake. numbers : (N,)"""
    reference, wrong, layout = filter_of(scene, numbers), Mutant(mistake), scene.world.layout
    belief, earlier = first_belief(scene, numbers.shape), dict[int, Asked]()
    for entry in entries_of(scene, numbers):
        step = advance(reference, belief, entry, scene.guard, layout)
        x, P = step.posterior  # what is right, and stays so where the mistake cannot be made
        posterior = Gaussian(x.copy(), P.copy())
        for run in np.flatnonzero(_handed_over(step, numbers)).tolist():
            own = replace(entry, given=_of_run(entry.given, run, numbers))
            before = Gaussian(belief.mean[run], belief.covariance[run])
            asked = Asked.at(own, before, layout.headings, earlier.get(run))
            earlier[run] = asked.as_earlier()
            if mistake.where(asked):
                believes = believed(wrong.call(asked), layout)
                posterior.mean[run], posterior.covariance[run] = believes
        measured = None if entry.truth is None else nees(posterior, entry.truth, layout)
        yield replace(step, posterior=posterior, nees=measured)
        belief = posterior


def _handed_over(step: Step, numbers: Integers) -> Booleans:
    """Which runs' filters are asked something : (N,)"""
    c = step.correction
    if c is None:
        return np.full(numbers.shape, step.entry.given is not None)
    return np.broadcast_to(c.used, numbers.shape)


def _of_run(given: Control | Reading | None, run: int, numbers: Integers) -> Control | Reading:
    """An input or a reading of one of N runs; one that is alike for all has no axis of theirs."""
    if isinstance(given, Control):
        return replace(given, u=np.broadcast_to(given.u, (len(numbers), given.u.shape[-1]))[run])
    assert given is not None
    return replace(given, z=np.broadcast_to(given.z, (len(numbers), given.z.shape[-1]))[run])
