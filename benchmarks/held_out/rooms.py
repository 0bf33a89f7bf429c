"""Rooms that no packaged world has, and routes through them."""

import math
from dataclasses import replace

import numpy as np

from ekfsim import load_world
from ekfsim.commands import Command, Move, Repeat, Sense
from ekfsim.floor import Map
from ekfsim.world import Noise, World

NOISE = Noise(0.02, 0.02, 0.01, 0.02, 0.02)
SQUARELY = (0.0, 90.0, 180.0, -90.0)
SIX = (0.0, 60.0, 120.0, 180.0, -120.0, -60.0)
Points = list[tuple[float, float]]

PARLOUR: Points = [(0, 0), (9, 0), (9, 7), (0, 7)]
STUDIO: Points = [(0, 0), (7, 0), (7, 7), (0, 7)]
GALLERY: Points = [(0, 0), (14, 0), (14, 5), (0, 5)]
BARN: Points = [(0, 0), (20, 0), (20, 14), (0, 14)]
HANGAR: Points = [(0, 0), (60, 0), (60, 50), (0, 50)]
TENT: Points = [(3, 0), (9, 0), (12, 5), (9, 10), (3, 10), (0, 5)]  # of six sides
TRAPEZE: Points = [(0, 0), (10, 0), (8, 6), (1, 6)]
BENT: Points = [(0, 0), (10, 0), (10, 4), (5, 4), (5, 9), (0, 9)]  # of the shape of an L
TEE: Points = [(0, 5), (4, 5), (4, 0), (8, 0), (8, 5), (12, 5), (12, 9), (0, 9)]
PASSAGE: Points = [(0, 0), (50, 0), (50, 2.4), (0, 2.4)]


def box(x: float, y: float, wide: float, high: float) -> Points:
    """A rectangle by its lower left corner."""
    return [(x, y), (x + wide, y), (x + wide, y + high), (x, y + high)]


def room(
    boundary: Points,
    start: tuple[float, float, float],
    obstacles: dict[str, Points] | None = None,
    noise: Noise = NOISE,
    sigma: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> World:
    """A world of which the filter is told the truth. start, sigma : m, m, degrees"""
    return World.of(boundary=boundary, start=start, obstacles=obstacles, noise=noise, sigma=sigma)


def packaged(name: str, start: tuple[float, float, float]) -> World:
    """A packaged room with a start of one's own, in m, m, degrees."""
    world = load_world(name)
    pose = np.array([*start[:2], math.radians(start[2])])
    return replace(world, start=pose, told=replace(world.told, start=pose))


def move(distance: float, turn: float = 0.0, slip: float = 0.0) -> Move:
    """Ahead by so many m, then a turn by so many degrees."""
    return Move(distance, math.radians(turn), slip)


def look(*bearings: float) -> list[Command]:
    """Beams to these sides, in degrees."""
    return [Sense(math.radians(bearing)) for bearing in bearings]


def lap(*sides: float, parts: int = 2, beams: tuple[float, ...] = SQUARELY) -> list[Command]:
    """Round a rectangle to the left, its sides in m, with a look round after each part of one."""
    done: list[Command] = []
    for side in sides:
        for part in range(parts):
            done += [move(side / parts, 90 if part == parts - 1 else 0), *look(*beams)]
    return done


def shuttle(
    step: float, times: int = 2, beams: tuple[float, ...] = SQUARELY, steps: int = 2
) -> list[Command]:
    """To and fro on one line, never turning."""
    there = [one for _ in range(steps) for one in (move(step), *look(*beams))]
    back = [one for _ in range(steps) for one in (move(-step), *look(*beams))]
    return [again(times, [*there, *back])]


def again(times: int, commands: list[Command]) -> Repeat:
    """The same, so many times."""
    return Repeat(times, tuple(commands))


def told_map(world: World, floor: Map) -> World:
    """The same with another map told to the filter."""
    return replace(world, told=replace(world.told, map=floor))
