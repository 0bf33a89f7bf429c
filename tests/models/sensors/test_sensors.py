"""What every sensor model must do. Each has, beside this, its own file where it has something of
its own."""

import math

import numpy as np
import pytest
from numerics import jacobian

from ekfsim.diagnostics.ambiguity import remark
from ekfsim.models.layout import INERTIAL, POSE, SPEED_POSE
from ekfsim.models.protocols import angles
from ekfsim.models.sensors.frozen import Frozen
from ekfsim.models.sensors.landmarks import BearingOnly, MarkerAngles, RangeBearing, RangeOnly
from ekfsim.models.sensors.lidar import LidarOffset
from ekfsim.models.sensors.offset import LandmarkOffset
from ekfsim.models.sensors.position import Position
from ekfsim.models.sensors.yaw import Yaw

LAYOUTS = {"pose": POSE, "speed": SPEED_POSE, "inertial": INERTIAL}
MAKERS = {
    "marker": lambda layout: MarkerAngles(0.5, -1.0, 0.226, 0.048, 0.006, layout=layout),
    "range and bearing": lambda layout: RangeBearing(0.5, -1.0, 0.3, 0.02, layout),
    "range": lambda layout: RangeOnly(0.5, -1.0, 0.6, layout),
    "bearing": lambda layout: BearingOnly(0.5, -1.0, 0.02, layout),
    "position": lambda layout: Position(0.15, 0.2, layout),
    "yaw": lambda layout: Yaw(2.0, 0.1, layout),
    "offset": lambda layout: LandmarkOffset(5.0, -5.0, 0.0075, 0.008, layout),
    "lidar": lambda layout: LidarOffset(5.0, -5.0, 0.0075, layout),
    "offset, yaw's error": lambda layout: LandmarkOffset(5.0, -5.0, 0.0075, 0.008, layout, 0.02),
}
CASES = [
    pytest.param(make(layout), layout, id=f"{s}, {n}")
    for s, make in MAKERS.items()
    for n, layout in LAYOUTS.items()
]
EVERY = pytest.mark.parametrize(("sensor", "layout"), CASES)
LANDMARKS = pytest.mark.parametrize(
    ("sensor", "layout"), [case for case in CASES if hasattr(case.values[0], "x")]
)


def drawn(layout, seed, axes=()):
    random = np.random.default_rng(seed)
    x = random.uniform(-5, 5, (*axes, len(layout.names)))
    x[..., layout.headings] = random.uniform(-math.pi, math.pi, (*axes, len(layout.headings)))
    return x


@EVERY
def test_H_equals_central_differences(sensor, layout):
    for seed in range(20):
        x = drawn(layout, seed)
        h, H, _ = sensor.linearize(x)
        expected = jacobian(lambda x, h=h: sensor.residual(sensor.h(x), h), x)
        np.testing.assert_allclose(H, expected, atol=1e-6, rtol=1e-6)


@EVERY
@pytest.mark.parametrize("axes", [(1,), (5,), (3, 2)])
def test_a_batch_equals_its_runs(sensor, layout, axes):
    x, k, n = drawn(layout, 1, axes), len(sensor.outputs), len(layout.names)
    batch = sensor.linearize(x)
    assert [values.shape for values in batch] == [(*axes, k), (*axes, k, n), (*axes, k, k)]
    np.testing.assert_array_equal(sensor.h(x), batch[0])
    for at in np.ndindex(axes):
        for values, alone in zip(batch, sensor.linearize(x[at]), strict=True):
            np.testing.assert_allclose(values[at], alone, atol=1e-13, rtol=1e-13)


@EVERY
def test_one_robot(sensor, layout):
    x, k, n = drawn(layout, 1), len(sensor.outputs), len(layout.names)
    assert [values.shape for values in sensor.linearize(x)] == [(k,), (k, n), (k, k)]
    assert sensor.h(x).shape == (k,)
    assert remark(sensor, x, np.eye(n)) is None


@EVERY
def test_differences_of_angles_go_the_short_way(sensor, layout):
    h = sensor.h(drawn(layout, 1, (6,)))
    z = h.copy()
    wrapped = angles(sensor.outputs)
    z[..., wrapped] += 2 * math.pi
    for residual in (sensor.residual(z, h), sensor.residual(z[0], h[0])):
        np.testing.assert_allclose(residual, 0, atol=1e-12)
    straight = [i for i in range(len(sensor.outputs)) if i not in wrapped]
    z[..., straight] += 7
    np.testing.assert_allclose(sensor.residual(z, h)[..., straight], 7)


@EVERY
def test_R_is_positive_definite(sensor, layout):
    R = sensor.linearize(drawn(layout, 1, (5,)))[2]
    assert np.array_equal(R, R.mT)
    assert (np.linalg.eigvalsh(R) > 0).all()


@LANDMARKS
def test_at_the_landmark_itself_nothing_breaks(sensor, layout):
    x = np.zeros((2, len(layout.names)))
    x[..., layout.position] = sensor.x, sensor.y
    x[1, layout.position[0]] += 1e-12
    for values in (*sensor.linearize(x), *sensor.linearize(x[0])):
        assert np.isfinite(values).all()
    # straight lines have a slope everywhere
    if not isinstance(sensor, LandmarkOffset | LidarOffset):
        assert not sensor.linearize(x)[1].any()
        assert not sensor.linearize(x[0])[1].any()


@EVERY
def test_the_heading_alone_turns_the_bearing(sensor, layout):
    x = drawn(layout, 3)
    turned = x.copy()
    turned[layout.heading] += 0.25
    change = sensor.residual(sensor.h(turned), sensor.h(x))
    if isinstance(sensor, LidarOffset):  # it turns both numbers, as test_offset.py tells
        return
    by = {"azimuth": -0.25, "bearing": -0.25, "yaw": 0.25}
    expected = [by.get(quantity.name, 0.0) for quantity in sensor.outputs]
    np.testing.assert_allclose(change, expected, atol=1e-12)


@EVERY
def test_frozen_it_stays_where_it_was(sensor, layout):
    at, x = drawn(layout, 1), drawn(layout, 2)
    frozen = Frozen(sensor, at)
    assert frozen.outputs == sensor.outputs
    for got, expected in zip(frozen.linearize(x), sensor.linearize(at), strict=True):
        np.testing.assert_array_equal(got, expected)
    np.testing.assert_array_equal(frozen.h(x), sensor.h(at))
    np.testing.assert_array_equal(
        frozen.residual(sensor.h(x), sensor.h(at)), sensor.residual(sensor.h(x), sensor.h(at))
    )
    assert remark(frozen, x, np.eye(len(x))) is None


@EVERY
def test_frozen_for_every_run_and_all_its_sigma_points(sensor, layout):
    at, points = drawn(layout, 1, (3,)), drawn(layout, 2, (3, 15))
    h = Frozen(sensor, at).h(points)
    assert h.shape == (3, 15, len(sensor.outputs))
    for run in range(3):
        np.testing.assert_allclose(
            h[run], np.broadcast_to(sensor.h(at[run]), h[run].shape), atol=1e-13
        )
