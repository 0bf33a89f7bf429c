"""Satellite fixes, on a plane that touches the earth."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ekfsim.files.keys.topics import OriginKeys
from ekfsim.files.maps.drawn.earth import on_plane

NO_FIX = -1  # status.status
UNKNOWN = 0  # position_covariance_type


@dataclass(frozen=True)
class Fixes:
    """The fixes that can be used, and what is to be told of them."""

    rows: list[
        tuple[int, float, float, str, str]
    ]  # ns, x, y in m, σ of x and of y, "" where unknown
    told: list[str]


def fixes_of(messages: Sequence[tuple[int, Any]], origin: OriginKeys | None) -> Fixes:
    """East and true north in m of the origin, or of the first fix. Left out: no fix, no number, and
    0° 0°, which is what programs write that know nothing.

    messages : (ns, NavSatFix)
    """
    told, kept = list[str](), list[tuple[int, Any]]()
    left_out = {"has no fix": 0, "has no number": 0, "is at 0°, 0°": 0}
    for t, fix in messages:
        if fix.status.status <= NO_FIX:
            left_out["has no fix"] += 1
        elif not math.isfinite(fix.latitude + fix.longitude):
            left_out["has no number"] += 1
        elif fix.latitude == fix.longitude == 0:
            left_out["is at 0°, 0°"] += 1
        else:
            kept.append((t, fix))
    told += [f"{n} of {len(messages)}: each {why}: left out" for why, n in left_out.items() if n]
    if not kept:
        return Fixes([], told)
    first = kept[0][1]
    lat, lon = (
        (first.latitude, first.longitude) if origin is None else (origin.latitude, origin.longitude)
    )
    degrees = np.array([(fix.longitude, fix.latitude) for _, fix in kept])
    xy = on_plane(degrees, (lon, lat))
    where = "the first fix" if origin is None else "recording.origin"
    told.append(
        f"x is m east and y m to true north (no grid's north) of {where}, latitude {lat:.9g}°, "
        f"longitude {lon:.9g}°; say otherwise with recording: {{origin: {{latitude: …, "
        "longitude: …}}"
    )
    sigmas = [_sigmas(fix) for _, fix in kept]
    if unknown := sum(each == ("", "") for each in sigmas):
        told.append(f"{unknown} of {len(kept)} tell no covariance: the sensor's own sigma counts")
    rows = [
        (t, x, y, *each) for (t, _), (x, y), each in zip(kept, xy.tolist(), sigmas, strict=True)
    ]
    return Fixes(rows, told)


def _sigmas(fix: Any) -> tuple[str, str]:
    """The standard deviations to the east and the north in m, "" where they are not known: zeros
    are no certainty.
    """
    east, north = float(fix.position_covariance[0]), float(fix.position_covariance[4])
    known = fix.position_covariance_type != UNKNOWN and east > 0 and north > 0
    if not known or not math.isfinite(east + north):
        return "", ""
    return repr(math.sqrt(east)), repr(math.sqrt(north))
