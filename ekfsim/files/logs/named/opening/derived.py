"""Columns that other programs write otherwise: dates, latitude and longitude, quaternions."""

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import replace
from datetime import UTC, datetime

import numpy as np

from ekfsim.files.keys.recorded.topics import OriginKeys
from ekfsim.files.logs.named.tables import Table
from ekfsim.files.maps.drawn.earth import on_plane

DATE = re.compile(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d")
EARTH = ("latitude", "longitude")
PLANE = ("x", "y")
TURNED = ("qx", "qy", "qz", "qw")
UPRIGHT = ("qz", "qw")  # of a robot on level ground


def with_derived(table: Table, origin: OriginKeys | None, with_fixes: bool) -> Table:
    """The table with t where it has dates, θ where it has a quaternion and no heading, and x and y
    where it has latitude and longitude alone.

    origin : where (0, 0) is on the earth; the table's first place where absent
    Raises UsageError where what is needed for places on the earth is missing.
    """
    if (place := _place(table, "t")) is not None and _holds_dates(table, place):
        table = _with(table, ("t",), lambda row: [_date(row[place])])
    quaternion = TURNED if table.has(*TURNED) else UPRIGHT
    if table.has(*quaternion) and _place(table, "theta") is None:
        places = [table.places[table.known_as(name) or ""] for name in quaternion]
        table = _with(table, ("theta",), lambda row: [_heading([_number(row[p]) for p in places])])
    if with_fixes and table.has(*EARTH) and not table.has(*PLANE):
        table = _on_plane(table, origin)
    return table


def place_of_first(table: Table) -> OriginKeys | None:
    """Where a table is on the earth at first; None where it does not tell."""
    if not table.has(*EARTH):
        return None
    for lat, lon in _on_earth(table).tolist():
        if math.isfinite(lat):
            return OriginKeys(latitude=lat, longitude=lon)
    return None


def _on_earth(table: Table) -> np.ndarray[tuple[int, int], np.dtype[np.float64]]:
    """Latitude and longitude of each row : (n, 2) degrees, nan where a row tells none, or 0°, 0°,
    which is what programs write that know nothing.
    """
    places = [table.places[table.known_as(name) or ""] for name in EARTH]
    rows = (text.split(table.separator) for text in table.lines.texts)
    found = [
        [_number(row[p]) for p in places] if len(row) > max(places) else [math.nan] * 2
        for row in rows
    ]
    degrees = np.array(found, float).reshape(-1, 2)
    lat, lon = degrees.T
    known = np.isfinite(lat + lon) & (np.abs(lat) <= 90) & (np.abs(lon) <= 360)
    known &= (lat != 0) | (lon != 0)
    return np.where(known[:, None], degrees, math.nan)


def _on_plane(table: Table, origin: OriginKeys | None) -> Table:
    """The table with x to the east and y to true north of the origin."""
    origin = origin or place_of_first(table)
    if origin is None:
        return table
    degrees = _on_earth(table)
    if lost := int(np.isnan(degrees[:, 0]).sum()):
        count = f"{lost} of {len(degrees)} rows"
        why = "tell no place on the earth (nothing, 0°, 0°, or no such degrees): left out"
        table = replace(table, remarks=(*table.remarks, f"{table.file}: {count} {why}"))
    xy = on_plane(degrees[:, ::-1], (origin.longitude, origin.latitude))
    rows = iter(xy.tolist())
    return _with(table, PLANE, lambda row: [f"{one:.9f}" for one in next(rows)])


def _with(table: Table, names: Sequence[str], values: Callable[[list[str]], list[str]]) -> Table:
    """The table with more columns behind the others; a row that is too short stays so."""
    texts = []
    for text in table.lines.texts:
        row = text.rstrip().split(table.separator)
        more = values([*row, *[""] * (table.width - len(row))])
        texts.append((table.separator or " ").join([*row, *more]))
    places = {**table.places, **{name: table.width + n for n, name in enumerate(names)}}
    return replace(
        table,
        lines=replace(table.lines, texts=texts),
        width=table.width + len(names),
        places=places,
    )


def _place(table: Table, name: str) -> int | None:
    known = table.known_as(name)
    return None if known is None else table.places[known]


def _holds_dates(table: Table, place: int) -> bool:
    rows = (text.split(table.separator) for text in table.lines.texts[:1])
    return any(len(row) > place and DATE.match(row[place].strip()) for row in rows)


def _date(text: str) -> str:
    """A date as s since 1970, of universal time where it says no other; as it stands where it is
    none.
    """
    try:
        date = datetime.fromisoformat(text.strip())
    except ValueError:
        return text.strip() or "nan"
    return repr((date if date.tzinfo else date.replace(tzinfo=UTC)).timestamp())


def _number(text: str) -> float:
    try:
        return float(text.strip().replace(",", "."))
    except ValueError:
        return math.nan


def _heading(q: list[float]) -> str:
    """The heading of a quaternion x, y, z, w, or of z and w alone."""
    x, y, z, w = q if len(q) == 4 else (0.0, 0.0, *q)
    return repr(math.atan2(2 * (w * z + x * y), 1 - 2 * (y**2 + z**2)))
