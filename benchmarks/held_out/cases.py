"""A case: a scene, the one mechanism behind what becomes of it, and the same without that."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from ekfsim.commands import Command, Kidnap, Move, expand
from ekfsim.diagnostics.verdict import BAND
from ekfsim.filters.arithmetic.chi_square import band
from ekfsim.geometry import Array, Booleans
from ekfsim.scene import Scene
from ekfsim.study.block import watched
from ekfsim.world import Faults, World

Outcome = Literal["lost", "over-confident", "over-cautious", "consistent"]
Cure = Callable[[Scene], Scene]


@dataclass(frozen=True)
class Case:
    """One scene of the held-out set. The engine is given `scene` and nothing else of it."""

    name: str
    mechanism: str | None  # as `ekfsim.why` names it; None where there is nothing to explain
    scene: Scene
    without: Cure | None  # the same scene without its mechanism
    outcome: Outcome = "lost"  # of the run that is looked at


def case(
    name: str,
    mechanism: str | None,
    world: World,
    commands: Sequence[Command],
    without: Cure | None,
    outcome: Outcome = "lost",
    *,
    seed: int = 0,
    gate: float | None = None,
) -> Case:
    """A case of these."""
    scene = Scene(world, tuple(commands), seed=seed, gate=gate, commands_source=name)
    return Case(name, mechanism, scene, without, outcome)


def noise_told(scene: Scene) -> Scene:
    """The filter is told the true ratios."""
    return _told(scene, noise=scene.world.noise)


def map_told(scene: Scene) -> Scene:
    """The filter is told the true map."""
    return _told(scene, map=scene.world.map)


def start_told(scene: Scene) -> Scene:
    """The filter is told the true start."""
    return _told(scene, start=scene.world.start)


def sound(scene: Scene) -> Scene:
    """Nothing is wrong with the robot and its laser."""
    return replace(scene, world=replace(scene.world, faults=Faults()))


def no_slip(scene: Scene) -> Scene:
    """The wheels grip, and nobody carries the robot away."""
    kept = (one for one in expand(scene.commands) if not isinstance(one, Kidnap))
    grips = (replace(one, slip=0.0) if isinstance(one, Move) else one for one in kept)
    return replace(scene, commands=tuple(grips))


def guarded(scene: Scene) -> Scene:
    """No beam is used that might meet another wall than the one expected."""
    return replace(scene, guard="skip")


def gated(scene: Scene) -> Scene:
    """No reading is used that does not fit."""
    return replace(scene, gate=0.99)


def sure(scene: Scene) -> Scene:
    """The heading at the start is known five times better, and turns are measured so."""
    world, fifth = scene.world, np.array([1.0, 1.0, 0.2])
    noise = replace(world.noise, odometry_angle=world.noise.odometry_angle / 5)
    told = replace(world.told, sigma=world.told.sigma * fifth, noise=noise)
    return replace(
        scene, world=replace(world, start_sigma=world.start_sigma * fifth, noise=noise, told=told)
    )


def wary(scene: Scene) -> Scene:
    """The filter is told seven times the laser's noise."""
    noise = scene.world.told.noise
    return _told(scene, noise=replace(noise, range=7 * noise.range))


def _told(scene: Scene, **changes: object) -> Scene:
    world = scene.world
    told = replace(world.told, **changes)  # type: ignore[arg-type]
    return replace(scene, world=replace(world, told=told))


@dataclass(frozen=True)
class Ended:
    """How runs of a scene ended. Arrays : (N,)"""

    lost: Booleans
    nis: Array  # −1 below its band, 1 above, 0 inside

    @classmethod
    def of(cls, scene: Scene, runs: int) -> "Ended":
        """Of the runs 0 … runs − 1."""
        of = watched(scene, 0, runs)
        limits = np.array([band(BAND, int(n)) if n else (0.0, np.inf) for n in of.readings.dof])
        side = (of.readings.nis > limits[:, 1]).astype(int) - (of.readings.nis < limits[:, 0])
        return cls(of.lost_from >= 0, side)

    def as_told(self, outcome: Outcome) -> Booleans:
        """Which of them ended so."""
        if outcome == "lost":
            return self.lost
        sides = {"over-confident": 1, "over-cautious": -1, "consistent": 0}
        return ~self.lost & (self.nis == sides[outcome])


@dataclass(frozen=True)
class Verified:
    """That the mechanism is the cause: how many end so with it, how many without, and a run."""

    with_it: float
    without: float
    run: int | None  # the first that ends so and does not without it

    @property
    def holds(self) -> bool:
        """Whether it ends so at least 4 times as often, or 30 points more."""
        apart = self.with_it - self.without
        return self.run is not None and (self.with_it >= 4 * self.without or apart >= 0.3)


def verified(one: Case, runs: int) -> Verified:
    """What several hundred runs of a case say."""
    ended = Ended.of(one.scene, runs).as_told(one.outcome)
    if one.without is None:
        chosen = np.flatnonzero(ended)
        return Verified(float(ended.mean()), 0.0, int(chosen[0]) if chosen.size else None)
    cured = Ended.of(one.without(one.scene), runs).as_told(one.outcome)
    chosen = np.flatnonzero(ended & ~cured)
    return Verified(
        float(ended.mean()), float(cured.mean()), int(chosen[0]) if chosen.size else None
    )
