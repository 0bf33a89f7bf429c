"""Whether the printed ellipse and cone are those of the printed covariance."""

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np

from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import ellipse, radius_factor
from ekfsim.student.printed.narrative.numbers import Check, Formula, Guess
from ekfsim.student.printed.narrative.reading import Block, Number

PROBABILITY = 0.954
K = radius_factor(PROBABILITY)
DEGREES = math.degrees(1.0)
READ = "section 4: the ellipse is that of the upper left 2x2 of P"
TWO = (
    "this is the ellipse of 2 sigma, which holds 86.5 % in two dimensions; 95.4 % reach "
    "k = sqrt(-2 ln(1 - 0.954)) = 2.4816 sigma"
)
ROUNDED = 2e-3  # of a radius: k is taken as 2.48 as well, or as 2.486, which holds 95.45 %
ROUND = 1e-3  # of λ₁; an ellipse whose axes differ by less has no direction to speak of


def uncertainty(block: Block, P: Sequence[Number]) -> Iterator[tuple[Check, Sequence[Number]]]:
    """What is printed of ellipse and cone, with the covariance that it follows from."""
    for name, at in (("minor radius", 1), ("major radius", 0)):
        for printed in block.facts.get(name, ()):
            one = replace(printed, half=printed.half + _left_open(P, at))
            yield Check(f"the {name}", one, _radius(at, K), "m", _of_radius(at), read=READ), P
    for printed in block.facts.get("orientation", ()):
        if not _is_round(_matrix(np.array([one.value for one in P]))):
            check = Check(
                "the orientation", printed, _direction, "degrees", DIRECTIONS, 180.0, read=READ
            )
            yield check, P
    if (cone := block.facts.get("cone")) is not None:
        factor, printed = cone
        yield Check(
            f"{factor.value:g}*sigma_theta", printed, _cone(factor.value), "degrees",
            _of_cone(factor.value), read="section 4: sigma_theta is the root of P_thth, in rad",
        ), P  # fmt: skip


def _matrix(numbers: Array) -> Array:
    return numbers.reshape(3, 3)


def _roots(P: Array) -> list[float]:
    """√ of the eigenvalues, the largest first."""
    return [math.sqrt(max(value, 0.0)) for value in np.linalg.eigvalsh((P + P.T) / 2)[::-1]]


def _radius(at: int, k: float) -> Formula:
    def radius(numbers: Array) -> float:
        return k * _roots(_matrix(numbers)[:2, :2])[at]

    return radius


def _left_open(P: Sequence[Number], at: int) -> float:
    """How far a radius may be off: k is rounded, and where P is all but singular the digits of its
    two variances, together, leave more open than each by itself.
    """
    numbers, radius = np.array([one.value for one in P]), _radius(at, K)
    wider = numbers + np.array([one.half * (i in (0, 4)) for i, one in enumerate(P)])
    if not np.all(np.isfinite(numbers)):
        return 0.0
    return ROUNDED * radius(numbers) + radius(wider) - radius(numbers)


def _of_radius(at: int) -> tuple[Guess, ...]:
    """What else may stand in the place of a radius; at : 0 of the major one, 1 of the minor"""

    def block(numbers: Array) -> Array:
        return _matrix(numbers)[:2, :2]

    return (
        (TWO, _radius(at, 2.0)),
        ("this is the root of the eigenvalue, 1 sigma", _radius(at, 1.0)),
        ("k is missing its root: -2 ln(1 - p) is k squared", _radius(at, K * K)),
        ("the other radius stands here", _radius(1 - at, K)),
        ("the other radius stands here, and it is that of 2 sigma", _radius(1 - at, 2.0)),
        ("this is k times the eigenvalue, not its root",
         lambda n: K * _roots(block(n))[at] ** 2),
        ("this is twice the eigenvalue, not its root",
         lambda n: 2 * _roots(block(n))[at] ** 2),
        ("this is the ellipse of the inverse of P", lambda n: K / _roots(block(n))[1 - at]),
        ("this is the ellipse of 2 sigma of the inverse of P",
         lambda n: 2 / _roots(block(n))[1 - at]),
        ("these are eigenvalues of the whole P, in which metres and radians are mixed",
         lambda n: K * _roots(_matrix(n))[at]),
        ("these are eigenvalues of the whole P, in which metres and radians are mixed",
         lambda n: K * _roots(_matrix(n))[at + 1]),
        ("these are 2 sigma of the whole P, in which metres and radians are mixed",
         lambda n: 2 * _roots(_matrix(n))[at]),
        ("these are 2 sigma of the whole P, in which metres and radians are mixed",
         lambda n: 2 * _roots(_matrix(n))[at + 1]),
        ("this is k sigma along x or y: P_xy is left out", _along_axis(at, K)),
        ("this is 2 sigma along x or y: P_xy is left out", _along_axis(at, 2.0)),
    )  # fmt: skip


def _along_axis(at: int, k: float) -> Formula:
    def along(numbers: Array) -> float:
        variances = sorted(np.diagonal(_matrix(numbers))[:2].tolist(), reverse=True)
        return k * math.sqrt(max(variances[at], 0.0))

    return along


def _direction(numbers: Array) -> float:
    """Of the major axis, in degrees."""
    return DEGREES * float(ellipse(_matrix(numbers), PROBABILITY).orientation)


def _of_whole(numbers: Array) -> float:
    """The direction of the longest axis of the whole P, seen from above."""
    P = _matrix(numbers)
    longest = np.linalg.eigh((P + P.T) / 2)[1][:, 2]
    return DEGREES * math.atan2(longest[1], longest[0])


DIRECTIONS: tuple[Guess, ...] = (
    ("this is the direction of the minor axis, or of the ellipse of the inverse of P",
     lambda n: _direction(n) + 90),
    ("it is in radians", lambda n: _direction(n) / DEGREES),
    ("it turns the wrong way: the sign of P_xy, or y that points down", lambda n: -_direction(n)),
    ("half of atan2(2 P_xy, P_xx - P_yy) is the direction", lambda n: 2 * _direction(n)),
    ("it is taken of the whole P, in which metres and radians are mixed", _of_whole),
)  # fmt: skip


def _cone(k: float) -> Formula:
    return lambda numbers: k * DEGREES * math.sqrt(max(numbers[8], 0.0))


def _of_cone(k: float) -> tuple[Guess, ...]:
    return (
        ("it is in radians", lambda n: k * math.sqrt(max(n[8], 0.0))),
        ("this is 1 sigma", lambda n: DEGREES * math.sqrt(max(n[8], 0.0))),
        ("this is the variance, not its root", lambda n: k * DEGREES * float(n[8])),
        ("the variance is turned into degrees, not its root",
         lambda n: k * math.sqrt(max(DEGREES * n[8], 0.0))),
        ("it is reckoned as the ellipse is, with k = 2.4816; one dimension has 2 sigma",
         lambda n: K * DEGREES * math.sqrt(max(n[8], 0.0))),
    )  # fmt: skip


def _is_round(P: Array) -> bool:
    """Whether the ellipse has no direction to speak of."""
    λ1, λ2 = np.square(_roots(P[:2, :2])).tolist()
    return bool(λ1 - λ2 <= ROUND * λ1)
