"""What a picture shows of a reading: lines and marks about the estimate, and words.

What more is to be said of a beam to a wall, `views.beams` tells.
"""

import math
from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from ekfsim.diagnostics.ambiguity import BeamSensor
from ekfsim.filters.belief import Refused, posed
from ekfsim.geometry import Array
from ekfsim.models.protocols import Quantity, Sensor
from ekfsim.models.sensors.infrared import InfraredBeam
from ekfsim.models.sensors.mounted import bare, place_of
from ekfsim.records import Reading, Step
from ekfsim.scene import Scene

if TYPE_CHECKING:
    from ekfsim.models.sensors.position import Position

# to each side of the estimate: as much of the circle about a landmark as is drawn
ARC = math.radians(25)
CORNERS = 41  # of an arc, and of the circle about a fix
NEEDLE = 1.0  # m, of a heading
FARTHEST = 5.0  # times as far as it is specified for may an intensity seem to come from
NOWHERE = np.empty((0, 2))


@dataclass(frozen=True, slots=True)
class Sight:
    """A reading as it is drawn, from the estimate before the update.
    All in m; empty where there is nothing to draw.
    """

    line: Array  # (n, 2) as measured: a ray, an arc about a landmark, the circle of 1 σ about a fix
    end: Array  # (n ≤ 1, 2) where the reading puts the landmark, the wall or the robot
    way: Array  # (n, 2) as it was expected
    expected: Array  # (n ≤ 1, 2) where it was expected to end
    place: Array  # (n ≤ 1, 2) the landmark that it is of
    refused: Refused
    word: str  # what it is: "beam", "direction", …

    @property
    def fix(self) -> bool:
        """Whether its end is the robot's place rather than a landmark's."""
        return self.word == "fix"


def sight(step: Step) -> Sight | None:
    """What is drawn of a reading; None where there is none."""
    given, correction = step.entry.given, step.correction
    if not isinstance(given, Reading) or correction is None:
        return None
    pose = place_of(given.sensor, posed(step.prior, step.layout).mean)
    z, predicted = given.z, correction.predicted
    refused, sensor = Refused(int(correction.refused)), bare(given.sensor)
    if isinstance(sensor, BeamSensor):
        line, way = (
            _ray(pose, sensor.bearing, beam_length(sensor, float(value[0])))
            for value in (z, predicted)
        )
        return Sight(line, line[1:], way, way[1:], NOWHERE, refused, "beam")
    return _without_beam(sensor, pose, z, predicted, refused)


def _without_beam(
    sensor: Sensor, pose: Array, z: Array, predicted: Array, refused: Refused
) -> Sight | None:
    """What is drawn of any other sensor; these are imported where one of them is read."""
    from ekfsim.models.sensors.landmarks import BearingOnly, MarkerAngles, RangeBearing, RangeOnly
    from ekfsim.models.sensors.lidar import LidarOffset
    from ekfsim.models.sensors.offset import LandmarkOffset
    from ekfsim.models.sensors.position import Position
    from ekfsim.models.sensors.yaw import Yaw

    match sensor:
        case MarkerAngles() | BearingOnly():
            place = np.array([sensor.x, sensor.y])
            line, way = (
                _ray(pose, value[0], math.dist(place, pose[:2])) for value in (z, predicted)
            )
            return Sight(line, NOWHERE, way, NOWHERE, place[None], refused, "direction")
        case RangeBearing():
            line, way = _ray(pose, z[1], z[0]), _ray(pose, predicted[1], predicted[0])
            return Sight(
                line, line[1:], way, way[1:], np.array([[sensor.x, sensor.y]]), refused, "landmark"
            )
        case RangeOnly():
            return _about(
                np.array([sensor.x, sensor.y]), pose, float(z[0]), float(predicted[0]), refused
            )
        case Position():
            return _fix(sensor, z, predicted, refused)
        case LandmarkOffset():
            line, way = (
                _finite(np.stack([pose[:2], pose[:2] + offset])) for offset in (z, predicted)
            )
            return Sight(
                line, line[1:], way, way[1:], np.array([[sensor.x, sensor.y]]), refused, "offset"
            )
        case LidarOffset():
            line, way = (_ray(pose, math.atan2(-x, y), math.hypot(x, y)) for x, y in (z, predicted))
            return Sight(
                line, line[1:], way, way[1:], np.array([[sensor.x, sensor.y]]), refused, "offset"
            )
        case Yaw():
            line, way = (
                _ray(pose, value[0] - sensor.orientation - pose[2], NEEDLE)
                for value in (z, predicted)
            )
            return Sight(line, NOWHERE, way, NOWHERE, NOWHERE, refused, "direction")
    return None


def beam_length(sensor: BeamSensor, z: float) -> float:
    """The distance to a wall that a reading stands for, in m;
    an intensity falls with its logarithm.
    """
    if not isinstance(sensor, InfraredBeam):
        return z
    logarithm = (sensor.offset - z / sensor.reflectance) / sensor.gain
    return math.exp(min(logarithm, math.log(FARTHEST * sensor.farthest)))


def kinds(scene: Scene) -> set[type[Sensor]]:
    """The kinds of sensors whose readings a driven or recorded run may hold."""
    if scene.log is not None:
        return {
            type(bare(e.given.sensor)) for e in scene.log.entries if isinstance(e.given, Reading)
        }
    return {type(bare(target.sensor)) for _, target in scene.world.targets(scene.reading)}


def told(values: Iterable[float], outputs: tuple[Quantity, ...], named: bool = True) -> str:
    """A reading as people say it, with or without the names of its numbers.

    >>> told([0.5, -0.02], (Quantity("azimuth", "rad"), Quantity("elevation", "rad")))
    'azimuth 28.6°, elevation −1.15°'
    >>> range_alone = (Quantity("range", "m"),)
    >>> told([1.25], range_alone), told([math.nan], range_alone, named=False)
    ('range 1.25 m', 'nothing')
    """
    numbers = [in_units(value, output.unit) for value, output in zip(values, outputs, strict=True)]
    if named:
        numbers = [
            f"{output.name} {number}" for output, number in zip(outputs, numbers, strict=True)
        ]
    return ", ".join(numbers)


def seconds(t: float) -> str:
    """An instant with two digits behind the point, three where it has them.

    >>> seconds(14.0), seconds(0.005), seconds(-0.25)
    ('14.00', '0.005', '−0.25')
    """
    text = f"{t:.3f}"
    return (text[:-1] if text.endswith("0") else text).replace("-", "−")


def instants(first: float, last: float) -> str:
    """What a view covers, in s.

    >>> instants(14.0, 14.0), instants(12.01, 14.0), instants(0.105, 0.2)
    ('14.00', '12.01–14.00', '0.105–0.200')
    """
    begin, end = seconds(first), seconds(last)
    if first == last:
        return end
    digits = max(len(begin.partition(".")[2]), len(end.partition(".")[2]))
    return f"{first:.{digits}f}–{last:.{digits}f}".replace("-", "−")


def in_units(value: float, unit: str) -> str:
    """A number with its unit: degrees for rad.

    >>> in_units(-math.pi / 4, "rad"), in_units(-12.3456, "m"), in_units(0.5, "V")
    ('−45°', '−12.346 m', '0.5 V')
    """
    if math.isnan(value):
        return "nothing"
    if unit == "rad":
        return f"{_plain(float(f'{math.degrees(value):.3g}'))}°"
    return f"{_plain(round(value, 3))} {unit}".rstrip()


def _plain(value: float) -> str:
    return f"{value + 0.0:.10g}".replace("-", "−")


def _ray(pose: Array, bearing: float, length: float) -> Array:
    """From a pose along a bearing : (2, 2) m, empty where one of them is no number"""
    angle = pose[2] + bearing
    return _finite(
        np.stack([pose[:2], pose[:2] + length * np.array([np.cos(angle), np.sin(angle)])])
    )


def _about(place: Array, pose: Array, measured: float, predicted: float, refused: Refused) -> Sight:
    """Where a range says that the robot is:
    on a circle about the landmark, drawn where the estimate is.
    """
    east, north = pose[:2] - place
    towards = math.atan2(north, east)
    around = towards + np.linspace(-ARC, ARC, CORNERS)
    arc = _finite(place + measured * np.stack([np.cos(around), np.sin(around)], axis=-1))
    way = _ray(np.array([*place, towards]), 0.0, predicted)
    return Sight(arc, NOWHERE, way, way[1:], place[None], refused, "range")


def _fix(sensor: "Position", z: Array, predicted: Array, refused: Refused) -> Sight:
    """A fix with a circle of 1 σ, and the way from it to where it was expected."""
    turn = np.linspace(0, 2 * math.pi, CORNERS)
    circle = _finite(
        z
        + np.array([sensor.sigma_x, sensor.sigma_y])
        * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    )
    way = _finite(np.stack([z, predicted]))
    return Sight(circle, _finite(z[None]), way, way[1:], NOWHERE, refused, "fix")


def _finite(points: Array) -> Array:
    """The points, or none of them where one is no number."""
    return points if np.isfinite(points).all() else NOWHERE
