"""The classroom's sensor: one laser beam to the first wall (the assignment's sections 2 and
3.2).
"""

import math
from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array, Booleans, Integers, backend
from ekfsim.geometry.lanes import back, front, lanes
from ekfsim.geometry.walls import Walls
from ekfsim.models.protocols import Quantity, Sensor

# below this angle between beam and wall a small turn moves the beam's end far
GRAZING = np.radians(15.0)
ALONG = 1e-9  # rad; a beam this close to its wall's direction has no usable derivative
REACH = 3.0  # standard deviations to the poses from which the beam is cast again
FLAT = 1e-10  # a variance below this share of the largest opens no direction to look in


@dataclass(frozen=True, slots=True)
class Sighting:
    """What the laser alone knows of a beam before its reading is used. Arrays carry leading axes
    (…).
    """

    wall: Integers  # (…) the wall that the estimate predicts, −1 where it predicts none
    # (…) rad between beam and wall, 0 along it, π/2 at right angles; nan where there is no wall
    incidence: Array
    # (…, 6, 3) the poses that were asked; the mean itself where there is none in that direction
    probes: Array
    probe_ranges: Array  # (…, 6) m from each of them, nan where the beam meets no wall
    probe_walls: Integers  # (…, 6) the walls met there, −1 where none is
    astray: Booleans  # (…, 6) it is another wall line than the mean's, or none

    @property
    def ambiguous(self) -> Booleans:
        """(…) from a pose about 3σ away the beam would meet another wall line, or none."""
        ambiguous: Booleans = np.asarray(self.astray.any(axis=-1))
        return ambiguous

    @property
    def grazing(self) -> Booleans:
        """(…) the beam meets its wall at less than 15°."""
        grazing: Booleans = self.incidence < GRAZING
        return grazing


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
        if direction.ndim == 1 and backend.used() == "numba":
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

    def sight(self, x: Array, P: Array) -> Sighting:
        """Look along the beam before using its reading. x : (…, 3), P : (…, 3, 3)

        The beam is cast again from the six poses x ± 3√λᵢ·vᵢ, λᵢ and vᵢ the eigenpairs of P (m and
        rad as they are). Where the robot cannot stand at such a pose, in an obstacle or outside the
        room, it is no evidence: it is drawn back along its arm to the last place where the robot
        can.
        """
        λ, V = np.linalg.eigh(P)
        if x.ndim == 1:
            return self._sight_one(x, λ.tolist(), V.T.tolist())
        reach = REACH * np.sqrt(np.where(λ > FLAT * λ[..., -1:], λ, 0.0))
        arms = (V * reach[..., None, :]).mT  # (…, 3, 3): a row for each eigenvector
        arms = np.concatenate([arms, -arms], axis=-2)
        share = self.walls.ground.reach(x[..., None, :2], arms[..., :2])
        probes = x[..., None, :] + share[..., None] * arms
        poses = np.concatenate([x[..., None, :], probes], axis=-2)
        direction = poses[..., 2] + self.bearing
        hit = self.walls.cast(poses[..., :2], direction)
        line, wall = self._line(hit.wall), hit.wall[..., 0]
        d = np.stack([np.cos(direction[..., 0]), np.sin(direction[..., 0])], axis=-1)
        sine = np.minimum(np.abs(np.vecdot(self._normal(wall), d)), 1.0)
        incidence = np.where(wall >= 0, np.arcsin(sine), np.nan)
        astray = line[..., 1:] != line[..., :1]
        return Sighting(wall, incidence, probes, hit.range[..., 1:], hit.wall[..., 1:], astray)

    def _sight_one(self, x: Array, λ: list[float], V: list[list[float]]) -> Sighting:
        """The same for one robot in plain floats: several times as fast, held equal to the above by
        a test.
        """
        first, bearing = self.walls.first, self.bearing
        px, py, θ = x.tolist()
        reaches = [REACH * math.sqrt(λ_i) if λ_i > FLAT * λ[2] else 0.0 for λ_i in λ]
        arms = [
            (reach * vx, reach * vy, reach * vθ)
            for sign in (1.0, -1.0)
            for reach, (vx, vy, vθ) in zip([sign * reach for reach in reaches], V, strict=True)
        ]
        shares = self.walls.ground.reach_of_each(px, py, arms)
        probes = [
            (px + t * dx, py + t * dy, θ + t * dθ)
            for t, (dx, dy, dθ) in zip(shares, arms, strict=True)
        ]
        wall = (here := first(px, py, θ + bearing))[1]
        hits = [
            first(x_i, y_i, θ_i + bearing) if any(arm) else here
            for (x_i, y_i, θ_i), arm in zip(probes, arms, strict=True)
        ]
        ranges, walls = zip(*hits, strict=True)
        incidence, line = math.nan, self.walls.line
        if wall >= 0:
            nx, ny = self.walls.normals[wall].tolist()
            incidence = math.asin(
                min(abs(nx * math.cos(θ + bearing) + ny * math.sin(θ + bearing)), 1.0)
            )
        astray = [
            other != wall and (wall < 0 or other < 0 or line[other] != line[wall])
            for other in walls
        ]
        return Sighting(
            np.array(wall),
            np.array(incidence),
            np.array(probes),
            np.array(ranges),
            np.array(walls),
            np.array(astray),
        )

    def _line(self, wall: Integers) -> Integers:
        """The straight line that each wall lies on, −1 where there is no wall."""
        return np.where(wall >= 0, self.walls.line[wall], -1) if len(self.walls.line) else wall

    def _normal(self, wall: Integers) -> Array:
        """Unit normals : (…, 2), zero where there is no wall."""
        if not len(self.walls.normals):
            return np.zeros((*wall.shape, 2))
        normals = back(front(self.walls.normals, 1)[:, wall], 1)
        normals[wall < 0] = 0.0
        return normals
