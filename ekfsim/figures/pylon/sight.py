"""The innovations of document 004's filter, seen along the line of sight to the pylon.

Along it the lidar's range speaks; across it, an error of the yaw turns the reading sideways.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from ekfsim.filters.arithmetic.chi_square import band
from ekfsim.geometry import Array, Booleans
from ekfsim.models.layout import INERTIAL
from ekfsim.records import Step

HALF_WINDOW = 5  # steps to each side, over which a turn rate is taken
TURNING = (0.0, 5.0, 20.0, 40.0)  # degrees/s from which on a turn is slow, …, fast
INSIDE = 0.95  # of χ²₂: the band that a NIS is held against
LONG = 1.5  # usual steps, a longer one is a gap


@dataclass(frozen=True)
class Innovations:
    """All readings of a run, in the frame of the line of sight."""

    t: Array  # (K,) s
    along: Array  # (K,) in standard deviations
    across: Array  # (K,) what is left of the other part, given the first, in standard deviations
    sideways: Array  # (K,) m, across
    distance: Array  # (K,) m, that the filter expected
    range: Array  # (K,) m, that the lidar read
    turn_rate: Array  # (K,) rad/s, of the measured yaw

    @classmethod
    def of(cls, steps: Iterable[Step]) -> "Innovations":
        """With the line of sight e and n across it, and S_en = L Lᵀ

            (along, across) = L⁻¹ (e·ν, n·ν)

        so that along² + across² = νᵀ S⁻¹ ν.
        """
        rows = list[tuple[float, ...]]()
        for step in steps:
            if (c := step.correction) is None or step.entry.t is None:
                continue
            far = float(np.hypot(*c.predicted))
            e = c.predicted / far
            axes = np.array([e, [-e[1], e[0]]])
            ν = axes @ c.innovation
            L = np.linalg.cholesky(axes @ c.S @ axes.T)
            read_range = float(np.hypot(*(c.predicted + c.innovation)))
            rows.append(
                (
                    step.entry.t,
                    *np.linalg.solve(L, ν),
                    ν[1],
                    far,
                    read_range,
                    step.prior.mean[INERTIAL.heading],
                )
            )
        t, along, across, sideways, distance, read, yaw = np.array(rows).T
        k, θ = np.arange(len(t)), np.unwrap(yaw)
        later, sooner = np.minimum(k + HALF_WINDOW, len(t) - 1), np.maximum(k - HALF_WINDOW, 0)
        return cls(
            t,
            along,
            across,
            sideways,
            distance,
            read,
            (θ[later] - θ[sooner]) / (t[later] - t[sooner]),
        )

    @property
    def nis(self) -> Array:
        """(K,)"""
        return self.along**2 + self.across**2

    @property
    def per_number(self) -> Array:
        """NIS per number read, of which 1 is right on average : (K,)"""
        return self.nis / 2

    @property
    def mean_nis(self) -> float:
        """Per number read."""
        return float(self.per_number.mean())

    def turning(self, number: int) -> Booleans:
        """Where the cart turns as fast as the number-th class of TURNING says : (K,)"""
        rate = np.degrees(np.abs(self.turn_rate))
        faster = (*TURNING, np.inf)
        return (rate >= faster[number]) & (rate < faster[number + 1])

    @property
    def scatter(self) -> Array:
        """How far each range is from the mean of its two neighbours,
        as the noise of one range : (K − 2,) m

        The robot's own motion hardly shows in it:
        three times of a tenth of a second are nearly a straight line.
        """
        middle: Array = (self.range[2:] + self.range[:-2]) / 2
        return (self.range[1:-1] - middle) / math.sqrt(1.5)

    @property
    def late(self) -> Booleans:
        """Where a reading comes after a gap : (K,)"""
        dt = np.diff(self.t)
        return np.concatenate([[False], dt > LONG * np.median(dt)])


def inside(found: Innovations) -> float:
    """The share of readings whose NIS lies in the 95 % band, in %."""
    low, high = band(INSIDE, 2)
    return 100 * float(np.mean((found.nis >= low) & (found.nis <= high)))
