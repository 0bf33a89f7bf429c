"""A step of the EKF taken apart: every symbol is worked out from the others, and any of them may be
replaced.
"""

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from ekfsim.filters.arithmetic.algebra import gain_of_moments, symmetric, wrapped
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array
from ekfsim.models.layout import INERTIAL, POSE, SPEED_POSE
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.protocols import Motion, Sensor
from ekfsim.models.sensors.laser import Laser
from ekfsim.records import Control
from ekfsim.student.asked import Asked
from ekfsim.student.mistakes.recalling import Recalling, recalling

Rule = Callable[["Working"], Array]
# what a mistake has in place of a symbol; its second argument gives what stood there before
Piece = Callable[["Working", Callable[[], Array]], Array]
Pieces = Mapping[str, Piece]

MOTION: Mapping[str, Rule] = MappingProxyType(
    {
        "x": lambda s: s.asked.x,
        "P": lambda s: s.asked.P,
        "u": lambda s: s.given_numbers,
        "u_f": lambda s: s.u,  # the input that f is taken of
        "u_J": lambda s: s.u,  # that the Jacobians are taken of
        "u_M": lambda s: s.u,  # that the noise is taken of
        "x_F": lambda s: s.x,  # where F is taken
        "x_G": lambda s: s.x,  # where G is taken
        "f": lambda s: s.model.f(s.x, s.u_f),  # eq. 4
        "F": lambda s: s.model.F(s.x_F, s.u_J),  # eq. 6
        "G": lambda s: s.model.G(s.x_G, s.u_J),  # eq. 6
        "M": lambda s: s.model.M(s.u_M),  # eq. 1
        "Q": lambda s: np.asarray(s.model.Q(s.u)),
        "spread": lambda s: s.F @ s.P @ s.F.T,
        "noise": lambda s: s.G @ s.M @ s.G.T,
        "mean": lambda s: s.f,
        "covariance": lambda s: s.spread + s.noise + s.Q,  # eq. 7
    }
)
READING: Mapping[str, Rule] = MappingProxyType(
    {
        "x": lambda s: s.asked.x,
        "P": lambda s: s.asked.P,
        "z": lambda s: s.given_numbers,
        "x_h": lambda s: s.x,  # where h is taken
        "x_H": lambda s: s.x,
        "x_R": lambda s: s.x,
        "h": lambda s: s.model.h(s.x_h),  # eq. 8
        "H": lambda s: s.model.H(s.x_H),  # eq. 11
        "R": lambda s: s.model.R(s.x_R),  # eq. 11
        "innovation": lambda s: s.model.residual(s.z, s.h),  # eq. 9
        "S": lambda s: s.H @ s.P @ s.H.T + s.R,  # eq. 11
        "cross": lambda s: s.P @ s.H.T,
        "K": lambda s: gain_of_moments(s.cross, s.S),  # eq. 11, 0 where S = 0
        "mean": lambda s: s.x + s.K @ s.innovation,  # eq. 10
        "covariance": lambda s: s.P - s.K @ s.H @ s.P,  # eq. 12
    }
)


def joseph(s: "Working", _: Callable[[], Array]) -> Array:
    """(I − KH) P (I − KH)ᵀ + K R Kᵀ"""
    I_KH = np.eye(len(s.x)) - s.K @ s.H
    return I_KH @ s.P @ I_KH.T + s.K @ s.R @ s.K.T


def by_innovation(s: "Working", _: Callable[[], Array]) -> Array:
    """P − K S Kᵀ"""
    return s.P - s.K @ s.S @ s.K.T


# other forms of eq. 12, which are the same as long as K is the right one for what is in them
FORMS: tuple[Pieces, ...] = ({"covariance": joseph}, {"covariance": by_innovation})


class Working:
    """The working of one step. A symbol is worked out when it is first asked for: `s.K`."""

    asked: Asked
    model: Recalling

    def __init__(self, asked: Asked, *changes: Pieces) -> None:
        self.asked, self.model = asked, recalling(model_of(asked))
        rules = dict(MOTION if isinstance(asked.given, Control) else READING)
        for pieces in changes:
            for symbol, piece in pieces.items():
                rules[symbol] = _changed(piece, rules[symbol])
        self._rules = rules

    def __getattr__(self, symbol: str) -> Array:
        """What a symbol is in this step."""
        value = self._rules[symbol](self)
        setattr(self, symbol, value)
        return value

    @property
    def robot(self) -> MoveTurn:
        """The motion, where it is the classroom's."""
        assert isinstance(self.model.model, MoveTurn)
        return self.model.model

    @property
    def laser(self) -> Laser:
        """The sensor, where it is the classroom's."""
        assert isinstance(self.model.model, Laser)
        return self.model.model

    @property
    def given_numbers(self) -> Array:
        """u or z"""
        given = self.asked.given
        return given.u if isinstance(given, Control) else given.z

    @property
    def places(self) -> tuple[int, int, int]:
        """Where x, y and θ stand in the state."""
        return places_of(self.asked)

    @property
    def result(self) -> Gaussian:
        """The belief after the step."""
        return Gaussian(wrapped(np.array(self.mean), self.asked.headings), self.covariance)


def places_of(asked: Asked) -> tuple[int, int, int]:
    """Where x, y and θ stand in the state that the filter is asked from."""
    n = len(asked.x)
    layouts = (SPEED_POSE, INERTIAL)
    return next((layout.places for layout in layouts if len(layout.names) == n), POSE.places)


def model_of(asked: Asked) -> Motion | Sensor:
    """The motion or the sensor that the filter is given."""
    given = asked.given
    return given.motion if isinstance(given, Control) else given.sensor


def usable(asked: Asked) -> bool:
    """Whether something can be made of it: an input, or a reading and a prediction of it."""
    given = asked.given
    if isinstance(given, Control):
        return True
    return bool(np.isfinite(given.z).all() and np.isfinite(given.sensor.h(asked.x)).all())


def right(asked: Asked) -> Gaussian:
    """What the EKF makes of the step: eqs 4 and 7, or 8 to 12. A reading that cannot be used leaves
    the belief as it was.
    """
    if not usable(asked):
        return Gaussian(asked.x, asked.P)
    x, P = Working(asked).result
    return Gaussian(x, symmetric(P))


def _changed(piece: Piece, before: Rule) -> Rule:
    return lambda s: piece(s, lambda: before(s))
