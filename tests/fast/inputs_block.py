"""Scenes of the classroom; many more in test_block.py."""

from dataclasses import replace

from scenes import rich
from twin_inputs import inputs


@inputs("ekfsim.study.block:watched", within=1e-9)  # runs that are lost make much of rounding
def scenes_of_the_classroom(random, runs):
    seed = int(random.integers(2**32))
    yield rich(seed), 0, runs or 1
    yield replace(rich(seed), filter="ukf"), 0, 1  # which is left to the text
