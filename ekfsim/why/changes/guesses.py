"""What may be wrong with the filter of a recorded log, each with the values that are tried."""

from collections import defaultdict
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import NamedTuple

import numpy as np

from ekfsim.diagnostics.innovations import named
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.belief import Refused
from ekfsim.geometry import Array
from ekfsim.records import Reading, Step
from ekfsim.systems.estimating import Estimating
from ekfsim.systems.robot import Robot
from ekfsim.why.changes.recorded import (
    later,
    louder,
    louder_motion,
    misread,
    unbiased,
    without_surprises,
)
from ekfsim.why.records import Change, Mechanism

FACTORS = (1 / 8, 1 / 4, 1 / 2, 0.7, 1.4, 2.0, 4.0, 8.0)  # of a noise
SCALES = (0.7, 0.8, 0.9, 0.95, 0.98, 1.02, 1.05, 1.1, 1.2, 1.4)  # of a way or a turn
RATES = (-0.3, -0.1, -0.03, -0.01, 0.01, 0.03, 0.1, 0.3)  # rad/s, m/s², rad
OFTEN = (1.0, 2.0, 4.0)  # times the mean innovation: the estimate absorbs a part of a bias
CLOCKS = (-1.0, -0.3, -0.1, 0.1, 0.3, 1.0)  # s
SURPRISING = 0.999  # a NIS beyond this quantile is left out
FEW = 0.1  # of the readings: more of them are no outliers
ENOUGH = 10  # readings, for a mean


class Family(NamedTuple):
    """One thing that may be wrong, by how much being unknown."""

    make: Callable[[float], Change]
    values: tuple[float, ...]
    mechanism: Callable[[float], Mechanism]
    by_factor: bool  # values lie between two others by their product, else by their sum
    beyond: bool = True  # whether there may be more than the outermost values
    beside: bool = True  # whether many are played side by side: none where readings change places


def families(steps: Sequence[Step], robot: Robot | None) -> list[Family]:
    """All that are played side by side, then the clocks of the sensors, where there is one."""
    found = [*_noises(steps), *_biases(steps), *_motions(robot)]
    return [*found, *_clocks(steps)]


def readings(steps: Sequence[Step]) -> dict[str, dict[str, list[Array]]]:
    """The innovations that there are, by sensor and target."""
    found: dict[str, dict[str, list[Array]]] = defaultdict(lambda: defaultdict(list))
    for step in steps:
        if step.correction is not None and isinstance(step.entry.given, Reading):
            sensor, target = named(step.entry.given)
            if not np.isnan(step.correction.nis):
                found[sensor][target].append(step.correction.innovation)
    return found


def _noises(steps: Sequence[Step]) -> Iterator[Family]:
    for sensor in readings(steps):
        yield Family(
            lambda factor, sensor=sensor: louder(sensor, factor),  # type: ignore[misc]
            FACTORS,
            lambda factor: (
                Mechanism.SENSOR_OVERTRUSTED if factor > 1 else Mechanism.SENSOR_DISTRUSTED
            ),
            by_factor=True,
        )
    yield Family(
        louder_motion,
        FACTORS,
        lambda factor: (
            Mechanism.ODOMETRY_OVERTRUSTED if factor > 1 else Mechanism.ODOMETRY_DISTRUSTED
        ),
        by_factor=True,
    )


def _biases(steps: Sequence[Step]) -> Iterator[Family]:
    """Of each sensor one, of each target its own, and of all targets of a sensor each its own."""
    for sensor, targets in readings(steps).items():
        mean: Array
        everything = [ν for some in targets.values() for ν in some]
        if len(everything) < ENOUGH:
            continue
        mean = np.mean(everything, axis=0)
        yield _bias(sensor, dict.fromkeys(targets, mean))
        own = {t: np.mean(some, axis=0) for t, some in targets.items() if len(some) >= ENOUGH}
        if len(targets) > 1 and own:
            yield _bias(f"{sensor}, of each target its own,", own)
            for target, one in own.items():
                yield _bias(target, {target: one})


def _bias(name: str, means: Mapping[str, Array]) -> Family:
    def make(often: float) -> Change:
        biases = {target: often * mean for target, mean in means.items()}
        least, most = np.min(list(biases.values()), axis=0), np.max(list(biases.values()), axis=0)
        told = ", ".join(
            f"{low:+.3g}" if low == high else f"{low:+.3g} to {high:+.3g}"
            for low, high in zip(least.tolist(), most.tolist(), strict=True)
        )
        return unbiased(name, biases, told)

    return Family(make, OFTEN, lambda often: Mechanism.SENSOR_BIAS, by_factor=True)


def _motions(robot: Robot | None) -> Iterator[Family]:
    """Scales and biases of what the robot measures of its motion."""
    if robot is None or isinstance(robot, Estimating):
        return
    for name in robot.faults:
        scale = name.endswith("_scale")
        mechanism = Mechanism.MOTION_BIAS
        if scale:
            mechanism = Mechanism.TURN_SCALE if name == "turn_scale" else Mechanism.WHEEL_SCALE
        yield Family(
            lambda value, name=name: misread(robot, name, value, f"{value:.4g}"),  # type: ignore[misc]
            SCALES if scale else RATES,
            lambda value, mechanism=mechanism: mechanism,  # type: ignore[misc]
            by_factor=scale,
            beyond=not scale,
        )


def _clocks(steps: Sequence[Step]) -> Iterator[Family]:
    if steps[-1].entry.t is None:
        return
    for sensor in readings(steps):
        yield Family(
            lambda by, sensor=sensor: later(sensor, by),  # type: ignore[misc]
            CLOCKS,
            lambda by: Mechanism.LATE_READINGS,
            by_factor=False,
            beyond=False,
            beside=False,
        )


def surprises(steps: Sequence[Step]) -> dict[int, str]:
    """The target of each reading that surprises beyond reason, by the index of its entry."""
    found = {}
    for step in steps:
        if step.correction is not None and isinstance(step.entry.given, Reading):
            dof = step.correction.innovation.shape[-1]
            if float(step.correction.nis) > quantile(SURPRISING, dof):
                found[step.entry.index] = named(step.entry.given)[1]
    return found


def outliers(robust: Sequence[Step]) -> Change | None:
    """The surprising readings left out, where they are few. robust : the log with a filter that is
    not led astray by them
    """
    found = surprises(robust)
    read = sum(
        step.correction is not None and int(step.correction.refused) != Refused.NO_ECHO
        for step in robust
    )
    if not found or len(found) > FEW * read:
        return None
    return without_surprises(frozenset(found), len(found) / read)
