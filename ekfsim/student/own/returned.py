"""What comes back of a student's code: looked at before it is used.

First what it is: two values, of the right shapes, finite. Then whether it can be: a covariance is
symmetric and has no negative variance, a heading is in radians.
"""

from typing import Any

import numpy as np

from ekfsim.filters.arithmetic.algebra import inverse, wrapped
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.records import Control
from ekfsim.student.asked import Answer, Asked

ASYMMETRY = 1e-9  # m², rad²: by so much may P differ from its transpose
SLIGHT = 1e-12  # m², rad²: σ of a micrometre, a microradian; what is less is rounding
ROUNDING = 1e-9  # of the largest variance
ALIKE = 1e-3  # rad
LARGEST = 1e12  # m, rad; beyond, a float itself is coarser than what is told
TURN = 2 * np.pi  # rad; a heading that leaps by more than this and what was turned is in degrees


class WrongError(ValueError):
    """What is wrong with what came back; what would be right."""


def answer(returned: Any, function: str, n: int) -> Answer:
    """The mean and the covariance that a function returned. Raises WrongError where it returned
    something else.
    """
    if returned is None:
        raise WrongError(f"{function} returns nothing; write `return x, P`")
    if not isinstance(returned, tuple | list):
        raise WrongError(f"{function} returns {a_kind(returned)}; write `return x, P`")
    if len(returned) != 2:
        raise WrongError(f"{function} returns {len(returned)} values; write `return x, P`")
    return looked_at(returned[0], returned[1], n)


def looked_at(x: Any, P: Any, n: int) -> Answer:
    """Mean and covariance as arrays of their own, of the right shapes and finite. Raises
    WrongError.
    """
    mean, covariance = numbers("x", x), numbers("P", P)
    if mean.shape == (n, n) and covariance.shape == (n,):
        raise WrongError("P comes first and x second; write `return x, P`")
    if mean.shape != (n,):
        right = ""
        if mean.size == n and n in mean.shape:
            kind = "column" if mean.shape[0] == n else "row"
            right = f", a {kind} vector; write x.ravel()"
        raise WrongError(f"x has the shape {mean.shape}, not ({n},){right}")
    if covariance.shape != (n, n):
        raise WrongError(f"P has the shape {covariance.shape}, not ({n}, {n})")
    for name, array in (("x", mean), ("P", covariance)):
        if not np.isfinite(array).all():
            at = tuple(int(i) for i in np.argwhere(~np.isfinite(array))[0])
            raise WrongError(f"{name}[{', '.join(map(str, at))}] is {array[at]}")
    return Answer(mean, covariance)


def numbers(name: str, value: Any) -> Array:
    """An array of real numbers, a copy. Raises WrongError where it is none."""
    if value is None:
        raise WrongError(f"{name} is None, not an array of numbers")
    try:
        if isinstance(value, np.ma.MaskedArray) and np.ma.is_masked(value):
            raise WrongError(f"{name} holds masked values; it is to hold numbers")
        array = np.asarray(value)
        if array.dtype == object:  # numbers that Python keeps one by one
            array = np.array([one_of(name, part) for part in array.ravel()]).reshape(array.shape)
    except WrongError:
        raise
    except Exception:
        raise WrongError(f"{name} is no array of numbers: {_uneven(name, value)}") from None
    if array.dtype.kind == "c":
        raise WrongError(f"{name} holds complex numbers; write {name}.real where they should be")
    if array.dtype.kind in "US":
        raise WrongError(f"{name} holds text where numbers should be")
    if array.dtype.kind not in "iuf":
        raise WrongError(f"{name} is {a_kind(value)}, not an array of numbers")
    return np.array(array, float)


def _uneven(name: str, value: Any) -> str:
    """Which entry is shaped otherwise than the first."""
    try:
        first, *rest = (np.shape(entry) for entry in value)
        i, shape = next((i, one) for i, one in enumerate(rest, 1) if one != first)
    except Exception:
        return "its entries have different shapes"
    return f"{name}[0] has the shape {first}, {name}[{i}] the shape {shape}"


def one_of(name: str, part: Any) -> float:
    """A number that stands in an array of objects. Raises WrongError where it is none."""
    if isinstance(part, int | float | np.integer | np.floating) and not isinstance(part, bool):
        return float(part)
    raise WrongError(f"{name} holds {a_kind(part)} where a number should be")


def a_kind(value: Any) -> str:
    """What kind of thing a value is.

    >>> a_kind(np.zeros(3)), a_kind("x"), a_kind(None), a_kind([1, 2])
    ('one array of shape (3,)', 'text', 'None', 'a list')
    """
    if value is None:
        return "None"
    if isinstance(value, str | bytes):
        return "text"
    if isinstance(value, np.ndarray) and value.dtype.kind in "iufc":
        return f"one array of shape {value.shape}"
    if isinstance(value, int | float | np.number) and not isinstance(value, bool):
        return "one number"
    name = type(value).__name__
    return f"{'an' if name[:1].lower() in 'aeiou' else 'a'} {name}"


def judged(asked: Asked, theirs: Answer) -> Gaussian:
    """The belief that the answer is, headings wrapped. Raises WrongError where it can be none."""
    x, P = theirs.x.copy(), theirs.P.copy()
    refuse_boundless(x, P)
    apart = np.abs(P - P.T)
    size = float(np.abs(P).max())
    if apart.max() > ASYMMETRY * max(1.0, size):
        i, j = (int(part) for part in np.unravel_index(np.argmax(apart), P.shape))
        raise WrongError(
            f"P is not symmetric: P[{i}, {j}] is {P[i, j]:.6g} and P[{j}, {i}] is {P[j, i]:.6g}"
        )
    for i, variance in enumerate(P.diagonal().tolist()):
        if variance < -(SLIGHT + ROUNDING * size):
            raise WrongError(f"P[{i}, {i}] is {variance:.6g}: no variance is negative")
    lowest, *_, highest = np.linalg.eigvalsh((P + P.T) / 2).tolist()
    if lowest < -(SLIGHT + ROUNDING * abs(highest)):
        raise WrongError(f"P has the negative eigenvalue {lowest:.6g}: it is no covariance")
    for i in asked.headings:
        refuse_degrees(asked, i, float(x[i]))
    return Gaussian(wrapped(x, asked.headings), P)


def refuse_boundless(x: Array, P: Array) -> None:
    """Raise WrongError where numbers are finite, and so large that no more can be calculated."""
    for i, (value, variance) in enumerate(zip(x.tolist(), P.diagonal().tolist(), strict=True)):
        if abs(value) > LARGEST:
            raise WrongError(f"x[{i}] is {value:.3g}: no robot is so far away")
        if variance > LARGEST**2:
            raise WrongError(f"P[{i}, {i}] is {variance:.3g}: nothing is so uncertain")
    for i, j in np.argwhere(np.abs(P) > LARGEST**2).tolist():
        raise WrongError(f"P[{i}, {j}] is {P[i, j]:.3g}: no covariance is so large")


def refuse_degrees(asked: Asked, i: int, heading: float) -> None:
    """Raise WrongError where a heading leaps as if it were told in degrees: by more than was turned
    and a full turn, and not by full turns alone.
    """
    leap, most = abs(heading - float(asked.x[i])), 2 * TURN
    if isinstance(asked.given, Control):
        inputs = zip(asked.given.u.tolist(), asked.given.motion.inputs, strict=True)
        most = TURN + sum(abs(value) for value, quantity in inputs if quantity.unit == "rad")
    if leap <= most or abs(wrap(heading - expected(asked)[i])) < ALIKE:
        return
    raise WrongError(
        f"x[{i}] goes from {asked.x[i]:.6g} to {heading:.6g} in one step: headings are in "
        "radians; this looks like degrees"
    )


def expected(asked: Asked) -> Array:
    """What an EKF makes of the mean : (n,)"""
    x, P = asked.x, asked.P
    if isinstance(asked.given, Control):
        return asked.given.motion.f(x, asked.given.u)
    h, H, R = asked.given.sensor.linearize(x)
    K = P @ H.mT @ inverse(H @ P @ H.mT + R)
    return x + K @ asked.given.sensor.residual(asked.given.z, h)
