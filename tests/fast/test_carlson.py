"""An update by compiled code is the text's, however sharp the sensor and however singular P."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ekfsim.filters.arithmetic.tolerances import ROUNDING
from ekfsim.filters.belief import Gaussian, Refused
from ekfsim.filters.kalman import Linearized, Rule, update
from ekfsim.twins import as_written

pytest.importorskip("numba")
UPPER = np.triu_indices(3)
N = 50


@pytest.mark.parametrize("R", [0.0, 1e-16, 1e-9, 1e-4, 1.0])
@pytest.mark.parametrize("rank", [0, 1, 2, 3])
@pytest.mark.parametrize("gate", [None, 0.5])
def test_an_update_by_the_square_root_of_P_is_the_texts(rank, R, gate):
    from ekfsim.fast.compiled.carlson import carlson

    random = np.random.default_rng(10 * rank)
    B = random.normal(size=(N, 3, 3)) * (np.arange(3) < rank)
    P = B @ B.mT
    P[::7, 2] = P[::7, :, 2] = 0.0
    x, H, z = random.normal(size=(N, 3)), random.normal(size=(N, 1, 3)), random.normal(size=(N, 1))
    x[:, 2] = random.choice([math.pi, -3.0, 0.0], N)
    H[::5, 0, 1] = 0.0
    h = np.ones((N, 1))
    reading = Linearized(z, h, z - h, H, np.full((N, 1, 1), R))
    posterior, correction = as_written(update)(Gaussian(x, P), reading, Rule(gate, False, (2,)))
    assert gate is None or rank == 0 or {0, 4} == set(correction.refused.tolist())

    from ekfsim.filters.arithmetic.chi_square import quantile

    limit = math.inf if gate is None else quantile(gate, 1)
    means, upper, room = x.T.copy(), P[:, *UPPER].T.copy(), np.empty((3, 3))
    for n in range(N):
        ν = z[n, 0] - 1.0
        nis = carlson(
            means, upper, n, H[n, 0], R, 1.0, ν, limit, math.inf, -math.inf, ROUNDING, room
        )
        assert_allclose(nis, correction.nis[n], 1e-12)
        assert correction.refused[n] == (Refused.GATE if nis > limit else Refused.NOT)
    assert_allclose(means.T, posterior.mean, 1e-12, 1e-12)
    assert_allclose(upper.T, posterior.covariance[:, *UPPER], 1e-12, 1e-12 * max(R, 1e-12))
