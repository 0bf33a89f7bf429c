"""Whether a filter that weighs its readings shuts them out: it believes itself, and not what it
reads, ever since some step.

huber and pdaf take a reading that lies far off for a bad one. Where it is the filter that is far
off, and its P too small, they do so to the end: nothing that they believe can call them back.
"""

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from ekfsim.filters.place import forward
from ekfsim.records import Step
from ekfsim.scene import Scene

SURE = math.log(1e4)  # log of how much likelier shutting out is to be than chance
MOST = 2 * SURE  # so that a filter which found its way since is told from one that did not


class Weighing(NamedTuple):
    """How a filter that is in order weighs its readings."""

    name: str  # of the filter
    little: float  # a trust below it is doubt
    rare: float  # the share of readings that are doubted where all is right

    @classmethod
    def of(cls, scene: Scene) -> "Weighing | None":
        """That of the scene's filter; None of one that weighs none."""
        own = scene.tuning
        match forward(scene.filter):
            case "huber":  # any reading beyond k σ
                return cls("huber", 1.0, math.erfc(own.huber / math.sqrt(2)))
            case "pdaf":
                return cls("pdaf", 0.1, own.clutter)
        return None


class ShutOut(NamedTuple):
    """That a filter has shut out its readings since some step."""

    weighing: Weighing
    since: int  # index of the first reading of those that it doubted
    doubted: int  # how many of …
    readings: int  # … so many since then


@dataclass
class Trusts:
    """How far each reading of one run was believed, gathered one step at a time."""

    of: list[tuple[int, float]] = field(default_factory=list)  # index of the step, trust

    def add(self, step: Step) -> None:
        """Take one more step into account."""
        c = step.correction
        if c is not None and c.trust is not None and not math.isnan(trust := float(c.trust)):
            self.of.append((step.entry.index, trust))

    def shut_out(self, weighing: Weighing | None) -> ShutOut | None:
        """Whether the readings are shut out at the end of the run, and since when."""
        return None if weighing is None else shut_out(self.of, weighing)


def shut_out(trusts: Sequence[tuple[int, float]], weighing: Weighing) -> ShutOut | None:
    """Page's sum of each reading's log p₁/p₀, begun anew where it falls to 0: doubted with the
    share p₀ = rare where all is right, p₁ = (1 + p₀)/2 where readings are shut out. None where the
    sum, which is kept to 2 ln 10⁴, ends below ln 10⁴: Page, Continuous inspection schemes, 1954.

    >>> pdaf = Weighing("pdaf", 0.1, 0.1)
    >>> shut_out([(1, 0.9), (2, 0.0), (3, 0.0), (4, 0.0), (5, 0.9)], pdaf) is None
    True
    >>> shut_out([(1, 0.9), *((2 + i, 0.0) for i in range(9)), (11, 0.9)], pdaf)[1:]
    (2, 9, 10)
    """
    p0 = min(max(weighing.rare, 1e-6), 1 - 1e-6)
    p1 = (1 + p0) / 2
    doubt, belief = math.log(p1 / p0), math.log((1 - p1) / (1 - p0))
    total, begun = 0.0, 0
    for i, (_, trust) in enumerate(trusts):
        total = min(total + (doubt if trust < weighing.little else belief), MOST)
        if total <= 0:
            total, begun = 0.0, i + 1
    if total < SURE:
        return None
    doubted = sum(trust < weighing.little for _, trust in trusts[begun:])
    return ShutOut(weighing, trusts[begun][0], doubted, len(trusts) - begun)


def shut_out_of(steps: Iterable[Step], scene: Scene) -> ShutOut | None:
    """The same of the steps of a run of a scene."""
    if (weighing := Weighing.of(scene)) is None:
        return None
    trusts = Trusts()
    for step in steps:
        trusts.add(step)
    return trusts.shut_out(weighing)
