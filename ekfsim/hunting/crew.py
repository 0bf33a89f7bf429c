"""Many variants of a scene judged at once, here or in processes of this machine; the counts are the
same, and in the order of the variants.
"""

import itertools
import pickle
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass

from ekfsim.hunting.goals import Count, Goal
from ekfsim.hunting.variants import Variant
from ekfsim.scene import Scene
from ekfsim.study.code import digests, of_same_code
from ekfsim.study.running.engines import do_packed, processes, unfailed
from ekfsim.twins import Way, taking
from ekfsim.version import VERSION

SOME = 16  # variants that are judged in one go, before a signal is heeded

# how many of the runs first … first + runs − 1 do it, for each of some variants of a scene
Judge = Callable[[Scene, Sequence[Variant], int, int], list[Count]]


@dataclass(frozen=True)
class Portion:
    """Some variants, to be judged wherever this is called."""

    scene: Scene
    goal: Goal
    variants: tuple[Variant, ...]
    way: Way

    def __call__(self, first: int, runs: int) -> list[Count]:
        """The count of each."""
        with taking(self.way):
            return [self.goal(variant.of(self.scene), first, runs) for variant in self.variants]


@contextmanager
def crew(workers: int, goal: Goal, way: Way, heard: Callable[[], None]) -> Iterator[Judge]:
    """A judge of variants. `heard` is called again and again, to heed what asks us to end."""
    if workers == 1:

        def alone(scene: Scene, variants: Sequence[Variant], first: int, runs: int) -> list[Count]:
            found = list[Count]()
            for some in portions(variants):
                heard()
                found += Portion(scene, goal, some, way)(first, runs)
            return found

        yield alone
        return
    with processes(workers) as submit:

        def together(
            scene: Scene, variants: Sequence[Variant], first: int, runs: int
        ) -> list[Count]:
            codes = digests([scene.filter])
            futures = [
                submit(
                    do_packed,
                    pickle.dumps(of_same_code(Portion(scene, goal, some, way), codes)),
                    first, runs, VERSION,
                )
                for some in portions(variants)
            ]  # fmt: skip
            found = list[Count]()
            for future in futures:
                heard()
                found += unfailed(future.result())
            return found

        yield together


def portions(variants: Sequence[Variant]) -> Iterator[tuple[Variant, ...]]:
    """The variants, some at a time."""
    waiting = iter(variants)
    while some := tuple(itertools.islice(waiting, SOME)):
        yield some
