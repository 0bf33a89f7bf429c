"""Satellite fixes, on a plane that touches the earth."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ekfsim.files.maps.drawn.earth import on_plane

Place = tuple[float, float]  # latitude and longitude in degrees

FAR = 50e3  # m from the origin, 200 m below a plane that touches the earth there
NO_FIX = -1  # status.status
UNKNOWN = 0  # position_covariance_type


@dataclass(frozen=True)
class Fixes:
    """The fixes that can be used, and what is to be told of them."""

    rows: list[
        tuple[int, float, float, str, str]
    ]  # ns, x, y in m, σ of x and of y, "" where unknown
    told: list[str]


def lacking(fix: Any) -> str:
    """What a fix lacks that is none, as in "it …"; empty for one that counts."""
    if fix.status.status <= NO_FIX:
        return "has no fix"
    if not math.isfinite(fix.latitude + fix.longitude):
        return "has no number"
    if abs(fix.latitude) > 90 or abs(fix.longitude) > 360:
        return "is nowhere on the earth"
    return "is at 0°, 0°" if fix.latitude == fix.longitude == 0 else ""


def first_place(messages: Sequence[tuple[int, Any]]) -> Place | None:
    """Where the first fix is that counts, by its stamp; None where none does."""
    kept = [one for one in messages if not lacking(one[1])]
    if not kept:
        return None
    _, fix = min(kept, key=lambda one: one[0])
    return fix.latitude, fix.longitude


def fixes_of(messages: Sequence[tuple[int, Any]], origin: Place | None) -> Fixes:
    """East and true north in m of the origin, or of the first fix. Left out: no fix, no number, and
    0° 0°, which is what programs write that know nothing.

    messages : (ns, NavSatFix)
    origin : latitude and longitude in degrees
    """
    lacks = [lacking(fix) for _, fix in messages]
    kept = [one for one, lack in zip(messages, lacks, strict=True) if not lack]
    told = [
        f"{n} of {len(messages)}: each {why}: left out" for why, n in Counter(lacks).items() if why
    ]
    if not kept:
        return Fixes([], told)
    first = first_place(messages)
    assert first is not None
    lat, lon = origin or first
    degrees = np.array([(fix.longitude, fix.latitude) for _, fix in kept])
    xy = on_plane(degrees, (lon, lat))
    where = "the first fix" if origin in (None, first) else "the origin"
    told.append(
        f"x is m east and y m to true north (no grid's north) of {where}, latitude {lat:.9g}°, "
        f"longitude {lon:.9g}°; say otherwise with recording: {{origin: {{latitude: …, "
        "longitude: …}}"
    )
    if (farthest := float(np.hypot(*xy.T).max())) > FAR:
        told.append(
            f"a fix lies {farthest / 1000:.0f} km from there, where a plane is no map of the earth "
            "any more: name an origin near the drive"
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
