"""The innovations of a run, by sensor and target, and whether all of them together are white."""

from dataclasses import dataclass, field
from typing import Any, Literal

import numpy as np

from ekfsim.diagnostics.nees import RANK
from ekfsim.diagnostics.whiteness import Whiteness, whiteness
from ekfsim.filters.belief import Correction, Refused
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.sensors.frozen import Frozen
from ekfsim.records import Reading, Step

LEVEL = 0.05  # of being called not white, for all tests of a run together, where all is right
PORTION = 1024  # readings that are whitened together
SIDES = ("ahead", "left", "behind", "right")  # what a beam looks to, within 45°

Word = Literal["white", "not white", "no evidence"]


@dataclass(frozen=True, slots=True)
class Found:
    """What is found of all sensors of a run, or of N runs side by side."""

    sensors: tuple[Whiteness, ...]
    no_reading: Integers  # (…) steps whose sensor met nothing, or was expected to
    refused: Integers  # (…) by the gate or the guard
    certain: Integers  # (…) of S = 0

    @property
    def _each(self) -> Array:
        """The p of every test of every sensor : (…, 3 sensors), nan where it was not asked."""
        return np.concatenate([one.tests for one in self.sensors], axis=-1)

    @property
    def tests(self) -> Integers:
        """(…) how many there are; one that was not asked is none."""
        if not self.sensors:
            return np.zeros(np.shape(self.certain), np.int64)
        return np.asarray(np.count_nonzero(~np.isnan(self._each), axis=-1))

    @property
    def p(self) -> Array:
        """The smallest p of all tests, times their number: one error rate for all together.

        (…) nan where there is no evidence.
        """
        if not self.sensors:
            return np.full(np.shape(self.certain), np.nan)
        least = np.min(np.where(np.isnan(self._each), 1.0, self._each), axis=-1)
        return np.where(self.tests > 0, np.minimum(self.tests * least, 1.0), np.nan)

    @property
    def coloured(self) -> Booleans:
        """(…) whether the innovations are not white."""
        coloured: Booleans = self.p < LEVEL
        return coloured

    @property
    def word(self) -> Word:
        """Of one run."""
        if np.isnan(self.p):
            return "no evidence"
        return "not white" if self.coloured else "white"

    def table(self) -> dict[str, Any]:
        """As `--summary` writes it, of one run; None where unknown."""
        return {
            "word": self.word,
            "p": known(self.p),
            "tests": int(self.tests),
            "left_out": {
                "no_reading": int(self.no_reading),
                "refused": int(self.refused),
                "certain": int(self.certain),
            },
            "sensors": {one.sensor: _of_sensor(one) for one in self.sensors},
        }


def _of_sensor(one: Whiteness) -> dict[str, Any]:
    return {
        "quantities": list(one.quantities),
        "readings": int(one.readings),
        "numbers": int(one.numbers),
        "lags": [known(r) for r in one.lags],
        "target_lags": [known(r) for r in one.target_lags],
        "means": {
            target: [known(mean) for mean in means]
            for target, means in zip(one.targets, one.means, strict=True)
        },
        "sign_changes": int(one.changes),
        "p_lags": known(one.p_lags),
        "p_target_lags": known(one.p_target_lags),
        "p_mean": known(one.p_mean),
        "p_runs": known(one.p_runs),
    }


def known(value: Array) -> float | None:
    """A number of a table, None where it is undefined."""
    return None if np.isnan(value) else float(value)


@dataclass
class OfSensor:
    """The readings of one sensor so far, whitened in portions: a run may be long."""

    quantities: tuple[str, ...]  # what it reads: ("range", "bearing")
    read: list[str] = field(default_factory=list)  # the target of each reading
    w: list[Array] = field(default_factory=list)  # (…, n, k) each, nan where one is left out
    left_out: Integers = field(default_factory=lambda: np.zeros(3, np.int64))  # (…, 3): see Found
    _waiting: list[Correction] = field(default_factory=list)

    def add(self, target: str, correction: Correction) -> None:
        """Take one more reading into account."""
        self.read.append(target)
        self._waiting.append(correction)
        if len(self._waiting) == PORTION:
            self.settle()

    def settle(self) -> None:
        """Whiten those that wait."""
        if self._waiting:
            why = together([one.refused for one in self._waiting])
            nis = together([one.nis for one in self._waiting])
            unmet = (why == Refused.NO_ECHO) | (why == Refused.NO_WALL)
            certain = (why == Refused.NOT) & np.isnan(nis)
            out = np.stack([unmet, ~unmet & (why != Refused.NOT), certain], axis=-1)
            w = whitened_all(self._waiting, len(self.quantities))
            self.w.append(np.where(out.any(axis=-1, keepdims=True), np.nan, w))
            self.left_out = self.left_out + np.count_nonzero(out, axis=-2)
            self._waiting = []


@dataclass
class Innovations:
    """The innovations of a run, or of N side by side, gathered one step at a time."""

    of: dict[str, OfSensor] = field(default_factory=dict)  # by the name of their sensor

    def add(self, step: Step) -> None:
        """Take one more step into account."""
        given, correction = step.entry.given, step.correction
        if correction is not None and isinstance(given, Reading):
            sensor, target = named(given)
            if sensor not in self.of:
                self.of[sensor] = OfSensor(tuple(q.name for q in given.sensor.outputs))
            self.of[sensor].add(target, correction)

    def found(self) -> Found:
        """What they come to."""
        left_out, sensors = np.zeros(3, np.int64), list[Whiteness]()
        for name, one in self.of.items():
            one.settle()
            left_out = left_out + one.left_out
            w = np.concatenate(one.w, axis=-2)
            sensors.append(whiteness(name, one.quantities, one.read, w))
        return Found(tuple(sensors), *np.moveaxis(left_out, -1, 0))


def named(reading: Reading) -> tuple[str, str]:
    """The sensor that a reading is of, and what it read: the same where there is but one thing.

    Of a beam it is the side that it looked to: what is wrong with a way shows ahead and behind with
    opposite signs, and no mean of all beams would show it.
    """
    sensor = reading.sensor
    while isinstance(sensor, Frozen):
        sensor = sensor.sensor
    plain, _, number = reading.name.rpartition(" ")
    if plain and any(map(str.isdigit, number)):
        return plain, reading.name
    bearing = getattr(sensor, "bearing", None)
    if isinstance(bearing, int | float):
        return reading.name, SIDES[round(bearing / (np.pi / 2)) % len(SIDES)]
    return reading.name, reading.name


def together(arrays: list[Any]) -> Any:
    """Numbers of n readings, one behind another : (…, n)"""
    return np.stack(np.broadcast_arrays(*arrays), axis=-1)


def whitened_all(corrections: list[Correction], most: int) -> Array:
    """The whitened innovations of n readings : (…, n, most), nan behind those of fewer numbers."""
    sizes = np.array([one.innovation.shape[-1] for one in corrections])
    axes = np.broadcast_shapes(*(one.innovation.shape[:-1] for one in corrections))
    w = np.full((*axes, len(sizes), max(most, *sizes)), np.nan)
    for k in set(sizes.tolist()):
        alike = [corrections[i] for i in np.flatnonzero(sizes == k)]
        ν = np.stack([np.broadcast_to(one.innovation, (*axes, k)) for one in alike], axis=-2)
        S = np.stack([np.broadcast_to(one.S, (*axes, k, k)) for one in alike], axis=-3)
        w[..., sizes == k, :k] = whitened(ν, S)
    return w[..., :most]


def whitened(ν: Array, S: Array) -> Array:
    """S^(-1/2) ν by the symmetric root, which leaves every number beside its own : (…, k)

    The root is taken of correlations, so that metres and radians do not decide it; nan where S has
    no inverse.
    """
    variance = np.diagonal(S, axis1=-2, axis2=-1)
    σ = np.sqrt(np.where(variance > 0, variance, np.nan))
    C = S / (σ[..., :, None] * σ[..., None, :])
    sound = np.isfinite(C).all(axis=(-2, -1))[..., None]
    λ, V = np.linalg.eigh(np.where(sound[..., None], C, np.eye(S.shape[-1])))
    root = np.sqrt(np.where(sound & (λ > RANK), λ, np.nan))
    w: Array = np.matvec(V, np.vecmat(ν / σ, V) / root)
    return w
