"""The twelve mechanisms once more as somebody else would write them: other rooms, other ways."""

from collections.abc import Iterator
from dataclasses import replace

from ekfsim.commands import Kidnap

from .cases import (
    Case,
    case,
    gated,
    guarded,
    map_told,
    no_slip,
    noise_told,
    sound,
    start_told,
    wary,
)
from .faults import faulty
from .rooms import (
    BARN,
    BENT,
    GALLERY,
    NOISE,
    PARLOUR,
    PASSAGE,
    SIX,
    SQUARELY,
    STUDIO,
    TEE,
    TENT,
    TRAPEZE,
    again,
    box,
    lap,
    look,
    move,
    room,
    told_map,
)
from .told import odometry, ratios
from .traps import aside


def strangers_cases() -> Iterator[Case]:
    """All of them."""
    for kind in (told, happens, seen, both):
        yield from kind()


def told() -> Iterator[Case]:
    """What the filter is told is not so."""
    zigzag = again(4, [move(1.2, 40), *look(0, 70, -110), move(1.2, -40), *look(0, 70, -110),
                       move(-2.2, 0), *look(10, 170)])  # fmt: skip
    rough = replace(NOISE, odometry_distance=0.04, odometry_angle=0.05)
    yield case(
        "zigzag in the barn, odometry told a quarter", "odometry overtrusted",
        odometry(room(BARN, (6, 6, 20), noise=rough), 1 / 4), [zigzag], noise_told, seed=31,
    )  # fmt: skip
    yield case(
        "laser told a quarter in the bend", "laser overtrusted",
        ratios(room(BENT, (1, 1, 0)), range=1 / 4),
        [again(3, lap(2.5, 2.5, 2.5, 2.5, beams=(15, 105, -75, 195)))], noise_told, seed=32,
    )  # fmt: skip
    yield case(
        "laser told six times, trapeze", "laser distrusted",
        ratios(room(TRAPEZE, (3, 1.5, 0)), range=6), lap(3, 2.5, 3, 2.5, beams=SIX), noise_told,
        "over-cautious", seed=33,
    )  # fmt: skip
    shelf = room(STUDIO, (2, 2, 0), {"shelf": box(6.3, 0.5, 0.7, 5)})
    yield case(
        "a shelf told 0.35 m farther", "wrong map",
        told_map(shelf, room(STUDIO, (2, 2, 0), {"shelf": box(6.65, 0.5, 0.35, 5)}).map),
        [again(3, lap(2.5, 2.5, 2.5, 2.5, beams=(0, -90, 90)))], map_told, seed=34,
    )  # fmt: skip
    yield case(
        "30° off, gated, gallery", "wrong start",
        aside(room(GALLERY, (3, 2, 0)), 0.0, 0.0, 30), [again(2, lap(6, 1.5, 6, 1.5))], start_told,
        gate=0.99, seed=35,
    )  # fmt: skip


def happens() -> Iterator[Case]:
    """Something is wrong with the robot, or happens to it."""
    yield case(
        "wheels 1.1 on a triangle", "wheel scale",
        faulty(room(BARN, (5, 3, 0)), odometry_distance_scale=1.1),
        [again(2, [step for side in (120, 120, 120)
                   for step in (move(3), *look(20, 110), move(3, side), *look(20, 110, -70))])],
        sound, seed=36,
    )  # fmt: skip
    yield case(
        "turns 0.93 to and fro", "turn scale",
        faulty(room(TENT, (6, 4, 0)), odometry_angle_scale=0.93),
        [again(3, [move(1.5, 170), *look(0, 90, -90), move(1.5, 190), *look(0, 90, -90)])],
        sound, seed=37,
    )  # fmt: skip
    yield case(
        "slip on the way back", "slip", room(TEE, (6, 1, 90)),
        [move(3), *look(*SQUARELY), move(3, 90), *look(*SQUARELY), move(2), *look(0, 90),
         move(-2, 0, 0.7), *look(*SQUARELY), move(1), *look(*SQUARELY)], no_slip, seed=38,
    )  # fmt: skip
    yield case(
        "carried round the corner of the bend", "kidnap", room(BENT, (1.5, 1.5, 0)),
        [move(2, 90), *look(*SQUARELY), move(1.5), *look(0, 90), Kidnap(2, 7.5, -2.0),
         *look(*SQUARELY), move(0.6, 30), *look(*SQUARELY)], no_slip, seed=39,
    )  # fmt: skip
    yield case(
        "0.15 m too near, all of six", "range bias",
        faulty(room(TENT, (5, 4, 10)), range_bias=-0.15),
        [again(4, [move(1, 60), *look(*SIX)])], sound, seed=40,
    )  # fmt: skip
    yield case(
        "a crowd in the barn", "short returns",
        faulty(room(BARN, (8, 6, 45)), short_returns=0.12),
        [again(5, [move(1, 72), *look(0, 90, 180, -90)])], sound, seed=41,
    )  # fmt: skip


def seen() -> Iterator[Case]:
    """What the beams meet."""
    yield case(
        "two columns", "wrong wall",
        room(BARN, (4, 4, 0), {"one": box(8, 6.1, 0.8, 0.8), "two": box(12, 6.4, 1, 0.6)}),
        [again(2, lap(10, 6, 10, 6, parts=5))], guarded, seed=42,
    )  # fmt: skip
    posts = {f"post {i}": box(4 + 1.4 * i, 2.0, 0.4, 0.4) for i in range(24)}
    yield case(
        "a fence of posts on one side", "look-alike walls",
        room(PASSAGE, (5.3, 1.1, 0), posts, replace(NOISE, odometry_distance=0.06)),
        [again(8, [move(1.2, 2), *look(90, 85), move(1.2, -2), *look(90, 95)])], gated, seed=43,
    )  # fmt: skip
    yield case(
        "0.15 m from the trapeze's wall", "close to the wall",
        room(TRAPEZE, (5, 3, -90),
             noise=replace(NOISE, execution_distance=0.005, odometry_distance=0.02)),
        [move(2.85), again(4, look(0))], wary, seed=44,
    )  # fmt: skip
    yield case("sound bend", None, room(BENT, (1.5, 1.5, 0)), lap(2, 2, 2, 2), None, "consistent",
               seed=45)  # fmt: skip
    honest = room(PARLOUR, (2, 2, 0))
    yield case("bad luck in the parlour", "chance", honest, lap(4, 3, 4, 3), None, "lost", seed=46)


def both() -> Iterator[Case]:
    """Two things at once, neither of them enough."""
    tent = faulty(room(TENT, (4, 3, 30)), odometry_angle_scale=0.9)
    yield case(
        "turns 0.9 and laser told a fifth", "laser overtrusted + turn scale",
        ratios(tent, range=1 / 5), [again(2, lap(3, 3, 3, 3))],
        lambda scene: noise_told(sound(scene)), seed=47,
    )  # fmt: skip
