"""Numbers as a person reads them: six digits, lengths to 0.1 mm, degrees to 0.0001, no noise of the
last bit.
"""

import math
from collections.abc import Iterable, Sequence
from functools import cache

import numpy as np

from ekfsim.geometry import Array
from ekfsim.models.layout import Layout
from ekfsim.models.protocols import Quantity
from ekfsim.twins import twinned

NOISE = 1e-15  # what is smaller is a rounding error of metres, radians or their squares
GRAIN = 1e-11  # m, degrees: of a pose, what is smaller is what sums of many steps make of 0
# of the largest number beside it, or of σᵢ σⱼ: the same of a number in a vector or matrix
ROUNDING = 1e-10
LARGE = 100.0  # m, degrees: of less, six digits are fine enough
HUGE = 1e12  # m, degrees: beyond, a float itself is coarser
WHOLE = 1e6  # of a glance: a larger number is told with a power of ten
TINY = 0.01  # of a glance: a smaller one is told as no more than that
MANY = 8  # numbers of a reading, rows and columns of a matrix; of more only so many are told
UNITS = {"rad": "degrees", "rad/s": "degrees/s"}  # what a person reads in place of it


def fill(template: str, *values: float) -> str:
    """A template with a number in the place of each %.6g.

    >>> fill("x=%.6g, y=%.6g, z=%.6g", 1 / 3, 6.1e-17, -0.0)
    'x=0.333333, y=0, z=0'
    """
    return template % tuple([0.0 if -NOISE < value < NOISE else value for value in values])


def fill_vector(template: str, *values: float) -> str:
    """The same with the numbers of one vector, none of which is told where it is the rounding of
    another.

    >>> fill_vector("dh/dx = %.6g, dh/dy = %.6g, dh/dth = %.6g", -1.0, 0.0, -2.2e-15)
    'dh/dx = -1, dh/dy = 0, dh/dth = 0'
    """
    slight = ROUNDING * max(map(abs, values))
    return fill(template, *[0.0 if abs(value) < slight else value for value in values])


def number(value: float) -> str:
    """Six significant digits.

    >>> number(1 / 3), number(6.1e-17)
    ('0.333333', '0')
    """
    return f"{0.0 if -NOISE < value < NOISE else value:.6g}"


def fine(value: float) -> str:
    """A length in m or an angle in degrees: six digits, and more where they would be coarser than
    0.0001.

    >>> fine(1 / 3), fine(5_000_000.123456), fine(-178.25), fine(6.1e-17)
    ('0.333333', '5000000.1235', '-178.25', '0')
    """
    if LARGE <= abs(value) < HUGE:
        return f"{value:.4f}".rstrip("0").rstrip(".")
    return f"{0.0 if -NOISE < value < NOISE else value:.6g}"


def turn(angle: float) -> str:
    """An angle turned by, in degrees; it may be more than a full turn, and −180 is not 180.

    >>> turn(-math.pi), turn(4 * math.pi)
    ('-180', '720')
    """
    return fine(math.degrees(angle))


def heading(angle: float) -> str:
    """A heading in degrees, in (−180, 180] also as it is written.

    >>> heading(math.pi / 2), heading(-math.pi + 1e-9)
    ('90', '180')
    """
    degrees = math.degrees(angle)
    return fine(degrees + 360 if degrees <= -179.99995 else _grained(degrees))


def point(x: float, y: float) -> str:
    """A place, in m.

    >>> point(1e-14, -0.5)
    '(0, -0.5)'
    """
    return f"({fine(_grained(x))}, {fine(_grained(y))})"


def pose(state: Iterable[float]) -> str:
    """x and y in m, θ in degrees.

    >>> pose([1.0, 2.5, math.pi]), pose([1e-14, -0.5, -1e-14])
    ('(1, 2.5, 180)', '(0, -0.5, 0)')
    """
    x, y, θ = state
    return f"({fine(_grained(x))}, {fine(_grained(y))}, {heading(θ)})"


def _grained(value: float) -> float:
    return 0.0 if abs(value) < GRAIN else value


def length(m: float) -> str:
    """A length with the unit that suits it.

    >>> length(0.0412), length(12.345), length(0), length(0.00071), length(1234.5)
    ('4.12 cm', '12.3 m', '0 m', '0.71 mm', '1230 m')
    """
    for unit, size in (("m", 1.0), ("cm", 1e-2), ("mm", 1e-3)):
        if abs(m) >= size:
            return f"{_three_digits(m / size)} {unit}"
    return f"{_three_digits(m * 1e3)} mm" if m else "0 m"


def _three_digits(value: float) -> str:
    return f"{float(f'{value:.3g}'):g}" if abs(value) < 1e5 else f"{value:.3g}"


def figure(value: float) -> str:
    """A number as a glance takes it: three digits, but whole where it is large.

    >>> figure(82.1314), figure(20341.2), figure(3.2e7), figure(1.5e-5), figure(0)
    ('82.1', '20341', '3.2e+07', '< 0.01', '0')
    """
    if 0 < value < TINY:
        return f"< {TINY:g}"
    return f"{value:.0f}" if 1000 <= value < WHOLE else f"{value:.3g}"


def between(low: float, high: float) -> str:
    """A band, as a glance takes it.

    >>> between(38.6098, 96.8781), between(3.9e-5, 7.88)
    ('38.6 to 96.9', '0 to 7.88')
    """
    return f"{figure(low) if low >= TINY else 0} to {figure(high)}"


def instant(t: float) -> str:
    """An instant in s, to a microsecond however long ago the clock began.

    >>> instant(0.1 + 0.2), instant(1248272272.841), instant(14.0)
    ('0.3', '1248272272.841', '14')
    """
    return f"{t:.6f}".rstrip("0").rstrip(".")


def quantity(what: Quantity, value: float) -> str:
    """A number of a motion input or a reading with its name and unit; radians in degrees, "nothing"
    for nan.

    >>> quantity(Quantity("turn rate", "rad/s"), math.pi), quantity(Quantity("echo", ""), math.nan)
    ('turn rate = 180 degrees/s', 'echo = nothing')
    """
    if math.isnan(value):
        return f"{what.name} = nothing"
    told = fine(math.degrees(value) if what.unit in UNITS else value)
    return f"{what.name} = {told} {UNITS.get(what.unit, what.unit)}".rstrip()


def quantities(what: Sequence[Quantity], values: Array, directions: bool = False) -> str:
    """The same for all of them; where they are directions, those in rad are told in (−180, 180].

    >>> import numpy as np
    >>> polar = (Quantity("range", "m"), Quantity("bearing", "rad"))
    >>> quantities(polar, np.array([2.0, -math.pi]), directions=True)
    'range = 2 m, bearing = 180 degrees'
    """
    told = [
        f"{q.name} = {heading(value)} degrees"
        if directions and q.unit == "rad"
        else quantity(q, value)
        for q, value in zip(what[:MANY], values[:MANY].tolist(), strict=True)
    ]
    return ", ".join([*told, f"… ({len(what)} numbers)"] if len(what) > MANY else told)


def state(x: Array, layout: Layout) -> str:
    """The entries of a state with their names, headings in degrees.

    >>> import numpy as np
    >>> from ekfsim.models.layout import SPEED_POSE
    >>> state(np.array([1.0, math.pi / 2, 3.0, 4.0]), SPEED_POSE)
    '(v, phi, x, y) = (1, 90, 3, 4)'
    """
    told = [
        heading(value) if i in layout.headings else fine(value)
        for i, value in enumerate(x.tolist())
    ]
    return f"({', '.join(layout.names)}) = ({', '.join(told)})"


def matrix(A: Array) -> str:
    """A matrix, a line for each row; … stands for what is too much to read.

    >>> import numpy as np
    >>> print(matrix(np.array([[1.0, 0.5], [0.25, 1 / 3]])), end="")
    [[1 0.5]
    [0.25 0.333333]]
    >>> print(matrix(np.array([[1.0, -6.97e-15]])), end="")
    [[1 0]]

    Of a covariance a small variance beside a large one is no rounding:

    >>> print(matrix(np.diag([1e12, 1e-6])), end="")
    [[1e+12 0]
    [0 1e-06]]
    """
    rows, columns = A.shape
    numbers = [value for row in cleared(A, ROUNDING)[:MANY] for value in row[:MANY]]
    return fill(_layout(rows, columns), *numbers)


@cache
def _layout(rows: int, columns: int) -> str:
    """The template of a matrix."""
    row = " ".join(["%.6g"] * min(columns, MANY) + ["…"] * (columns > MANY))
    told = "\n".join([f"[{row}]"] * min(rows, MANY) + ["…"] * (rows > MANY))
    return f"[{told}]\n"


@twinned
def cleared(A: Array, rounding: float) -> list[list[float]]:
    """The rows of a matrix, 0 in place of each number that is less than this of what it is small
    beside.
    """
    rows: list[list[float]] = np.where(np.abs(A) < rounding * _beside(A, rounding), 0.0, A).tolist()
    return rows


def _beside(A: Array, rounding: float) -> Array:
    """What each number of a matrix is small beside: of a covariance σᵢ σⱼ, else the largest of its
    row and column.
    """
    if A.shape[0] == A.shape[1] and (A.diagonal() >= 0).all():
        σ = np.sqrt(A.diagonal())
        σσ: Array = np.outer(σ, σ)
        if (np.abs(A - A.T) <= rounding * σσ).all():
            return σσ
    size: Array = np.nan_to_num(np.abs(A))
    largest: Array = np.maximum(
        size.max(axis=0, initial=0.0), size.max(axis=1, keepdims=True, initial=0.0)
    )
    return largest


def count(n: int, thing: str) -> str:
    """So many things.

    >>> count(1, "reading"), count(12, "reading")
    ('1 reading', '12 readings')
    """
    return f"{n} {thing}" if n == 1 else f"{n} {thing}s"
