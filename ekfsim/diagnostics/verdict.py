"""What one run says of its filter: lost or not, and ΣNIS against its band.

Of many runs more can be said: `ekfsim.study.verdict`.
"""

import math
from dataclasses import dataclass, field
from enum import Enum

from ekfsim.diagnostics.shutting_out import Trusts
from ekfsim.filters.arithmetic.chi_square import band, quantile
from ekfsim.filters.belief import Refused
from ekfsim.records import Nees, Step

LOST = 0.999  # NEES beyond this χ² quantile: lost
BAND = 0.99  # the two-sided band that ΣNIS is held against
# a single NIS or NEES beyond this χ² quantile is called so; below no quantile is it surprising
SURPRISING = 0.99


def lost(measured: Nees) -> bool:
    """Whether one run's NEES lies beyond its χ² 99.9 % quantile, or its belief is impossible."""
    return bool(measured.impossible) or float(measured.value) > quantile(LOST, int(measured.dof))


FIRST = 10  # readings by which a start is judged
FAR = 20.0  # NIS per number read of these, beyond which no noise is likely to be the cause
SETTLED = 3.0  # times the NIS of all later ones: a filter that found its way since


class Verdict(Enum):
    """What can be said of one run. The value is the word; `Evidence.sentence` gives its reason."""

    LOST = "lost"
    OVER_CONFIDENT = "over-confident"
    OVER_CAUTIOUS = "over-cautious"
    CONSISTENT = "consistent"
    NO_EVIDENCE = "no evidence"


@dataclass
class Evidence:
    """What the steps of one run say for and against its filter, gathered one at a time."""

    nis_sum: float = 0.0
    nis_dof: int = 0  # of the readings that had a NIS together, refused ones included
    lost_from: int | None = None  # index of the step from which on the run is lost without a gap
    last_nees: Nees | None = None
    nis_refused: int = 0  # how many readings of the sum were refused
    nis_readings: int = 0  # how many readings it sums
    # index of the reading since which the sum lies outside its band without a gap
    nis_outside_from: int | None = None
    used_sum: float = 0.0  # the same sum without the readings that were refused
    used_dof: int = 0
    # of the first few readings: the same sum, and how many the gate refused
    first_sum: float = 0.0
    first_dof: int = 0
    first_refused: int = 0
    trusts: Trusts = field(default_factory=Trusts)  # of a filter that weighs its readings

    def add(self, step: Step) -> None:
        """Take one more step into account."""
        correction = step.correction
        self.trusts.add(step)
        if correction is not None and not math.isnan(nis := float(correction.nis)):
            self.nis_sum += nis
            self.nis_dof += correction.innovation.shape[-1]
            self.nis_readings += 1
            if self.nis_readings <= FIRST:
                self.first_sum, self.first_dof = self.nis_sum, self.nis_dof
                self.first_refused += int(correction.refused) == Refused.GATE
            if int(correction.refused) != Refused.NOT:
                self.nis_refused += 1
            else:
                self.used_sum += nis
                self.used_dof += correction.innovation.shape[-1]
            low, high = self.nis_band
            if low <= self.nis_sum <= high:
                self.nis_outside_from = None
            elif self.nis_outside_from is None:
                self.nis_outside_from = step.entry.index
        if step.nees is not None:
            self.last_nees = step.nees
            if not lost(step.nees):
                self.lost_from = None
            elif self.lost_from is None:
                self.lost_from = step.entry.index

    @property
    def nis_band(self) -> tuple[float, float]:
        """The two-sided 99 % band of χ² for ΣNIS."""
        return band(BAND, self.nis_dof)

    @property
    def doubts_start(self) -> bool:
        """Whether the first readings speak against the start rather than against the noises: nearly
        all of them were refused, or they are far off and later ones are not.
        """
        few, later = min(self.nis_readings, FIRST), self.nis_dof - self.first_dof
        if few < FIRST / 2 or self.first_sum < FAR * self.first_dof:
            return False
        rest = (self.nis_sum - self.first_sum) / later if later else 0.0
        refused = self.first_refused >= 0.9 * few
        return refused or self.first_sum > SETTLED * rest * self.first_dof

    @property
    def verdict(self) -> Verdict:
        """Lost, else by ΣNIS against its band. NEES over time is correlated and never summed into a
        verdict.
        """
        low, high = self.nis_band
        if self.lost_from is not None:
            return Verdict.LOST
        if self.nis_dof == 0:
            return Verdict.NO_EVIDENCE
        if self.nis_sum > high:
            return Verdict.OVER_CONFIDENT
        return Verdict.OVER_CAUTIOUS if self.nis_sum < low else Verdict.CONSISTENT
