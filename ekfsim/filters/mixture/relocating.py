"""Whether the robot was carried away, and where it may be then: what mhekf does when none of its
hypotheses explains what is read.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ekfsim.filters import kalman
from ekfsim.filters.arithmetic.algebra import wrapped
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.protocols import Motion, Sensor

ODDS = float(np.log(1e-4))  # log odds that a robot is being carried away
SURPRISE = 3.0  # what a single reading adds to them at most
FEWEST, MOST = 3, 10  # readings that a place is sought by
BEST = 48  # places that are tried closely
GRAIN = 0.4  # m, rad: about how far a place may be from the nearest that is tried
STEPS = 5  # of Gauss and Newton's search
CLOSE = 1e-3  # of GRAIN²: what keeps that search from running away along what is not seen


class Moved(NamedTuple):
    """A motion input of the last few."""

    motion: Motion
    value: Array  # u : (…, m)


class Read(NamedTuple):
    """A reading of the last few."""

    sensor: Sensor
    value: Array  # z : (…, k)


Heard = Moved | Read


@dataclass(frozen=True, slots=True)
class Memory:
    """What is remembered lest the robot was carried away. Arrays carry leading axes (…)."""

    heard: tuple[Heard, ...]
    doubt: Array  # (…) log odds that it was, since when the doubt began
    since: Integers  # (…) how many readings that is ago

    @classmethod
    def empty(cls, axes: tuple[int, ...]) -> "Memory":
        """Nothing has happened."""
        return cls((), np.full(axes, ODDS), np.zeros(axes, np.int64))

    def moved(self, motion: Motion, u: Array) -> "Memory":
        """With a motion input, where there is a reading before it."""
        if not self.heard:
            return self
        return Memory((*self.heard, Moved(motion, u)), self.doubt, self.since)

    def read(self, sensor: Sensor, z: Array, surprise: Array, used: Booleans) -> "Memory":
        """With a reading. Its surprise : (…) is log p(z | carried away) − log p(z | the mixture).

        doubt ← max(doubt + surprise, log odds of old): Page, Continuous inspection schemes, 1954.
        A reading that is refused changes no doubt.
        """
        more = np.clip(np.nan_to_num(surprise), -SURPRISE, SURPRISE)
        doubt = np.where(used, np.maximum(self.doubt + more, ODDS), self.doubt)
        since = np.where(doubt > ODDS, np.minimum(self.since + 1, MOST), 0)
        heard = (*self.heard, Read(sensor, z))
        readings = [i for i, one in enumerate(heard) if isinstance(one, Read)]
        return Memory(heard[readings[-MOST] if len(readings) > MOST else 0 :], doubt, since)

    @property
    def lost(self) -> Booleans:
        """(…) where it is more likely than not that the robot was carried away."""
        lost: Booleans = (self.doubt > 0) & (self.since >= FEWEST)
        return lost

    def calmed(self, which: Booleans) -> "Memory":
        """The same without the doubt of some runs."""
        doubt, since = np.where(which, ODDS, self.doubt), np.where(which, 0, self.since)
        return Memory(self.heard, doubt, since)

    def last(self, readings: int, rows: Booleans) -> list[Heard]:
        """What some runs heard from so many readings ago on; values : (r, …)"""
        at = [i for i, one in enumerate(self.heard) if isinstance(one, Read)][-readings]
        return [one._replace(value=one.value[rows]) for one in self.heard[at:]]


class Found(NamedTuple):
    """Where a robot may be. Arrays carry an axis of runs and one of places."""

    means: Array  # (r, c, n)
    covariances: Array  # (r, c, n, n)
    log: Array  # (r, c) how well each explains what was heard


def span(readings: Array) -> float:
    """log p(z | carried away) of a reading that is anything between the extremes of these : (p, k);
    nan where there is none.
    """
    met = readings[~np.isnan(readings).any(axis=-1)]
    if not len(met):
        return float("nan")
    return -float(np.sum(np.log(np.maximum(np.ptp(met, axis=0), 1e-6))))


def sought(heard: list[Heard], places: Array, headings: tuple[int, ...]) -> Found:
    """Places from which all that was heard may have been read, with their ways since then, as each
    is now.

    The best of many by what is read there, sharpened by Gauss and Newton's search of the pose at
    the first reading; then an EKF from there on. places : (p, n)
    """
    runs = len(heard[0].value)
    x, log = places[None], np.zeros((runs, len(places)))
    for one in heard:
        value = one.value[:, None, :]
        if isinstance(one, Read):
            log += _score(one.sensor, x, value)
        else:
            x = one.motion.f(x, np.broadcast_to(value, (runs, len(places), value.shape[-1])))
    best = np.argpartition(-log, BEST, axis=-1)[:, :BEST]
    start = _sharpened(heard, places[best], headings)
    return _followed(heard, start, headings)


def _score(sensor: Sensor, x: Array, z: Array) -> Array:
    """How well readings fit places that are about GRAIN from where they should be : (r, p); what is
    no reading fits all alike.
    """
    h = sensor.h(x)
    ν = sensor.residual(z, h)
    square = np.sum(np.square(ν / GRAIN), axis=-1)
    square = np.where(np.isnan(square), np.inf, square)  # where no wall is met: far off
    return -np.log1p(np.where(np.isnan(z).any(axis=-1), 0.0, square))


def _sharpened(heard: list[Heard], start: Array, headings: tuple[int, ...]) -> Array:
    """x₀ ← x₀ + (Σ JᵀJ w + Λ)⁻¹ Σ Jᵀ ν w, J = H F … F of each reading, w such that an innovation
    beyond GRAIN pulls less : (r, c, n)
    """
    n = start.shape[-1]
    for _ in range(STEPS):
        x, F_so_far = start, np.broadcast_to(np.eye(n), (*start.shape, n))
        A = np.broadcast_to(CLOSE / GRAIN**2 * np.eye(n), F_so_far.shape).copy()
        b = np.zeros_like(start)
        for one in heard:
            value = np.broadcast_to(one.value[:, None, :], (*x.shape[:-1], one.value.shape[-1]))
            if isinstance(one, Read):
                h, H, _ = one.sensor.linearize(x)
                ν = np.nan_to_num(one.sensor.residual(value, h))
                J = H @ F_so_far
                w = 1 / (1 + np.square(ν / GRAIN)) / GRAIN**2
                A += (J.mT * w[..., None, :]) @ J
                b += np.matvec(J.mT, w * ν)
            else:
                F_so_far = one.motion.F(x, value) @ F_so_far
                x = one.motion.f(x, value)
        step = np.linalg.solve(A, b[..., None])[..., 0]
        start = wrapped(start + np.clip(step, -1, 1), headings)
    return start


def _followed(heard: list[Heard], start: Array, headings: tuple[int, ...]) -> Found:
    """The EKF from each start on, unsure of it by GRAIN."""
    n = start.shape[-1]
    x, P = start, np.broadcast_to(GRAIN**2 * np.eye(n), (*start.shape, n))
    log = np.zeros(start.shape[:-1])
    for one in heard:
        value = np.broadcast_to(one.value[:, None, :], (*x.shape[:-1], one.value.shape[-1]))
        if isinstance(one, Read):
            h, H, R = one.sensor.linearize(x)
            ν = one.sensor.residual(value, h)
            reading = kalman.Linearized(value, h, ν, H, R)
            (x, P), told = kalman.update(
                Gaussian(x, P), reading, kalman.Rule(None, False, headings)
            )
            _, log_det = np.linalg.slogdet(np.nan_to_num(told.S) + 1e-12 * np.eye(h.shape[-1]))
            fit = -0.5 * np.minimum(told.nis, 100.0) - 0.5 * log_det
            log += np.where(np.isnan(fit), -50.0, fit)
        else:
            f, F, G, M, Q = one.motion.linearize(x, value)
            x, P = f, kalman.predict(P, F, G, M, Q)
    return Found(x, P, log)
