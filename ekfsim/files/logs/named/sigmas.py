"""How sure a reading is, where its row tells."""

from dataclasses import replace
from typing import Any

import numpy as np

from ekfsim.files.logs.named.tables import SQUARED, Table
from ekfsim.files.logs.table import Rows
from ekfsim.geometry import Array
from ekfsim.models.protocols import Sensor
from ekfsim.models.sensors.infrared import InfraredBeam
from ekfsim.models.sensors.landmarks import BearingOnly, MarkerAngles, RangeBearing, RangeOnly
from ekfsim.models.sensors.lidar import LidarOffset
from ekfsim.models.sensors.mounted import Mounted
from ekfsim.models.sensors.position import Position
from ekfsim.models.sensors.ultrasonic import UltrasonicBeam
from ekfsim.models.sensors.yaw import Yaw

SIGMA = "sigma"
# of a sensor, the fields that hold the standard deviation of each number that it reads
FIELDS: dict[type[Sensor], tuple[str, ...]] = {
    Position: ("sigma_x", "sigma_y"),
    RangeBearing: ("range_sigma", "bearing_sigma"),
    MarkerAngles: ("azimuth_sigma", "elevation_sigma"),
    RangeOnly: ("sigma",),
    BearingOnly: ("sigma",),
    Yaw: ("sigma",),
    UltrasonicBeam: ("sigma",),
    InfraredBeam: ("sigma",),
    LidarOffset: ("sigma", "sigma"),
}


def columns_of_sigmas(table: Table, columns: tuple[str, ...]) -> tuple[str, ...]:
    """The columns of a table that tell how sure these are, for each the one that is its own."""
    found = []
    for column in columns:
        own = (f"{kind}_{column}" for kind in (SIGMA, SQUARED))
        found += [name for name in (*own, SIGMA, SQUARED) if table.has(name)][:1]
    return tuple(dict.fromkeys(found))


def sigmas_of(
    columns: tuple[str, ...], told: tuple[str, ...], rows: Rows, warnings: list[str]
) -> Array:
    """The standard deviation of each number of each row : (n, k), nan where none is told: 0 is no
    certainty, but what programs write that do not know.
    told : the columns, the last of each row
    """
    σ = np.full((len(rows), len(columns)), np.nan)
    for place, name in enumerate(told, start=rows.values.shape[1] - len(told)):
        kind, _, one = name.partition("_")
        values = rows.values[:, place]
        values = np.where(values > 0, values, np.nan)
        values = np.sqrt(values) if kind == SQUARED else values
        for column in range(len(columns)):
            if one in ("", columns[column]):
                σ[:, column] = values
        if zero := int(np.sum(~(rows.values[:, place] > 0))):
            row = int(np.argmin(rows.values[:, place] > 0))
            more = f", and so in {zero - 1} more rows" if zero > 1 else ""
            warnings.append(
                f"{rows.at(row)}: {name} is not above 0{more}: unknown, and the sensor's own counts"
            )
    return σ


def as_sure(sensor: Sensor, σ: Array) -> Sensor:
    """A sensor with these standard deviations, its own where one is nan. σ : (k,)"""
    if isinstance(sensor, Mounted):
        return replace(sensor, sensor=as_sure(sensor.sensor, σ))
    fields = FIELDS.get(type(sensor))
    if fields is None or np.isnan(σ).all():
        return sensor
    told: dict[str, Any] = {
        field: one for field, one in zip(fields, σ.tolist(), strict=True) if not np.isnan(one)
    }
    if isinstance(sensor, UltrasonicBeam):
        told["sigma_per_metre"] = 0.0
    changed: Sensor = replace(sensor, **told)  # type: ignore[type-var]
    return changed
