"""Which suspects it was: by what many runs say of those that cure this one."""

from collections.abc import Sequence

from ekfsim.why.changes.suspects import Suspect
from ekfsim.why.records import Shares, together
from ekfsim.why.trying.crowd import Crowd
from ekfsim.why.trying.minimal import SpentError, minimal
from ekfsim.why.trying.trials import Trials

MUCH = 0.5  # of what is lost: less than that, taken away, names no way of reckoning as the cause
SOME = 0.3  # the same of a mistake in what the filter is told or in what happens
NEARLY = 0.1  # two that differ by less are alike: the one that explains more is named
OFTEN = 0.03  # a share of bad runs below which a few runs tell nothing
TOGETHER = "all of these together"


def taken_away(found: Shares) -> float:
    """The share of the bad runs that a change takes away; 0 where that may be chance."""
    return (found.lost - found.lost_with) / found.lost if found.high < 0 else 0.0


def named(
    suspects: Sequence[Suspect], trials: Trials, crowd: Crowd, few: Crowd
) -> tuple[tuple[Suspect, ...], Shares | None]:
    """The suspects that made the run end as it did, mostly one, with what many runs say; none where
    none is sure.

    few : runs for what takes long
    """
    quick = [one for one in suspects if not one.slow]
    curing = [one for one in quick if cured(one, trials)]
    if not len(crowd.numbers):  # this run alone: only where nothing else cures it
        curing += [one for one in suspects if one.slow and cured(one, trials)]
        return (tuple(curing) if len(curing) == 1 else ()), None
    found = [(one, crowd.shares(one.in_many)) for one in curing]
    # what leads the filter's own lines astray is named before them
    mistakes = [(one, shares) for one, shares in found if not one.reckoning]
    reckoning = [(one, shares) for one, shares in found if one.reckoning]
    for some, least in ((mistakes, SOME), (reckoning, MUCH)):
        best = max((taken_away(shares) for _, shares in some), default=0.0)
        if best >= least:
            return next(
                ((one,), shares) for one, shares in some if taken_away(shares) >= best - NEARLY
            )
    several = _several(quick, trials)
    if len(several) > 1:
        changes = tuple(one.in_many for one in several)
        shares = crowd.shares(together(TOGETHER, changes), changes)
        return (several, shares) if taken_away(shares) >= MUCH else ((), None)
    return _last(suspects, trials, crowd, few)


def _last(
    suspects: Sequence[Suspect], trials: Trials, crowd: Crowd, few: Crowd
) -> tuple[tuple[Suspect, ...], Shares | None]:
    """A suspect that takes long to try, where nothing else has much to do with what is lost: what
    makes nothing linear cures of much else, too.
    """
    slow = [one for one in suspects if one.slow and cured(one, trials)]
    if not slow or crowd.bad().mean() < OFTEN:
        return (), None
    rivals = (crowd.shares(one.in_many) for one in suspects if not one.slow)
    if any(taken_away(shares) >= SOME for shares in rivals):
        return (), None
    found = [(one, few.shares(one.in_many)) for one in slow]
    return next(
        (((one,), shares) for one, shares in found if taken_away(shares) >= MUCH), ((), None)
    )


def cured(suspect: Suspect, trials: Trials) -> bool:
    """Whether a suspect's change cures the run, or a part of it does."""
    try:
        # single readings are tried side by side, and do not tell of a class
        ways = (one for one in (suspect.change, *suspect.members) if one.kind != "reading")
        alone = [trials.alone(one) for one in dict.fromkeys(ways)]
    except SpentError:
        return False
    return any(alone)


def _several(suspects: Sequence[Suspect], trials: Trials) -> tuple[Suspect, ...]:
    """The fewest suspects that cure the run together; none where all of them do not. What leads the
    filter's own lines astray is put right before them.
    """

    def cures(some: Sequence[Suspect]) -> bool:
        return bool(some) and trials.together([one.change for one in some])

    mistakes = tuple(one for one in suspects if not one.reckoning)
    reckoning = tuple(one for one in suspects if one.reckoning)
    try:
        if not cures(suspects):
            return ()
        needed = () if cures(mistakes) else minimal(reckoning, lambda some: cures(mistakes + some))
        if cures(needed):
            return needed
        return minimal(mistakes, lambda some: cures(some + needed)) + needed
    except SpentError:
        return ()
