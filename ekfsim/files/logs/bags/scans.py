"""Laser scans, thinned to the beams that the world names."""

import math
from collections.abc import Sequence
from typing import Any


def beams_of(scan: Any, bearings: Sequence[float]) -> list[tuple[int, float]]:
    """What a scan tells of each of some bearings (rad): the number of the bearing and the range in
    m, inf without an echo. Beams of which it tells nothing are left out: those that it does not
    have, too near ones, and those without a reading.

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
        told.append((number, r if r <= scan.range_max else math.inf))
    return told
