"""One robot that is driven, tick by tick in plain floats."""

import math

import numpy as np

from ekfsim.fast.one.geometry.angles import wrap_one
from ekfsim.geometry import Array
from ekfsim.simulation.driver import Gains


def driven(here: Array, asked: Array, noise: Array, gains: Gains, dt: float) -> Array | None:
    """x, y, θ, way and turn before each tick and after the last : (T + 1, 5). None of many
    robots.
    """
    if here.ndim > 1:
        return None
    cos, sin, π = math.cos, math.sin, math.pi
    along, across, around = gains
    x, y, θ, distance, turn = here.tolist()
    rows = [(x, y, θ, distance, turn)]
    for (speed, rate, sign, to_x, to_y, to_θ), (ex, ey, eθ) in zip(
        asked.tolist(), noise.tolist(), strict=True
    ):
        middle = θ + turn / 2
        x, y = x + distance * cos(middle) + ex, y + distance * sin(middle) + ey
        θ = θ + turn + eθ
        if not -π < θ <= π:
            θ = wrap_one(θ)
        missing = to_θ - θ
        if not -π < missing <= π:
            missing = wrap_one(missing)
        dx, dy, c, s = to_x - x, to_y - y, cos(θ), sin(θ)
        distance = (speed + along * (c * dx + s * dy)) * dt
        turn = (rate + sign * across * (c * dy - s * dx) + around * missing) * dt
        rows.append((x, y, θ, distance, turn))
    return np.array(rows)
