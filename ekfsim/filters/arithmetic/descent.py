"""The search for the most probable state of the iterated Kalman filter: Gauss–Newton steps that
only lead down.
"""

import numpy as np

from ekfsim.filters.arithmetic.algebra import wrapped
from ekfsim.filters.arithmetic.square_root import conditioned, slope
from ekfsim.filters.arithmetic.tolerances import CONVERGED, ROUNDING
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.protocols import Sensor

SHORTEST = 2.0**-10  # a step that must be shortened so much before it leads down leads nowhere
# for each whole step: in a narrow bent valley, as a far too sharp sensor makes one, no step gets
# far
TRIES = 8


class Search:
    """The search of N runs at once, each in x = x⁻ + L w, so that w is in standard deviations of
    the prior.

    J(w) = wᵀ w + νᵀ R⁻¹ ν, ν = z − h(x); infinite where x predicts no reading. A perfect sensor, R
    = 0, weighs as much as numbers can tell: R is never less than the share of S that rounding
    leaves.
    """

    def __init__(
        self,
        sensor: Sensor,
        z: Array,
        x: Array,
        L: Array,
        R: Array,
        S: Array,
        headings: tuple[int, ...],
    ) -> None:
        n, k = x.shape[-1], S.shape[-1]
        axes = S.shape[:-2]
        self._axes, self._one = axes, x.ndim == z.ndim == 1
        self._sensor, self._headings = sensor, headings
        self._z, self._x = (_rows(a, axes, a.shape[-1:]) for a in (z, x))
        self._L, self._R = _rows(L, axes, (n, n)), _rows(R, axes, (k, k))
        noise = conditioned(
            np.zeros((n, n)),
            np.zeros((k, n)),
            self._R + ROUNDING * _rows(S, axes, (k, k)),
            np.zeros(k),
        )
        self._unmixed, self._variances = noise.unmixed, noise.variances

    def descend(
        self, ν: Array, h: Array, H: Array, used: Booleans, most: int
    ) -> tuple[Array, Booleans]:
        """The most probable x : (…, n), and whether the search came to rest within so many steps :
        (…)

        It begins at the prior, where ν, h and H are, for the runs whose reading is used.
        """
        n = self._x.shape[-1]
        x, w = self._x.copy(), np.zeros_like(self._x)
        ν, h, H = (
            _rows(a, self._axes, a.shape[len(a.shape) - m :]).copy()
            for a, m in ((ν, 1), (h, 1), (H, 2))
        )
        going = np.flatnonzero(np.broadcast_to(used, self._axes))
        J, share, left = np.zeros(len(x)), np.ones(len(x)), np.full(len(x), float(most))
        tries = TRIES * most
        J[going] = self._cost(going, w[going], ν[going], h[going])[0]
        step, going = self._step(going, w, ν, h, H)
        while len(going) and tries:
            tries -= 1
            w_t = w[going] + share[going, None] * step[going]
            x_t = wrapped(self._x[going] + np.matvec(self._L[going], w_t), self._headings)
            h_t, H_t = self._linearized(x_t)
            ν_t = self._sensor.residual(self._z[going], h_t)
            J_t, slack = self._cost(going, w_t, ν_t, h_t)
            down = J_t <= J[going] + slack
            moved, stays = going[down], going[~down]
            for array, new in ((w, w_t), (x, x_t), (ν, ν_t), (h, h_t), (H, H_t), (J, J_t)):
                array[moved] = new[down]
            left[moved] -= share[moved]
            # where one step had to be short, the next will have to
            share[moved] = np.minimum(4 * share[moved], 1.0)
            share[stays] /= 2
            renewed, moved = self._step(moved[left[moved] > 0], w, ν, h, H)
            step[moved] = renewed[moved]
            going = np.concatenate([moved, stays[share[stays] > SHORTEST]])
        settled = left > 0
        settled[going] = False
        return x.reshape(*self._axes, n), settled.reshape(self._axes)

    def _step(
        self, some: Integers, w: Array, ν: Array, h: Array, H: Array
    ) -> tuple[Array, Integers]:
        """To where the linearised problem has its least J : (N, n), and which of some are not there
        yet.
        """
        steps = np.zeros_like(w)
        if len(some):
            D = slope(H[some], self._L[some])
            K = self._gain(D, self._R[some], h[some])
            steps[some] = np.matvec(K, ν[some] + np.matvec(D, w[some])) - w[some]
            # what the rounding of h is worth
            unsure = ROUNDING * np.matvec(np.abs(K), np.abs(h[some]))
            some = some[np.any(np.abs(steps[some]) > CONVERGED + unsure, axis=-1)]
        return steps, some

    def _gain(self, D: Array, R: Array, h: Array) -> Array:
        """Dᵀ (D Dᵀ + R)⁻¹ : (m, n, k)"""
        one = np.eye(D.shape[-1])
        if self._one:
            return conditioned(one, D[0], R[0], h[0]).K[None]
        return conditioned(one, D, R, h).K

    def _cost(self, some: Integers, w: Array, ν: Array, h: Array) -> tuple[Array, Array]:
        """J : (m,), and how much of it may be the rounding of h."""
        T, s = self._unmixed[some], self._variances[some]
        e, per = np.matvec(T, ν), np.divide(1.0, s, out=np.zeros_like(s), where=s > 0)
        J = np.vecdot(w, w) + np.vecdot(e * e, per)
        slack = np.vecdot(np.abs(e) * per, np.matvec(np.abs(T), np.abs(h))) + np.where(
            np.isnan(J), 0.0, J
        )
        return np.where(np.isnan(J), np.inf, J), ROUNDING * slack

    def _linearized(self, x: Array) -> tuple[Array, Array]:
        """h : (m, k) and H : (m, k, n); one robot is looked after by the sensor's quick way for
        one.
        """
        if self._one:
            h, H, _ = self._sensor.linearize(x[0])
            return h[None], H[None]
        h, H, _ = self._sensor.linearize(x)
        return h, H


def _rows(a: Array, axes: tuple[int, ...], shape: tuple[int, ...]) -> Array:
    """(…, *shape) → (N, *shape), one row for each run."""
    return np.broadcast_to(a, (*axes, *shape)).reshape(-1, *shape)
