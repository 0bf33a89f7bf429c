"""Draws of one run."""

from twin_inputs import inputs

from ekfsim.simulation.draws import BLOCK


@inputs("ekfsim.simulation.draws:draw", within=0.0)
def draws(random, runs):
    if runs is not None:
        return
    seeds = [0, 1, 7, 2**31, 2**32 - 1, *random.integers(2**32, size=3).tolist()]
    indices = [0, 15, 16, 17, 255, 256, 257, 10**6, 2**32 - 1, *random.integers(10**6, size=3)]
    numbers = [0, 1, BLOCK - 1, BLOCK, 5 * BLOCK + 3, 2**32, 2**62 + 5]
    for seed in seeds:
        for i in map(int, indices):
            run = int(random.choice(numbers))
            yield seed, i, run, bool(random.integers(2))
    for run in numbers:
        yield 7, 300, run, False
        yield 7, 300, run, True
