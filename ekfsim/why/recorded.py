"""explain_log: what a recorded log tells of its filter, where nobody can play its draws again.

Guesses are tried in place of what is known of a simulation: other noises, biases, scales, clocks,
each with the value that fits best. A guess cures where ΣNIS comes into its band, or where a truth
is known and the run is lost no more. Of several that cure the one is named under which the readings
are by far the likeliest; where two are nearly as likely, none is.
"""

import contextlib
import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

from ekfsim.scene import Scene
from ekfsim.why.changes.driven import NO_GATE
from ekfsim.why.changes.groups import groups_of
from ekfsim.why.changes.guesses import Family, families, outliers, surprises
from ekfsim.why.changes.recorded import start_at_truth, unsure
from ekfsim.why.records import Change, Explanation, Heard, Mechanism
from ekfsim.why.trying.log_naming import named_of_log
from ekfsim.why.trying.log_trials import Guess, LogTrials, plain
from ekfsim.why.trying.minimal import SpentError
from ekfsim.why.trying.replaying import replayed

ROBUST = "huber"  # a filter that few bad readings do not lead astray
BETWEEN = 4  # values that are tried in the second round, beside the one that would fit
LIKELY = 4  # families of which still better values are sought
BEYOND = (1.4, 2.0, 3.0)  # times the outermost value, where that fits best


def explain_log(scene: Scene, budget: int, heard: Heard | None = None) -> Explanation:
    """Why the filter of a recorded log ended as it did, as far as the log tells."""
    steps = tuple(replayed(scene, ()))
    log = LogTrials(scene, steps, budget, heard)
    if log.was in ("consistent", "recorded"):
        return Explanation(scene, log.was, None, budget=budget, lost_steps=steps)
    mechanisms: tuple[Mechanism, ...] = ()
    cure: tuple[Change, ...] = ()
    stopped = False
    try:
        with contextlib.suppress(SpentError):
            _try_all(log)
        mechanisms, cure = named_of_log(log)
    except KeyboardInterrupt:
        stopped = True
        cure = tuple(one.tried.change for one in log.guesses if one.tried.cures)[:1]
    cured_steps = tuple(replayed(scene, cure)) if cure else ()
    tried = tuple(one.tried for one in log.guesses)
    return Explanation(
        scene, log.was, log.lost_from, tried, cure,
        tuple(one.change for one in tried if one.cures and one.change not in cure),
        None, mechanisms[0] if len(mechanisms) == 1 else None,
        mechanisms if len(mechanisms) > 1 else (), log.replays, budget, None, steps, cured_steps,
        stopped,
    )  # fmt: skip


def _try_all(log: LogTrials) -> None:
    """Groups left out, starts, and every family with its values, then with better ones."""
    scene, steps = log.scene, log.steps
    log.beside(*plain([group.change for group in groups_of(steps, None)]))
    for change in _starts(log):
        log.alone(change)
    robust = tuple(replayed(replace(scene, filter=ROBUST, gate=None), ()))
    log.surprising = surprises(robust)
    if (few := outliers(robust)) is not None:
        log.beside(*plain([few]))
    if scene.gate is not None:
        log.alone(NO_GATE)
    every = families(steps, scene.world.told_robot)
    _try_values(log, [(one, value) for one in every for value in one.values])
    for many in (len(every), LIKELY):
        # the likeliest first, should the budget not do for all
        some = sorted(every, key=lambda one: -_best(log, one))[:many]
        _try_values(log, [(one, value) for one in some for value in finer(one, _of(log, one))])


def _try_values(log: LogTrials, values: Sequence[tuple[Family, float]]) -> None:
    """Families each with a value: side by side what can be."""
    beside = [one for one in values if one[0].beside]
    log.beside([family.make(value) for family, value in beside], beside)
    for family, value in values:
        if not family.beside:
            log.alone(family.make(value), family, value)


def _of(log: LogTrials, family: Family) -> list[Guess]:
    return [one for one in log.guesses if one.family is family]


def _best(log: LogTrials, family: Family) -> float:
    """How likely the readings are under the best value of a family."""
    return max(map(_likelihood, _of(log, family)), default=-math.inf)


def _likelihood(guess: Guess) -> float:
    return guess.likelihood if math.isfinite(guess.likelihood) else -math.inf


def _starts(log: LogTrials) -> Iterator[Change]:
    """The start, by the truth where the log knows it, and a start that is less sure."""
    known = log.scene.log is not None and log.scene.log.start_known
    if known and (truth := log.entries[0].truth) is not None:
        yield start_at_truth(truth)
    yield unsure()


def finer(family: Family, tried: Sequence[Guess]) -> list[float]:
    """Values between those under which the readings are likeliest, and the one at which ΣNIS
    would be what it should be.
    """
    known = sorted(
        (one for one in tried if math.isfinite(one.likelihood)), key=lambda one: one.value
    )
    if not known:
        return []
    best = max(range(len(known)), key=lambda i: known[i].likelihood)
    around = known[max(best - 1, 0) : best + 2]
    low, high = around[0].value, around[-1].value
    parts = [i / (BETWEEN + 1) for i in range(1, BETWEEN + 1)]
    if family.by_factor:
        values = [low * (high / low) ** part for part in parts] if low * high > 0 else []
    else:
        values = [low + (high - low) * part for part in parts]
    if family.beyond and best in (0, len(known) - 1):  # what fits best may lie beyond
        edge = known[best].value
        shrinks = family.by_factor and edge < 1
        values += [edge / factor if shrinks else edge * factor for factor in BEYOND]
    return [*values, *fitting(known)] if family.by_factor else values


def fitting(known: Sequence[Guess]) -> Iterator[float]:
    """Where NIS per number would be 1, between two values of which one gives more and one less."""
    for one, other in itertools.pairwise(known):
        if (one.mean_nis - 1) * (other.mean_nis - 1) < 0 and one.value * other.value > 0:
            a, b = math.log(one.mean_nis), math.log(other.mean_nis)
            yield one.value * (other.value / one.value) ** (a / (a - b))
