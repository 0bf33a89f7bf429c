"""Timing side by side: every candidate in every round, so that what slows the computer down slows
all of them alike.

Only ratios are worth printing: times differ from computer to computer and from minute to minute.
"""

import gc
import importlib
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from statistics import median
from time import process_time
from types import MappingProxyType, ModuleType

from ekfsim.twins import Way

# s that a candidate runs in each round: long against the clock's tick, short against a neighbour's
# burst
SLICE = 0.02

Task = Callable[[], object]

# what many beams and many runs are calculated with, and how the program is told to
WAYS: Mapping[str, Way] = MappingProxyType({"numpy": "quick", "numba": "compiled"})


@dataclass(frozen=True, slots=True)
class Ratio:
    """How one peer compares."""

    peer: str
    # the peer's time over ours, median over the rounds: 10 says that we are ten times as fast
    ratio: float
    seconds: float  # s that the peer takes for the same work, median
    ours: float  # s that one call of ours takes, median

    def __str__(self) -> str:
        return (
            f"{self.ratio:9.1f} × {self.peer:50s} {self.seconds * 1e6:12.3f} µs, ours "
            f"{self.ours * 1e6:10.3f} µs"
        )


def ratios(
    ours: Task,
    peers: Mapping[str, Task],
    rounds: int = 9,
    seconds: float = SLICE,
    calls: Mapping[str, float] = MappingProxyType({}),
    parts: int = 1,
) -> list[Ratio]:
    """Time `ours` and each of the peers in turn, `rounds` times over, and compare within each
    round.

    Each is called once to warm up, then as often in a round as fills `seconds` of processor time.
    `calls` tells how many calls of a peer do the work of one of ours, where it is not one; `parts`,
    of how many alike that work is made: the times are those of a part.
    """
    weights = [1 / parts, *(calls.get(peer, 1.0) / parts for peer in peers)]
    tasks = [ours, *peers.values()]
    repeats = [_repeats(task, seconds) for task in tasks]
    collecting = gc.isenabled()
    gc.disable()
    try:
        times = [
            [
                weight * _time(task, n)
                for task, n, weight in zip(tasks, repeats, weights, strict=True)
            ]
            for _ in range(rounds)
        ]
    finally:
        if collecting:
            gc.enable()
    mine = median(row[0] for row in times)
    return [
        Ratio(peer, median(row[i] / row[0] for row in times), median(row[i] for row in times), mine)
        for i, peer in enumerate(peers, start=1)
    ]


def optional(module: str) -> ModuleType | None:
    """The module of a peer, or None and a line that says what is left out."""
    try:
        return importlib.import_module(module)
    except ImportError:
        print(f"skipped: {module} is not installed")
        return None


def _repeats(task: Task, seconds: float) -> int:
    """How many calls fill the time given."""
    task()
    repeats = 1
    while (taken := _time(task, repeats) * repeats) < seconds / 4:
        repeats *= 2
    return max(1, round(repeats * seconds / taken))


def _time(task: Task, repeats: int) -> float:
    """Processor seconds per call."""
    start = process_time()
    for _ in range(repeats):
        task()
    return (process_time() - start) / repeats
