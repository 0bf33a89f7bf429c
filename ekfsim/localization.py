"""Entries × filter → Steps."""

from collections.abc import Iterable, Iterator
from dataclasses import replace

import numpy as np

from ekfsim.diagnostics.ambiguity import remark as remarked
from ekfsim.diagnostics.nees import nees
from ekfsim.errors import UsageError
from ekfsim.filters import FILTERS
from ekfsim.filters.belief import Belief, Gaussian
from ekfsim.filters.listing import ListingEKF
from ekfsim.filters.protocol import Beginning, Filter
from ekfsim.filters.shadows import ShadowsAlone
from ekfsim.geometry import Integers
from ekfsim.models.layout import POSE, Layout
from ekfsim.models.sensors.laser_by_reading import by_reading
from ekfsim.records import Control, Entry, Reading, Step
from ekfsim.scene import Guard, Scene
from ekfsim.simulation import simulate
from ekfsim.simulation.draws import particle_generators
from ekfsim.simulation.interpolation import stretched
from ekfsim.simulation.nominal import nominal_trajectory
from ekfsim.twins import twinned

NO_PLAN = (
    "a recording does not tell the way that was planned, which it is linearised about; take "
    "kf or ekf"
)


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
    match entry.given:
        case Control(motion, u):
            posterior, prediction = filter.predict(belief, motion, u)
        case Reading(sensor, z):
            if belief.mean.ndim == 1 or guard == "skip":
                remark = remarked(sensor, *belief)
            skip = guard == "skip" and remark is not None and remark.ambiguous
            posterior, correction = filter.update(belief, sensor, z, skip)
    measured = None if entry.truth is None else nees(posterior, entry.truth, layout)
    return Step(entry, belief, posterior, prediction, correction, remark, measured, layout)


def first_belief(scene: Scene, axes: tuple[int, ...] = ()) -> Gaussian:
    """What the filter is told of the start : (…, n), (…, n, n)"""
    mean, P = scene.log.first if scene.log is not None else _told_first(scene)
    return Gaussian(
        np.broadcast_to(mean, (*axes, *mean.shape)), np.broadcast_to(P, (*axes, *P.shape))
    )


def _told_first(scene: Scene) -> Gaussian:
    """The first belief of a simulation: the document's own; the world file may say how uncertain
    its pose is.
    """
    world, told = scene.world, scene.world.told
    if world.told_robot is None:
        return Gaussian(told.start, np.diag(told.sigma**2))
    P = world.told_robot.first_covariance(scene.reading).copy()
    if np.any(told.sigma):
        places = np.array(world.layout.places)
        P[places[:, None], places] = np.diag(told.sigma**2)
    return Gaussian(world.layout.state(told.start), P)


def filter_of(scene: Scene, runs: Integers | None = None) -> Filter:
    """The filter that watches a scene, at the beginning of its run, or of N runs side by side."""
    numbers = np.asarray(scene.run if runs is None else runs)
    if scene.log is not None and scene.filter == "kf-nominal":
        raise UsageError(f"{scene.commands_source}: kf-nominal: {NO_PLAN}")
    beginning = Beginning(
        first_belief(scene), scene.world.layout.headings, scene.gate,
        lambda: particle_generators(scene.seed, numbers), scene.tuning,
        lambda: nominal_trajectory(scene),
    )  # fmt: skip
    if by_listing(scene):
        return ListingEKF.begin(beginning)
    filter = FILTERS[scene.filter].begin(beginning)
    return ShadowsAlone(filter) if scene.tuning.cross_covariances == "dropped" else filter


def by_listing(scene: Scene) -> bool:
    """Whether readings are held against the state of before the motion, as the code of two
    documents does.
    """
    return (
        scene.filter == "ekf"
        and scene.world.system in ("mower", "gnss")
        and scene.reading == "coded"
    )


def noise_by_reading(entry: Entry) -> Entry:
    """The same entry, its laser told to take C_v from the reading in place of the prediction: a
    counter-example.
    """
    if not isinstance(entry.given, Reading):
        return entry
    sensor, z = entry.given.sensor, entry.given.z
    return replace(entry, given=replace(entry.given, sensor=by_reading(sensor, z)))


def play(scene: Scene, runs: Integers | None = None) -> Iterator[Step]:
    """Localize in a scene: every Step of its run, or of N runs side by side. runs : (N,)"""
    entries = simulate(scene, runs) if scene.log is None else iter(scene.log.entries)
    # its authors have a fix at every motion input
    if scene.world.system == "gnss" and scene.reading == "coded":
        entries = stretched(entries)
    if scene.tuning.range_variance == "reading":
        entries = map(noise_by_reading, entries)
    belief = first_belief(scene, np.shape(scene.run if runs is None else runs))
    return localize(entries, filter_of(scene, runs), belief, scene.guard, scene.world.layout)
