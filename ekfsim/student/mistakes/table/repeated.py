"""Updates that are made again: with the same reading, or at the estimate that came of it."""

from collections.abc import Callable
from dataclasses import replace

from ekfsim.filters.arithmetic.algebra import gain_of_moments
from ekfsim.geometry import Array
from ekfsim.student.mistakes.working import Piece, Working


def again(s: Working) -> Working:
    """The step after this one, with the same reading."""
    once = Working(s.asked)
    return Working(replace(s.asked, x=once.mean, P=once.covariance))


def anew(s: Working) -> tuple[Array, Array]:
    """K and H at the estimate after the update."""
    x = s.x + s.K @ s.innovation
    H, R = s.model.H(x), s.model.R(x)
    return gain_of_moments(s.P @ H.T, H @ s.P @ H.T + R), H


def iterated(times: int, noise: Callable[[Working, Array], Array]) -> dict[str, Piece]:
    """The update whose h and J_H are taken again at the estimate that comes of it.

    noise : C_v at such an estimate
    """

    def last(s: Working) -> tuple[Array, Array, Array]:
        x = s.x
        for _ in range(times):
            H = s.model.H(x)
            K = gain_of_moments(s.P @ H.T, H @ s.P @ H.T + noise(s, x))
            at = x
            x = s.x + K @ (s.model.residual(s.z, s.model.h(at)) - H @ (s.x - at))
        return x, K, H

    def covariance(s: Working) -> Array:
        _, K, H = last(s)
        return s.P - K @ H @ s.P

    return {"mean": lambda s, _: last(s)[0], "covariance": lambda s, _: covariance(s)}
