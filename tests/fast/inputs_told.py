"""Beliefs and matrices that are told."""

import numpy as np
from numerics import covariance
from twin_inputs import axes_of, inputs

from ekfsim.filters.belief import Gaussian
from ekfsim.views.words.numbers import MANY, ROUNDING


@inputs("ekfsim.diagnostics.coverage:inside_ellipse")
@inputs("ekfsim.diagnostics.coverage:inside_cone")
def beliefs(random, runs):
    axes = axes_of(runs)
    x = random.uniform(-5, 5, (*axes, 3)) * [1, 1, 0] + [0, 0, np.pi]
    P = covariance(random, *axes, 3)
    flat = np.diag([1.0, 0.0, 0.0]) * np.ones((*axes, 1, 1))
    for size in (0.1, 1.0, 3.0):
        truth = x + size * random.normal(size=x.shape)
        truth[..., 2] = np.arctan2(np.sin(truth[..., 2]), np.cos(truth[..., 2]))
        yield Gaussian(x, P), truth, 0.954
        yield Gaussian(x, 0 * P), truth, 0.5
        yield Gaussian(x, flat), truth, 0.99
        yield Gaussian(x, flat @ P @ flat), truth, 0.99
        yield Gaussian(np.nan * x, P), truth, 0.99
    yield Gaussian(x, 0 * P), x, 0.954
    yield Gaussian(x, P), x, 0.954


@inputs("ekfsim.views.words.numbers:cleared")
def matrices(random, runs):
    if runs is not None:
        return
    for n in (1, 2, 3, 7, MANY + 1):
        P = covariance(random, n)
        small = np.diag(10.0 ** random.uniform(-12, 12, n))
        A = random.normal(size=(n, random.integers(1, 5))) * 10.0 ** random.integers(-15, 3)
        turned = P - 2 * np.diag(P.diagonal())
        for M in (P, small @ P @ small, turned, 0 * P, A, A.T):
            yield M, ROUNDING
            odd = np.where(random.random(M.shape) < 0.3, random.choice([np.nan, 0.0]), M)
            yield odd, ROUNDING
    yield np.array([[1e12, 0.0], [1e-13, 1e-6]]), ROUNDING
