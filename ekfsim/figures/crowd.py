"""Many runs of one filter side by side, and their errors over time."""

import math
from dataclasses import dataclass, replace

import numpy as np

from ekfsim.diagnostics.verdict import LOST
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.belief import Refused
from ekfsim.filters.protocol import Filter
from ekfsim.geometry import Array, Booleans
from ekfsim.geometry.angles import wrap
from ekfsim.localization import first_belief, localize, play
from ekfsim.records import Control, Nees
from ekfsim.scene import Scene
from ekfsim.simulation import simulate

UNSEEN = (Refused.NO_WALL, Refused.GUARD)  # nothing was predicted; the pioneer's guard never skips


@dataclass(frozen=True)
class Crowd:
    """N runs of one filter side by side, one row for each of T instants."""

    t: Array  # (T,) s
    error: Array  # (T, N, 3) m, m, rad: estimate − truth
    reckoned: Array  # (T, N, 3) the same of the motion inputs alone
    nees: Array  # (N,) of the pose at the end, ∞ where the belief is impossible
    blind: float  # readings in a run that were refused because the filter predicted none

    @property
    def position(self) -> Array:
        """(T, N) m"""
        distance: Array = np.hypot(self.error[..., 0], self.error[..., 1])
        return distance

    @property
    def heading(self) -> Array:
        """(T, N) rad"""
        return self.error[..., 2]

    @property
    def is_lost(self) -> Booleans:
        """Whether the last NEES of each run lies beyond its χ² quantile : (N,)"""
        lost: Booleans = self.nees > quantile(LOST, 3)
        return lost

    @property
    def lost(self) -> float:
        """The share of such runs."""
        return float(np.mean(self.is_lost))


def crowd_of(scene: Scene, n: int, filter: Filter | None = None) -> Crowd:
    """Runs 0 … n − 1 of a scene, simulated;
    watched by another filter than the scene's where one is given.
    """
    layout, reckoned, blind = scene.world.layout, np.zeros(0), 0
    at: dict[float, tuple[Array, Array]] = {}  # the last of each instant
    last: Nees | None = None
    runs = np.arange(n)
    watched = play(scene, runs)
    if filter is not None:
        watched = localize(
            simulate(scene, runs), filter, first_belief(scene, (n,)), scene.guard, layout
        )
    for step in watched:
        entry = step.entry
        assert entry.t is not None
        assert entry.truth is not None
        if entry.given is None:
            reckoned = step.posterior.mean
        if isinstance(entry.given, Control):
            reckoned = entry.given.motion.f(reckoned, entry.given.u)
        if step.correction is not None:
            blind += int(np.sum(np.isin(step.correction.refused, UNSEEN)))
        estimated, alone = layout.pose(step.posterior.mean), layout.pose(reckoned)
        at[entry.t] = _difference(estimated, entry.truth), _difference(alone, entry.truth)
        last = step.nees
    assert last is not None
    errors, of_reckoned = (np.stack(each) for each in zip(*at.values(), strict=True))
    return Crowd(
        np.array(list(at)),
        errors,
        of_reckoned,
        np.where(last.impossible, np.inf, last.value),
        blind / n,
    )


def _difference(pose: Array, truth: Array) -> Array:
    """pose − truth : (…, 3), the heading wrapped"""
    e: Array = pose - truth
    e[..., 2] = wrap(e[..., 2])
    return e


def set_down(scene: Scene, metres: float, degrees: float) -> Scene:
    """The same scene, its robot set down on its mark no better than that,
    and the filter told so.
    """
    sigma = np.array([metres, metres, math.radians(degrees)])
    told = replace(scene.world.told, sigma=sigma)
    return replace(scene, world=replace(scene.world, start_sigma=sigma, told=told))


def over_runs(e: Array) -> Array:
    """RMSE of all runs at each instant : (T, N) → (T,)"""
    over_time: Array = np.sqrt(np.mean(e**2, axis=1))
    return over_time
