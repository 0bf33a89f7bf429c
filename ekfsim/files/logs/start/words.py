"""The line that says where a filter was let begin, and how to say otherwise."""

import math
from collections.abc import Sequence

import numpy as np

from ekfsim.files.given.given import called
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array
from ekfsim.models.layout import Layout
from ekfsim.world import NOTHING_SAID, World

AXES = ("x", "y", "theta")
START = "--set start.x=… (y, theta)"
SIGMA = "--set belief.sigma.x=… (y, theta)"


def assumed(world: World, first: Gaussian) -> str:
    """Of a filter that begins where the world's file says, or somebody by `belief.start`."""
    said, how = world.told.start_said, sure(world.layout, first.covariance)
    place = where(world.layout.pose(first.mean))
    if all(said):
        return f"starts at {place} as told, to within {how}"
    rest = "the start" if said == NOTHING_SAID else f"{_listed(said)} as told, the rest the start"
    taken = f"taken is {place}, {rest} of {called(world)}"
    return f"no truth tells where it starts: {taken}, to within {how}"


def at_fix(world: World, first: Gaussian, t: float, course: str) -> str:
    """Of a filter that begins at its first fix, with what tells its heading."""
    pose, how = world.layout.pose(first.mean), sure(world.layout, first.covariance)
    return f"starts at {t:.12g} s, at its first fix: {where(pose)} to within {how}, {course}"


def otherwise(world: World) -> str:
    """How to say otherwise: what nobody has said yet."""
    start, sigma = all(world.told.start_said), all(world.sigma_said)
    ways = [*([] if start else [START]), *([] if sigma else [SIGMA])]
    return f"; say otherwise with {' and '.join(ways)}" if ways else ""


def where(pose: Array) -> str:
    """x and y in m, θ in degrees.

    >>> where(np.array([4.0, 2.25, 0.0])), where(np.array([388096.12345, 0.1, math.pi / 2]))
    ('(4, 2.25, 0°)', '(388096.123, 0.1, 90°)')
    """
    x, y, θ = pose.tolist()
    return f"({_short(x, 3)}, {_short(y, 3)}, {_short(math.degrees(θ), 2)}°)"


def sure(layout: Layout, P: Array) -> str:
    """The standard deviations of a pose."""
    x, y, θ = np.sqrt(np.diag(layout.pose_covariance(P))).tolist()
    at = f"{x:.3g} m" if x == y else f"{x:.3g} m, {y:.3g} m"
    return f"{at} and {math.degrees(θ):.3g}°"


def _short(value: float, digits: int) -> str:
    return f"{round(value, digits) + 0.0:.{digits}f}".rstrip("0").rstrip(".")


def _listed(said: Sequence[bool]) -> str:
    return " and ".join(axis for axis, told in zip(AXES, said, strict=True) if told)
