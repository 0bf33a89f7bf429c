"""Whether a beam could as well meet another wall: to be known before its reading is used."""

from dataclasses import dataclass

import numpy as np

from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.protocols import Sensor
from ekfsim.models.sensors.frozen import Frozen
from ekfsim.models.sensors.infrared import InfraredBeam
from ekfsim.models.sensors.laser import Laser
from ekfsim.models.sensors.mounted import Mounted, carried, carried_by
from ekfsim.models.sensors.ultrasonic import UltrasonicBeam
from ekfsim.records import Step
from ekfsim.twins import twinned

BeamSensor = Laser | UltrasonicBeam | InfraredBeam  # each looks along one beam, from the pose
# below this angle between beam and wall a small turn moves the beam's end far
GRAZING = np.radians(15.0)
REACH = 3.0  # standard deviations to the poses from which the beam is cast again
FLAT = 1e-10  # a variance below this share of the largest opens no direction to look in


@dataclass(frozen=True, slots=True)
class Sighting:
    """What is known of a beam before its reading is used. Arrays carry leading axes (…)."""

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


def remark(sensor: Sensor, x: Array, P: Array) -> Sighting | None:
    """What is to be said of a reading before it is used; None of a sensor that sends no beam."""
    if isinstance(sensor, Frozen):
        return remark(sensor.sensor, x, P)
    if isinstance(sensor, Mounted):
        pose, P_pose = sensor.layout.pose(x), sensor.layout.pose_covariance(P)
        J = carried_by(pose, sensor.mount)
        return remark(sensor.sensor, carried(pose, sensor.mount), J @ P_pose @ J.mT)
    return sighting(sensor, x, P) if isinstance(sensor, BeamSensor) else None


def sighting_of(step: Step) -> Sighting | None:
    """What is known of the beam of a step; None where there was none, or it was not asked."""
    return step.remark if isinstance(step.remark, Sighting) else None


@twinned
def sighting(beam: BeamSensor, x: Array, P: Array) -> Sighting:
    """Look along the beam from where the robot may stand. x : (…, 3), P : (…, 3, 3)

    The beam is cast again from the six poses x ± 3√λᵢ·vᵢ, λᵢ and vᵢ the eigenpairs of P (m and rad
    as they are). Where the robot cannot stand at such a pose, in an obstacle or outside the room,
    it is no evidence: it is drawn back along its arm to the last place where the robot can.
    """
    λ, V = np.linalg.eigh(P)
    reach = REACH * np.sqrt(np.where(λ > FLAT * λ[..., -1:], λ, 0.0))
    arms = (V * reach[..., None, :]).mT  # (…, 3, 3): a row for each eigenvector
    arms = np.concatenate([arms, -arms], axis=-2)
    share = beam.walls.ground.reach(x[..., None, :2], arms[..., :2])
    probes = x[..., None, :] + share[..., None] * arms

    poses = np.concatenate([x[..., None, :], probes], axis=-2)
    direction = poses[..., 2] + beam.bearing
    hit = beam.walls.cast(poses[..., :2], direction)
    line, wall = _line(beam, hit.wall), hit.wall[..., 0]
    d = np.stack([np.cos(direction[..., 0]), np.sin(direction[..., 0])], axis=-1)
    n = beam.walls.normal_at(wall, x[..., :2] + hit.range[..., :1] * d)
    sine = np.minimum(np.abs(np.vecdot(n, d)), 1.0)
    incidence = np.where(wall >= 0, np.arcsin(sine), np.nan)
    astray = line[..., 1:] != line[..., :1]
    return Sighting(wall, incidence, probes, hit.range[..., 1:], hit.wall[..., 1:], astray)


def _line(beam: BeamSensor, wall: Integers) -> Integers:
    """The straight line that each wall lies on, −1 where there is no wall."""
    return np.where(wall >= 0, beam.walls.line[wall], -1) if len(beam.walls.line) else wall
