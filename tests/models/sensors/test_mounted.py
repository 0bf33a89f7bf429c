"""A sensor that is not carried where the pose is told of: it reads from where it sits."""

import math

import numpy as np
import pytest

from ekfsim.diagnostics.ambiguity import remark
from ekfsim.models.layout import INERTIAL, POSE, SPEED_POSE, Layout
from ekfsim.models.sensors.infrared import InfraredBeam
from ekfsim.models.sensors.landmarks import BearingOnly, MarkerAngles, RangeBearing, RangeOnly
from ekfsim.models.sensors.lidar import LidarOffset
from ekfsim.models.sensors.mounted import AT_THE_POSE, Mount, Mounted, bare, carried, place_of
from ekfsim.models.sensors.offset import LandmarkOffset
from ekfsim.models.sensors.position import Position
from ekfsim.models.sensors.ultrasonic import UltrasonicBeam
from ekfsim.models.sensors.yaw import Yaw
from ekfsim.raycast.walls import BOUNDARY, Walls

ROOM = Walls.of(
    {
        BOUNDARY: np.array([[-9.0, -8], [9, -8], [9, 8], [-9, 8]]),
        "desk": np.array([[2.0, 1], [4, 1], [4, 3], [2, 3]]),
    }
)
SENSORS = (
    MarkerAngles(2.0, 3.0, 0.226, 0.048, 0.006),
    RangeBearing(2.0, 3.0, 0.3, 0.02),
    RangeOnly(2.0, 3.0, 0.6),
    BearingOnly(2.0, 3.0, 0.02),
    LidarOffset(2.0, 3.0, 0.01),
    LandmarkOffset(2.0, 3.0, 0.01, 0.01, yaw_sigma=0.02),
    Position(0.1, 0.2),
    Yaw(0.4, 0.02),
    UltrasonicBeam(ROOM, 0.4, 0.005, 0.01, 0.1, 40.0),
    InfraredBeam(ROOM, -0.7, 1.0, 1.0, 1.0, 0.05, 0.1, 40.0),
)
BIASED = Layout(("x", "y", "theta", "gyro_bias"))
LAYOUTS = (POSE, SPEED_POSE, INERTIAL, BIASED)
MOUNT = Mount(0.7, -0.3, 2.2)


def states(layout, poses):
    """States with these poses, and something else than 0 in all other entries."""
    x = np.full((*poses.shape[:-1], len(layout.names)), 0.3)
    x[..., layout.places] = poses
    return x


def poses(n):
    """Anywhere, and about the seam of the heading as the robot and as the sensor see it."""
    random = np.random.default_rng(5)
    found = random.uniform(-5, 5, (n, 3))
    seams = (math.pi, -math.pi, math.pi - MOUNT.theta, 0.0, math.pi / 2)
    found[: len(seams), 2] = seams
    return found


@pytest.mark.parametrize("sensor", SENSORS, ids=lambda one: type(one).__name__)
def test_it_reads_what_the_sensor_reads_at_its_own_pose(sensor):
    """By complex numbers: the arm is turned by e^(iθ)."""
    x = poses(40)
    at = x[:, 0] + 1j * x[:, 1] + (MOUNT.x + 1j * MOUNT.y) * np.exp(1j * x[:, 2])
    own = np.stack([at.real, at.imag, x[:, 2] + MOUNT.theta], axis=-1)
    mounted = Mounted(sensor, MOUNT, POSE)
    apart = sensor.residual(mounted.h(x), sensor.h(own))
    np.testing.assert_allclose(apart, 0.0, atol=1e-9)
    np.testing.assert_allclose(mounted.R(x), sensor.R(own), rtol=1e-9)
    assert mounted.outputs == sensor.outputs


@pytest.mark.parametrize("layout", LAYOUTS, ids=lambda one: "-".join(one.names))
@pytest.mark.parametrize("sensor", SENSORS, ids=lambda one: type(one).__name__)
def test_its_jacobian_equals_central_differences(sensor, layout):
    """Where a beam sees the same wall a hair to each side."""
    x, mounted, step = states(layout, poses(60)), Mounted(sensor, MOUNT, layout), 1e-6
    H = mounted.H(x)
    for i in range(len(layout.names)):
        to_side = np.zeros(len(layout.names))
        to_side[i] = step
        slope = mounted.residual(mounted.h(x + to_side), mounted.h(x - to_side)) / (2 * step)
        smooth = np.isfinite(slope) & (np.abs(slope) < 1e3)
        assert smooth.mean() > 0.9
        np.testing.assert_allclose(H[..., i][smooth], slope[smooth], rtol=2e-6, atol=2e-6)


def test_leading_axes_are_those_of_the_states():
    x = poses(24)
    for sensor in SENSORS:
        mounted = Mounted(sensor, MOUNT, POSE)
        for axes in ((), (24,), (4, 6)):
            some = x.reshape(*axes, 3) if axes else x[0]
            for whole, part in zip(mounted.linearize(x), mounted.linearize(some), strict=True):
                np.testing.assert_allclose(
                    part, whole.reshape(*axes, *whole.shape[1:]) if axes else whole[0], atol=1e-12
                )


def test_a_mounted_beam_names_the_wall_that_it_meets_and_its_doubt_is_that_of_its_own_place():
    """As a bare beam of a belief that was carried there, its covariance by J P Jᵀ with J from
    differences."""
    beam, x = UltrasonicBeam(ROOM, 0.0, 0.01, 0.0, 0.1, 40.0), np.array([0.0, 0.0, 0.9])
    P = np.array([[0.04, 0.01, 0.0], [0.01, 0.05, 0.002], [0.0, 0.002, 0.01]])
    mount, step = Mount(1.2, 0.5, -0.4), 1e-6
    J = np.stack(
        [(carried(x + d, mount) - carried(x - d, mount)) / (2 * step) for d in np.eye(3) * step],
        axis=-1,
    )
    own = remark(beam, carried(x, mount), J @ P @ J.T)
    for layout in (POSE, BIASED):
        n = len(layout.names)
        P_all = np.eye(n)
        P_all[:3, :3] = P
        found = remark(Mounted(beam, mount, layout), states(layout, x), P_all)
        assert (int(found.wall), bool(found.ambiguous)) == (int(own.wall), bool(own.ambiguous))
        np.testing.assert_array_equal(found.probe_walls, own.probe_walls)
        np.testing.assert_allclose(found.probe_ranges, own.probe_ranges, atol=1e-5)


def test_what_is_inside_and_where_it_sits_is_told():
    sensor, pose = SENSORS[1], np.array([1.0, 2.0, math.pi / 2])
    mounted = Mounted(sensor, Mount(1.0, 0.0, math.pi / 2), POSE)
    assert bare(mounted) is sensor
    assert bare(sensor) is sensor
    np.testing.assert_allclose(place_of(mounted, pose), [1.0, 3.0, math.pi], atol=1e-12)
    assert place_of(sensor, pose) is pose
    np.testing.assert_array_equal(carried(pose, AT_THE_POSE), pose)
