"""Laser scans, thinned to the beams that the world names."""

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

from ekfsim.files.logs.bags.messages import SECOND
from ekfsim.systems.instruments import Ultrasonic

TURN = 2 * math.pi
ROUNDED = 1e-4  # rad, by which a scan's angles are off that are told in single precision
LONGEST = 1.0  # s that a turn of the scanner may last; more is no time between two beams


class Beams(NamedTuple):
    """The beams of some scans, and what is to be told of them."""

    rows: list[tuple[int, float, float]]  # ns, bearing in rad, range in m, inf without an echo
    told: list[str]


def beams_in(messages: Sequence[tuple[int, Any]], sensor: Ultrasonic) -> Beams:
    """The beams of a sensor as scans tell them, each at its own instant, and along the scanner's
    beam that is nearest; what lies beyond the sensor's reach is no echo, and what is nearer than it
    can see is left out.
    """
    rows, told = list[tuple[int, float, float]](), list[str]()
    far = near = 0
    seen = set[int]()
    for t, scan in messages:
        step = float(scan.time_increment)
        step = step if 0 < step * len(scan.ranges) <= LONGEST else 0.0
        for number, index, r in beams_of(scan, sensor.bearings):
            seen.add(number)
            bearing = sensor.bearings[number]
            aside = math.remainder(scan.angle_min + index * scan.angle_increment - bearing, TURN)
            if abs(aside) > ROUNDED:
                bearing = math.remainder(bearing + aside, TURN)
            if r < sensor.nearest:
                near += 1
                continue
            if sensor.farthest < r < math.inf:
                far, r = far + 1, math.inf
            rows.append((t + round(index * step * SECOND), bearing, r))
    key = f"--set sensors.{sensor.called}"
    if far:
        told.append(
            f"{far} of {len(rows)} beams met a wall beyond {sensor.farthest:g} m, as far as "
            f"{sensor.called} sees: no echo; say otherwise with {key}.range=…"
        )
    if near:
        told.append(
            f"{near} beams met a wall nearer than {sensor.nearest:g} m, from where on "
            f"{sensor.called} sees: left out; say otherwise with {key}.nearest=…"
        )
    if absent := [n for n in range(len(sensor.bearings)) if n not in seen and messages]:
        degrees = ", ".join(f"{math.degrees(sensor.bearings[n]):.4g}°" for n in absent)
        told.append(f"no scan tells of {sensor.called}'s beams at {degrees}")
    return Beams(rows, told)


def beams_of(scan: Any, bearings: Sequence[float]) -> list[tuple[int, int, float]]:
    """What a scan tells of each of some bearings (rad): the number of the bearing, that of the
    scan's beam, and the range in m, inf without an echo. Beams of which it tells nothing are left
    out: those that it does not have, too near ones, and those without a reading.

    Beam i points to angle_min + i · angle_increment; how many there are, only the ranges tell
    (angle_max is rounded). +inf is no echo, −inf too near, nan no reading (REP 117).
    """
    count, first, step = len(scan.ranges), float(scan.angle_min), float(scan.angle_increment)
    told = []
    for number, bearing in enumerate(bearings):
        # the beam nearest to the bearing, going the way round that the scanner goes
        steps = math.remainder(bearing - first, 2 * math.pi) / step if step else 0.0
        index = round(steps if steps > -0.5 else steps + 2 * math.pi / abs(step))
        if not 0 <= index < count or abs(
            math.remainder(first + index * step - bearing, 2 * math.pi)
        ) > 0.51 * abs(step):
            continue
        r = float(scan.ranges[index])
        if math.isnan(r) or r < scan.range_min:
            continue
        told.append((number, index, r if r <= scan.range_max else math.inf))
    return told
