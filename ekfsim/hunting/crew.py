"""Many variants of a scene judged at once, here or in processes of this machine; the counts are the
same, and in the order of the variants.
"""

import itertools
import pickle
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from ekfsim.hunting.changes.variants import Variant
from ekfsim.hunting.goals import Count, Goal
from ekfsim.scene import Scene
from ekfsim.study.running.engines import do_packed, processes, unfailed
from ekfsim.twins import Way, taking
from ekfsim.version import VERSION

MOST = 16  # variants that are judged in one go in this process, before a signal is heeded

# how many of the runs first … first + runs − 1 do it, for each of some variants of a scene
Judge = Callable[[Scene, Sequence[Variant], int, int], list[Count]]


@dataclass(frozen=True)
class Judging:
    """Judges variants wherever this is called."""

    scene: Scene
    goal: Goal
    way: Way

    def __call__(self, first: int, runs: int, variants: Sequence[Variant]) -> list[Count]:
        """The count of each."""
        with taking(self.way):
            return [self.goal(variant.of(self.scene), first, runs) for variant in variants]


@contextmanager
def crew(workers: int, goal: Goal, way: Way, heed: Callable[[], None]) -> Iterator[Judge]:
    """A judge of variants. `heed` is called again and again: what it raises ends the work."""
    if workers == 1:

        def alone(scene: Scene, variants: Sequence[Variant], first: int, runs: int) -> list[Count]:
            judging, found = Judging(scene, goal, way), list[Count]()
            for some in portions(variants, MOST):
                heed()
                found += judging(first, runs, some)
            return found

        yield alone
        return
    with processes(workers) as submit:
        last: tuple[Scene, bytes] | None = None  # packed once, as long as it is the same

        def together(
            scene: Scene, variants: Sequence[Variant], first: int, runs: int
        ) -> list[Count]:
            nonlocal last
            if last is None or last[0] is not scene:
                last = scene, pickle.dumps(Judging(scene, goal, way))
            parcel, size = last[1], max(-(-len(variants) // workers), 1)
            futures = [
                submit(do_packed, parcel, first, runs, VERSION, some)
                for some in portions(variants, size)
            ]
            found = list[Count]()
            for future in futures:
                heed()
                found += unfailed(future.result())
            return found

        yield together


def portions(variants: Sequence[Variant], most: int) -> Iterator[tuple[Variant, ...]]:
    """The variants, some at a time."""
    waiting = iter(variants)
    while some := tuple(itertools.islice(waiting, most)):
        yield some
