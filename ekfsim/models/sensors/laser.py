"""The classroom's sensor: one laser beam to the first wall (assignment, sections 2 and 3.2)."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.protocols import Alternatives, Quantity, Sensor
from ekfsim.models.which_wall import other_walls
from ekfsim.raycast.walls import Walls

ALONG = 1e-9  # rad; a beam this close to its wall's direction has no usable derivative


@dataclass(frozen=True, slots=True)
class Laser(Sensor):
    """A beam `bearing` rad from straight ahead, counter-clockwise; x = (x, y, θ) in m, m, rad."""

    walls: Walls
    bearing: float
    range_ratio: float

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """One range."""
        return (Quantity("range", "m"),)

    def h(self, x: Array) -> Array:
        """r = the distance to the first wall : (…, 1) m          eq. 8

        nan where there is none, or where the beam runs along it and has no usable derivative.
        """
        r, _, _ = self._met(x)
        return r[..., None]

    def H(self, x: Array) -> Array:
        """J_H = ∂h/∂x : (…, 1, 3), 0 where h is nan          eq. 11

        A beam of direction d from p meets the wall through a with normal n:

            r = n·(a − p) / n·d      ∂r/∂p = −n / n·d      ∂r/∂θ = −r n·d⊥ / n·d

        So it is of a round wall, with the normal where the beam meets it: there the wall's tangent
        and the wall itself are one to the first order.
        """
        r, n, d = self._met(x)
        aside = np.stack([-d[..., 1], d[..., 0]], axis=-1)  # d⊥
        turned = r * np.vecdot(n, aside)
        rows = np.stack([n[..., 0], n[..., 1], turned], axis=-1)
        known = ~np.isnan(r)
        n_d = np.where(known, np.vecdot(n, d), 1.0)
        return np.where(known[..., None], -rows / n_d[..., None], 0.0)[..., None, :]

    def R(self, x: Array) -> Array:
        """C_v = (ratio · r)² : (…, 1, 1)          eq. 11

        From the prediction: taken from the reading, short echoes are believed too much
        (laser_by_reading.py).
        """
        return np.square(self.range_ratio * self.h(x))[..., None]

    def alternatives(self, x: Array, P: Array) -> Alternatives | None:
        """The ranges to the other walls that it may meet."""
        return other_walls(self.walls, self.bearing, self.range_ratio, self.linearize(x), x, P)

    def _met(self, x: Array) -> tuple[Array, Array, Array]:
        """r : (…), the normal n of the wall that is met and the beam's direction d : (…, 2) each"""
        heading = x[..., 2] + self.bearing
        hit = self.walls.cast(x[..., :2], heading)
        d = np.stack([np.cos(heading), np.sin(heading)], axis=-1)
        n = self.walls.normal_at(hit.wall, x[..., :2] + hit.range[..., None] * d)
        return np.where(np.abs(np.vecdot(n, d)) > ALONG, hit.range, np.nan), n, d
