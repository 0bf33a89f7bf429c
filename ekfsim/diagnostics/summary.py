"""The closing summary of a run: errors, NIS, what dead reckoning alone would have done, and the
verdict.
"""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from typing import Any, Self

from ekfsim.diagnostics.innovations import Innovations
from ekfsim.diagnostics.shutting_out import ShutOut, Weighing
from ekfsim.diagnostics.verdict import Evidence
from ekfsim.filters.belief import Refused
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.geometry.outline import path_error
from ekfsim.models.layout import POSE, Layout
from ekfsim.records import Control, Entry, Step
from ekfsim.scene import Scene
from ekfsim.shown import Shown
from ekfsim.twins import twinned


@dataclass
class Errors:
    """Mean, spread and worst of a stream of errors, kept without keeping them."""

    _n: int = 0
    _total: float = 0.0
    _squares: float = 0.0
    _largest: float = 0.0
    # not yet in the sums: a later error of the same instant takes its place
    _last: float | None = None
    _instant: float | None = None

    def add(self, e: float, t: float | None = None) -> None:
        """Take one more error into account; it may be negative. Of each instant t (s) only the last
        one counts.
        """
        if self._last is not None and (t is None or t != self._instant):
            self._n, self._total, self._squares = (
                self._n + 1,
                self._total + self._last,
                self._squares + self._last**2,
            )
            self._largest = max(self._largest, abs(self._last))
        self._last, self._instant = e, t

    @property
    def n(self) -> int:
        """How many there were."""
        return self._n + (self._last is not None)

    @property
    def largest(self) -> float:
        """The largest |e|."""
        return max(self._largest, abs(self._last or 0.0))

    @property
    def rmse(self) -> float | None:
        """√(mean e²), None where no truth was known, or the estimate was no number."""
        mean_square = (self._squares + (self._last or 0.0) ** 2) / self.n if self.n else math.nan
        return math.sqrt(mean_square) if math.isfinite(mean_square) else None

    def table(self) -> dict[str, float | None]:
        """rmse, mean, sd (of the errors around their mean) and the largest |e|."""
        rmse = self.rmse
        if rmse is None:
            return dict.fromkeys(("rmse", "mean", "sd", "max"))
        mean = (self._total + (self._last or 0.0)) / self.n
        return {
            "rmse": rmse,
            "mean": mean,
            "sd": math.sqrt(max(rmse**2 - mean**2, 0.0)),
            "max": self.largest,
        }


@dataclass
class Instants:
    """The instants of a run at which errors are counted: asked of one entry after another.

    Without a clock, in the classroom, every entry that gives the filter something is an instant of
    its own.
    """

    _judged: float | None = None  # s, the last of them

    def hold(self, entry: Entry) -> bool:
        """Whether an entry is one of them, or more of one."""
        if entry.t is None:
            return entry.given is not None and entry.judged
        if entry.judged:
            self._judged = entry.t
        return entry.t == self._judged


@dataclass(repr=False)
class Summary(Shown):
    """What is left of a run when it is over, gathered one step at a time.

    Errors are taken at every instant (`Instants`), after its last reading: position as a distance
    in m, heading in rad with its sign. Dead reckoning starts at the first estimate and follows the
    motion inputs alone.
    """

    layout: Layout = POSE
    expected_path: Array | None = None  # (n, 2) m, the outline that was to be driven
    start_known: bool = True  # False of a log whose truth does not tell where it begins
    weighing: Weighing | None = None  # of a filter that weighs its readings
    steps: int = 0
    inputs: int = 0
    updates: int = 0
    refused: dict[Refused, int] = field(default_factory=dict)
    position: Errors = field(default_factory=Errors)
    heading: Errors = field(default_factory=Errors)
    path: Errors = field(default_factory=Errors)
    reckoned_position: Errors = field(default_factory=Errors)
    reckoned_heading: Errors = field(default_factory=Errors)
    evidence: Evidence = field(default_factory=Evidence)
    innovations: Innovations = field(default_factory=Innovations)
    first_t: float | None = None  # s, of the start
    last_t: float | None = None
    _reckoned: Array | None = None  # (n,), the whole state
    _instants: Instants = field(default_factory=Instants)

    def __repr__(self) -> str:
        done = f"{self.steps} steps, {self.updates} of {self.readings} readings used"
        since = self.evidence.lost_from
        lost = "" if since is None else f" from step {since} on"
        return f"Summary({done}: {self.evidence.verdict.value}{lost})"

    @classmethod
    def of(cls, scene: Scene) -> Self:
        """An empty summary for a run of this scene."""
        known = scene.log is None or scene.log.start_known
        return cls(scene.world.layout, scene.world.expected_path, known, Weighing.of(scene))

    @property
    def shut_out(self) -> ShutOut | None:
        """Whether its filter believes its readings no more; None where it does, or weighs none."""
        return self.evidence.trusts.shut_out(self.weighing)

    @property
    def readings(self) -> int:
        """How many there were, used or not."""
        return self.updates + sum(self.refused.values())

    @property
    def duration(self) -> float | None:
        """From the start to the last instant, in s; None where there is no clock."""
        return None if self.first_t is None or self.last_t is None else self.last_t - self.first_t

    def add(self, step: Step) -> None:
        """Take one more step into account; the first is the start."""
        entry = step.entry
        self.evidence.add(step)
        self.innovations.add(step)
        self.last_t = entry.t
        if self._reckoned is None:
            self._reckoned, self.first_t = step.posterior.mean, entry.t
        else:
            self.steps += 1
        if isinstance(entry.given, Control):
            self.inputs += 1
            self._reckoned = entry.given.motion.f(self._reckoned, entry.given.u)
        if step.correction is not None:
            self._count(Refused(int(step.correction.refused)))
        if self._instants.hold(entry):
            self._measure(
                entry, self.layout.pose(step.posterior.mean), self.layout.pose(self._reckoned)
            )

    @twinned
    def following(self, steps: Iterable[Step]) -> Iterator[Step]:
        """The same steps, each taken into account before it goes on."""
        for step in steps:
            self.add(step)
            yield step

    def _measure(self, entry: Entry, estimated: Array, reckoned: Array) -> None:
        if entry.truth is not None:
            _compare(estimated, entry.truth, entry.t, self.position, self.heading)
            _compare(reckoned, entry.truth, entry.t, self.reckoned_position, self.reckoned_heading)
        if self.expected_path is not None and entry.given is not None:
            self.path.add(float(path_error(estimated[:2], self.expected_path)), entry.t)

    def _count(self, refused: Refused) -> None:
        if refused is Refused.NOT:
            self.updates += 1
        else:
            self.refused[refused] = self.refused.get(refused, 0) + 1

    def table(self) -> dict[str, Any]:
        """As `--summary` writes it: m and rad, None where unknown."""
        evidence, last = self.evidence, self.evidence.last_nees
        low, high = evidence.nis_band if evidence.nis_dof else (None, None)
        return {
            "steps": self.steps,
            "updates": self.updates,
            "refused": sum(self.refused.values()),
            "position": self.position.table(),
            "heading": self.heading.table(),
            "path_rmse": self.path.rmse,
            "nis": {
                "mean": evidence.nis_sum / evidence.nis_dof if evidence.nis_dof else None,
                "sum": evidence.nis_sum,
                "dof": evidence.nis_dof,
                "low": low,
                "high": high,
            },
            "nees": {
                "last": None if last is None or last.impossible else float(last.value),
                "dof": None if last is None else int(last.dof),
            },
            "whiteness": self.innovations.found().table(),
            "lost_from": evidence.lost_from,
            "verdict": evidence.verdict.value,
            "dead_reckoning": {
                "position": self.reckoned_position.rmse,
                "heading": self.reckoned_heading.rmse,
            },
        }


def _compare(pose: Array, truth: Array, t: float | None, position: Errors, heading: Errors) -> None:
    e = pose - truth
    position.add(math.hypot(*e[:2].tolist()), t)
    heading.add(float(wrap(e[2])), t)
