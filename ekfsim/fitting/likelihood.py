"""How likely the innovations of a log are under what its filter is told (Bar-Shalom, Li &
Kirubarajan, Estimation with Applications to Tracking and Navigation, 2001, section 5.4).
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache

import numpy as np

from ekfsim.filters.belief import Correction, Refused
from ekfsim.fitting import abreast
from ekfsim.fitting.noises import Retold
from ekfsim.geometry import Array, Integers
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
                if c is not None and int(c.refused) == Refused.NOT:
                    total += float(self._of(c))
        except (ArithmeticError, np.linalg.LinAlgError):
            return IMPOSSIBLE
        return total if np.isfinite(total) else IMPOSSIBLE

    def of_all(self, retold: Retold, values: Array, until: int) -> Array:
        """Of the first `until` entries of a log, under each of N sets of numbers : (N, n) → (N)"""
        if abreast.possible(retold.scene):
            try:
                return self.of_runs(abreast.side_by_side(retold, values, until), len(values))
            except (ArithmeticError, np.linalg.LinAlgError):
                pass  # one of them: which, each for itself tells
        return np.array([self.of(retold.with_(row.tolist(), until)) for row in values])

    def of_runs(self, scene: Scene, runs: int) -> Array:
        """Of a log that is given to N runs side by side : (N)"""
        total = np.zeros(runs)
        for step in self.steps(scene, np.arange(runs)):
            c = step.correction
            if c is not None:
                total += np.where(c.refused == Refused.NOT, self._of(c), 0.0)
        return np.where(np.isfinite(total), total, IMPOSSIBLE)

    def refused(
        self, gate: float, retold: Retold, values: Sequence[float], until: int
    ) -> frozenset[int]:
        """The indices of the entries that a gate refuses under a set of numbers."""
        return refused_by(gate, retold.with_(values, until))

    def _of(self, c: Correction) -> Array:
        """½ (νᵀ S⁻¹ ν + ln det S) : (…), 0 of a reading of which the filter was certain"""
        with np.errstate(invalid="ignore"):  # S is nan where nothing is predicted
            _, ln_det = np.linalg.slogdet(c.S)
        whole = c.nis / truncation(self.gate, c.innovation.shape[-1]) + ln_det
        return np.where(np.isnan(c.nis), 0.0, whole) / 2

    def steps(self, scene: Scene, runs: Integers | None = None) -> Iterator[Step]:
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
        return play(replace(scene, log=replace(scene.log, entries=entries), gate=None), runs)


@cache
def truncation(gate: float | None, numbers: int) -> float:
    """The mean of NIS per number of what lies below a gate, where all is right: 1 without one.

    >>> round(truncation(0.99, 1), 3), truncation(None, 2)
    (0.925, 1.0)
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
