"""Playing for a notebook: the same steps, which nobody can write into, and which know their scene.

Whatever stays in the program takes them from `localization` and `simulation`, and pays nothing.
"""

from collections.abc import Iterable, Iterator
from copy import deepcopy
from dataclasses import fields, is_dataclass

import numpy as np

from ekfsim import localization, simulation
from ekfsim.filters.belief import Belief, Learning, Mixture, Particles
from ekfsim.filters.protocol import Filter
from ekfsim.geometry import Integers
from ekfsim.models.layout import POSE, Layout
from ekfsim.records import Control, Entry, Reading, Step
from ekfsim.scene import Guard, Scene


def play(scene: Scene, runs: Integers | None = None) -> Iterator[Step]:
    """Localize in a scene: every Step of its run, or of N runs side by side. runs : (N,)

    Nobody can write into what is handed out: keep it, and it stays as it is.
    """
    for step in localization.play(scene, runs):
        object.__setattr__(step, "scene", scene)  # it is new, and nobody else has it
        _hold(step.prior)
        _hold_entry(step.entry)
        yield _held(step)


def simulate(scene: Scene, runs: Integers | None = None) -> Iterator[Entry]:
    """The log of the scene's run, or of N runs side by side. runs : (N,) numbers from 0

    Nobody can write into what is handed out: keep it, and it stays as it is.
    """
    for entry in simulation.simulate(scene, runs):
        _hold_entry(entry)
        yield entry


def localize(
    entries: Iterable[Entry],
    filter: Filter,
    belief: Belief,
    guard: Guard = "warn",
    layout: Layout = POSE,
) -> Iterator[Step]:
    """Filter a log, simulated or recorded, one entry at a time.

    Nobody can write into what is handed out but into the entries and the belief, which are yours.
    """
    for step in localization.localize(entries, filter, deepcopy(belief), guard, layout):
        yield _held(step)


def _held(step: Step) -> Step:
    """The same step, its numbers but those of entry and prior held fast."""
    _hold(step.posterior)
    if (made := step.prediction) is not None:
        _fast(made.F, made.G)
    if (c := step.correction) is not None:
        _fast(c.predicted, c.innovation, c.R, c.S, c.H, c.K, c.nis, c.refused, c.settled)
        _fast(*(weight for weight in (c.trust, c.noise_factor) if weight is not None))
    if (nees := step.nees) is not None:
        _fast(nees.value, nees.dof, nees.impossible)
    _hold_fields(step.remark)
    return step


def _hold(belief: Belief) -> None:
    _fast(belief.mean, belief.covariance)
    if isinstance(belief, Particles):
        _fast(belief.states, belief.weights)
    elif isinstance(belief, Learning):
        _fast(*belief.factors.values())
    elif isinstance(belief, Mixture):
        _fast(belief.means, belief.covariances, belief.weights)
        _fast(belief.walls, belief.merged, belief.pruned)


def _hold_entry(entry: Entry) -> None:
    _fast(entry.truth, entry.bump, entry.fix)
    match entry.given:
        case Control(motion, u):
            _fast(u)
            _hold_fields(motion)
        case Reading(sensor, z):
            _fast(z)
            _hold_fields(sensor)


def _hold_fields(record: object) -> None:
    """The numbers of a model, or of what it remarks; those of its walls are held from the first."""
    if is_dataclass(record):
        _fast(*(getattr(record, field.name) for field in fields(record)))


def _fast(*numbers: object) -> None:
    for one in numbers:
        if isinstance(one, np.ndarray):
            one.flags.writeable = False
