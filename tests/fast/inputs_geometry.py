"""Covariances of positions: round ones, flat ones, lines, points."""

import numpy as np
from numerics import covariance
from twin_inputs import axes_of, inputs


@inputs("ekfsim.geometry.ellipse:ellipse")
def ellipses(random, runs):
    axes = axes_of(runs)
    for probability in (0.5, 0.954):
        for n in (2, 3):
            yield covariance(random, *axes, n), probability
            yield 1e-8 * covariance(random, *axes, n), probability
            yield covariance(random, *axes, n, rank=1), probability
            yield np.zeros((*axes, n, n)), probability
            yield np.zeros((*axes, n, n)) + np.diag([0.0, 1.0, 1.0][:n]), probability
