"""Robots side by side that are driven, tick by tick, in arrays that are made once."""

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.simulation.driver import Gains


def driven(here: Array, asked: Array, noise: Array, gains: Gains, dt: float) -> Array | None:
    """x, y, θ, way and turn before each tick and after the last : (T + 1, N, 5). None of one
    robot.
    """
    if here.ndim != 2:
        return None
    rows = np.empty((len(asked) + 1, 5, len(here)))
    rows[0] = here.T
    ahead, to, parts = np.empty((3, 2, len(here)))  # cos and sin, a way, products of the two
    middle, sizes = np.empty(len(here)), np.empty(2 * len(here))
    along, across, around = gains
    orders = np.column_stack([asked[:, :3], wrap(asked[:, 5])]).tolist()
    places, noises = asked[:, 3:5, None], np.moveaxis(noise, -1, 1)
    steps = zip(rows[:-1], rows[1:], orders, places, noises, strict=True)
    for before, after, (speed, rate, sign, to_θ), place, disturbed in steps:
        θ, way, turn = before[2:]
        next_θ, next_way, next_turn = after[2:]
        np.multiply(turn, 0.5, out=middle)
        middle += θ
        np.cos(middle, out=ahead[0])
        np.sin(middle, out=ahead[1])
        ahead *= way
        np.add(before[:2], ahead, out=after[:2])
        np.add(θ, turn, out=next_θ)
        after[:3] += disturbed
        missing = np.subtract(to_θ, next_θ, out=next_way)  # stands there until it is used
        np.abs(after[2:4].reshape(-1), out=sizes)
        if np.maximum.reduce(sizes) >= np.pi:
            _wrap(next_θ)
            np.subtract(to_θ, next_θ, out=missing)
            _wrap(missing)
        missing *= around
        np.subtract(place, after[:2], out=to)
        np.cos(next_θ, out=ahead[0])
        np.sin(next_θ, out=ahead[1])
        np.multiply(ahead, to[::-1], out=parts)
        np.subtract(parts[0], parts[1], out=next_turn)
        next_turn *= sign * across
        next_turn += rate
        next_turn += missing
        np.multiply(ahead, to, out=parts)
        np.add(parts[0], parts[1], out=next_way)
        next_way *= along
        next_way += speed
        after[3:] *= dt
    return np.moveaxis(rows, 1, -1)


def _wrap(angle: Array) -> None:
    """The same directions in (−π, π], in place; most are less than a turn away from 0."""
    if np.maximum.reduce(np.abs(angle)) < 2 * np.pi:
        np.subtract(angle, 2 * np.pi, out=angle, where=angle > np.pi)
        np.add(angle, 2 * np.pi, out=angle, where=angle <= -np.pi)
    else:
        angle[:] = wrap(angle)
