"""explain: what was wrong with one run, by what cures it."""

from collections.abc import Callable

from ekfsim.scene import Scene
from ekfsim.why.changes import changes_of
from ekfsim.why.records import Explanation, Tried
from ekfsim.why.replaying import cures, ending, replayed

BUDGET = 400  # replays of one run


def explain(
    scene: Scene,
    runs: int = 1000,
    budget: int = BUDGET,
    heard: Callable[[int, int], None] | None = None,
) -> Explanation:
    """Why the scene's run ended as it did.

    runs : how many stand behind the shares; budget : how many times one run is played again at
    most; heard : is told how many of these are done, and the budget
    """
    as_it_stands = tuple(replayed(scene, ()))
    was = ending(as_it_stands)
    if was.outcome == "consistent":
        return Explanation(scene, was.outcome, None, lost_steps=as_it_stands, budget=budget)
    tried = []
    for change in changes_of(scene):
        now = ending(replayed(scene, (change,)))
        tried.append(Tried(change, cures(was, now), now.nees, now.lost_from, now.outcome))
        if heard is not None:
            heard(len(tried), budget)
    curing = [one.change for one in tried if one.cures]
    cured = tuple(replayed(scene, curing[:1])) if curing else ()
    return Explanation(
        scene,
        was.outcome,
        was.lost_from,
        tuple(tried),
        tuple(curing[:1]),
        tuple(curing[1:]),
        replays=len(tried),
        budget=budget,
        lost_steps=as_it_stands,
        cured_steps=cured,
    )
