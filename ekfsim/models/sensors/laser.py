"""The classroom's sensor: one laser beam to the first wall (the assignment's sections 2 and
3.2).
"""

import math
from dataclasses import dataclass

import numpy as np

from ekfsim import twins
from ekfsim.geometry import Array, Integers
from ekfsim.geometry.soa import back, front, lanes
from ekfsim.models.protocols import Quantity, Sensor
from ekfsim.raycast.walls import Walls

ALONG = 1e-9  # rad; a beam this close to its wall's direction has no usable derivative


@dataclass(frozen=True, slots=True)
class Laser(Sensor):
    """A beam `bearing` rad from straight ahead, counter-clockwise, from x = (x, y, θ) in m, m,
    rad.
    """

    walls: Walls
    bearing: float
    range_ratio: float

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """One range."""
        return (Quantity("range", "m"),)

    def h(self, x: Array) -> Array:
        """r = the distance to the first wall : (…, 1) m, nan where there is none          eq. 8"""
        return self.linearize(x)[0]

    def linearize(self, x: Array) -> tuple[Array, Array, Array]:
        """h (…, 1), its Jacobian H = J_H (…, 1, 3) and R = C_v (…, 1, 1)          eqs 8, 11

        A beam of direction d from p meets the wall through a with normal n:

            r = n·(a − p) / n·d      ∂r/∂p = −n / n·d      ∂r/∂θ = −r n·d⊥ / n·d
            C_v = (ratio · r)²

        C_v comes from the prediction: taken from the reading, short echoes are believed too much
        (laser_by_reading.py).
        """
        if x.ndim == 1:
            return self._linearize_one(*x.tolist())
        direction = x[..., 2] + self.bearing
        hit = self.walls.cast(x[..., :2], direction)
        if direction.ndim == 1 and twins.taken() == "compiled":
            from ekfsim.models.compiled import beamed

            return beamed(
                direction, hit.range, hit.wall, self.walls.normals, self.range_ratio, ALONG
            )
        (nx, ny), c, s = front(self._normal(hit.wall), 1), np.cos(direction), np.sin(direction)
        n_d = nx * c + ny * s
        met = np.abs(n_d) > ALONG
        r, per = (
            hit.range,
            -1.0 / n_d if met.all() else np.divide(-1.0, n_d, out=np.zeros_like(n_d), where=met),
        )
        if not met.all():
            r = np.where(met, r, np.nan)
        H, R = lanes(r.shape, 1, 3), lanes(r.shape, 1, 1)
        H[..., 0, 0], H[..., 0, 1] = nx * per, ny * per
        H[..., 0, 2] = np.where(met, r, 0.0) * (ny * c - nx * s) * per
        R[..., 0, 0] = np.square(self.range_ratio * r)
        return r[..., None], H, R

    def _linearize_one(self, x: float, y: float, θ: float) -> tuple[Array, Array, Array]:
        """The same for one robot in plain floats: several times as fast, held equal to the above by
        a test.
        """
        direction = θ + self.bearing
        r, wall = self.walls.first(x, y, direction)
        dx, dy = math.cos(direction), math.sin(direction)
        nx, ny = self.walls.normals[wall].tolist() if wall >= 0 else (0.0, 0.0)
        n_d = nx * dx + ny * dy
        if abs(n_d) <= ALONG:
            return np.array([math.nan]), np.zeros((1, 3)), np.array([[math.nan]])
        H = np.array([[-nx / n_d, -ny / n_d, -r * (ny * dx - nx * dy) / n_d]])
        return np.array([r]), H, np.array([[(self.range_ratio * r) ** 2]])

    def _normal(self, wall: Integers) -> Array:
        """Unit normals : (…, 2), zero where there is no wall."""
        if not len(self.walls.normals):
            return np.zeros((*wall.shape, 2))
        normals = back(front(self.walls.normals, 1)[:, wall], 1)
        normals[wall < 0] = 0.0
        return normals
