"""Two things are wrong: one of them harmless, or both to blame."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ekfsim.commands import Command, Kidnap
from ekfsim.scene import Scene
from ekfsim.world import World

from .cases import Case, Cure, case, guarded, map_told, no_slip, noise_told, sound, start_told, sure
from .faults import faulty
from .rooms import (
    BARN,
    GALLERY,
    HANGAR,
    PARLOUR,
    SIX,
    SQUARELY,
    STUDIO,
    TENT,
    again,
    box,
    lap,
    look,
    move,
    room,
    shuttle,
    told_map,
)
from .told import odometry, ratios


def traps_cases() -> Iterator[Case]:
    """All of them."""
    for kind in (harmless, both):
        yield from kind()


def aside(world: World, x: float, y: float, degrees: float = 0.0) -> World:
    """The filter is told a start that lies so far off."""
    pose = world.told.start + np.array([x, y, np.radians(degrees)])
    return replace(world, told=replace(world.told, start=pose))


def harmless() -> Iterator[Case]:
    """What is wrong besides is too small to matter, or no beam meets it."""
    big, parlour = [again(2, lap(4, 3, 4, 3))], room(PARLOUR, (2, 2, 0))
    yield case(
        "carried away; laser told a fifth more", "kidnap", ratios(parlour, range=1.2),
        [*lap(3, 2), Kidnap(7, 5, 1.0), *look(*SQUARELY), move(0.5, 45), *look(*SQUARELY)],
        no_slip, seed=1,
    )  # fmt: skip
    table = room(PARLOUR, (2, 1.5, 0), {"table": box(4.4, 2.9, 1.0, 0.9)})
    yield case(
        "a table; 2 cm off at the start", "wrong wall", aside(table, 0.02, 0.0),
        [again(2, lap(4.5, 4, 4.5, 4, parts=3))], guarded, seed=2,
    )  # fmt: skip
    unseen = room(BARN, (5, 4, 0), {"box": box(18.5, 0.3, 1, 1)})
    yield case(
        "slip; a box that the map lacks", "slip",
        told_map(unseen, room(BARN, (5, 4, 0)).map),
        [*lap(6, 5), move(3, 90, 0.6), *look(*SQUARELY), move(2), *look(*SQUARELY)], no_slip,
    )  # fmt: skip
    yield case(
        "laser told a third; wheels 1.002", "laser overtrusted",
        faulty(ratios(parlour, range=1 / 3), odometry_distance_scale=1.002), big, noise_told,
        seed=3,
    )  # fmt: skip
    yield case(
        "passers-by; 5 mm too far", "short returns",
        faulty(room(STUDIO, (1.5, 1.5, 0)), short_returns=0.15, range_bias=0.005),
        lap(3, 3, 3, 3, parts=3), lambda scene: _only(scene, short_returns=0.0), seed=4,
    )  # fmt: skip
    yield case(
        "hangar, 20°; a slip of 0.02 m", "heading spread",
        room(HANGAR, (20, 20, 0), sigma=(0.05, 0.05, 20)),
        [move(3, 0, 0.007), *look(*SIX)], sure, seed=5,
    )  # fmt: skip
    yield case(
        "0.15 m too far; a map that leans by 1 cm", "range bias",
        told_map(faulty(parlour, range_bias=0.15), room(
            [(0, 0), (9, 0), (9.01, 7), (0.01, 7)], (2, 2, 0)).map), big, sound, seed=6,
    )  # fmt: skip
    yield case(
        "odometry told a fifth; a table", "odometry overtrusted",
        odometry(room(PARLOUR, (1.5, 1, 0), {"table": box(7.5, 5.5, 1.0, 0.9)}), 1 / 5),
        big, noise_told, seed=7,
    )  # fmt: skip
    yield case(
        "laser told a third, each beam twice", "laser overtrusted", ratios(parlour, range=1 / 3),
        [again(2, lap(4, 3, 4, 3, beams=(*SQUARELY, *SQUARELY)))], noise_told, seed=8,
    )  # fmt: skip
    yield case(
        "passers-by, each beam three times", "short returns",
        faulty(room(TENT, (4, 3, 30)), short_returns=0.15),
        lap(3, 3, 3, 3, beams=(0, 0, 0, 120, 120, 120)), sound, seed=9,
    )  # fmt: skip
    yield case(
        "turns 1.08, grazing beams besides", "turn scale",
        faulty(room(GALLERY, (2, 1, 0)), odometry_angle_scale=1.08),
        [again(2, lap(6, 2.5, 6, 2.5, beams=(*SQUARELY, 8.0)))], sound, seed=10,
    )  # fmt: skip
    yield case(
        "0.7 m off, gated; laser told a tenth more", "wrong start",
        aside(ratios(parlour, range=1.1), 0.7, 0.0), big, start_told, gate=0.99, seed=11,
    )  # fmt: skip
    yield case(
        "a wall 0.3 m too near; short returns of 1 in 200", "wrong map",
        told_map(faulty(parlour, short_returns=0.005), room(
            [(0.3, 0), (9, 0), (9, 7), (0.3, 7)], (2, 2, 0)).map), big, map_told, seed=12,
    )  # fmt: skip


def both() -> Iterator[Case]:
    """Taking away one alone does not help."""
    parlour, studio = room(PARLOUR, (2, 2, 0)), room(STUDIO, (1.5, 1.5, 0))
    big = [again(2, lap(4, 3, 4, 3))]
    yield _both(
        "turns 0.92 and 0.2 m too far", ("turn scale", "range bias"),
        faulty(studio, odometry_angle_scale=0.92, range_bias=0.2), [again(2, lap(3, 3, 3, 3))],
        sound, 0,
    )  # fmt: skip
    yield _both(
        "laser told a fifth and a wall 0.4 m too near", ("laser overtrusted", "wrong map"),
        ratios(told_map(parlour, room([(0.4, 0), (9, 0), (9, 7), (0.4, 7)], (2, 2, 0)).map),
               range=1 / 5), big, lambda scene: map_told(noise_told(scene)), 1,
    )  # fmt: skip
    yield _both(
        "passers-by and 0.2 m too far", ("range bias", "short returns"),
        faulty(room(STUDIO, (3, 3, 0), sigma=(0.1, 0.1, 2)), short_returns=0.25, range_bias=0.2),
        shuttle(0.8, 3), sound, 2,
    )  # fmt: skip


def _both(
    name: str,
    mechanisms: tuple[str, ...],
    world: World,
    commands: list[Command],
    without: Cure,
    seed: int,
) -> Case:
    return case(name, " + ".join(sorted(mechanisms)), world, commands, without, seed=seed)


def _only(scene: Scene, **right: float) -> Scene:
    """The scene with some of its faults taken out."""
    world = scene.world
    return replace(scene, world=replace(world, faults=replace(world.faults, **right)))
