"""The map that the filter is told, made true: obstacle by obstacle, and wall by wall where the
corners of a room differ.
"""

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import numpy as np

from ekfsim.floor import Map, Obstacle, RoundObstacle, WallLine
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.raycast.walls import BOUNDARY
from ekfsim.why.changes.told import told_change
from ekfsim.why.records import Change
from ekfsim.world import World

Thing = Obstacle | RoundObstacle | WallLine
SAME = 1e-9  # m, rad
LEANING = 0.005  # rad; walls of a told map that are turned by more lean
ALIKE = 0.5  # the least of them is turned by this share of the most


def map_changes(world: World) -> list[Change]:
    """Everything in which the told map differs from the true one, each by itself."""
    told, true = world.told.map, world.map
    if told is true:
        return []
    return [*_boundary(told, true), *_things(told, true)]


def leans(world: World) -> bool:
    """Whether several walls of the told map are turned alike, so that it leans as a whole."""
    told, true = dict(world.told.map.rings()), dict(world.map.rings())
    turned = np.concatenate(
        [np.empty(0)]
        + [
            _turns(told[name], true[name])
            for name in told
            if name in true and told[name].shape == true[name].shape
        ]
    )
    turned = turned[np.abs(turned) > LEANING]
    size = np.abs(turned)
    alike = size.size > 1 and (np.sign(turned) == np.sign(turned[0])).all()
    return bool(alike and size.min() >= ALIKE * size.max())


def _turns(told: Array, true: Array) -> Array:
    """By how much each edge of a ring is turned : (n,) rad"""
    ways = [np.roll(ring, -1, axis=0) - ring for ring in (told, true)]
    one, other = (np.arctan2(way[:, 1], way[:, 0]) for way in ways)
    return np.asarray(wrap(one - other))


def _boundary(told: Map, true: Map) -> Iterator[Change]:
    """Each wall of the room that lies elsewhere than it is told, or the whole rim where it has
    other corners.
    """
    one, other = told.boundary, true.boundary
    if one is None or other is None or one.shape != other.shape:
        if one is not other:
            text = "other corners told" if one is not None and other is not None else "not told"
            yield told_change(
                "map", "the boundary of the map", text,
                lambda w: replace(w.told, map=replace(w.told.map, boundary=w.map.boundary)),
            )  # fmt: skip
        return
    for edge in range(len(one)):
        if far := _beside(one, other, edge):
            yield _wall(edge, far)


def _beside(told: Array, true: Array, edge: int) -> float:
    """How far the ends of a told wall lie beside the true one's line, in m; 0 where on it."""
    a, b = true[edge], true[(edge + 1) % len(true)]
    ends = told[[edge, (edge + 1) % len(told)]]
    along = (b - a) / max(float(np.hypot(*(b - a))), SAME)
    off = np.abs((ends - a) @ np.array([-along[1], along[0]])).max()
    return float(off) if off > SAME else 0.0


def _wall(edge: int, far: float) -> Change:
    def right(world: World) -> Map:
        told, true = world.told.map.boundary, world.map.boundary
        assert told is not None
        assert true is not None
        corners = told.copy()
        both = [edge, (edge + 1) % len(corners)]
        corners[both] = true[both]
        return replace(world.told.map, boundary=corners)

    return told_change(
        "map", f"edge {edge} of {BOUNDARY} in the map", f"{far:.3g} m off",
        lambda w: replace(w.told, map=right(w)),
    )  # fmt: skip


def _things(told: Map, true: Map) -> Iterator[Change]:
    """Each obstacle and each wall that stands free: moved, missing in the map, or there alone."""
    for field in ("obstacles", "lines"):
        ones: dict[str, Thing] = {one.name: one for one in getattr(told, field)}
        others: dict[str, Thing] = {one.name: one for one in getattr(true, field)}
        for name in dict.fromkeys((*others, *ones)):
            one, other = ones.get(name), others.get(name)
            if one is None or other is None or not _same(one, other):
                yield _thing(field, name, _said(one, other))


def _said(told: Thing | None, true: Thing | None) -> str:
    """In what an obstacle differs."""
    if told is None or true is None:
        return "missing in the map" if told is None else "in the map alone"
    far = float(np.hypot(*(_middle(told) - _middle(true))))
    return f"{far:.3g} m off" if far > SAME else "of another shape"


def _thing(field: str, name: str, text: str) -> Change:
    def right(world: World) -> Map:
        ones = {one.name: one for one in getattr(world.told.map, field)}
        true = {one.name: one for one in getattr(world.map, field)}
        ones = {**ones, name: true[name]} if name in true else _without(ones, name)
        kept: Any = tuple(ones.values())
        return replace(world.told.map, **{field: kept})

    return told_change("map", f"{name} in the map", text, lambda w: replace(w.told, map=right(w)))


def _without(things: dict[str, Thing], name: str) -> dict[str, Thing]:
    return {key: one for key, one in things.items() if key != name}


def _same(one: Thing, other: Thing) -> bool:
    """Whether two obstacles have the same walls."""
    if isinstance(one, RoundObstacle) or isinstance(other, RoundObstacle):
        return (
            isinstance(one, RoundObstacle)
            and isinstance(other, RoundObstacle)
            and one.radius == other.radius
            and bool((one.centre == other.centre).all())
        )
    return one.points.shape == other.points.shape and bool((one.points == other.points).all())


def _middle(one: Thing) -> Array:
    if isinstance(one, RoundObstacle):
        return one.centre
    middle: Array = one.points.mean(axis=0)
    return middle
