"""Which views a page holds: all of a lesson; of a long drive some, and those that matter."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

from ekfsim.diagnostics.verdict import LOST
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.belief import Refused
from ekfsim.views.playback.view import View

MOST = 800  # views that are held at even distances
NOTED = 200  # more of them, where something happens


@dataclass
class Holding:
    """Chooses among the views of a run as they come."""

    views: int  # how many the run has
    least: int = 1  # of how many one is held, at least

    @property
    def every(self) -> float:
        """Of how many views one is held."""
        return max(self.least, self.views / MOST)

    def choose(self, views: Iterable[View]) -> Iterator[View]:
        """Every so many views, the first, the last, and where something happens. A beam and what
        it makes of the estimate stay together.
        """
        beam: View | None = None  # waits for its revised estimate
        due, noted, troubled = 0.0, 0, False
        for view in views:
            if view.beam:
                beam = view
                continue
            trouble = any(map(troubles, (view, *view.others)))
            news = trouble and not troubled and noted < NOTED
            troubled = trouble
            if view.number >= due or news or view.judged.closing is not None:
                both = (view,) if beam is None else (beam, view)
                if view.number >= due:
                    due = max(due + self.every * len(both), view.number)
                else:
                    noted += 1
                yield from both
            beam = None


def troubles(view: View) -> bool:
    """Whether a view shows what is worth a look: a run that is lost, a reading that surprises or
    is refused, though there was something to read.
    """
    correction = view.step.correction
    if view.judged.lost_from is not None:
        return True
    if correction is None:
        return False
    surprising = float(correction.nis) > quantile(LOST, len(correction.innovation))
    return surprising or int(correction.refused) in (Refused.GATE, Refused.GUARD)
