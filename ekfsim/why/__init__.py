"""Why a run was lost: one thing put right at a time, and the very same draws played again.

records.py     Change, Tried, Mechanism, Shares, Explanation: what is asked and what was found
explaining.py  explain: the changes tried, the smallest set that cures, and its name
recorded.py    explain_log: what a recorded log tells of its filter
changes/       what can be put right, each alone; suspects: which mechanism each takes away
trying/        a scene with changes → its Steps; one run within a budget, many runs side by side;
               which suspects it was, by both; the smallest set that cures

`ekfsim.why` is this package, which can be called: `ekfsim.why(scene, runs=1000)`.
"""

import sys
from types import ModuleType
from typing import Any

from ekfsim.why.explaining import explain
from ekfsim.why.records import Change, Explanation, Mechanism, Shares, Tried

__all__ = ["Change", "Explanation", "Mechanism", "Shares", "Tried", "explain"]


class Explaining(ModuleType):
    """What the package is, so that it can be called: `ekfsim.why` means one thing, whatever is
    imported first.
    """

    def __call__(self, scene: Any, runs: int = 1000, budget: int | None = None) -> Explanation:
        """Why the run of a scene was lost: see `ekfsim.views.notebook.reasons.why`."""
        from ekfsim.views.notebook.reasons import why  # the door to what a notebook shows

        return why(scene, runs, budget)


sys.modules[__name__].__class__ = Explaining
