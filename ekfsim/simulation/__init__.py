"""World + commands or drive + draws → Entries: a log being written.

The truth moves here and nowhere else; what the filter is given (odometry, readings, its own map)
leaves in the Entry.
"""

from collections.abc import Iterator

import numpy as np

from ekfsim.geometry import Integers
from ekfsim.records import Entry
from ekfsim.scene import Scene
from ekfsim.simulation.classroom import obey
from ekfsim.simulation.draws import Draws

__all__ = ["Draws", "simulate"]


def simulate(scene: Scene, runs: Integers | None = None) -> Iterator[Entry]:
    """The log of the scene's run, or of N runs side by side. runs : (N,) numbers from 0"""
    draws = Draws(scene.seed, np.asarray(scene.run if runs is None else runs, dtype=np.int64))
    if scene.drive is None:
        return obey(scene, draws)
    from ekfsim.simulation.driven import drive  # no classroom waits for its import

    return drive(scene, scene.drive, draws)
