"""The closing summary of a run: errors, NIS, what dead reckoning alone would have done, and the verdict."""

import math
from dataclasses import dataclass, field
from typing import Any

from ekfsim.consistency import Evidence
from ekfsim.filters.belief import Refused
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap_one
from ekfsim.records import Control, Step


@dataclass
class Errors:
    """Mean, spread and worst of a stream of errors, kept without keeping them."""

    n: int = 0
    total: float = 0.0
    squares: float = 0.0
    largest: float = 0.0

    def add(self, e: float) -> None:
        """Take one more error into account; it may be negative."""
        self.n += 1
        self.total += e
        self.squares += e * e
        self.largest = max(self.largest, abs(e))

    @property
    def rmse(self) -> float | None:
        """√(mean e²), None where no truth was known."""
        return math.sqrt(self.squares / self.n) if self.n else None

    def table(self) -> dict[str, float | None]:
        """rmse, mean, sd (of the errors around their mean) and the largest |e|."""
        if not self.n:
            return dict.fromkeys(("rmse", "mean", "sd", "max"))
        mean = self.total / self.n
        sd = math.sqrt(max(self.squares / self.n - mean**2, 0.0))
        return {"rmse": self.rmse, "mean": mean, "sd": sd, "max": self.largest}


@dataclass
class Summary:
    """What is left of a run when it is over, gathered one step at a time.

    Errors are taken after every step that gave the filter something: position as a distance in m, heading in rad
    with its sign. Dead reckoning starts at the first estimate and follows the odometry alone.
    """

    steps: int = 0
    updates: int = 0
    refused: dict[Refused, int] = field(default_factory=dict)
    position: Errors = field(default_factory=Errors)
    heading: Errors = field(default_factory=Errors)
    reckoned_position: Errors = field(default_factory=Errors)
    reckoned_heading: Errors = field(default_factory=Errors)
    evidence: Evidence = field(default_factory=Evidence)
    _reckoned: Array | None = None

    def add(self, step: Step) -> None:
        """Take one more step into account; the first is the start."""
        self.evidence.add(step)
        if self._reckoned is None:
            self._reckoned = step.posterior.mean
            return
        self.steps += 1
        if isinstance(step.entry.given, Control):
            self._reckoned = step.entry.given.motion.f(self._reckoned, step.entry.given.u)
        if step.correction is not None:
            self._count(Refused(int(step.correction.refused)))
        if step.entry.given is not None and step.entry.truth is not None:
            _measure(step.posterior.mean, step.entry.truth, self.position, self.heading)
            _measure(self._reckoned, step.entry.truth, self.reckoned_position, self.reckoned_heading)

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
            "path_rmse": None,
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
            "lost_from": evidence.lost_from,
            "verdict": evidence.verdict.value,
            "dead_reckoning": {"position": self.reckoned_position.rmse, "heading": self.reckoned_heading.rmse},
        }


def _measure(mean: Array, truth: Array, position: Errors, heading: Errors) -> None:
    ex, ey, eθ = (mean - truth).tolist()
    position.add(math.hypot(ex, ey))
    heading.add(wrap_one(eθ))
