"""A student's own derivatives: functions F, G and H in the same file."""

from collections.abc import Sequence
from typing import Any

from ekfsim.geometry import Array
from ekfsim.records import Control, Reading
from ekfsim.student.fault import FaultError
from ekfsim.student.own.handed import HandedMotion, HandedSensor
from ekfsim.student.own.loading import Code
from ekfsim.student.own.returned import WrongError, numbers


def derivative(
    code: Code, name: str, x: Array, given: Control | Reading, provided: Sequence[str] | None
) -> Array:
    """What the F(x, u, motion) : (n, n), G(x, u, motion) : (n, m) or H(x, sensor) : (k, n) returns.

    Raises FaultError where there is no such function, or where it fails or returns something else.
    """
    function, n = getattr(code.module, name, None), len(x)
    args: tuple[Any, ...]
    match given:
        case Control(motion, u):
            args, taken = (u.copy(), HandedMotion(motion, n, provided)), "x, u, motion"
            shape = n, (n if name == "F" else len(u))
        case Reading(sensor, z):
            args, taken, shape = (HandedSensor(sensor, n, provided),), "x, sensor", (len(z), n)
    if not callable(function):
        raise FaultError(code.label, f"there is no function {name}({taken})")
    place = code.place_of(function)
    with code.home.entered():
        try:
            returned = function(x.copy(), *args)
        except BaseException as error:
            code.home.blame(error, place)
    try:
        if returned is None:
            raise WrongError(f"{name} returns nothing; write `return {name}`")
        found = numbers(name, returned)
    except WrongError as wrong:
        raise FaultError(place, str(wrong)) from None
    if found.shape != shape:
        raise FaultError(place, f"{name} has the shape {found.shape}, not {shape}")
    return found
