"""What a reading would make of each hypothesis, where it is one thing or another.

Hypotheses and their walls are few in most runs, and many in some: those of all runs stand one after
the other here, m in all, until each is revised.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple, TypeVar

import numpy as np
from numpy.typing import NDArray

from ekfsim.filters import kalman
from ekfsim.filters.belief import Correction, Gaussian, Mixture
from ekfsim.geometry import Array, Integers
from ekfsim.models.protocols import Alternatives, Parting, Sensor

T = TypeVar("T", bound=np.generic)


class Answers(NamedTuple):
    """What a reading would make of each hypothesis and each of its walls, c in all."""

    posterior: Gaussian  # (…, c, n), (…, c, n, n)
    correction: Correction
    weights: Array  # (…, c), their sum is 1
    walls: Integers  # (…, c)
    parents: Integers  # (…, c) which hypothesis each comes of
    log: Array  # (…) of the density that the mixture has for the reading
    parting: bool  # whether the sensor's reading may be of one thing or another


class Lines(NamedTuple):
    """The lines that a sensor may be taken for at m hypotheses of N mixtures."""

    rows: Integers  # (m,) of which mixture each hypothesis is
    places: Integers  # (m,) and which of its hypotheses
    may: Alternatives  # (m, a, …)
    innovation: Array  # (m, a, k)
    parting: bool


def answered(before: Mixture, sensor: Sensor, z: Array, headings: tuple[int, ...]) -> Answers:
    """Every hypothesis revised by every line that the sensor may be taken for there. z : (…, k)"""
    lines, rule = _lines(before, sensor, z), kalman.Rule(None, False, headings)
    if before.weights.shape[-1] == lines.may.share.shape[-1] == 1:
        return _alone(before, lines, z, rule)
    axes, may = before.mean.shape[:-1], lines.may
    N, most, n = math.prod(axes), *before.means.shape[-2:]
    # what none of a belief sees is left out; a hypothesis's own line is not
    which, line = np.nonzero((may.share > 0) | (np.arange(may.share.shape[-1]) == 0))
    rows, places = lines.rows[which], lines.places[which]
    prior = Gaussian(
        before.means.reshape(N, most, n)[rows, places],
        before.covariances.reshape(N, most, n, n)[rows, places],
    )
    reading = kalman.Linearized(
        z.reshape(N, -1)[rows], may.h[which, line], lines.innovation[which, line],
        may.H[which, line], may.R[which, line],
    )  # fmt: skip
    posterior, told = kalman.update(prior, reading, rule)
    put = _Slots.of(rows, axes).put
    weights = before.weights.reshape(N, most)[rows, places]
    log = put(_log_likelihood(told) + _log(weights * may.share[which, line]), -np.inf)
    top = np.max(log, axis=-1, keepdims=True)
    w = np.exp(log - np.where(np.isfinite(top), top, 0.0))
    total = w.sum(axis=-1, keepdims=True)
    as_before = put(np.where(line == 0, weights, 0.0))
    w = np.where(total > 0, w / np.where(total > 0, total, 1.0), as_before)
    return Answers(
        Gaussian(put(posterior.mean), put(posterior.covariance)), _each(told, put), w,
        put(may.wall[which, line], -1), put(places), (_log(total) + top)[..., 0], lines.parting,
    )  # fmt: skip


def _alone(before: Mixture, lines: Lines, z: Array, rule: kalman.Rule) -> Answers:
    """One hypothesis that sees one wall is an EKF."""
    axes = before.mean.shape[:-1]
    h, H, R, ν = (
        part.reshape((*axes, *part.shape[2:])) for part in (*lines.may[:3], lines.innovation)
    )
    reading = kalman.Linearized(z, h, ν, H, R)
    (x, P), told = kalman.update(Gaussian(before.mean, before.covariance), reading, rule)
    return Answers(
        Gaussian(x[..., None, :], P[..., None, :, :]),
        _each(told, lambda part: np.expand_dims(part, len(axes))),
        before.weights,
        lines.may.wall.reshape((*axes, 1)),
        np.zeros((*axes, 1), np.int64),
        _log_likelihood(told),
        lines.parting,
    )


def _lines(before: Mixture, sensor: Sensor, z: Array) -> Lines:
    """What the sensor may be taken for at each hypothesis of some weight."""
    axes, (most, n) = before.mean.shape[:-1], before.means.shape[-2:]
    N, alone = math.prod(axes), most == 1
    rows, places = np.nonzero(before.weights.reshape(N, most) > 0)
    if isinstance(sensor, Parting):
        x = before.mean if alone else before.means.reshape(N, most, n)[rows, places]
        flat = before.covariances.reshape(N, most, n, n)[rows, places]
        may = sensor.alternatives(x, before.covariance if alone else flat)
        if may is not None:
            m, lead = len(rows), x.ndim - 1
            may = Alternatives(*(part.reshape((m, *part.shape[lead:])) for part in may))
            read = z.reshape(N, -1)[rows][:, None, :]
            return Lines(rows, places, may, sensor.residual(read, may.h), True)
    # a sensor may hold something of each run: it is asked of all hypotheses side by side
    h, H, R = sensor.linearize(before.mean if alone else before.means)
    ν = sensor.residual(z if alone else z[..., None, :], h)
    h, H, R, ν = (
        part.reshape((N, most, *part.shape[-axes_of:]))[rows, places, None]
        for part, axes_of in ((h, 1), (H, 2), (R, 2), (ν, 1))
    )
    one = np.ones((len(rows), 1))
    return Lines(rows, places, Alternatives(h, H, R, one, np.full(one.shape, -1)), ν, False)


class _Slots(NamedTuple):
    """Where what is known of m answers stands among those of N mixtures, c of each."""

    rows: Integers  # (m,)
    columns: Integers  # (m,)
    shape: tuple[int, int]  # N, c
    axes: tuple[int, ...]  # of the mixtures, N in all

    @classmethod
    def of(cls, rows: Integers, axes: tuple[int, ...]) -> "_Slots":
        """One after the other, in the order in which they come. rows : (m,), ascending"""
        counts = np.bincount(rows, minlength=math.prod(axes))
        columns = np.arange(len(rows)) - (np.cumsum(counts) - counts)[rows]
        return cls(rows, columns, (len(counts), int(counts.max(initial=1))), axes)

    def put(self, values: NDArray[T], nothing: float = 0.0) -> NDArray[T]:
        """(m, …) → (…, c, …)"""
        N, c = self.shape
        all = np.full((N, c, *values.shape[1:]), nothing, values.dtype)
        all[self.rows, self.columns] = values
        return all.reshape((*self.axes, c, *values.shape[1:]))


def _log_likelihood(correction: Correction) -> Array:
    """log N(ν; 0, S) : (…), −∞ where nothing was predicted or read; 0 where nothing is uncertain

    As a logarithm: an impossible reading must not make all hypotheses equal.
    """
    sign, log_det = np.linalg.slogdet(np.nan_to_num(correction.S))
    k = correction.S.shape[-1]
    log_det = np.where(sign > 0, log_det, 0.0)
    log = -0.5 * (np.nan_to_num(correction.nis) + log_det + k * math.log(2 * math.pi))
    return np.where(np.isnan(correction.innovation).any(axis=-1), -np.inf, log)


def _log(share: Array) -> Array:
    """log share, −∞ of none."""
    return np.where(share > 0, np.log(np.where(share > 0, share, 1.0)), -np.inf)


def picked(correction: Correction, which: Integers) -> Correction:
    """The correction of one hypothesis and wall. which : (…)"""

    def of(numbers: NDArray[T]) -> NDArray[T]:
        index = np.asarray(which).reshape(*which.shape, *(1,) * (numbers.ndim - which.ndim))
        return np.take_along_axis(numbers, index, axis=which.ndim).squeeze(which.ndim)

    return _each(correction, of)


def _each(told: Correction, made: Callable[[NDArray[Any]], NDArray[Any]]) -> Correction:
    """The same of all its arrays."""
    return Correction(
        made(told.predicted), made(told.innovation), made(told.R), made(told.S), made(told.H),
        made(told.K), made(told.nis), made(np.asarray(told.refused)),
    )  # fmt: skip
