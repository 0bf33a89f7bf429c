"""How honest a filter was at every step of a run, not at its end alone: there it and its smoother
believe the same.
"""

from dataclasses import dataclass

from ekfsim.diagnostics.verdict import LOST
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.records import Step


@dataclass
class Shares:
    """Steps of one run by their NEES, gathered one at a time."""

    judged: int = 0  # whose belief is uncertain of something, or impossible
    above: int = 0  # beyond the median of χ²
    lost: int = 0  # beyond its 99.9 % quantile

    def take(self, step: Step) -> None:
        """Take one more step into account."""
        if step.nees is None or not (step.nees.dof or step.nees.impossible):
            return
        value, dof, impossible = (
            float(step.nees.value), int(step.nees.dof), bool(step.nees.impossible)
        )  # fmt: skip
        self.judged += 1
        self.above += impossible or value > quantile(0.5, dof)
        self.lost += impossible or value > quantile(LOST, dof)
