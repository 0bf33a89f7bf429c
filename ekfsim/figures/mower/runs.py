"""Document 000 over many runs:
each drive once, its log filtered side by side in every way that a table compares.
"""

from collections.abc import Iterable
from dataclasses import dataclass, replace
from typing import NamedTuple

import numpy as np

from ekfsim.diagnostics.nees import nees
from ekfsim.figures.mower.told import as_told_by, with_angles_of
from ekfsim.figures.track import Track
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.localization import first_belief
from ekfsim.models.sensors.frozen import Frozen
from ekfsim.records import Control, Reading
from ekfsim.scene import Scene
from ekfsim.simulation import simulate
from ekfsim.systems.document import DocumentReading

RUNS = 20
EVERY = 20  # motion inputs between two instants at which errors are counted: five a second


class Way(NamedTuple):
    """How a log is filtered."""

    reading: DocumentReading | None  # None: by its motion inputs alone
    ideal: bool = False  # with the angles of the true pose


ALONE = Way(None)


@dataclass(frozen=True)
class Outcome:
    """What came of N runs, at T instants each."""

    position: Array  # (T, N) m
    heading: Array  # (T, N) rad, with its sign
    nees: Array  # (T, N) of three degrees of freedom
    nis: Array  # (N,) mean per number read

    @classmethod
    def of(cls, track: Track) -> "Outcome":
        """Of one run."""
        judged = nees(Gaussian(track.state, track.covariance), track.truth, track.layout).value
        numbers = sum(len(reading.z) for reading in track.readings)
        nis = (
            np.nansum([reading.nis for reading in track.readings]) / numbers if numbers else np.nan
        )
        return cls(
            track.position_error[:, None],
            track.heading_error[:, None],
            judged[:, None],
            np.array([nis]),
        )

    @property
    def rmse(self) -> Array:
        """Of the position : (N,) m"""
        return np.asarray(np.sqrt(np.nanmean(self.position**2, axis=0)), np.float64)

    @property
    def heading_rmse(self) -> Array:
        """(N,) rad"""
        return np.asarray(np.sqrt(np.nanmean(self.heading**2, axis=0)), np.float64)


def outcomes(scene: Scene, asked: Iterable[Way], runs: int) -> dict[Way, Outcome]:
    """Runs 0 … N − 1 of a simulated scene, filtered by an EKF in each of the ways at once."""
    layout = scene.world.layout
    ekf = EKF(scene.gate, layout.headings)
    ways = list(asked)
    many = len(ways)
    x, P = first_belief(scene, (many * runs,))
    before, truth, ticks = x, np.zeros((runs, 3)), 0
    judged = list[tuple[Array, Array, Array]]()
    # the sum of NIS, and of how many numbers
    read = [(np.zeros(runs), np.zeros(runs)) for _ in ways]

    def judge() -> None:
        everywhere = np.tile(truth, (many, 1))
        e = x - everywhere
        square = nees(Gaussian(x, P), everywhere, layout).value
        judged.append((np.hypot(e[:, 0], e[:, 1]), wrap(e[:, 2]), square))

    for entry in simulate(scene, np.arange(runs)):
        match entry.given:
            case Control(motion, u):
                if ticks and ticks % EVERY == 0:
                    judge()
                ticks, before = ticks + 1, x
                (x, P), _ = ekf.predict(Gaussian(x, P), motion, np.tile(u, (many, 1)))
            case Reading():
                x, P = x.copy(), P.copy()
                for way, (nis, count), here in zip(ways, read, _rows(many, runs), strict=True):
                    if way.reading is None:
                        continue
                    assert entry.truth is not None
                    given = as_told_by(way.reading, entry.given)
                    given = with_angles_of(entry.truth, given) if way.ideal else given
                    sensor = given.sensor
                    if way.reading == "coded":
                        sensor = Frozen(sensor, before[here])
                    (x[here], P[here]), correction = ekf.update(
                        Gaussian(x[here], P[here]), sensor, given.z
                    )
                    nis += np.nan_to_num(correction.nis)
                    count += given.z.shape[-1] * ~np.isnan(correction.nis)
        assert entry.truth is not None
        truth = entry.truth
    judge()
    position, heading, square = (np.array(column) for column in zip(*judged, strict=True))
    with np.errstate(invalid="ignore"):
        return {
            way: Outcome(position[:, here], heading[:, here], square[:, here], nis / count)
            for way, (nis, count), here in zip(ways, read, _rows(many, runs), strict=True)
        }


def _rows(ways: int, runs: int) -> list[slice]:
    """Which rows of the batch are the runs of each way."""
    return [slice(way * runs, (way + 1) * runs) for way in range(ways)]


def as_shaken_as_told(scene: Scene) -> Scene:
    """The same scene with a robot that is what the filter is told."""
    world = scene.world
    return replace(scene, world=replace(world, robot=world.believed_robot))
