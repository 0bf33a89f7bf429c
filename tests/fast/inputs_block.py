"""Scenes of the classroom; many more in test_block.py."""

from dataclasses import replace

import numpy as np
from scenes import among_pillars, rich
from twin_inputs import inputs

from ekfsim.filters.belief import Correction, Gaussian
from ekfsim.models.layout import POSE
from ekfsim.records import Nees
from ekfsim.study.block import Instant, Watched


@inputs("ekfsim.study.block:watched", within=1e-9)  # runs that are lost make much of rounding
def scenes_of_the_classroom(random, runs):
    seed = int(random.integers(2**32))
    made = rich(seed)
    yield replace(made, commands=made.commands[:8]), 0, runs or 1
    yield replace(among_pillars(seed), commands=made.commands[:8]), 0, runs or 1
    yield replace(rich(seed), filter="ukf"), 0, 1  # which is left to the text


@inputs("ekfsim.study.block:follow")
def courses(random, runs):
    """Runs that are lost now and then, certain and wrong, no numbers, or unmoved for a while."""
    N, numbers = runs or 1, 3 + np.arange(runs or 1)
    course, still = list[Instant](), None
    for k in range(150):
        if still is None or random.random() < 0.7:
            still = instant(random, N, float(k), k % 4 == 0)
        course.append(still._replace(t=float(k), corrections=still.corrections * (still.t == k)))
    yield Watched.empty(numbers, np.array([0, 1, 2, 3, 70, 75, 149])), course
    if N < 64:
        yield Watched.empty(numbers, np.array([0, 149])), course
        yield Watched.empty(numbers, np.arange(150)), course
    yield Watched.empty(numbers, np.array([0, 149])), course[:40]


def instant(random, N, t, read):
    belief = Gaussian(random.normal(size=(N, 3)), np.tile(np.diag([0.1, 0.2, 0.01]), (N, 1, 1)))
    belief.mean[random.random(N) < 0.02] = np.nan
    impossible = random.random(N) < 0.1
    value = np.where(impossible, np.nan, random.choice([0.0, 1.0, 99.0], N))
    dof = np.array(3) if random.random() < 0.3 else random.integers(0, 4, N)
    nis = np.where(random.random(N) < 0.1, np.nan, random.random(N))
    one = np.ones((N, 1, 1))
    settled = random.random(N) < 0.9
    correction = Correction(
        one[0], one[:, 0], one, one, one, one, nis, np.zeros(N, int), settled=settled
    )
    truth = belief.mean + 0.1 * random.normal(size=(N, 3))
    return Instant(t, belief, POSE, truth, Nees(value, dof, impossible), (correction,) * read)
