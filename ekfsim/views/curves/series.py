"""The numbers of one filter's run over its steps, gathered one step at a time."""

import math
from array import array
from collections.abc import Iterable
from dataclasses import dataclass, field
from typing import Self

import numpy as np

from ekfsim.diagnostics import innovations as whitening
from ekfsim.diagnostics.verdict import Evidence
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.belief import Correction, Refused
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.geometry.angles import wrap
from ekfsim.models.protocols import Quantity
from ekfsim.records import Reading, Step, called
from ekfsim.views.curves.events import Event, events

NONE = -1  # in `refused`: nothing was read at this step
# index, t, e (3), σ (3), NEES (3: value, dof, impossible), NIS (3: value, dof, refused)
COLUMNS = 14
BOUNDS = 0.95, 0.99, 0.999  # χ² quantiles that are drawn: usual, SURPRISING, LOST


class Innovations:
    """The innovations of one quantity that is read, and their standard deviations."""

    def __init__(self) -> None:
        self._rows, self._ν, self._σ = array("q"), array("d"), array("d")

    def append(self, row: int, ν: float, variance: float) -> None:
        """One more, of the series' row; nan where it is undefined."""
        self._rows.append(row)
        self._ν.append(ν)
        self._σ.append(math.sqrt(variance) if variance >= 0 else math.nan)

    @property
    def rows(self) -> Integers:
        """(k,) the rows of the series at which it was read"""
        return np.array(self._rows)

    @property
    def ν(self) -> Array:
        """(k,) in the unit of the quantity"""
        return np.array(self._ν)

    @property
    def σ(self) -> Array:
        """√S of each : (k,)"""
        return np.array(self._σ)


class Learnt:
    """What a filter has learnt of the noise of one kind of reading."""

    def __init__(self) -> None:
        self._rows, self._factors = array("q"), array("d")

    def append(self, row: int, factor: float) -> None:
        """After one more reading, of the series' row."""
        self._rows.append(row)
        self._factors.append(factor)

    @property
    def rows(self) -> Integers:
        """(k,) the rows of the series at which it was read"""
        return np.array(self._rows)

    @property
    def ratio(self) -> Array:
        """How many times the told σ it is taken for since : (k,)"""
        ratio: Array = np.sqrt(np.array(self._factors))
        return ratio


@dataclass
class Series:
    """The curves of one filter, a row a step; the first is the start.

    Errors and their σ are those of the pose after the step, whatever else the state holds.
    A number that is undefined is nan, so that a line breaks there.
    """

    name: str = ""  # of the filter, as people call it
    labels: list[str] = field(default_factory=list)  # what each step is: "step 7 (sense 90°)"
    events: list[Event] = field(default_factory=list)
    # of each quantity that was read, in the order of their first readings
    innovations: dict[Quantity, Innovations] = field(default_factory=dict)
    # of a filter that learns its sensors' noises, by what is read
    learnt: dict[tuple[Quantity, ...], Learnt] = field(default_factory=dict)
    evidence: Evidence = field(default_factory=Evidence)  # holds the verdict and `lost_from`
    whitened: whitening.Innovations = field(default_factory=whitening.Innovations)
    _rows: "array[float]" = field(default_factory=lambda: array("d"))  # COLUMNS of each step

    @classmethod
    def of(cls, steps: Iterable[Step], name: str = "") -> Self:
        """The series of a whole run."""
        series = cls(name)
        for step in steps:
            series.take(step)
        return series

    def __len__(self) -> int:
        return len(self._rows) // COLUMNS

    def take(self, step: Step) -> None:
        """Take one more step; the first is the start."""
        entry, row = step.entry, len(self)
        self.labels.append(called(entry))
        self.events.extend(events(step, row))
        self.evidence.add(step)
        self.whitened.add(step)
        self._rows.extend((entry.index, math.nan if entry.t is None else entry.t))
        self._rows.extend(_error(step))
        P = step.posterior.covariance
        self._rows.extend(math.sqrt(max(float(P[i, i]), 0.0)) for i in step.layout.places)
        self._rows.extend(_nees(step))
        self._rows.extend(_nis(step))
        if isinstance(entry.given, Reading) and step.correction is not None:
            self._innovated(entry.given.sensor.outputs, step.correction, row)

    def _innovated(self, outputs: tuple[Quantity, ...], c: Correction, row: int) -> None:
        variances = np.diagonal(c.S).tolist()
        for quantity, ν, S in zip(outputs, c.innovation.tolist(), variances, strict=True):
            self.innovations.setdefault(quantity, Innovations()).append(row, ν, S)
        if c.noise_factor is not None:
            self.learnt.setdefault(outputs, Learnt()).append(row, float(c.noise_factor))

    def _columns(self, first: int, end: int) -> Array:
        """(N, end − first)"""
        return np.array(self._rows).reshape(-1, COLUMNS)[:, first:end]

    @property
    def index(self) -> Integers:
        """(N,) of the entry, from 0, the start"""
        return self._columns(0, 1)[:, 0].astype(np.int64)

    @property
    def t(self) -> Array:
        """(N,) s since the start, nan where there is no clock"""
        t = self._columns(1, 2)[:, 0]
        return t - t[:1]

    @property
    def clocked(self) -> bool:
        """Whether there is a clock: in drives and recorded logs of robots that have one."""
        return len(self) > 0 and not math.isnan(self._rows[1])

    @property
    def abscissa(self) -> Array:
        """(N,) what curves are drawn over: s where there is a clock, else the steps' indices"""
        return self.t if self.clocked else self._columns(0, 1)[:, 0]

    @property
    def error(self) -> Array:
        """e = estimate − truth of x, y (m) and θ (rad, wrapped) : (N, 3), nan without a truth"""
        return self._columns(2, 5)

    @property
    def sigma(self) -> Array:
        """σ of x, y (m) and θ (rad) : (N, 3)"""
        return self._columns(5, 8)

    @property
    def has_truth(self) -> bool:
        """Whether a truth is known at any step."""
        return not np.isnan(self.error).all()

    @property
    def nees(self) -> Array:
        """(N,) nan where there is no truth, or where the belief is impossible"""
        return self._columns(8, 9)[:, 0]

    @property
    def nees_dof(self) -> Integers:
        """(N,) the rank of P; 0 where there is no truth, too"""
        return self._columns(9, 10)[:, 0].astype(np.int64)

    @property
    def impossible(self) -> Booleans:
        """(N,) the error has a part where P claims certainty"""
        return self._columns(10, 11)[:, 0].astype(np.bool_)

    @property
    def nis(self) -> Array:
        """(N,) of refused readings, too; nan where nothing was read, or nothing is uncertain"""
        return self._columns(11, 12)[:, 0]

    @property
    def nis_dof(self) -> Integers:
        """(N,) how many numbers were read; 0 where nothing was"""
        return self._columns(12, 13)[:, 0].astype(np.int64)

    @property
    def refused(self) -> Integers:
        """(N,) one of `Refused`, `NONE` where nothing was read"""
        return self._columns(13, 14)[:, 0].astype(np.int64)

    @property
    def read(self) -> Booleans:
        """(N,) where a reading was taken, used or not"""
        return np.not_equal(self.refused, NONE)

    @property
    def used(self) -> Booleans:
        """(N,) where a reading was taken and not refused"""
        return np.equal(self.refused, Refused.NOT)

    @property
    def span(self) -> str:
        """How long the run is, in words: "80 steps", "1497 steps, 75 s"."""
        steps = len(self) - 1
        told = f"{steps} step" if steps == 1 else f"{steps} steps"
        return f"{told}, {float(self.t[-1]):.6g} s" if self.clocked else told

    @property
    def lost_from(self) -> int | None:
        """Index of the step since which the run is lost without a gap to its end so far."""
        return self.evidence.lost_from


def _error(step: Step) -> tuple[float, float, float]:
    truth = step.entry.truth
    if truth is None:
        return math.nan, math.nan, math.nan
    mean = step.posterior.mean
    x, y, θ = (float(mean[i]) for i in step.layout.places)
    true_x, true_y, true_θ = truth.tolist()
    return x - true_x, y - true_y, float(wrap(np.asarray(θ - true_θ)))


def _nees(step: Step) -> tuple[float, int, bool]:
    """Its value, its degrees of freedom, and whether the belief is impossible."""
    if step.nees is None:
        return math.nan, 0, False
    return float(step.nees.value), int(step.nees.dof), bool(step.nees.impossible)


def _nis(step: Step) -> tuple[float, int, int]:
    """Its value, its degrees of freedom, and whether and why the reading is refused."""
    c = step.correction
    return (math.nan, 0, NONE) if c is None else (float(c.nis), len(c.innovation), int(c.refused))


def bound(probability: float, dof: Integers) -> Array:
    """The χ² quantile of each number of degrees of freedom, nan for none. dof : (N,) → (N,)"""
    of = np.array([math.nan, *(quantile(probability, n) for n in range(1, 1 + dof.max(initial=0)))])
    return of[dof]
