"""N runs at once, sweeps of their numbers, and the machines that they run on: from one run to a
million.

plan.py        what is asked → cases, in blocks   results.py      Tally → numbers with uncertainty
block.py       1024 runs → a Tally                verdict.py      what they say of a filter
counting.py    the runs at one step → counts      expectation.py  what a scene promises
tally.py       records that add                   tables.py       CSV
comparison.py  two settings side by side, by      running/        engines, clusters, the journal
pairs.py       differences of pairs of runs       code.py         that of filters of one's own
recorded.py    one run that was recorded, in each cell

`ekfsim.study` is this package, which can be called: `ekfsim.study(scene, runs=1000)`.
"""

import sys
from types import ModuleType
from typing import Any


class Studying(ModuleType):
    """What the package is, so that it can be called: `ekfsim.study` means one thing, whatever is
    imported first.
    """

    def __call__(
        self,
        scene: Any,
        runs: int = 10_000,
        sweep: Any = None,
        filters: Any = None,
        seed: int | None = None,
        workers: int = 1,
        fast: bool = False,
    ) -> Any:
        """Run a scene many times: see `ekfsim.views.notebook.studies.study`."""
        from ekfsim.views.notebook.studies import study  # the door to what a notebook shows

        return study(scene, runs, sweep, filters, seed, workers, fast)


sys.modules[__name__].__class__ = Studying
