"""Entries × filter → Steps."""

from collections.abc import Iterable, Iterator

import numpy as np

from ekfsim.consistency import nees
from ekfsim.filters import FILTERS
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.protocol import Filter
from ekfsim.geometry import Integers
from ekfsim.records import Control, Entry, Reading, Step
from ekfsim.scene import Guard, Scene
from ekfsim.simulation import simulate


def localize(entries: Iterable[Entry], filter: Filter, belief: Gaussian, guard: Guard = "warn") -> Iterator[Step]:
    """Filter a log, simulated or recorded, one entry at a time."""
    for entry in entries:
        step = advance(filter, belief, entry, guard)
        belief = step.posterior
        yield step


def advance(filter: Filter, belief: Gaussian, entry: Entry, guard: Guard = "warn") -> Step:
    """What the filter makes of one entry."""
    prediction = correction = sighting = None
    posterior = belief
    match entry.given:
        case Control(motion, u):
            posterior, prediction = filter.predict(belief, motion, u)
        case Reading(sensor, z):
            sighting = sensor.sight(*belief)
            skip = guard == "skip" and sighting is not None and sighting.ambiguous
            posterior, correction = filter.update(belief, sensor, z, skip)
    measured = None if entry.truth is None else nees(posterior, entry.truth)
    return Step(entry, belief, posterior, prediction, correction, sighting, measured)


def first_belief(scene: Scene, axes: tuple[int, ...] = ()) -> Gaussian:
    """What the filter is told of the start : (…, 3), (…, 3, 3)"""
    told = scene.world.told
    mean = np.broadcast_to(told.start, (*axes, 3))
    return Gaussian(mean, np.broadcast_to(np.diag(told.sigma**2), (*axes, 3, 3)))


def play(scene: Scene, runs: Integers | None = None) -> Iterator[Step]:
    """Simulate a scene and localize in it: every Step of its run, or of N runs side by side. runs : (N,)"""
    filter = FILTERS[scene.filter](gate=scene.gate)
    return localize(
        simulate(scene, runs), filter, first_belief(scene, np.shape(scene.run if runs is None else runs)), scene.guard
    )
