"""A study of a recorded log. A recording is one run: each cell is played once by each filter, and
nothing is said of shares of runs.
"""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Self

from ekfsim.diagnostics.summary import Summary
from ekfsim.errors import UsageError
from ekfsim.files.scenes.load_study import Request
from ekfsim.files.scenes.settings import Setting
from ekfsim.localization import play
from ekfsim.study.plan import Case, cases_of


@dataclass(frozen=True)
class Played:
    """What one filter made of the log under the settings of one cell."""

    case: Case
    summary: Summary


@dataclass(frozen=True)
class Recorded:
    """A study of a log, ready to be done."""

    request: Request
    cases: tuple[Case, ...]
    warnings: tuple[str, ...]

    @classmethod
    def of(cls, request: Request) -> Self:
        """What is asked. Raises UsageError or InputError where a cell of it is no sound scene."""
        if request.a or request.b:
            raise UsageError(
                f"{request.name}: puts two settings side by side; a recording has no runs to pair: "
                "sweep the key in `ekfsim study`"
            )
        return cls(request, *cases_of(request))

    @property
    def keys(self) -> tuple[str, ...]:
        """The swept keys."""
        return tuple(values[0].key for values in self.request.sweep)

    @property
    def settings(self) -> tuple[Setting, ...]:
        """What overrules the files, in all cells or in one."""
        return (*self.request.settings, *(values[0] for values in self.request.sweep))

    @property
    def filters(self) -> tuple[str, ...]:
        """The filters that watch, in their order."""
        return tuple(dict.fromkeys(case.scene.filter for case in self.cases))

    def played(self, done: Callable[[], None] = lambda: None) -> list[Played]:
        """What comes of each cell; `done` hears of each."""
        found = list[Played]()
        for case in self.cases:
            summary = Summary.of(case.scene)
            for _ in summary.following(play(case.scene)):
                pass
            found.append(Played(case, summary))
            done()
        return found
