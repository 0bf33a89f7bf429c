"""Entries × filter → Steps."""

from collections.abc import Callable, Iterable, Iterator

import numpy as np

from ekfsim.diagnostics.ambiguity import remark as remarked
from ekfsim.diagnostics.nees import nees
from ekfsim.errors import StepError, UsageError
from ekfsim.filters.belief import Belief, Gaussian, Particles
from ekfsim.filters.place import forward, is_smoothed, label
from ekfsim.filters.protocol import Beginning, Filter
from ekfsim.filters.tuning import CROWDS
from ekfsim.geometry import Array, Integers
from ekfsim.models.layout import POSE, Layout
from ekfsim.records import Control, Entry, Reading, Step, called
from ekfsim.scene import Guard, Scene
from ekfsim.simulation import simulate
from ekfsim.simulation.draws import PLACES, STARTS, particle_generators
from ekfsim.simulation.nominal import nominal_trajectory
from ekfsim.systems import system_of
from ekfsim.twins import twinned


@twinned
def localize(
    entries: Iterable[Entry],
    filter: Filter,
    belief: Belief,
    guard: Guard = "warn",
    layout: Layout = POSE,
) -> Iterator[Step]:
    """Filter a log, simulated or recorded, one entry at a time."""
    for entry in entries:
        step = advance(filter, belief, entry, guard, layout)
        belief = step.posterior
        yield step


def advance(
    filter: Filter, belief: Belief, entry: Entry, guard: Guard = "warn", layout: Layout = POSE
) -> Step:
    """What the filter makes of one entry.

    A single run is told all that is to be said of a reading; N runs side by side only what the
    guard needs to know.
    """
    prediction = correction = remark = None
    posterior = belief
    try:
        match entry.given:
            case Control(motion, u):
                posterior, prediction = filter.predict(belief, motion, u)
            case Reading(sensor, z):
                if belief.mean.ndim == 1 or guard == "skip":
                    remark = remarked(sensor, *belief)
                skip = guard == "skip" and remark is not None and remark.ambiguous
                posterior, correction = filter.update(belief, sensor, z, skip)
    except StepError as error:
        raise error.at(called(entry)) from error.__cause__
    measured = None if entry.truth is None else nees(posterior, entry.truth, layout)
    return Step(entry, belief, posterior, prediction, correction, remark, measured, layout)


def play(scene: Scene, runs: Integers | None = None) -> Iterator[Step]:
    """Localize in a scene: every Step of its run, or of N runs side by side. runs : (N,)

    Where the filter's name asks for it, with all readings of the run: the first step comes when the
    last is known.
    """
    belief = belief_of(scene, runs)
    entries = entries_of(scene, runs)
    steps = localize(entries, filter_of(scene, runs), belief, scene.guard, scene.world.layout)
    if is_smoothed(scene.filter):
        from ekfsim.smoothing import smoothed  # seldom asked

        return smoothed(steps)
    return steps


def entries_of(scene: Scene, runs: Integers | None = None) -> Iterable[Entry]:
    """What happens in a scene, simulated or recorded, as its system gives it to a filter."""
    happened = simulate(scene, runs) if scene.log is None else scene.log.entries
    return system_of(scene.world.system).entries(happened, scene.reading)


def belief_of(scene: Scene, runs: Integers | None = None) -> Belief:
    """With what the filter begins a run, or N runs side by side: the first belief, or where no
    start is known particles from all over the floor.

    Raises UsageError where the filter can begin with no such crowd.
    """
    numbers = np.asarray(scene.run if runs is None else runs)
    first = first_belief(scene, numbers.shape)
    if not scene.world.told.start_unknown:
        return first
    anywhere = scene.world.anywhere
    if forward(scene.filter) not in CROWDS or anywhere is None:
        raise UsageError(
            f"{scene.world_source}: belief.start: {label(scene.filter)} cannot begin where the "
            f"start is unknown; name one that can: --filter {' or '.join(reversed(CROWDS))}"
        )
    p = scene.tuning.crowd(scene.filter)
    drawn = [anywhere(one, p) for one in particle_generators(scene.seed, numbers, STARTS)]
    states = np.stack(drawn).reshape(*numbers.shape, p, -1)
    return Particles(*first, states, np.full(states.shape[:-1], 1 / p))


def first_belief(scene: Scene, axes: tuple[int, ...] = ()) -> Gaussian:
    """What the filter is told of the start : (…, n), (…, n, n)"""
    log = scene.log
    mean, P = scene.world.first_belief(scene.reading) if log is None else log.first
    return Gaussian(
        np.broadcast_to(mean, (*axes, *mean.shape)), np.broadcast_to(P, (*axes, *P.shape))
    )


def places_of(scene: Scene) -> Callable[[int], Array] | None:
    """So many states from all over the floor that the filter believes free, the same for all runs
    of a seed; None where no map tells where that is.
    """
    anywhere = scene.world.anywhere
    if anywhere is None:
        return None
    first = np.array(0)
    return lambda number: anywhere(particle_generators(scene.seed, first, PLACES)[0], number)


def filter_of(scene: Scene, runs: Integers | None = None) -> Filter:
    """The filter that watches a scene, at the beginning of its run, or of N runs side by side."""
    numbers = np.asarray(scene.run if runs is None else runs)
    beginning = Beginning(
        first_belief(scene), scene.world.layout.headings, scene.gate,
        lambda: particle_generators(scene.seed, numbers), scene.tuning,
        lambda: nominal_trajectory(scene), scene.world.anywhere, places_of(scene),
        runs, scene.world.layout.places,
    )  # fmt: skip
    name = forward(scene.filter)
    return system_of(scene.world.system).filter(name, scene.reading, beginning)
