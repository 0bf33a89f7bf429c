import math

import numpy as np
import pytest
from numerics import covariance

from ekfsim.filters.belief import Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.filters.stretch import stretch
from ekfsim.models.motions.unicycle import Unicycle
from ekfsim.models.motions.wheels import GyroWheels, TwoWheels

Q = np.diag([1e-6, 2e-6, 3e-7])


def inputs(random, *axes):
    ways = 0.02 + 0.002 * random.normal(size=(*axes, 2))
    return {
        "two wheels": (TwoWheels(0.5, 0.002), ways),
        "two wheels with process noise": (TwoWheels(0.5, 0.002, Q), ways),
        "gyro": (
            GyroWheels(0.5, 0.002, Q, 0.01),
            np.concatenate(
                [ways, random.normal(size=(*axes, 1)), np.full((*axes, 1), 0.01)], axis=-1
            ),
        ),
        "unicycle": (
            Unicycle(0.02, 0.1),
            np.concatenate(
                [
                    random.normal(1, 0.1, (*axes, 1)),
                    random.normal(size=(*axes, 1)),
                    np.full((*axes, 1), 0.05),
                ],
                axis=-1,
            ),
        ),
    }


KINDS = ["two wheels", "two wheels with process noise", "gyro", "unicycle"]


@pytest.mark.parametrize("axes", [(), (4,)])
@pytest.mark.parametrize("kind", KINDS)
def test_a_stretch_is_its_steps(kind, axes):
    random = np.random.default_rng(0)
    motion, U = inputs(random, 400, *axes)[kind]
    x = np.broadcast_to([3.0, -2.0, 3.0], (*axes, 3)) + random.normal(size=(*axes, 3))
    belief = Gaussian(x, 1e-3 * covariance(random, *axes, 3))
    many = stretch(belief, motion, U)
    for k, u in enumerate(U):
        belief, _ = EKF().predict(belief, motion, u)
        turn = many.mean[k] - belief.mean
        turn[..., 2] = np.arctan2(np.sin(turn[..., 2]), np.cos(turn[..., 2]))
        assert turn == pytest.approx(0, abs=1e-12)
        assert many.covariance[k] == pytest.approx(belief.covariance, rel=1e-12, abs=1e-14)
    assert (np.abs(many.mean[..., 2]) <= math.pi).all()


def test_a_stretch_of_one_and_of_none():
    motion, U = inputs(np.random.default_rng(1), 1)["gyro"]
    belief = Gaussian(np.array([0.0, 0.0, 1.0]), np.zeros((3, 3)))
    one, _ = EKF().predict(belief, motion, U[0])
    assert stretch(belief, motion, U).mean[0] == pytest.approx(one.mean, abs=1e-15)
    assert stretch(belief, motion, U).covariance[0] == pytest.approx(one.covariance, abs=1e-15)
    assert stretch(belief, motion, U[:0]).mean.shape == (0, 3)
