"""What a filter of document 000 may be told of one and the same sight of a marker."""

from dataclasses import replace

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.sensors.landmarks import MarkerAngles
from ekfsim.records import Reading
from ekfsim.systems.document import DocumentReading

IDEAL_SIGMA = 1e-6  # rad, eq. 31: R = 1e-12 I


def as_told_by(reading: DocumentReading, given: Reading) -> Reading:
    """The same angles, their sensor with the derivatives of a reading of the document."""
    if not isinstance(given.sensor, MarkerAngles):
        return given
    sensor = replace(given.sensor, elevation_sign=-1.0 if reading == "printed" else 1.0)
    return replace(given, sensor=sensor)


def with_angles_of(truth: Array, given: Reading) -> Reading:
    """The angles of the true pose (…, 3) as if cameras did not err,
    and R = 1e-12 I. eq. 31
    """
    if not isinstance(given.sensor, MarkerAngles):
        return given
    sensor = replace(given.sensor, azimuth_sigma=IDEAL_SIGMA, elevation_sigma=IDEAL_SIGMA)
    return replace(given, sensor=sensor, z=np.where(np.isnan(given.z), np.nan, sensor.h(truth)))
