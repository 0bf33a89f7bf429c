"""The shortest input at which a filter's numbers differ from a reference's.

One run shows it, on the draws of the scene's own seed: lists are tried length by length, so that
the first that shows it is the shortest of those that were tried.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ekfsim.hunting.changes.lists import Listed, Space
from ekfsim.hunting.search import KEY
from ekfsim.hunting.shrinking import less
from ekfsim.hunting.worlds import without
from ekfsim.scene import Scene
from ekfsim.student.asked import Caller
from ekfsim.student.comparing.found import Found
from ekfsim.student.comparing.found import found as found_in
from ekfsim.student.comparing.sides import caller_of, runs_of
from ekfsim.student.exposing.exposed import exposed
from ekfsim.student.fault import FaultError
from ekfsim.student.mistakes.known import KNOWN
from ekfsim.student.mistakes.mistake import Mistake

MANY = 200  # lists of each length


@dataclass(frozen=True)
class Exposure:
    """An input that exposes a filter, as short and round as it was found."""

    scene: Scene
    looked_at: int  # lists
    found: Found  # what the comparison finds in its run


def exposure(
    scene: Scene, against: str, longest: int, begin: Sequence[Listed],
    heed: Callable[[], None], go_on: Callable[[], bool],
) -> Exposure | None:  # fmt: skip
    """The shortest input at which the scene's filter has other numbers than another, or its code
    fails; None where none of those that were tried shows any.

    begin : lists that are tried when no shorter one shows it; go_on : whether there is time for
    more
    """
    space, caller = Space(scene.world, longest), caller_of(scene)

    def shows(played: Scene, tried: Sequence[Listed]) -> Listed | None:
        for listed in tried:
            heed()
            if not go_on():
                return None
            if differs(replace(played, commands=listed), caller, against):
                return listed
        return None

    looked_at = 0
    for listed in (*by_length(scene, space), *begin):
        if not go_on():
            return None
        looked_at += 1
        if shows(scene, [listed]) is None:
            continue
        barer, shorter = less(scene, space, listed, shows, without)
        played = replace(barer, commands=shorter)
        return Exposure(played, looked_at, found_in(runs_of(played, caller, against)))
    return None


def differs(scene: Scene, caller: Caller, against: str) -> bool:
    """Whether any step of the scene's run has other numbers, or the code fails at one."""
    try:
        ((_, steps),) = runs_of(scene, caller, against)
        return any(step.differences for step in steps)
    except FaultError:
        return True


def by_length(scene: Scene, space: Space, many: int = MANY) -> Iterator[Listed]:
    """Lists that are made by chance, each once, the short ones first."""
    rng = np.random.Generator(
        np.random.PCG64(np.random.SeedSequence([scene.seed], spawn_key=(KEY, 0)))
    )
    known = set[Listed]()
    for length in range(1, space.longest + 1):
        for _ in range(many):
            listed = space.of_length(length, rng)
            if listed not in known:
                known.add(listed)
                yield listed


def exposing(
    scene: Scene, longest: int, mistakes: Sequence[Mistake] = KNOWN
) -> dict[Mistake, Listed]:
    """Of each known mistake the first list that exposes it; those that no list exposes, or that
    cannot be made in such a world, are not in it.
    """
    left, found = list(mistakes), dict[Mistake, Listed]()
    for listed in by_length(scene, Space(scene.world, longest)):
        for one in exposed(replace(scene, commands=listed), left):
            if one.first is not None:
                found[one.mistake] = listed
        left = [mistake for mistake in left if mistake not in found]
        if not left:
            break
    return found
