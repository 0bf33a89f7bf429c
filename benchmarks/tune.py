"""How often the true noises lie within the intervals that `ekfsim tune` gives.

    python benchmarks/tune.py [TRIALS] [classroom|landmarks]

A simulated run of each seed is tuned from numbers that are wrong by a factor of two; of each number
is counted in how many trials its 95 % interval holds the truth.
"""

import sys
import time
from collections import Counter
from dataclasses import replace

from ekfsim import load_scene
from ekfsim.fitting.estimate import fit
from ekfsim.fitting.noises import Retold, noises_of
from ekfsim.fitting.trial import recorded
from ekfsim.scene import Scene


def classroom() -> Scene:
    """A long tour of an empty room: a look round after each move."""
    scene = load_scene("diverge-00-control")
    return replace(scene, commands=scene.commands * 4)


SCENES = {"classroom": classroom, "landmarks": lambda: load_scene("landmarks")}


def main(trials: int, name: str) -> None:
    """Print the share of each number, and the time of a trial."""
    held, asked, idle = Counter[str](), Counter[str](), Counter[str]()
    begun = time.process_time()
    for seed in range(trials):
        scene = recorded(replace(SCENES[name](), seed=seed, gate=None))
        truth = noises_of(scene)
        assert scene.log is not None
        off = Retold(scene, truth).with_([one.value * 2 for one in truth])
        found = fit(Retold(off, noises_of(off)), len(scene.log.entries), None)
        values = {one.key: one.value for one in truth}
        idle.update(one.key for one in found.idle)
        for one in found.found:
            asked[one.number.key] += 1
            held[one.number.key] += one.low <= values[one.number.key] <= one.high
    took = (time.process_time() - begun) / trials
    for key, n in asked.items():
        print(f"{name}: {key}: {held[key]} of {n} intervals hold the truth ({held[key] / n:.3f})")
    for key, n in idle.items():
        print(f"{name}: {key}: not to be found in {n} of {trials} logs")
    print(f"{name}: {took:.1f} s of CPU a trial")


if __name__ == "__main__":
    which = sys.argv[2:] or list(SCENES)
    for one in which:
        main(int(sys.argv[1]) if len(sys.argv) > 1 else 20, one)
