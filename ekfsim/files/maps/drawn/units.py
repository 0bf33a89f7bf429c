"""What one of a drawing's coordinates is, and the metres that it makes."""

from collections.abc import Callable

import numpy as np

from ekfsim.errors import UsageError
from ekfsim.files.maps.drawn.earth import FAR, to_metres
from ekfsim.files.maps.plan import METRES, Units
from ekfsim.geometry import Array

TINY = 0.05  # m across: no plan
Place = Callable[[Array], Array]  # (n, 2) as drawn → (n, 2) m


def places(points: Array, units: Units, shown: str, told: list[str]) -> Place:
    """How the coordinates of a drawing become metres. points : (n, 2), all that are drawn

    Raises UsageError where they cannot be in these units.
    """
    if units != "degrees":
        scale = METRES[units]
        return lambda drawn: drawn * scale
    if not len(points):
        return lambda drawn: drawn
    x, y = np.abs(points).max(axis=0).tolist()
    if x > 180 or y > 90:
        raise UsageError(
            f"{shown}: {x:g}, {y:g} is no longitude and latitude; --units m says that these are "
            "metres"
        )
    metres, (lon, lat) = to_metres(points)
    across = float(np.hypot(*metres.T).max())
    if across > FAR:
        raise UsageError(
            f"{shown}: read as longitude and latitude the plan is {2 * across / 1000:.0f} km "
            "across; --units m says that these are metres"
        )
    told.append(
        f"longitude and latitude became metres about ({lon:.7f}, {lat:.7f}): x is east, y is true "
        "north (otherwise: --units m)"
    )
    lookup = dict(zip(map(tuple, points.tolist()), metres, strict=True))
    return lambda drawn: np.array([lookup[tuple(one)] for one in drawn.tolist()]).reshape(-1, 2)
