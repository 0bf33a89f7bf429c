"""Longitude and latitude → metres about a place on the earth."""

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.geometry import Array
from ekfsim.late import found

FAR = 50_000.0  # m from the middle: no plan of a building or a town


def to_metres(degrees: Array) -> tuple[Array, tuple[float, float]]:
    """x east and y true north in m on the plane that touches the earth in the middle of some
    places, and that middle.

    degrees : (n, 2) longitude and latitude (WGS 84). Raises UsageError where pymap3d is missing.
    """
    low, high = degrees.min(axis=0), degrees.max(axis=0)
    lon, lat = ((low + high) / 2).tolist()
    return on_plane(degrees, (lon, lat)), (lon, lat)


def on_plane(degrees: Array, origin: tuple[float, float]) -> Array:
    """The same about a place of one's own : (n, 2) m. origin : its longitude and latitude"""
    try:
        geodetic2enu = found("pymap3d:geodetic2enu")
    except ImportError:
        raise UsageError(
            "longitude and latitude need the package 'pymap3d': pip install 'ekfsim[maps]'"
        ) from None
    lon, lat = origin
    x, y, _ = geodetic2enu(degrees[:, 1], degrees[:, 0], 0.0, lat, lon, 0.0)
    return np.column_stack([x, y])
