"""What a filter asks of a motion and of a sensor. All arrays carry leading axes (…)."""

from typing import NamedTuple, Protocol, TypeVar, cast, runtime_checkable

from ekfsim.geometry import Array, Integers
from ekfsim.twins import twinned


class Quantity(NamedTuple):
    """One number of a motion input or a reading, as people call it.

    unit : "m", "rad", "m/s", "s", …, "" for none
    """

    name: str
    unit: str


class Motion(Protocol):
    """x⁺ = f(x, u + noise of covariance M) + noise of covariance Q

    Linearised by F = ∂f/∂x and G = ∂f/∂u.
    """

    __slots__ = ()

    @property
    def inputs(self) -> tuple[Quantity, ...]:
        """What the entries of u are."""

    def f(self, x: Array, u: Array) -> Array:
        """The next state. x : (…, n), u : (…, m) → (…, n)"""

    def F(self, x: Array, u: Array) -> Array:
        """∂f/∂x : (…, n, n)"""

    def G(self, x: Array, u: Array) -> Array:
        """∂f/∂u : (…, n, m)"""

    def M(self, u: Array) -> Array:
        """Covariance of the input's noise : (…, m, m)"""

    def Q(self, u: Array) -> Array | float:
        """Covariance of the process noise : (…, n, n), or 0 where there is none."""

    @twinned
    def linearize(self, x: Array, u: Array) -> tuple[Array, Array, Array, Array, Array | float]:
        """f, F, G, M and Q, as a filter asks for them."""
        return self.f(x, u), self.F(x, u), self.G(x, u), self.M(u), self.Q(u)


class Alternatives(NamedTuple):
    """The lines that a sensor may be taken for about one state, the first of them its own there.
    What is none has a share of 0.
    """

    h: Array  # (…, a, k), nan where nothing is predicted
    H: Array  # (…, a, k, n)
    R: Array  # (…, a, k, k)
    share: Array  # (…, a) of the belief, from where the reading would be that line's
    wall: Integers  # (…, a) which wall it is, as the sensor's map counts them; −1 where none is


class Sensor(Protocol):
    """z = h(x) + noise of covariance R, linearised by H = ∂h/∂x."""

    __slots__ = ()

    @property
    def outputs(self) -> tuple[Quantity, ...]:
        """What the entries of z are.

        Those in rad are directions: z − h wraps them, and a mean of them is circular.
        """

    def h(self, x: Array) -> Array:
        """The reading that the state x predicts : (…, k), nan where it predicts none."""

    def H(self, x: Array) -> Array:
        """∂h/∂x : (…, k, n), 0 where h is nan"""

    def R(self, x: Array) -> Array:
        """Covariance of the reading's noise : (…, k, k), nan where h is nan and R depends on it"""

    @twinned
    def linearize(self, x: Array) -> tuple[Array, Array, Array]:
        """h, H and R, as a filter asks for them."""
        return self.h(x), self.H(x), self.R(x)

    def residual(self, z: Array, h: Array) -> Array:
        """ν = z − h : (…, k), to be wrapped where it is an angle"""
        return z - h


Model = TypeVar("Model", bound=Motion | Sensor)


@runtime_checkable
class OfRuns(Protocol):
    """A sensor that holds something of each of N runs side by side."""

    def of_run(self, run: tuple[int | Integers, ...]) -> Sensor:
        """The sensor of one of them; of some of them, where the index is an array."""


def of_rows(model: Model, rows: Integers) -> Model:
    """The sensor, or the motion, of some of N runs. rows : (m,)"""
    of_run = getattr(model, "of_run", None)  # a protocol would take far longer to be asked
    return model if of_run is None else cast(Model, of_run((rows,)))


@runtime_checkable
class Parting(Protocol):
    """A sensor whose reading may be one thing or another: a beam may meet this wall or that."""

    def alternatives(self, x: Array, P: Array) -> Alternatives | None:
        """What may be read within a belief x : (…, n), P : (…, n, n); None where what it is made of
        has no alternatives.
        """


def angles(quantities: tuple[Quantity, ...]) -> tuple[int, ...]:
    """Which entries are directions on the circle.

    >>> angles((Quantity("range", "m"), Quantity("bearing", "rad")))
    (1,)
    """
    return tuple(i for i, quantity in enumerate(quantities) if quantity.unit == "rad")
