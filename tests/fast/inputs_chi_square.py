"""Quantiles as verdicts, gates and studies ask for them."""

from twin_inputs import inputs


@inputs("ekfsim.filters.arithmetic.chi_square:quantile")
def quantiles(random, runs):
    for dof in (0, 1, 2, 3, 60, int(random.integers(4, 5000)), 5001):
        for probability in (0.0, 0.005, 0.5, 0.954, 0.995, 0.999, 1.0, float(random.random())):
            yield probability, dof
