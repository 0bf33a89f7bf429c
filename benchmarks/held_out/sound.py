"""Every told number is true, and yet filters go astray; or they do not."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from ekfsim.world import World

from .cases import Case, case, gated, guarded, sure, wary
from .rooms import (
    BARN,
    BENT,
    GALLERY,
    HANGAR,
    NOISE,
    PARLOUR,
    PASSAGE,
    SIX,
    SQUARELY,
    STUDIO,
    TEE,
    TENT,
    again,
    box,
    lap,
    look,
    move,
    packaged,
    room,
)


def sound_cases() -> Iterator[Case]:
    """All of them."""
    for kind in (nothing, wrong_walls, alike, headings, close):
        yield from kind()


def nothing() -> Iterator[Case]:
    """Nothing is wrong: what a sound explanation is silent about."""
    right = partial(case, mechanism=None, without=None, outcome="consistent")
    yield right("sound parlour", world=room(PARLOUR, (2, 2, 0)), commands=lap(4, 3, 4, 3))
    yield right("sound tent", world=room(TENT, (4, 3, 30)), commands=lap(3, 3, 3, 3, beams=SIX))
    yield right("sound barn", world=room(BARN, (5, 4, 0)), commands=lap(8, 5, 8, 5), seed=3)
    yield case(
        "bare passage",
        "no direction is seen",
        room(PASSAGE, (8, 1.2, 0), noise=replace(NOISE, odometry_distance=0.06)),
        [again(10, [move(1.2, 2), *look(90, -90), move(1.2, -2), *look(90, -90)])],
        None,
        "consistent",
        seed=1,
    )
    yield case(
        "long gallery, side beams alone",
        "no direction is seen",
        room(
            [(0, 0), (80, 0), (80, 5), (0, 5)],
            (10, 2, 0),
            noise=replace(NOISE, odometry_distance=0.08),
        ),
        [again(14, [move(1.5), *look(80, -80, 100)])],
        None,
        "consistent",
        seed=2,
    )


def wrong_walls() -> Iterator[Case]:
    """All told numbers are true; a beam passes a corner."""
    wrong = partial(case, mechanism="wrong wall", without=guarded)
    table = {"table": box(4.4, 2.9, 1.0, 0.9)}
    yield wrong(
        "parlour with a table",
        world=room(PARLOUR, (2, 1.5, 0), table),
        commands=[again(2, lap(4.5, 4, 4.5, 4, parts=3))],
        seed=1,
    )
    pillar = {"pillar": box(3.2, 3.1, 0.8, 0.8)}
    yield wrong(
        "studio with a pillar",
        world=room(STUDIO, (1.4, 1.4, 0), pillar),
        commands=[again(2, lap(4.2, 4.2, 4.2, 4.2, parts=3))],
        seed=4,
    )
    yield wrong(
        "round the bend",
        world=room(BENT, (1.5, 1.5, 0)),
        commands=[again(3, lap(2.4, 4.2, 2.4, 4.2, parts=3, beams=(0, 30, -90, -60)))],
        seed=2,
    )
    yield wrong(
        "the head of the T",
        world=room(TEE, (6, 1, 90)),
        commands=[
            move(2.5, 0),
            *look(0, 90, -90),
            move(2, -90),
            *look(0, 90, 180),
            again(4, [move(1.2), *look(-60, -120, 90), move(-1.2), *look(-110, -70, 90)]),
        ],
        seed=5,
    )
    yield wrong(
        "furnished room",
        world=packaged("furnished-room", (1.2, 1.4, 0)),
        commands=[
            move(2.5),
            *look(0, 90, 45),
            move(2.5, 90),
            *look(0, 90, -45, -90),
            again(3, [move(1.5), *look(*SQUARELY), move(-1.5), *look(*SQUARELY)]),
        ],
        seed=3,
    )
    crate = {"crate": box(6.4, 1.9, 1.2, 1.2)}
    yield wrong(
        "gallery with a crate",
        world=room(GALLERY, (3, 0.9, 0), crate),
        commands=[again(2, lap(7.5, 3.2, 7.5, 3.2, parts=4))],
        seed=6,
    )
    columns = {"column": box(9, 6, 1.3, 1.3)}
    yield wrong(
        "barn with a column",
        world=room(BARN, (5, 3, 0), columns),
        commands=[again(2, lap(9, 7, 9, 7, parts=4))],
        seed=8,
    )
    yield wrong(
        "office door",
        world=World.of(
            boundary=[(0, 0), (12, 0), (12, 6), (0, 6)],
            start=(2, 2, 0),
            noise=NOISE,
            walls=[[(6, 0), (6, 2.4)], [(6, 3.5), (6, 6)]],
        ),
        commands=[again(3, lap(2.6, 2, 2.6, 2, beams=(0, 20, -20, 90, 180)))],
        seed=9,
    )


def alike() -> Iterator[Case]:
    """Walls that look alike, and a place along them that is not known."""
    for name, pitch, wide, deep, wander, seed, beams in (
        ("niches", 1.3, 0.5, 0.4, 0.05, 0, (90.0, -90.0)),
        ("racks", 1.6, 0.6, 0.7, 0.06, 1, (90.0, -90.0)),
        ("doors on one side", 2.0, 0.8, 0.3, 0.07, 2, (90.0, -90.0, 80.0)),
    ):
        posts = {}
        for i in range(int(40 / pitch)):
            x = 4 + pitch * i
            posts[f"north {i}"] = box(x, 2.8 - deep, wide, deep)
            if name != "doors on one side":
                posts[f"south {i}"] = box(x, 0, wide, deep)
        noise = replace(NOISE, odometry_distance=wander)
        world = room([(0, 0), (50, 0), (50, 2.8), (0, 2.8)], (5.1, 1.4, 0), posts, noise)
        route = [again(9, [move(1.1, 3), *look(*beams), move(1.1, -3), *look(*beams)])]
        yield case(name, "look-alike walls", world, route, gated, seed=seed)


def headings() -> Iterator[Case]:
    """The heading is too uncertain for a straight line, or beams graze."""
    spread = partial(case, mechanism="heading spread", without=sure)
    for name, boundary, start, sigma, distance, beams, seed in (
        ("hangar, 18°", HANGAR, (20, 20, 0), 18, 4, SIX, 0),
        ("hangar, 25°", HANGAR, (30, 15, 90), 25, 2, SQUARELY, 1),
        ("barn, 16°", BARN, (6, 6, 0), 16, 3, (0.0, 40.0, 90.0, 135.0, -90.0, -45.0), 2),
        ("hangar, 15° and a long way", HANGAR, (15, 25, 0), 15, 9, (0.0, 90.0, -90.0, 180.0), 3),
    ):
        yield spread(
            name,
            world=room(boundary, start, sigma=(0.05, 0.05, sigma)),
            commands=[move(distance), *look(*beams)],
            seed=seed,
        )
    graze = partial(case, mechanism="grazing beams", without=sure)
    loose = replace(NOISE, odometry_angle=0.2)
    aisle = [(0, 0), (50, 0), (50, 14), (0, 14)]
    for turn, high, seed in ((7.0, 1.0, 0), (5.0, 1.5, 1), (8.0, 0.8, 2)):
        route = [move(0.6, turn), *look(-14), move(0.6, -turn), *look(-7)]
        yield graze(
            f"along the wall, {turn:g}°",
            world=room(aisle, (6, high, 0), noise=loose),
            commands=[again(6, route)],
            seed=seed,
        )


def close() -> Iterator[Case]:
    """So near a wall that the noise that is told of a range goes to nothing."""
    near = partial(case, mechanism="close to the wall", without=wary)
    loose = replace(NOISE, execution_distance=0.005, odometry_distance=0.02)
    for name, boundary, start, way, beams, seed in (
        ("0.12 m from the end", STUDIO, (2, 3.5, 0), 4.88, 4, 0),
        ("0.2 m from the end", GALLERY, (3, 2.5, 0), 10.8, 3, 1),
        ("0.1 m from the end", PARLOUR, (5, 3, 0), 3.9, 5, 2),
    ):
        yield near(
            name,
            world=room(boundary, start, noise=loose),
            commands=[move(way), again(beams, look(0))],
            seed=seed,
        )
