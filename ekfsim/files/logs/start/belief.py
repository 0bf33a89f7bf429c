"""With which belief the filter of a recorded log begins. What somebody told goes before what the
log tells, and that before the world's own start.
"""

import numpy as np

from ekfsim.files.logs.start import words
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array
from ekfsim.systems.document import DocumentReading
from ekfsim.world import World


def at_truth(world: World, reading: DocumentReading, pose: Array) -> Gaussian:
    """The belief at a true pose : (3,)"""
    mean = np.where(world.told.start_said, world.told.start, pose)
    return Gaussian(world.layout.state(mean), world.first_covariance(reading))


def assumed(world: World, reading: DocumentReading, name: str, warnings: list[str]) -> Gaussian:
    """The belief where nothing in the log tells a pose. name : the log, as messages call it"""
    first = Gaussian(world.layout.state(world.told.start), world.first_covariance(reading))
    told = world.told
    if not (all(told.start_said) and told.sigma_said is not None and all(told.sigma_said)):
        warnings.append(f"{name}: {words.assumed(world, first)}{words.otherwise(world)}")
    return first
