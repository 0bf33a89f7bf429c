"""How often the true noises lie within the intervals that `ekfsim tune` gives.

    python benchmarks/tune.py [TRIALS] [classroom|landmarks]

A simulated run of each trial is tuned from numbers that are wrong by a factor of two. Of each
number is counted in how many trials its 95 % interval holds the truth; and in how many all do at
once, of which nothing promises 95 %. The logs of all trials are filtered side by side: what one
trial asks for waits until all have asked.
"""

import sys
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from queue import SimpleQueue
from threading import Thread

import numpy as np

from ekfsim import load_scene
from ekfsim.fitting import abreast
from ekfsim.fitting.estimate import Fit, fit
from ekfsim.fitting.likelihood import Likelihood
from ekfsim.fitting.noises import NoiseNumber, Retold, noises_of
from ekfsim.fitting.trial import OUTLIERS
from ekfsim.geometry import Array
from ekfsim.localization import entries_of, first_belief
from ekfsim.records import Control, Entry, Log, Reading
from ekfsim.scene import Scene

ROWS = 1500  # runs side by side that stay in the processor's cache
SLOW = 2.0  # Hz, of the landmarks' odometry: all else would take minutes


def classroom() -> Scene:
    """Eight laps of an empty room: 256 beams, a look round after each of 64 moves."""
    scene = load_scene("diverge-00-control")
    return replace(scene, commands=scene.commands * 4)


def landmarks() -> Scene:
    """Two rounds among landmarks, the odometry told less often than it is."""
    return load_scene("landmarks").with_("robot.rate", SLOW)


SCENES = {"classroom": classroom, "landmarks": landmarks}


class Logs:
    """The logs of all trials, side by side."""

    def __init__(self, scene: Scene, trials: int) -> None:
        self.entries = tuple(entries_of(scene, np.arange(trials)))
        entries = tuple(_of_one(entry, 0) for entry in self.entries)
        told = replace(scene, log=Log(entries, first_belief(scene)))
        self.truth = noises_of(told)
        self.scene = Retold(told, self.truth).with_([2 * one.value for one in self.truth])
        self.retold = Retold(self.scene, noises_of(self.scene))

    def of(self, trial: int) -> Scene:
        """One of them alone."""
        entries = tuple(_of_one(entry, trial) for entry in self.entries)
        return replace(self.scene, log=Log(entries, first_belief(self.scene)))

    def costs(self, values: Array, whose: "list[Waiting]") -> Array:
        """−ln p of the log of trial whose[i], under numbers (m, n) : (m)"""
        found = np.empty(len(values))
        for gate in {one.gate for one in whose}:
            rows = np.flatnonzero([one.gate == gate for one in whose])
            for part in np.array_split(rows, len(rows) // ROWS + 1):
                mine = [whose[row] for row in part]
                scene = abreast.side_by_side(self.retold, values[part])
                assert scene.log is not None
                entries = tuple(
                    _of_trials(one, given, mine)
                    for one, given in zip(scene.log.entries, self.entries, strict=True)
                )
                scene = replace(scene, log=replace(scene.log, entries=entries))
                found[part] = Likelihood(gate=gate).of_runs(scene, len(part))
        return found


def _of_one(entry: Entry, trial: int) -> Entry:
    """What one trial was given."""
    match entry.given:
        case Control(motion, u):
            return Entry(entry.index, Control(motion, u[trial]), t=entry.t)
        case Reading(sensor, z, name):
            return Entry(entry.index, Reading(sensor, z[trial], name), t=entry.t)
    return Entry(entry.index, None, t=entry.t)


def _of_trials(entry: Entry, all_of_it: Entry, whose: "list[Waiting]") -> Entry:
    """The models of an entry, with what each of some trials was given; nan is left out."""
    which = [one.trial for one in whose]
    match entry.given, all_of_it.given:
        case Control(motion), Control(_, u):
            return replace(entry, given=Control(motion, u[which]))
        case Reading(sensor), Reading(_, z, name):
            out = np.array([entry.index in one.out for one in whose])
            return replace(
                entry, given=Reading(sensor, np.where(out[:, None], np.nan, z[which]), name)
            )
    return entry


@dataclass(frozen=True)
class Waiting(Likelihood):
    """The likelihood of one trial's log, which is worked out beside the others'."""

    trial: int = 0
    logs: Logs | None = None
    asked: "SimpleQueue[Asked]" = field(default_factory=SimpleQueue)
    answered: "SimpleQueue[Array]" = field(default_factory=SimpleQueue)

    def of_all(self, retold: Retold, values: Array, until: int) -> Array:
        """Under each of N sets of numbers : (N, n) → (N)"""
        self.asked.put((self, values))
        return self.answered.get()

    def refused(
        self, gate: float, retold: Retold, values: Sequence[float], until: int
    ) -> frozenset[int]:
        """The indices of the entries that a gate refuses."""
        assert self.logs is not None
        own = Retold(self.logs.of(self.trial), retold.numbers)
        return super().refused(gate, own, values, until)


Asked = tuple[Waiting, Array | None]  # who asks, and the numbers to be tried; None at the end


def fits(logs: Logs, trials: int) -> list[Fit]:
    """What is found in each log."""
    asked: SimpleQueue[Asked] = SimpleQueue()
    found: dict[int, Fit] = {}

    def one(mine: Waiting) -> None:
        try:
            found[mine.trial] = fit(logs.retold, len(logs.entries), OUTLIERS, likelihood=mine)
        finally:
            asked.put((mine, None))

    for trial in range(trials):
        mine = Waiting(trial=trial, logs=logs, asked=asked)
        Thread(target=one, args=(mine,), daemon=True).start()
    still = trials
    while still:
        turn = [asked.get() for _ in range(still)]
        wanted = [(mine, values) for mine, values in turn if values is not None]
        still = len(wanted)
        if wanted:
            sizes = [len(values) for _, values in wanted]
            whose = [mine for mine, values in wanted for _ in values]
            costs = logs.costs(np.concatenate([values for _, values in wanted]), whose)
            for (mine, _), part in zip(wanted, np.split(costs, np.cumsum(sizes)[:-1]), strict=True):
                mine.answered.put(part)
    return [found[trial] for trial in range(trials)]


def main(trials: int, name: str) -> None:
    """Print the share of each number, of all numbers, and of all at once; and the time."""
    begun = time.process_time()
    logs = Logs(replace(SCENES[name](), seed=0, gate=None), trials)
    held, asked, idle, at_once = Counter[str](), Counter[str](), Counter[str](), 0
    truth: dict[str, NoiseNumber] = {one.key: one for one in logs.truth}
    for found in fits(logs, trials):
        inside = {one.number.key: one.low <= truth[one.number.key].value <= one.high
                  for one in found.found}  # fmt: skip
        idle.update(one.key for one in found.idle)
        asked.update(list(inside))
        held.update(key for key, is_inside in inside.items() if is_inside)
        at_once += all(inside.values())
    for key, n in asked.items():
        print(f"{name}: {key}: {held[key]} of {n} intervals hold the truth ({held[key] / n:.3f})")
    for key, n in idle.items():
        print(f"{name}: {key}: not to be found in {n} of {trials} logs")
    n = asked.total()
    print(f"{name}: {held.total()} of all {n} intervals hold the truth ({held.total() / n:.3f})")
    print(f"{name}: in {at_once} of {trials} logs all do at once ({at_once / trials:.3f})")
    print(f"{name}: {(time.process_time() - begun) / trials:.2f} s of CPU a trial")


if __name__ == "__main__":
    which = sys.argv[2:] or list(SCENES)
    for one in which:
        main(int(sys.argv[1]) if len(sys.argv) > 1 else 200, one)
