"""A sensor that is not carried in the middle of its robot, or looks another way: its lever arm."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.layout import Layout
from ekfsim.models.protocols import Alternatives, Parting, Quantity, Sensor
from ekfsim.models.sensors.frozen import Frozen


class Mount(NamedTuple):
    """Where a sensor sits on its robot, and which way it looks there."""

    x: float = 0.0  # m ahead of the point that the state tells of
    y: float = 0.0  # m to its left
    theta: float = 0.0  # rad from straight ahead, counter-clockwise


AT_THE_POSE = Mount()


def carried(pose: Array, mount: Mount) -> Array:
    """The pose of a sensor on a robot : (…, 3) → (…, 3)

        x + c m_x − s m_y        y + s m_x + c m_y        θ + m_θ

    with c = cos θ and s = sin θ.

    >>> carried(np.array([1.0, 2.0, np.pi / 2]), Mount(0.5, 0.0, 0.0)).round(6).tolist()
    [1.0, 2.5, 1.570796]
    """
    x, y, θ = np.moveaxis(pose, -1, 0)
    east, north = _arm(θ, mount)
    return np.stack([x + east, y + north, wrap(θ + mount.theta)], axis=-1)


def carried_by(pose: Array, mount: Mount) -> Array:
    """∂(pose of the sensor)/∂(pose of the robot) = [1 0 −Δy; 0 1 Δx; 0 0 1] : (…, 3, 3), Δ the
    lever arm in the world's frame
    """
    east, north = _arm(pose[..., 2], mount)
    J = np.broadcast_to(np.eye(3), (*east.shape, 3, 3)).copy()
    J[..., 0, 2], J[..., 1, 2] = -north, east
    return J


def _arm(θ: Array, mount: Mount) -> tuple[Array, Array]:
    """The lever arm to the east and to the north : (…) m each"""
    c, s = np.cos(θ), np.sin(θ)
    return c * mount.x - s * mount.y, s * mount.x + c * mount.y


@dataclass(frozen=True, slots=True)
class Mounted(Sensor):
    """What `sensor` reads where it sits. It knows of a pose alone; the state holds the robot's."""

    sensor: Sensor  # of the state x, y, θ
    mount: Mount
    layout: Layout  # of the robot's state

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """Those of the sensor."""
        return self.sensor.outputs

    def h(self, x: Array) -> Array:
        """What the sensor predicts where it sits : (…, k)"""
        return self.sensor.h(self._pose(x))

    def H(self, x: Array) -> Array:
        """∂h/∂(pose of the sensor) · ∂(pose of the sensor)/∂x : (…, k, n)"""
        return self._placed(self.sensor.H(self._pose(x)), x)

    def R(self, x: Array) -> Array:
        """R of the sensor where it sits : (…, k, k)"""
        return self.sensor.R(self._pose(x))

    def alternatives(self, x: Array, P: Array) -> Alternatives | None:
        """Those of the sensor where it sits."""
        if not isinstance(self.sensor, Parting):
            return None
        pose = self.layout.pose(x)
        J = carried_by(pose, self.mount)
        other = self.sensor.alternatives(self._pose(x), J @ self.layout.pose_covariance(P) @ J.mT)
        return None if other is None else other._replace(H=self._placed(other.H, x[..., None, :]))

    def residual(self, z: Array, h: Array) -> Array:
        """ν = z − h as the sensor has it : (…, k)"""
        return self.sensor.residual(z, h)

    def _pose(self, x: Array) -> Array:
        """Where the sensor is and looks : (…, 3)"""
        return carried(self.layout.pose(x), self.mount)

    def _placed(self, H: Array, x: Array) -> Array:
        """Derivatives by the sensor's pose (…, k, 3) as those by the robot's state : (…, k, n)"""
        by_state = np.zeros((*H.shape[:-1], x.shape[-1]))
        by_state[..., self.layout.places] = H @ carried_by(self.layout.pose(x), self.mount)
        return by_state


def bare(sensor: Sensor) -> Sensor:
    """The sensor itself, where it is wrapped to be linearised elsewhere, or mounted."""
    while isinstance(sensor, Frozen | Mounted):
        sensor = sensor.sensor
    return sensor


def place_of(sensor: Sensor, pose: Array) -> Array:
    """From where a sensor reads on a robot at a pose (…, 3) : (…, 3)"""
    while isinstance(sensor, Frozen):
        sensor = sensor.sensor
    return carried(pose, sensor.mount) if isinstance(sensor, Mounted) else pose
