"""The filter around a student's calls: what it is not handed, and what is calculated beside it."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, field, replace
from typing import ClassVar, Self

import numpy as np

from ekfsim.filters import kalman
from ekfsim.filters.arithmetic.algebra import symmetric
from ekfsim.filters.belief import Belief, Correction, Gaussian, Prediction, Refused
from ekfsim.filters.protocol import Beginning
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.protocols import Motion, OfRuns, Sensor
from ekfsim.models.sensors.laser_by_reading import LaserByReading
from ekfsim.records import Control, Reading
from ekfsim.student.asked import Answer, Asked, Caller, Together, one_by_one
from ekfsim.student.fault import FaultError
from ekfsim.student.own.returned import WrongError, judged

Run = tuple[int, ...]  # where it stands in the leading axes: () for one robot, (k,) of many


@dataclass(frozen=True)
class OwnFilter:
    """A filter of two functions or of a class of one's own, which knows one robot at a time.

    Its beliefs are what the calls return, one call for each run. F and G, and ν, S, H, K and NIS
    are calculated here, as an EKF has them at the same prior; by them gate and guard refuse.
    """

    remark: ClassVar[str] = (
        "derivatives, innovation and gain are calculated at its own estimate, not by it; it is "
        "not handed a reading without echo or wall, nor one where nothing is uncertain"
    )
    new_caller: Callable[[], Caller]
    gate: float | None = None
    headings: tuple[int, ...] = (2,)
    runs: Integers | None = None  # (N,) the numbers of runs side by side
    together: Together = one_by_one  # who asks them
    callers: dict[Run, Caller] = field(default_factory=dict)  # one for each run

    @classmethod
    def around(
        cls,
        new_caller: Callable[[], Caller],
        beginning: Beginning,
        together: Together = one_by_one,
    ) -> Self:
        """The filter for a run that begins so."""
        return cls(new_caller, beginning.gate, beginning.headings, beginning.runs, together)

    def predict(self, belief: Belief, motion: Motion, u: Array) -> tuple[Gaussian, Prediction]:
        """What predict returns of x, P and u of each run          u : (…, m)"""
        x, _ = belief
        given = {run: Control(motion, _row(u, run)) for run in np.ndindex(x.shape[:-1])}
        return self._called(belief, given), Prediction(motion.F(x, u), motion.G(x, u))

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """What update returns of x, P and z of each run          z : (…, k)

        A reading that is refused is not handed over, nor one where S = 0, of which nothing can be
        learnt.
        """
        x, P = prior
        told = self._beside(x, P, sensor, z, skip)
        handed = (told.refused == Refused.NOT) & (told.S != 0).any(axis=(-2, -1))
        given = {
            run: Reading(_of_run(sensor, run), _row(z, run))
            for run in np.ndindex(x.shape[:-1])
            if handed[run]
        }
        return self._called(prior, given), told

    def _beside(
        self, x: Array, P: Array, sensor: Sensor, z: Array, skip: Booleans | bool
    ) -> Correction:
        """What an EKF would make of the reading at the same prior."""
        h, H, R = sensor.linearize(x)
        reading = kalman.Linearized(z, h, sensor.residual(z, h), H, R)
        rule = kalman.Rule(self.gate, skip, self.headings)
        _, told = kalman.update(Gaussian(x, symmetric(P)), reading, rule)
        return told

    def _called(self, belief: Belief, given: Mapping[Run, Control | Reading]) -> Gaussian:
        """What each run's call makes of its belief; others keep theirs. Raises FaultError."""
        x, P = belief
        posterior = Gaussian(x.copy(), P.copy())
        calls = [
            (self._caller(run, x[run], P[run]), Asked(x[run], P[run], one, self.headings))
            for run, one in given.items()
        ]
        answers = self.together(calls)
        for run, (caller, asked) in zip(given, calls, strict=True):
            with self._in(run):
                after = believed(asked, next(answers), caller)
            posterior.mean[run], posterior.covariance[run] = after
        return posterior

    def _caller(self, run: Run, x: Array, P: Array) -> Caller:
        """Who answers for a run, which begins where nobody did yet."""
        caller = self.callers.get(run)
        if caller is None:
            caller = self.callers[run] = self.new_caller()
            with self._in(run):
                caller.begin(x, P)
        return caller

    @contextmanager
    def _in(self, run: Run) -> Iterator[None]:
        """What fails here fails in this run."""
        try:
            yield
        except FaultError as fault:
            if self.runs is None or fault.run is not None:
                raise
            raise fault.in_run(int(self.runs[run])) from fault.__cause__


def believed(asked: Asked, theirs: Answer, caller: Caller) -> Gaussian:
    """The belief that an answer is. Raises FaultError where it can be none."""
    try:
        return judged(asked, theirs)
    except WrongError as wrong:
        raise FaultError(caller.place_of(asked.given), str(wrong)) from None


def _row(values: Array, run: tuple[int, ...]) -> Array:
    """Input or reading of one run; one that is the same for all has no axes."""
    return values[run] if values.shape[:-1] else values


def _of_run(sensor: Sensor, run: tuple[int, ...]) -> Sensor:
    """The sensor of one run, where each has its own."""
    if isinstance(sensor, LaserByReading):
        return replace(sensor, z=sensor.z[run])
    return sensor.of_run(run) if isinstance(sensor, OfRuns) else sensor
