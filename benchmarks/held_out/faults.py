"""Something is wrong with the robot, or happens to it."""

from collections.abc import Iterator
from dataclasses import replace
from functools import partial

from ekfsim.commands import Kidnap
from ekfsim.world import Faults, World

from .cases import Case, case, no_slip, sound
from .rooms import (
    BARN,
    GALLERY,
    PARLOUR,
    SIX,
    SQUARELY,
    STUDIO,
    TENT,
    TRAPEZE,
    again,
    lap,
    look,
    move,
    room,
    shuttle,
)


def faults_cases() -> Iterator[Case]:
    """All of them."""
    for kind in (scales, slips, biases, repeated, short):
        yield from kind()


def scales() -> Iterator[Case]:
    """The odometry misreads."""
    few = (0.0, 90.0)
    for boundary, start, sides, scale, beams in (
        (PARLOUR, (2, 2, 0), (4, 3, 4, 3), 1.04, few),
        (STUDIO, (1.5, 1.5, 0), (4, 4, 4), 0.95, few),
        (BARN, (5, 4, 0), (8, 5, 8, 5), 1.06, SQUARELY),
        (TENT, (4, 3, 30), (4, 3, 4), 0.93, few),
        (GALLERY, (2, 1, 0), (6, 3, 6, 3), 1.05, SQUARELY),
    ):
        yield case(
            f"wheels {scale}",
            "wheel scale",
            faulty(room(boundary, start), odometry_distance_scale=scale),
            [again(2, lap(*sides, parts=2, beams=beams))],
            sound,
            seed=int(scale * 100),
        )
    for boundary, start, sides, scale, beams in (
        (PARLOUR, (2, 2, 0), (4, 3, 4, 3), 1.06, SQUARELY),
        (STUDIO, (1.5, 1.5, 0), (4, 4, 4, 4), 0.94, SQUARELY),
        (BARN, (5, 4, 0), (8, 5, 8, 5), 1.08, SQUARELY),
        (TRAPEZE, (3, 1.5, 0), (3, 2.5, 3, 2.5), 0.92, SQUARELY),
    ):
        yield case(
            f"turns {scale}",
            "turn scale",
            faulty(room(boundary, start), odometry_angle_scale=scale),
            [again(2, lap(*sides, parts=2, beams=beams))],
            sound,
            seed=int(scale * 100),
        )


def slips() -> Iterator[Case]:
    """One move slips, or the robot is carried away."""
    slip = partial(case, mechanism="slip", without=no_slip)
    side = [move(2.0, 90), *look(*SQUARELY)]
    yield slip(
        "slip of 0.6",
        world=room(PARLOUR, (3, 2, 0)),
        commands=[*side, *side, move(2, 90, 0.6), *look(*SQUARELY), *side, *side],
    )
    yield slip(
        "wheels spin",
        world=room(STUDIO, (2, 2, 0)),
        seed=1,
        commands=[*lap(3, 3), move(1.5, 0, 0.95), *look(*SQUARELY), move(1.0), *look(0, 90)],
    )
    yield slip(
        "slip under a gate",
        world=room(BARN, (5, 4, 0)),
        seed=2,
        gate=0.99,
        commands=[*lap(6, 5), move(3, 90, 0.5), *look(*SQUARELY), *lap(3, 3)],
    )
    yield slip(
        "slip in the tent",
        world=room(TENT, (4, 3, 30)),
        seed=3,
        commands=[*lap(3, 2, beams=SIX), move(2, 0, 0.7), *look(0, 120), move(1), *look(60)],
    )
    carried = partial(case, mechanism="kidnap", without=no_slip)
    for name, boundary, start, place, seed, gate in (
        ("carried across the parlour", PARLOUR, (2, 2, 0), (7, 5, 1.0), 4, None),
        ("carried and turned in the studio", STUDIO, (1.5, 1.5, 0), (3, 4.5, -1.5), 5, None),
        ("carried in the barn, gated", BARN, (5, 4, 0), (16, 3, 1.6), 6, 0.99),
        ("carried through the gallery", GALLERY, (2, 1, 0), (11, 3, 3.0), 7, None),
    ):
        yield carried(
            name,
            world=room(boundary, start),
            seed=seed,
            gate=gate,
            commands=[
                *lap(3, 2),
                Kidnap(*place),
                *look(*SQUARELY),
                move(0.5, 45),
                *look(*SQUARELY),
            ],
        )


def biases() -> Iterator[Case]:
    """The laser reads too far, or too near."""
    bias = partial(case, mechanism="range bias", without=sound)
    doubt = (0.1, 0.1, 2.0)
    yield bias(
        "0.07 m too far",
        world=faulty(room(STUDIO, (3, 2, 0), sigma=doubt), range_bias=0.07),
        commands=shuttle(0.8, 3),
    )
    yield bias(
        "0.06 m too near",
        world=faulty(room(PARLOUR, (2, 2, 0)), range_bias=-0.06),
        commands=[again(2, lap(4, 3, 4, 3))],
        seed=1,
    )
    yield bias(
        "0.2 m too far in the barn",
        world=faulty(room(BARN, (5, 4, 0)), range_bias=0.2),
        commands=lap(8, 5, 8, 5, parts=3),
        seed=2,
    )
    yield bias(
        "0.12 m too far, one side",
        world=faulty(room(PARLOUR, (3, 3, 0), sigma=doubt), range_bias=0.12),
        commands=shuttle(1.0, 4, beams=(0, 90)),
        seed=3,
    )
    yield bias(
        "0.1 m too near, two sides",
        world=faulty(room(TENT, (5, 4, 0), sigma=doubt), range_bias=-0.1),
        commands=shuttle(0.7, 4, beams=(30, -60)),
        seed=4,
    )
    scale = partial(case, mechanism="range scale", without=sound)
    yield scale(
        "ranges 1.04",
        world=faulty(room(PARLOUR, (2, 2, 0)), range_scale=1.04),
        commands=[again(2, lap(4, 3, 4, 3))],
    )
    yield scale(
        "ranges 0.94",
        world=faulty(room(BARN, (5, 4, 0)), range_scale=0.94),
        commands=lap(8, 5, 8, 5),
        seed=1,
    )
    yield scale(
        "ranges 1.06, one side",
        world=faulty(room(STUDIO, (2, 3, 0), sigma=doubt), range_scale=1.06),
        commands=shuttle(0.8, 4, beams=(0, 90)),
        seed=2,
    )


def repeated() -> Iterator[Case]:
    """One beam again and again, wrong by the same each time."""
    often = partial(case, mechanism="repeated readings", without=sound)
    doubt = (0.1, 0.1, 1.0)
    for name, faults, start, bearing, times, seed in (
        ("forty beams", {"range_bias": 0.06}, (3, 3, 0), 90, 40, 0),
        ("sixty beams to the left", {"range_bias": -0.04}, (5, 2, 90), -90, 60, 1),
        ("beams of a scale", {"range_scale": 1.02}, (3, 2.5, 0), 180, 60, 2),
    ):
        yield often(
            name,
            world=faulty(room(PARLOUR, start, sigma=doubt), **faults),
            commands=[again(times, look(bearing))],
            seed=seed,
        )


def short() -> Iterator[Case]:
    """Someone walks through the beam."""
    people = partial(case, mechanism="short returns", without=sound)
    for boundary, start, sides, share, seed in (
        (PARLOUR, (2, 2, 0), (4, 3, 4, 3), 0.06, 0),
        (STUDIO, (1.5, 1.5, 0), (3, 3, 3, 3), 0.15, 1),
        (BARN, (5, 4, 0), (8, 5, 8, 5), 0.1, 2),
        (TENT, (4, 3, 30), (3, 3, 3, 3), 0.2, 3),
    ):
        yield people(
            f"{share:.0%} short returns",
            world=faulty(room(boundary, start), short_returns=share),
            commands=lap(*sides, parts=3),
            seed=seed,
        )


def faulty(world: World, **faults: float) -> World:
    """The same with something wrong."""
    return replace(world, faults=Faults(**faults))
