"""A world of Python's values, with all the checks of a world file."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from ekfsim.files.given.given import Given
from ekfsim.files.keys.worlds.world import NoiseKeys
from ekfsim.floor import Obstacle, RoundObstacle, WallLine
from ekfsim.world import Noise, World

OF = "World.of"  # how messages name what was handed over
POSE = ("x", "y", "theta")


def world_of(told: Mapping[str, Any]) -> World:
    """The world that a file of these keys would hold; None is a key that is left out.

    Raises InputError with all mistakes, each with the path of its key.
    """
    from ekfsim.files.scenes.load import read_world

    values = as_in_a_file(told)
    if (sigma := values.pop("sigma", None)) is not None:
        start = values.get("start")
        values["start"] = {**start, "sigma": sigma} if isinstance(start, Mapping) else start
    if isinstance(belief := values.get("belief"), Mapping):
        values["belief"] = as_in_a_file(belief)
    return read_world(Given.values(values, OF)).get()


def as_in_a_file(told: Mapping[str, Any]) -> dict[str, Any]:
    """The keys of a world as a file has them, where Python has a shorter way to say it."""
    return {key: _as_in_a_file(key, value) for key, value in told.items() if value is not None}


def _as_in_a_file(key: str, value: Any) -> Any:
    if isinstance(value, np.ndarray):
        value = value.tolist()
    match key, value:
        case (("start" | "sigma"), (list() | tuple())) if len(value) == len(POSE):
            return dict(zip(POSE, value, strict=True))
        case "obstacles", Mapping():
            return [
                {"name": name, **(shape if isinstance(shape, Mapping) else {"points": shape})}
                for name, shape in value.items()
            ]
        case "walls", Mapping():
            return [{"name": name, "points": points} for name, points in value.items()]
        case (("obstacles" | "walls"), list() | tuple()):
            return [_shape(one) for one in value]
        case "noise", Noise():
            aliases = {name: field.alias for name, field in NoiseKeys.model_fields.items()}
            return {alias: getattr(value, name) for name, alias in aliases.items()}
    return value


def _shape(one: Any) -> Any:
    match one:
        case Obstacle() | WallLine():
            return {"name": one.name, "points": one.points}
        case RoundObstacle():
            x, y = one.centre.tolist()
            return {"name": one.name, "circle": {"x": x, "y": y, "radius": one.radius}}
    return one
