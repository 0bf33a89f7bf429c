"""What was wrong with the filter of a recorded log, by the guesses that cure and by how likely the
readings are under each.
"""

import contextlib
import math
from collections import Counter
from collections.abc import Iterator

import numpy as np

from ekfsim.diagnostics.innovations import Innovations
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.why.changes.guesses import readings
from ekfsim.why.changes.recorded import louder_all
from ekfsim.why.records import Change, Mechanism
from ekfsim.why.trying.log_trials import Guess, LogTrials
from ekfsim.why.trying.minimal import SpentError, minimal
from ekfsim.why.trying.replaying import replayed

SURE = 3.0  # of the log of a density: what is likelier by less is as likely
MANY = 4  # guesses that are tried together
OF_ONE = 0.5  # of the readings of a target: where more surprise, it is to blame and not chance
CHANCE = 3.0  # standard deviations of a share
ROUNDS = 3  # until one factor of all noises fits
NOISES_TOO_SMALL = (Mechanism.ODOMETRY_OVERTRUSTED, Mechanism.SENSOR_OVERTRUSTED)
NOISES_TOO_LARGE = (Mechanism.ODOMETRY_DISTRUSTED, Mechanism.SENSOR_DISTRUSTED)


def named_of_log(log: LogTrials) -> tuple[tuple[Mechanism, ...], tuple[Change, ...]]:
    """What it was, and what cures it; no name where none is sure."""
    curing = {one.tried.change.name: one for one in log.guesses if one.tried.cures}
    start = next((c for n, c in curing.items() if c.tried.change.kind in ("start", "sigma")), None)
    likely = max((one.likelihood for one in _likeliest(log, curing=False)), default=-math.inf)
    if start is not None and (
        log.evidence.doubts_start or start.likelihood > max(likely, log.likelihood) + SURE
    ):
        return (Mechanism.WRONG_START,), (start.tried.change,)
    for mechanism, change in _few_readings(log, curing):
        return (mechanism,), (change,)
    best = _likeliest(log, curing=True)
    if best:
        change, likeliest = best[0].tried.change, best[0].mechanism
        sure = len(best) == 1 or best[0].likelihood > best[1].likelihood + SURE
        everywhere = _likeliest(log, curing=False)
        if not sure or likeliest is None or everywhere[0].mechanism is not likeliest:
            return _one_target(log, curing) or ((), (change,))
        noise = likeliest in (*NOISES_TOO_SMALL, *NOISES_TOO_LARGE)
        if not noise or merely_noise(log, change):
            return (likeliest,), (change,)
        return _one_target(log, curing) or ((), (change,))
    if curing:
        return (), (next(iter(curing.values())).tried.change,)
    return _several(log)


def merely_noise(log: LogTrials, change: Change) -> bool:
    """Whether another noise explains all: the innovations are white with it, and no more of them
    are small than should be, as would be so if a few were far too large.
    """
    innovations, small, read = Innovations(), 0, 0
    for step in replayed(log.scene, (change,)):
        innovations.add(step)
        if step.correction is not None and not np.isnan(nis := float(step.correction.nis)):
            small += nis < quantile(0.5, step.correction.innovation.shape[-1])
            read += 1
    many = small > read / 2 + CHANCE * math.sqrt(read) / 2
    return not many and not bool(innovations.found().coloured)


def _few_readings(log: LogTrials, curing: dict[str, Guess]) -> Iterator[tuple[Mechanism, Change]]:
    """One target whose readings surprise mostly, or a few readings of no one target."""
    often = Counter(
        {
            target: len(some)
            for each in readings(log.steps).values()
            for target, some in each.items()
        }
    )
    bad = Counter(log.surprising.values())
    astray = [name for name, n in bad.items() if n > OF_ONE * often[name] and len(often) > 1]
    mine = [curing[f"the {name}"] for name in astray if f"the {name}" in curing]
    if len(mine) == 1:
        yield Mechanism.MISPLACED_LANDMARK, mine[0].tried.change
    few = curing.get("the surprising readings")
    if few is not None and not astray:
        yield Mechanism.OUTLIERS, few.tried.change


def _one_target(
    log: LogTrials, curing: dict[str, Guess]
) -> tuple[tuple[Mechanism, ...], tuple[Change, ...]] | None:
    """The one target of several without which all fits, where a larger noise hides something."""
    targets = [target for each in readings(log.steps).values() for target in each]
    mine = [curing[f"the {name}"] for name in targets if f"the {name}" in curing]
    if len(mine) == 1 and len(targets) > 2:
        return (Mechanism.MISPLACED_LANDMARK,), (mine[0].tried.change,)
    return None


def _likeliest(log: LogTrials, curing: bool) -> list[Guess]:
    """Of each mechanism the guess under which the same readings are likeliest, and likelier than
    as they stand; the likeliest first.
    """
    best: dict[Mechanism, Guess] = {}
    for one in log.guesses:
        mechanism = one.mechanism
        if mechanism is None or one.dof != log.dof or (curing and not one.tried.cures):
            continue
        if one.likelihood < log.likelihood + SURE:
            continue
        if mechanism not in best or one.likelihood > best[mechanism].likelihood:
            best[mechanism] = one
    return sorted(best.values(), key=lambda one: -one.likelihood)


def _all_noises(
    log: LogTrials,
) -> tuple[tuple[Mechanism, ...], tuple[Change, ...]] | None:
    """Every told noise by the one factor that makes ΣNIS what it should be, where that cures."""
    if log.lost_from is not None or not log.evidence.nis_dof:
        return None
    factor = math.sqrt(log.evidence.nis_sum / log.evidence.nis_dof)
    with contextlib.suppress(SpentError):
        for _ in range(ROUNDS):  # the first belief is as sure as before
            everything = louder_all(factor)
            one = log.alone(everything)
            if one.tried.cures:
                others = _likeliest(log, curing=False)
                if others and others[0].likelihood > one.likelihood + SURE:
                    return None
                if factor < 1:  # nothing but noises told too large makes innovations too small
                    return NOISES_TOO_LARGE, (everything,)
                return (NOISES_TOO_SMALL if merely_noise(log, everything) else ()), (everything,)
            factor *= math.sqrt(one.mean_nis)
    return None


def _several(log: LogTrials) -> tuple[tuple[Mechanism, ...], tuple[Change, ...]]:
    """The fewest of the likeliest guesses that cure together."""
    some = [one for one in _likeliest(log, curing=False) if one.family and one.family.beside]
    if (found := _all_noises(log)) is not None:
        return found
    some = some[:MANY]
    changes = tuple(one.tried.change for one in some)
    try:
        if len(changes) < 2 or not log.cures(changes):
            return (), ()
    except SpentError:
        return (), ()
    kept = minimal(changes, log.cures)
    names = tuple(one.mechanism for one in some if one.tried.change in kept and one.mechanism)
    return tuple(dict.fromkeys(names)), kept
