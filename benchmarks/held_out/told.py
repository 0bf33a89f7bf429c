"""The filter is told what is not so."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

import numpy as np

from ekfsim.floor import Map
from ekfsim.world import World

from .cases import Case, case, map_told, noise_told, start_told
from .rooms import (
    BARN,
    NOISE,
    PARLOUR,
    SIX,
    STUDIO,
    TENT,
    Points,
    again,
    box,
    lap,
    room,
    shuttle,
    told_map,
)


def told_cases() -> Iterator[Case]:
    """All of them."""
    for kind in (told_noise, maps, starts):
        yield from kind()


def told_noise() -> Iterator[Case]:
    """The filter is told ratios that are not true."""
    big = [again(2, lap(4, 3, 4, 3))]
    over = partial(case, without=noise_told)
    parlour, tent = room(PARLOUR, (2, 2, 0)), room(TENT, (4, 3, 30))
    studio, barn = room(STUDIO, (1.5, 1.5, 0)), room(BARN, (5, 4, 0))
    tall = replace(NOISE, odometry_distance=0.05, odometry_angle=0.04)
    mild = replace(NOISE, odometry_distance=0.03, odometry_angle=0.03)
    yield over("odometry told a fifth", "odometry overtrusted", odometry(parlour, 1 / 5), big)
    yield over(
        "odometry told a third, tent",
        "odometry overtrusted",
        odometry(room(TENT, (4, 3, 30), noise=mild), 1 / 3),
        [again(2, lap(3, 3, 3, 3, beams=SIX))],
        seed=1,
    )
    yield over(
        "distances told a sixth",
        "odometry overtrusted",
        ratios(room(STUDIO, (1.5, 1.5, 0), noise=tall), odometry_distance=1 / 6),
        [again(2, lap(3, 3, 3, 3))],
        seed=2,
    )
    yield over(
        "turns told a fifth",
        "odometry overtrusted",
        ratios(room(PARLOUR, (2, 2, 0), noise=tall), odometry_angle=1 / 5),
        big,
        seed=3,
    )
    yield over(
        "odometry told none",
        "odometry overtrusted",
        odometry(room(BARN, (5, 4, 0), noise=tall), 0.1),
        [again(2, lap(8, 5, 8, 5))],
    )
    yield over(
        "odometry told five times",
        "odometry distrusted",
        odometry(room(STUDIO, (1.5, 1.5, 0), noise=tall), 5),
        [again(2, lap(3, 3, 3, 3))],
        outcome="over-cautious",
    )
    yield over(
        "odometry told four times",
        "odometry distrusted",
        odometry(parlour, 4),
        big,
        outcome="over-cautious",
        seed=1,
    )
    yield over("laser told a third", "laser overtrusted", ratios(parlour, range=1 / 3), big)
    yield over(
        "laser told a fifth, tent",
        "laser overtrusted",
        ratios(tent, range=1 / 5),
        [again(2, lap(3, 3, 3, 3, beams=SIX))],
        seed=1,
    )
    yield over(
        "laser told a third, barn",
        "laser overtrusted",
        ratios(barn, range=1 / 3),
        [again(2, lap(8, 5, 8, 5, parts=3))],
        seed=2,
    )
    yield over(
        "laser told half",
        "laser overtrusted",
        ratios(studio, range=0.5),
        [again(4, lap(3, 3, 3, 3))],
        seed=3,
    )
    cautious = partial(over, mechanism="laser distrusted", outcome="over-cautious")
    yield cautious("laser told three times", world=ratios(parlour, range=3), commands=big)
    yield cautious(
        "laser told five times",
        world=ratios(tent, range=5),
        commands=lap(3, 3, 3, 3, beams=SIX),
        seed=1,
    )
    yield cautious(
        "laser told ten times", world=ratios(barn, range=10), commands=lap(8, 5, 8, 5), seed=2
    )


def maps() -> Iterator[Case]:
    """The map that the filter is told of is not the room."""
    wrong = partial(case, without=map_told)
    wall, big = "wrong map", [again(2, lap(4, 3, 4, 3))]

    def floor(boundary: Points, **obstacles: Points) -> Map:
        return room(boundary, (1, 1, 0), obstacles).map

    parlour = room(PARLOUR, (2, 2, 0))
    yield wrong(
        "left wall 0.25 m too near",
        wall,
        told_map(parlour, floor([(0.25, 0), (9, 0), (9, 7), (0.25, 7)])),
        big,
    )
    yield wrong(
        "upper wall 0.2 m too far",
        wall,
        told_map(room(STUDIO, (1.5, 1.5, 0)), floor([(0, 0), (7, 0), (7, 7.2), (0, 7.2)])),
        [again(2, lap(3.5, 3.5, 3.5, 3.5))],
        seed=1,
    )
    yield wrong(
        "barn's end 0.8 m too far",
        wall,
        told_map(room(BARN, (5, 4, 0)), floor([(0, 0), (20.8, 0), (20.8, 14), (0, 14)])),
        lap(8, 5, 8, 5, parts=3),
        seed=2,
    )
    yield wrong(
        "sofa moved 0.4 m",
        wall,
        told_map(
            room(PARLOUR, (2, 1.5, 0), {"sofa": box(6.8, 2, 1.8, 3)}),
            floor(PARLOUR, sofa=box(7.2, 2, 1.8, 3)),
        ),
        shuttle(1.0, 3, beams=(0, 20, 90, 180)),
        seed=3,
    )
    yield wrong(
        "cupboard that the map lacks",
        wall,
        told_map(room(PARLOUR, (2, 2, 0), {"cupboard": box(8.2, 1, 0.8, 4)}), floor(PARLOUR)),
        big,
        seed=4,
    )
    yield wrong(
        "crate that is gone",
        wall,
        told_map(room(STUDIO, (2, 2, 0)), floor(STUDIO, crate=box(1.0, 6.2, 5, 0.8))),
        [again(2, lap(3, 3, 3, 3))],
        seed=5,
    )
    for boundary, start, lean, seed in (
        (PARLOUR, (2, 2, 0), 0.4, 6),
        (STUDIO, (1.5, 1.5, 0), 0.5, 7),
        (BARN, (5, 4, 0), -1.0, 8),
    ):
        leans = [(x + lean * (y > 0), y) for x, y in boundary]
        yield wrong(
            f"leaning by {lean} m",
            "sheared map",
            told_map(room(boundary, start), floor(leans)),
            [again(3, lap(3, 3, 3, 3))],
            seed=seed,
        )


def starts() -> Iterator[Case]:
    """The filter is sure of a start that is not the robot's."""
    wrong = partial(case, mechanism="wrong start", without=start_told)
    for name, boundary, start, off, outcome, gate, seed in (
        ("0.7 m off", PARLOUR, (2, 2, 0), (0.7, 0, 0), "over-confident", None, 0),
        ("25° off", STUDIO, (2, 2, 0), (0, 0, 25), "over-confident", None, 1),
        ("0.7 m off, gated", PARLOUR, (2, 2, 0), (0, 0.7, 0), "lost", 0.99, 2),
        ("25° off, gated", TENT, (4, 3, 30), (0, 0, -25), "lost", 0.99, 3),
        ("2 m off in the barn", BARN, (5, 4, 0), (-2, 1, 0), "lost", 0.999, 4),
    ):
        world = room(boundary, start)
        pose = world.start + np.array([off[0], off[1], np.radians(off[2])])
        yield wrong(
            name,
            world=replace(world, told=replace(world.told, start=pose)),
            commands=[again(2, lap(3, 3, 3, 3))],
            outcome=outcome,
            gate=gate,
            seed=seed,
        )


def ratios(world: World, **times: float) -> World:
    """The filter is told other ratios: so many times the true ones."""
    noise = world.noise
    told = replace(noise, **{name: getattr(noise, name) * by for name, by in times.items()})
    return replace(world, told=replace(world.told, noise=told))


def odometry(world: World, by: float) -> World:
    """The filter is told so many times the noise of the odometry."""
    return ratios(world, odometry_distance=by, odometry_angle=by)
