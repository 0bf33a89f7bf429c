"""What many runs of a scenario find, in the cells of a table."""

import math

from ekfsim.study.results import Result, Share
from ekfsim.views.study.words import percent, shared

NONE = "–"
HEAD = (
    *("lost", "ΣNIS above / below", "NEES above / below", "inside the ellipse"),
    "NIS per number read",
)
MEANING = """\
Shares are in percent, with the 95 % interval (Wilson) in brackets. Lost: the last NEES lies \
beyond its χ² 99.9 % quantile, or the belief is impossible. ΣNIS: runs whose sum of NIS lies \
above / below its two-sided 95 % band; NEES: runs whose last NEES does. Inside: the true position, \
of the ellipses of 95.4 % that have an area."""


def shares(found: Result) -> tuple[str, ...]:
    """The cells beneath HEAD; a dash where there is nothing to be counted."""
    of, runs, last = found.tally.of, found.tally.runs, found.last
    return (
        shared(last.lost),
        sides(of.nis_above, of.nis_below, runs) if of.nis_runs else NONE,
        sides(of.nees_above, of.nees_below, runs) if last.above_95.of else NONE,
        shared(last.ellipse) if last.ellipse.of else NONE,
        NONE if math.isnan(found.nis.value) else f"{found.nis.value:.3g}",
    )


def sides(above: int, below: int, runs: int) -> str:
    """Two shares of runs, in percent."""
    return " / ".join(percent(Share(n, runs)) for n in (above, below)) + " %"
