"""Mistakes of ν, J_H and C_v: of what a reading is compared with, and how it is weighed."""

from collections.abc import Callable

import numpy as np

from ekfsim.geometry import Array
from ekfsim.student.mistakes.mistake import Mistake
from ekfsim.student.mistakes.table.noise import deviations, squares
from ekfsim.student.mistakes.table.steps import beams, of_angles, readings
from ekfsim.student.mistakes.working import Piece, Working

DEGREE = np.pi / 180


def _columns(by: float, *entries: int) -> Piece:
    """J_H with its columns of x, y or θ times `by`."""

    def H(s: Working, right: Callable[[], Array]) -> Array:
        J = np.array(right())
        J[:, [s.places[i] for i in entries]] *= by
        return J

    return H


def _theta_without_r(s: Working, right: Callable[[], Array]) -> Array:
    J = np.array(right())
    J[:, 2] /= s.h
    return J


def _theta_of_the_reading(s: Working, right: Callable[[], Array]) -> Array:
    J = np.array(right())
    J[:, 2] *= s.z / s.h
    return J


def _along(direction: Callable[[float, float], float]) -> Piece:
    """J_H of the same wall and range, but of a beam in another direction."""

    def H(s: Working, right: Callable[[], Array]) -> Array:
        n = right()[0, :2]
        along = direction(s.x_H[2], s.laser.bearing)
        d, aside = np.array([np.cos(along), np.sin(along)]), [-np.sin(along), np.cos(along)]
        slope: Array = -np.array([[*n, s.h[0] * (n @ aside)]]) / (n @ d)
        return slope

    return H


def _of_a_point(s: Working, _: Callable[[], Array]) -> Array:
    """−d of the beam: as if the wall were a point where it is met."""
    along = s.x_H[2] + s.laser.bearing
    return -np.array([[np.cos(along), np.sin(along), 0.0]])


def _of_a_turned_point(s: Working, right: Callable[[], Array]) -> Array:
    """The same with the right ∂h/∂θ."""
    J = np.array(right())
    J[0, :2] = _of_a_point(s, right)[0, :2]
    return J


def _unit_normal(of_theta: bool) -> Piece:
    """−n, without the division by n·d."""

    def H(s: Working, right: Callable[[], Array]) -> Array:
        J = np.array(right())
        J[:, : 3 if of_theta else 2] /= np.hypot(*J[0, :2])
        return J

    return H


def _exchanged(s: Working, right: Callable[[], Array]) -> Array:
    """J_H with its columns of x and y exchanged."""
    J, (x, y, _) = np.array(right()), s.places
    J[:, [x, y]] = J[:, [y, x]]
    return J


def _range_variance(of: Callable[[float, float], float]) -> Piece:
    """C_v from the ratio and the predicted range."""
    return lambda s, _: np.diag([of(s.laser.range_ratio, s.h[0])])


OF_READINGS = (
    Mistake(
        "innovation-sign",
        "your x is the one with the other sign of the innovation, h − z, or of all of J_H",
        "eqs 9, 10: r = z − h, and x + K r",
        readings,
        ({"innovation": lambda s, right: -right()},),
    ),
    Mistake(
        "innovation-not-wrapped",
        "your innovation has an angle beyond half a turn: it is not wrapped into (−π, π]",
        "eq 9: r = z − h, wrapped where it is an angle",
        of_angles,
        ({"innovation": lambda s, _: s.z - s.h},),
    ),
    Mistake(
        "innovation-absolute",
        "your innovation has no sign: |z − h|",
        "eq 9: r = z − h",
        readings,
        ({"innovation": lambda s, right: np.abs(right())},),
    ),
    Mistake(
        "reading-for-innovation",
        "your x is the one with K z in place of K (z − h)",
        "eqs 9, 10: r = z − h, and x + K r",
        readings,
        ({"innovation": lambda s, _: s.z},),
    ),
    Mistake(
        "J_H-sign-theta",
        "your step is the one with the other sign of ∂h/∂θ in J_H",
        "eq 11: the derivatives of h",
        readings,
        ({"H": _columns(-1.0, 2)},),
    ),
    Mistake(
        "J_H-without-theta",
        "your step is the one with ∂h/∂θ = 0 in J_H",
        "eq 11: the derivatives of h; a turn of the robot changes what it sees",
        readings,
        ({"H": _columns(0.0, 2)},),
    ),
    Mistake(
        "J_H-theta-without-range",
        "your step is the one with ∂h/∂θ without the range as a factor in J_H",
        "eq 11: ∂h/∂θ grows with the range; the further the wall, the more a turn changes",
        beams,
        ({"H": _theta_without_r},),
    ),
    Mistake(
        "J_H-theta-of-the-reading",
        "your step is the one with the measured range in ∂h/∂θ of J_H",
        "eq 11: the derivatives of h at the estimate; the reading is not in them",
        beams,
        ({"H": _theta_of_the_reading},),
    ),
    Mistake(
        "J_H-direction",
        "your J_H is that of a beam in another direction than θ + angle, which h is taken along",
        "eqs 8, 11: J_H holds the derivatives of h, along the same beam",
        beams,
        (
            {"H": _along(lambda θ, bearing: θ)},
            {"H": _along(lambda θ, bearing: bearing)},
            {"H": _along(lambda θ, bearing: θ - bearing)},
            {"H": _along(lambda θ, bearing: np.degrees(θ + bearing))},
        ),
    ),
    Mistake(
        "J_H-sign-x",
        "your step is the one with the other sign of ∂h/∂x in J_H",
        "eq 11: the derivatives of h",
        readings,
        ({"H": _columns(-1.0, 0)},),
    ),
    Mistake(
        "J_H-sign-y",
        "your step is the one with the other sign of ∂h/∂y in J_H",
        "eq 11: the derivatives of h",
        readings,
        ({"H": _columns(-1.0, 1)},),
    ),
    Mistake(
        "J_H-signs-xy",
        "your step is the one with the other sign of both ∂h/∂x and ∂h/∂y in J_H",
        "eq 11: the derivatives of h by x and y",
        readings,
        ({"H": _columns(-1.0, 0, 1)},),
    ),
    Mistake(
        "J_H-exchanged",
        "your step is the one with ∂h/∂x and ∂h/∂y exchanged in J_H",
        "eq 11: the derivatives of h, by x first",
        readings,
        ({"H": _exchanged},),
    ),
    Mistake(
        "J_H-of-a-point",
        "your step is the one with the J_H of a point where the beam ends, not of a wall",
        "eq 11: the derivatives of h; from another place the beam meets the wall at another point",
        beams,
        ({"H": _of_a_point}, {"H": _of_a_turned_point}),
    ),
    Mistake(
        "J_H-without-slant",
        "your step is the one with J_H not divided by the cosine between beam and normal",
        "eq 11: ∂h/∂x and ∂h/∂y are the wall's normal towards the robot over that cosine",
        beams,
        ({"H": _unit_normal(True)}, {"H": _unit_normal(False)}),
    ),
    Mistake(
        "J_H-in-degrees",
        "your step is the one with ∂h/∂θ by degrees in J_H, or with π/180 the wrong way round",
        "eq 11: the derivatives of h, by θ in radians",
        readings,
        ({"H": _columns(DEGREE, 2)}, {"H": _columns(1 / DEGREE, 2)}),
    ),
    Mistake(
        "sigma-in-C_v",
        "your C_v holds σ where σ² belongs",
        "eq 11: C_v is a variance, the square of σ",
        readings,
        ({"R": deviations},),
    ),
    Mistake(
        "C_v-of-the-reading",
        "your C_v is that of the measured range",
        "eq 11: C_v is of the predicted range, (rangeSigmaRatio * h)^2",
        beams,
        ({"R": lambda s, _: np.diag((s.laser.range_ratio * s.z) ** 2)},),
    ),
    Mistake(
        "no-C_v",
        "your K is the one without C_v",
        "eq 11: S = J_H P J_H' + C_v",
        readings,
        (
            {"R": lambda s, right: np.zeros_like(right())},
            {"S": lambda s, _: s.H @ s.P @ s.H.T},
        ),
    ),
    Mistake(
        "C_v-without-range",
        "your C_v is the ratio squared, without the range",
        "eq 11: C_v = (rangeSigmaRatio * h)^2",
        beams,
        ({"R": _range_variance(lambda ratio, h: ratio**2)},),
    ),
    Mistake(
        "C_v-ratio-not-squared",
        "your C_v is the one with the ratio not squared: ratio * h²",
        "eq 11: C_v = (rangeSigmaRatio * h)^2",
        beams,
        ({"R": _range_variance(lambda ratio, h: ratio * h**2)},),
    ),
    Mistake(
        "C_v-range-not-squared",
        "your C_v is the one with the range not squared: ratio² * h",
        "eq 11: C_v = (rangeSigmaRatio * h)^2",
        beams,
        ({"R": _range_variance(lambda ratio, h: ratio**2 * h)},),
    ),
    Mistake(
        "C_v-is-ratio",
        "your C_v is the ratio itself",
        "eq 11: C_v = (rangeSigmaRatio * h)^2",
        beams,
        ({"R": _range_variance(lambda ratio, h: ratio)},),
    ),
    Mistake(
        "C_v-squared-twice",
        "your C_v is σ⁴: a variance squared once more",
        "eq 11: C_v is a variance, the square of σ",
        readings,
        ({"R": squares},),
    ),
    Mistake(
        "C_v-subtracted",
        "your S is J_H P J_H' − C_v",
        "eq 11: S = J_H P J_H' + C_v",
        readings,
        ({"S": lambda s, _: s.H @ s.P @ s.H.T - s.R},),
    ),
)
