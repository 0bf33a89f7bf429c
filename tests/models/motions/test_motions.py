"""What every motion model must do. Each has, beside this, its own file where it has something of
its own."""

import math

import numpy as np
import pytest
from numerics import jacobian

from ekfsim.geometry.angles import wrap
from ekfsim.models.layout import INERTIAL, POSE, SPEED_POSE
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.motions.odometry import ArctanOdometry, SkidSteer
from ekfsim.models.motions.planar_imu import PlanarImu
from ekfsim.models.motions.unicycle import Stride, Unicycle
from ekfsim.models.motions.wheel_speeds import WheelSpeeds, WheelSpeedsAsWritten
from ekfsim.models.motions.wheels import GyroWheels, TwoWheels, WheelsBesideGyro

Q = np.diag([1e-4, 1e-4, 7.62e-5])
MOTIONS = {
    "move and turn": (MoveTurn(0.02, 0.03), POSE),
    "two wheels": (TwoWheels(1.41, 0.01, Q), POSE),
    "wheels and gyro": (GyroWheels(1.41, 0.01, Q, 0.002), POSE),
    "wheels beside a gyro": (WheelsBesideGyro(1.41, 0.01, Q, 0.002), POSE),
    "arctan": (ArctanOdometry(0.38, 0.05, 0.002, Q), POSE),
    "skid steer": (SkidSteer(((0.5, 0.45), (0.02, -0.03), (2.5, -2.4)), 0.02, Q), POSE),
    "wheel speeds": (WheelSpeeds(0.27, 0.1, 0.3), SPEED_POSE),
    "the recipe": (WheelSpeedsAsWritten(), SPEED_POSE),
    "unicycle": (Unicycle(0.02, 0.1), POSE),
    "stride": (Stride(0.05, 0.01), POSE),
    "inertial": (PlanarImu(), INERTIAL),
    "inertial, unwrapped": (PlanarImu(wrapped=False), INERTIAL),
}
EVERY = pytest.mark.parametrize(("motion", "layout"), MOTIONS.values(), ids=MOTIONS)
DERIVED = pytest.mark.parametrize(  # the recipe's F is not its derivative: see test_model_errata
    ("motion", "layout"),
    [value for value in MOTIONS.values() if not isinstance(value[0], WheelSpeedsAsWritten)],
)
TIMED = pytest.mark.parametrize(
    ("motion", "layout"), [value for value in MOTIONS.values() if value[0].inputs[-1].name == "dt"]
)


def drawn(motion, layout, seed, axes=(), big=3.0):
    """A state and an input within ± big, headings within (−π, π], dt within 5 ms and 0.5 s."""
    random = np.random.default_rng(seed)
    x = random.uniform(-big, big, (*axes, len(layout.names)))
    x[..., layout.headings] = random.uniform(-math.pi, math.pi, (*axes, len(layout.headings)))
    u = random.uniform(-big, big, (*axes, len(motion.inputs)))
    if motion.inputs[-1].name == "dt":
        u[..., -1] = random.uniform(0.005, 0.5, axes)
    return x, u


def apart(motion, layout, x, u):
    """f near (x, u), as the difference from f(x, u): no wrap comes between."""
    center = motion.f(x, u)

    def difference(x, u):
        change = motion.f(x, u) - center
        change[..., layout.headings] = wrap(change[..., layout.headings])
        return change

    return difference


@DERIVED
@pytest.mark.parametrize("seed", range(20))
def test_F_equals_central_differences(motion, layout, seed):
    x, u = drawn(motion, layout, seed)
    f = apart(motion, layout, x, u)
    np.testing.assert_allclose(motion.F(x, u), jacobian(lambda x: f(x, u), x), atol=1e-6, rtol=1e-6)


@EVERY
@pytest.mark.parametrize("seed", range(20))
def test_G_equals_central_differences(motion, layout, seed):
    x, u = drawn(motion, layout, seed)
    f = apart(motion, layout, x, u)
    G, expected = motion.G(x, u), jacobian(lambda u: f(x, u), u, 1e-7)
    # its wheels' columns are eq. 22, not the derivative: see test_wheels
    if type(motion) is GyroWheels:
        G, expected = G[:, 2:], expected[:, 2:]
    np.testing.assert_allclose(G, expected, atol=1e-5, rtol=1e-5)


@EVERY
def test_all_at_once_equals_one_by_one(motion, layout):
    for seed in range(20):
        x, u = drawn(motion, layout, seed)
        one_by_one = (motion.f(x, u), motion.F(x, u), motion.G(x, u), motion.M(u), motion.Q(u))
        batch = (motion.f(x[None], u[None])[0], *one_by_one[1:])
        for got, alone, expected in zip(motion.linearize(x, u), one_by_one, batch, strict=True):
            np.testing.assert_allclose(got, expected, atol=1e-12, rtol=1e-12)
            np.testing.assert_allclose(alone, expected, atol=1e-12, rtol=1e-12)
            assert np.shape(got) == np.shape(expected)


@EVERY
@pytest.mark.parametrize("axes", [(1,), (5,), (3, 2)])
def test_a_batch_equals_its_runs(motion, layout, axes):
    x, u = drawn(motion, layout, 1, axes)
    n, m = len(layout.names), len(motion.inputs)
    shapes = [(n,), (n, n), (n, m), (m, m)]
    batch = motion.linearize(x, u)
    for values, shape in zip(batch[:4], shapes, strict=True):
        assert values.shape == (*axes, *shape)
    for k in np.ndindex(axes):
        for values, alone in zip(batch[:4], motion.linearize(x[k], u[k])[:4], strict=True):
            np.testing.assert_allclose(values[k], alone, atol=1e-12, rtol=1e-12)


@EVERY
def test_one_input_moves_many(motion, layout):
    x, u = drawn(motion, layout, 2, (7,))[0], drawn(motion, layout, 3)[1]
    f, F, G, _, _ = motion.linearize(x, u)
    for k in range(7):
        for values, alone in zip((f, F, G), motion.linearize(x[k], u)[:3], strict=True):
            np.testing.assert_allclose(values[k], alone, atol=1e-12, rtol=1e-12)
    one = motion.f(x[0], np.broadcast_to(u, (4, len(u))))
    assert one.shape == (4, len(layout.names))


@EVERY
def test_the_input_is_named(motion, layout):
    assert len(motion.inputs) == len(drawn(motion, layout, 0)[1])
    assert len({quantity.name for quantity in motion.inputs}) == len(motion.inputs)


@EVERY
def test_headings_stay_in_their_range(motion, layout):
    for seed in range(100):
        x, u = drawn(motion, layout, seed, (3,), big=20.0)
        for after in (motion.f(x, u), motion.f(x[0], u[0])):
            headings = after[..., layout.headings]
            assert (headings > -math.pi).all()
            assert (headings <= math.pi).all()


@EVERY
def test_covariances_are_covariances(motion, layout):
    for seed in range(10):
        u = drawn(motion, layout, seed, (2,))[1]
        for covariance in (motion.M(u), np.atleast_2d(motion.Q(u))):
            assert np.array_equal(covariance, covariance.mT)
            assert (np.linalg.eigvalsh(covariance) >= -1e-12 * np.abs(covariance).max()).all()


@TIMED
def test_the_clock_does_not_err(motion, layout):
    M = motion.M(drawn(motion, layout, 1, (4,))[1])
    assert not M[..., -1, :].any()
    assert not M[..., :, -1].any()


@TIMED
def test_in_no_time_nothing_is_divided_by_it(motion, layout):
    x, u = drawn(motion, layout, 1, (4,))
    u[..., -1] = 0
    for values in (*motion.linearize(x, u), *motion.linearize(x[0], u[0])):
        assert np.isfinite(values).all()
