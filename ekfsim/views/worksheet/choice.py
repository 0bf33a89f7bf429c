"""Which numbers are left out of a worksheet."""

import random
from collections.abc import Iterable, Iterator

from ekfsim.views.worksheet.gaps import COVARIANCE, ELLIPSE, POSE, STATE, Block, Number, Told

DRAWN = tuple((ELLIPSE, name) for name in ("minor radius", "major radius", "orientation"))
# later numbers of the same command that would give an earlier one away, reckoned backwards
GIVEN_AWAY = {
    ("predicted range", ""): (("innovation", ""), ("C_v", "")),
    ("C_v", ""): (("S", ""),),
    ("S", ""): (("innovation", "standard deviation"),),
    ("innovation", "standard deviation"): (("innovation", "NIS"),),
    **{("gain", name): ((STATE, name),) for name in POSE},
    **{(COVARIANCE, f"row {i}, column {j}"): DRAWN for i, j in ((1, 1), (1, 2), (2, 2))},
    (COVARIANCE, "row 3, column 3"): ((ELLIPSE, "cone"),),
}
TERMS = ("J_u P_u J_u'", "J_x P J_x'")  # of a new covariance: less the one it is the other


def calculated(blocks: Iterable[Block]) -> list[Told]:
    """Each number that can be calculated, once, in the order in which they are first told."""
    found: dict[Number, Told] = {}
    for block in blocks:
        for line in block.lines:
            for part in line:
                if isinstance(part, Told) and part.number is not None:
                    found.setdefault(part.number, part)
    return list(found.values())


def chosen(blocks: Iterable[Block], share: float, seed: tuple[int, int]) -> dict[Number, int]:
    """A share of the numbers that can be calculated, and the number of each gap, from 1.

    With a number goes each later one that would give it away. seed : of the scene, and its run
    """
    blocks = list(blocks)
    numbers = [told.number for told in calculated(blocks) if told.number is not None]
    dice = random.Random(f"{seed[0]} {seed[1]}")
    left, known = set[Number](), set(numbers)
    for number in sorted(numbers, key=lambda _: dice.random()):
        if len(left) >= round(share * len(numbers)) and left:
            break
        left |= set(_with_it(number)) & known
    return {number: i for i, number in enumerate(filter(left.__contains__, numbers), 1)}


def _with_it(number: Number) -> Iterator[Number]:
    """A number, and those that would give it away."""
    yield number
    others = GIVEN_AWAY.get((number.what, number.name), ())
    if number.what in TERMS:
        others = ((COVARIANCE, number.name),)
    for what, name in others:
        yield from _with_it(Number(number.since, what, name))
