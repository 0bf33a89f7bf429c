"""By its own bound a few runs in a thousand of an honest filter are beyond it: bad luck."""

from collections.abc import Sequence

from ekfsim.diagnostics.verdict import BAND, LOST, Evidence
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.records import Step
from ekfsim.study.results import Share
from ekfsim.why.records import Outcome, Shares
from ekfsim.why.trying.crowd import Crowd

# of an honest filter's runs, and how many times as many are still so few: beyond the far tail of a
# NEES a filter that makes straight lines has more than χ² says, beyond the band of a sum hardly
BEYOND: dict[Outcome, tuple[float, float]] = {
    "lost": (1 - LOST, 5.0),
    "over-confident": ((1 - BAND) / 2, 2.0),
    "over-cautious": ((1 - BAND) / 2, 2.0),
}
ENOUGH = 500  # runs; of fewer a share that small is not known
UNLIKELY = 1e-5  # what has a smaller probability is no bad luck


def by_chance(steps: Sequence[Step], crowd: Crowd, was: Outcome) -> Shares | None:
    """How few runs end as badly, where this one need be no more than one of these.

    steps : of the run as it stands
    """
    if was not in BEYOND or len(crowd.numbers) < ENOUGH or not _near(steps, was):
        return None
    bound, times = BEYOND[was]
    found = Share(int(crowd.bad().sum()), len(crowd.numbers))
    if found.value > times * bound:
        return None
    return Shares(found.of, found.value, found.value, found.low, found.high, None, was)


def _near(steps: Sequence[Step], was: Outcome) -> bool:
    """Whether a run is beyond its bound by no more than luck brings about."""
    evidence = Evidence()
    for step in steps:
        evidence.add(step)
    nees, total, dof = evidence.last_nees, evidence.nis_sum, evidence.nis_dof
    if was == "lost":
        return (
            nees is not None
            and not nees.impossible
            and float(nees.value) <= quantile(1 - UNLIKELY, int(nees.dof))
        )
    if was == "over-confident":
        return total <= quantile(1 - UNLIKELY, dof)
    return total >= quantile(UNLIKELY, dof)
