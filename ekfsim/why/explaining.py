"""explain: what was wrong with one run, by what cures it."""

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from ekfsim.filters.tuning import reads
from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.why.changes.beams import AMBIGUOUS
from ekfsim.why.changes.driven import NO_GATE, suspects_of_drive
from ekfsim.why.changes.groups import groups_of
from ekfsim.why.changes.singles import singles
from ekfsim.why.changes.suspects import FEW, Suspect, suspects_of
from ekfsim.why.changes.told import ratios, starts
from ekfsim.why.records import Change, Explanation, Heard, Mechanism, Shares
from ekfsim.why.trying.chance import by_chance
from ekfsim.why.trying.crowd import Crowd
from ekfsim.why.trying.minimal import SpentError, minimal
from ekfsim.why.trying.naming import named
from ekfsim.why.trying.seeing import unseen
from ekfsim.why.trying.trials import Trials

BUDGET = 400  # replays of one run
# of a driven robot, whose run has thousands of steps
STEPS_REPLAYED = 3_000_000  # of all replays of one run
STEPS_OBEYED = 300_000  # the same of the classroom's robot, whose beams take longer
LEAST_BUDGET = 40
LEAST_OF_CROWDS = 10  # the same of particles
# steps of the ekf that take as long as one of another filter, and how many particles do
PRICES = {"iekf": 3, "ukf": 3, "ukf-augmented": 3, "mhekf": 3}
PARTICLES_OF_ONE = 25
STEPS_OF_RUNS = 200_000  # of all of many runs, with each change
STEPS_OF_OBEYED = 2_000_000  # the same of the classroom's robot
FEWEST_DRIVEN = 20  # runs; of fewer nothing is to be learnt, and this one speaks for itself
PARTED = 1e-6  # m, rad; two estimates that differ by more have parted
PARTICLE_STEPS = 4_000_000  # of many runs' exact filter, in all
FEWEST = 100  # runs that it is tried in all the same


def explain(
    scene: Scene, runs: int = 1000, budget: int | None = None, heard: Heard | None = None
) -> Explanation:
    """Why the scene's run ended as it did.

    runs : how many stand behind the shares; budget : how many times one run is played again at
    most; where nobody says it, what is affordable; heard : is told how many of these are done, and
    the budget, then how far many runs have come. Ctrl-C ends it with what is known by then, once
    the run itself is.
    """
    if scene.log is not None:
        from ekfsim.why.recorded import explain_log  # of no use to a simulation

        return explain_log(scene, budget or affordable(scene, len(scene.log.entries)), heard)
    steps = tuple(Trials.first(scene))
    budget = budget or affordable(scene, len(steps))
    if scene.commanded:
        runs = min(runs, max(FEWEST, STEPS_OF_OBEYED // len(steps)))
    else:
        runs = min(runs, STEPS_OF_RUNS // len(steps))
        runs = runs if runs >= FEWEST_DRIVEN else 0
    trials = Trials(scene, steps, budget, heard)
    was = trials.was
    if was.outcome == "consistent":
        blind = scene.commanded and unseen(scene, steps)
        seen = Mechanism.NO_DIRECTION_SEEN if blind else None
        return Explanation(
            scene, was.outcome, None, mechanism=seen, budget=budget, lost_steps=steps
        )
    found, stopped = Named((), (), None), False
    try:
        found = _named(scene, trials, runs, heard)
        cure = _cure(found.guilty, trials)
    except KeyboardInterrupt:
        stopped, cure = True, _cure((), trials)
    cured = tuple(trials.again(cure)) if cure else ()
    return Explanation(
        scene,
        was.outcome,
        was.lost_from,
        tuple(trials.tried),
        cure,
        tuple(one.change for one in trials.tried if one.cures and one.change not in cure),
        parted(steps, cured),
        found.mechanisms[0] if len(found.mechanisms) == 1 else None,
        found.mechanisms if len(found.mechanisms) > 1 else (),
        trials.replays,
        budget,
        found.shares,
        steps,
        cured,
        stopped,
    )


def affordable(scene: Scene, steps: int) -> int:
    """How many replays of a run of so many steps are asked at most: fewer of a filter whose step
    takes longer, so that what is tried ends.
    """
    in_all = STEPS_OBEYED if scene.commanded else STEPS_REPLAYED
    crowd = scene.tuning.crowd(scene.filter) if reads(scene.filter, "particles") else 0
    price = max(PRICES.get(scene.filter, 1), crowd // PARTICLES_OF_ONE)
    least = LEAST_OF_CROWDS if crowd else LEAST_BUDGET
    return min(BUDGET, max(least, in_all // (price * max(steps, 1))))


class Named(NamedTuple):
    """What it was, and what many runs say of it."""

    guilty: tuple[Suspect, ...]
    mechanisms: tuple[Mechanism, ...]
    shares: Shares | None


def _named(scene: Scene, trials: Trials, runs: int, heard: Heard | None) -> Named:
    """What it was, by every change that is tried on the run, and those that cure on many."""
    steps, was = trials.steps, trials.was.outcome
    suspects = suspects_of(scene, steps) if scene.commanded else suspects_of_drive(scene, was)
    _try_all(scene, suspects, trials)
    few = max(min(runs, FEWEST), min(runs, PARTICLE_STEPS // (FEW * len(steps))))
    crowd = Crowd(scene, runs, was, heard)
    guilty, shares = named(suspects, trials, crowd, Crowd(scene, few, was, heard))
    if not guilty and (luck := by_chance(steps, crowd, was)) is not None:
        return Named((), (Mechanism.CHANCE,), luck)
    return Named(guilty, tuple(one.mechanism for one in guilty), shares)


def parted(lost: Sequence[Step], cured: Sequence[Step]) -> int | None:
    """The index of the first step after which two runs believe to be elsewhere."""
    for one, other in zip(lost, cured, strict=False):
        if not np.allclose(one.posterior.mean, other.posterior.mean, rtol=0, atol=PARTED):
            return one.entry.index
    return None


def _try_all(scene: Scene, suspects: Sequence[Suspect], trials: Trials) -> None:
    """Every change by itself, as far as the budget goes."""
    classes = [
        one
        for suspect in suspects
        for one in (suspect.change, *suspect.members)
        if one.kind != "reading"
    ]
    others = [*starts(scene.world)]
    others += [*ratios(scene.world), AMBIGUOUS] if scene.commanded else [NO_GATE]
    names = {(one.kind, one.name) for one in classes}
    classes += [one for one in others if (one.kind, one.name) not in names]
    try:
        for change in classes:
            trials.alone(change)
        if scene.commanded:
            trials.each(singles([step.entry for step in trials.steps]))
        else:
            trials.groups(groups_of(trials.steps, scene.world.robot))
    except SpentError:
        pass


def _cure(guilty: Sequence[Suspect], trials: Trials) -> tuple[Change, ...]:
    """The smallest set that cures: of what is guilty, of all else where nothing is."""
    if not guilty:
        return tuple(one.change for one in trials.tried if one.cures)[:1]
    if len(guilty) > 1:
        return minimal(tuple(one.change for one in guilty), trials.together)
    suspect = guilty[0]
    alone = [one for one in trials.tried if one.cures and one.change in suspect.ways]
    # rather one that makes it consistent, and rather a part than the whole
    alone.sort(key=lambda one: (one.outcome != "consistent", suspect.ways.index(one.change)))
    if suspect.has_parts and any(one.change == suspect.change for one in alone):
        best = alone[0]
        if best.change == suspect.change or best.outcome != "consistent":
            wanted = next(one for one in alone if one.change == suspect.change).outcome
            return minimal(
                suspect.members, lambda some: trials.ends(some) in (wanted, "consistent")
            )
    return (alone[0].change,)
