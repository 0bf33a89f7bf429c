"""A scene with changes → its Steps, and what they say. The draws are those of the scene."""

import functools
from collections.abc import Iterable, Sequence
from typing import NamedTuple

from ekfsim.diagnostics.verdict import Evidence, Verdict
from ekfsim.geometry import Integers
from ekfsim.localization import belief_of, entries_of, filter_of, localize
from ekfsim.records import Entry, Step
from ekfsim.scene import Scene
from ekfsim.why.records import Change, Outcome

OUTCOMES: dict[Verdict, Outcome] = {
    Verdict.LOST: "lost",
    Verdict.OVER_CONFIDENT: "over-confident",
    Verdict.OVER_CAUTIOUS: "over-cautious",
    Verdict.CONSISTENT: "consistent",
    Verdict.NO_EVIDENCE: "consistent",
}


def changed(scene: Scene, changes: Sequence[Change]) -> Scene:
    """The scene with all of what changes say of it."""
    return functools.reduce(lambda so_far, one: one.of_scene(so_far), changes, scene)


def replayed(
    scene: Scene, changes: Sequence[Change], runs: Integers | None = None
) -> Iterable[Step]:
    """Every Step of the scene's run with changes, or of N runs side by side. runs : (N,)"""
    now = changed(scene, changes)
    entries: Iterable[Entry] = entries_of(now, runs)
    entries = functools.reduce(lambda so_far, one: one.of_entries(so_far), changes, entries)
    belief = belief_of(now, runs)
    return localize(entries, filter_of(now, runs), belief, now.guard, now.world.layout)


class Ending(NamedTuple):
    """What is to be said of one run."""

    outcome: Outcome
    lost_from: int | None
    nees: float


def ending(steps: Iterable[Step]) -> Ending:
    """How a run ended."""
    evidence = Evidence()
    for step in steps:
        evidence.add(step)
    last = evidence.last_nees
    nees = float("nan") if last is None else float(last.value)
    return Ending(OUTCOMES[evidence.verdict], evidence.lost_from, nees)


def cured(was: Outcome, now: Outcome) -> bool:
    """Whether a run that ended badly does so no more: a lost one is lost no more; another is
    consistent.
    """
    return now != "lost" if was == "lost" else now == "consistent"
