"""A run as arrays: what a figure draws over time."""

from collections.abc import Iterable
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ekfsim.filters.belief import Refused
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.geometry.angles import wrap
from ekfsim.models.layout import Layout
from ekfsim.records import Control, Reading, Step


class Judged(NamedTuple):
    """A reading and what the filter made of it."""

    t: float  # s
    name: str
    z: Array  # (k,)
    nis: float
    refused: Refused


@dataclass(frozen=True)
class Track:
    """A run, one row for each instant as it stood after the last update of that instant."""

    t: Array  # (N,) s
    state: Array  # (N, n)
    covariance: Array  # (N, n, n)
    truth: Array  # (N, 3) pose, nan where it is not known
    fix: Array  # (N, 2) m, positions that were recorded and not used, nan where there is none
    reckoned: Array  # (N, n) what the motion inputs alone make of the first estimate
    readings: tuple[Judged, ...]
    layout: Layout

    @classmethod
    def of(cls, steps: Iterable[Step], layout: Layout) -> "Track":
        """The track of a drive or a recorded log, whose entries know their instants."""
        t: list[float] = []
        rows: list[tuple[Array, Array, Array, Array, Array]] = []
        readings: list[Judged] = []
        reckoned: Array | None = None
        nowhere, nofix = np.full(3, np.nan), np.full(2, np.nan)
        for step in steps:
            entry, (x, P) = step.entry, step.posterior
            assert entry.t is not None
            reckoned = x if reckoned is None else reckoned
            if isinstance(entry.given, Control):
                reckoned = entry.given.motion.f(reckoned, entry.given.u)
            if isinstance(entry.given, Reading) and step.correction is not None:
                c = step.correction
                readings.append(
                    Judged(
                        entry.t,
                        entry.given.name,
                        entry.given.z,
                        float(c.nis),
                        Refused(int(c.refused)),
                    )
                )
            truth = nowhere if entry.truth is None else entry.truth
            fix = nofix if entry.fix is None else entry.fix
            if t and t[-1] == entry.t:
                if entry.fix is None:
                    fix = rows[-1][3]
                rows[-1] = (x, P, truth, fix, reckoned)
            elif entry.judged:
                t.append(entry.t)
                rows.append((x, P, truth, fix, reckoned))
        state, covariance, truth, fix, reckoned_all = (
            np.array(column) for column in zip(*rows, strict=True)
        )
        return cls(
            np.array(t), state, covariance, truth, fix, reckoned_all, tuple(readings), layout
        )

    @property
    def pose(self) -> Array:
        """(N, 3) x, y in m, heading in rad"""
        return self.layout.pose(self.state)

    @property
    def pose_covariance(self) -> Array:
        """(N, 3, 3)"""
        return self.layout.pose_covariance(self.covariance)

    @property
    def position_error(self) -> Array:
        """(N,) m, nan where the truth is not known"""
        error: Array = np.hypot(*(self.pose[:, :2] - self.truth[:, :2]).T)
        return error

    @property
    def heading_error(self) -> Array:
        """(N,) rad, with its sign"""
        return wrap(self.pose[:, 2] - self.truth[:, 2])

    @property
    def nis(self) -> float:
        """The mean NIS per number read: 1 is right. nan where nothing was read"""
        known = [reading for reading in self.readings if not np.isnan(reading.nis)]
        numbers = sum(len(reading.z) for reading in known)
        return sum(reading.nis for reading in known) / numbers if numbers else float("nan")

    @property
    def seen(self) -> Integers:
        """(N,) how many readings were taken at each instant"""
        counted = np.zeros(len(self.t), np.int64)
        times = np.array([reading.t for reading in self.readings])
        np.add.at(counted, np.minimum(np.searchsorted(self.t, times), len(self.t) - 1), 1)
        return counted

    @property
    def has_truth(self) -> Booleans:
        """(N,) where the truth is known"""
        return ~np.isnan(self.truth[:, 0])


def rmse(error: Array) -> float:
    """√(mean e²) of what is known of an error."""
    known = error[~np.isnan(error)]
    return float(np.sqrt(np.mean(known**2))) if known.size else float("nan")


def running_rmse(error: Array) -> Array:
    """RMSE of all errors up to each instant (document 004, eq. 12) : (N,)"""
    return np.sqrt(np.cumsum(error**2) / np.arange(1, len(error) + 1))
