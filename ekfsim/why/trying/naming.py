"""Which suspects it was: by what many runs say of those that cure this one."""

from collections.abc import Sequence

from ekfsim.why.changes.suspects import Suspect
from ekfsim.why.records import Shares, together
from ekfsim.why.trying.crowd import Crowd
from ekfsim.why.trying.minimal import SpentError
from ekfsim.why.trying.trials import Trials

MUCH = 0.5  # a change that takes away less of what is lost names no cause
NEARLY = 0.1  # two that differ by less are alike: the one that explains more is named
OFTEN = 0.03  # a share of bad runs below which a few runs tell nothing
ALL_BUT = 0.2  # where all changes together take away so much more, there is more than one cause


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
    best = max((taken_away(shares) for _, shares in found), default=0.0)
    if best < 1 - ALL_BUT:
        several, shares = _several(quick, trials, crowd)
        if shares is not None and taken_away(shares) > best + ALL_BUT:
            return several, shares
    if best >= MUCH:
        return next(
            ((one,), shares) for one, shares in found if taken_away(shares) >= best - NEARLY
        )
    if crowd.bad().mean() < OFTEN:
        return (), None
    for one in suspects:
        if one.slow and cured(one, trials):
            shares = few.shares(one.in_many)
            if taken_away(shares) >= MUCH:
                return (one,), shares
    return (), None


def cured(suspect: Suspect, trials: Trials) -> bool:
    """Whether a suspect's change cures the run, or a part of it does."""
    try:
        # single readings are tried side by side, and do not tell of a class
        ways = (one for one in (suspect.change, *suspect.members) if one.kind != "reading")
        alone = [trials.alone(one) for one in dict.fromkeys(ways)]
    except SpentError:
        return False
    return any(alone)


def _several(
    suspects: Sequence[Suspect], trials: Trials, crowd: Crowd
) -> tuple[tuple[Suspect, ...], Shares | None]:
    """The fewest suspects that take away as much as all together, if all together cure."""
    kept = tuple(suspects)
    try:
        if len(kept) < 2 or not trials.together([one.change for one in kept]):
            return (), None
    except SpentError:
        return (), None

    def shares(some: Sequence[Suspect]) -> Shares:
        changes = tuple(one.in_many for one in some)
        return crowd.shares(together(NAME, changes), changes)

    most = taken_away(shares(kept))
    for one in reversed(suspects):
        rest = tuple(other for other in kept if other is not one)
        if rest and taken_away(shares(rest)) >= most - NEARLY:
            kept = rest
    return kept, shares(kept)


NAME = "all of these together"
