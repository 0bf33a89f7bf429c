import numpy as np
import pytest

from ekfsim.models.motions.unicycle import Stride, Unicycle


def test_a_stride_is_a_unicycle_of_the_same_way_turn_and_noise():
    random = np.random.default_rng(1)
    x, u = random.uniform(-2, 2, (6, 3)), random.uniform(0.1, 1, (6, 3))
    speed, stride = Unicycle(0.02, 0.1), Stride(0.02, 0.1)
    way = np.column_stack([u[:, 0] * u[:, 2], u[:, 1] * u[:, 2], u[:, 2]])
    assert stride.f(x, way) == pytest.approx(speed.f(x, u))
    assert stride.F(x, way) == pytest.approx(speed.F(x, u))
    noises = [m.G(x, v) @ m.M(v) @ m.G(x, v).mT for m, v in ((speed, u), (stride, way))]
    assert noises[0] == pytest.approx(noises[1])


def test_in_no_time_there_is_no_noise():
    still = np.array([1.0, 1.0, 0.0])
    assert not Unicycle(0.02, 0.1).M(still).any()
    assert not Unicycle(0.02, 0.1).linearize(np.zeros(3), still)[3].any()
    assert not Stride(0.02, 0.1).M(still).any()


def test_it_ends_where_its_circle_does_when_the_steps_are_short():
    """A metre round a circle of 0.5 m, in 2000 steps."""
    x, model = np.zeros(3), Unicycle(0, 0)
    for _ in range(2000):
        x = model.f(x, np.array([1.0, 2.0, 0.0005]))
    assert x == pytest.approx([0.5 * np.sin(2), 0.5 * (1 - np.cos(2)), 2], abs=1e-6)
