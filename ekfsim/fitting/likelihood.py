"""How likely the innovations of a log are under what its filter is told (Bar-Shalom, Li &
Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, section 5.4).
"""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from ekfsim.filters.belief import Refused
from ekfsim.localization import play
from ekfsim.records import Reading, Step
from ekfsim.scene import Scene

IMPOSSIBLE = 1e12  # of a filter that fails


@dataclass(frozen=True)
class Likelihood:
    """−ln p of the innovations of a scene's log but for a constant: ½ Σ (νᵀ S⁻¹ ν + ln det S).

    A gate would fool it: numbers so small that nearly all is refused leave a few likely readings.
    So the filter has none here; which readings are left out is fixed beforehand, and where a gate
    of probability p will have left them out, the NIS of the others is divided by what their mean is
    under p.
    """

    out: frozenset[int] = frozenset()  # the indices of the entries that are left out
    gate: float | None = None  # by which they were

    def of(self, scene: Scene) -> float:
        """Of a scene as its filter is told."""
        total = 0.0
        try:
            for step in self.steps(scene):
                c = step.correction
                if c is None or int(c.refused) != Refused.NOT or np.isnan(c.nis):
                    continue
                _, ln_det = np.linalg.slogdet(c.S)
                total += float(c.nis) / truncation(self.gate, c.innovation.shape[-1]) + float(
                    ln_det
                )
        except (ArithmeticError, np.linalg.LinAlgError):
            return IMPOSSIBLE
        return total / 2 if np.isfinite(total) else IMPOSSIBLE

    def steps(self, scene: Scene) -> Iterator[Step]:
        """What its filter makes of the log without those that are left out, and without a gate."""
        assert scene.log is not None
        entries = scene.log.entries
        if self.out:
            entries = tuple(
                replace(entry, given=None)
                if entry.index in self.out and isinstance(entry.given, Reading)
                else entry
                for entry in entries
            )
        return play(replace(scene, log=replace(scene.log, entries=entries), gate=None))


@cache
def truncation(gate: float | None, numbers: int) -> float:
    """The mean of NIS per number of what lies below a gate, where all is right: 1 without one.

    >>> round(truncation(0.99, 1), 3), truncation(None, 2)
    (0.923, 1.0)
    """
    if gate is None:
        return 1.0
    from scipy.stats import chi2

    bound = chi2.ppf(gate, numbers)
    return float(chi2.cdf(bound, numbers + 2) / gate)


def refused_by(gate: float, scene: Scene) -> frozenset[int]:
    """The indices of the entries that a gate refuses."""
    return frozenset(
        step.entry.index
        for step in play(replace(scene, gate=gate))
        if step.correction is not None and int(step.correction.refused) == Refused.GATE
    )
