"""The search for the most probable state of the iterated Kalman filter: Gauss–Newton steps that
only lead down.
"""

import numpy as np

from ekfsim.filters.arithmetic.algebra import wrapped
from ekfsim.filters.arithmetic.square_root import conditioned, slope
from ekfsim.filters.arithmetic.tolerances import CONVERGED, ROUNDING
from ekfsim.geometry import Array, Booleans, Integers
from ekfsim.models.protocols import Sensor, of_rows
from ekfsim.twins import twinned

SHORTEST = 2.0**-10  # a step that must be shortened so much before it leads down leads nowhere
# for each whole step: in a narrow bent valley, as a far too sharp sensor makes one, no step gets
# far
TRIES = 8


class Search:
    """The search of N runs at once, each in x = x⁻ + L w, so that w is in standard deviations of
    the prior.

    J(w) = wᵀ w + νᵀ R⁻¹ ν = Σ wᵢ² + Σ eᵢ²/sᵢ, with ν = z − h(x) and e = T ν; infinite where x
    predicts no reading. A perfect sensor, R = 0, weighs as much as numbers can tell: R is never
    less than the share of S that rounding leaves.
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
        self.axes = axes = S.shape[:-2]
        self.sensor, self.headings = sensor, headings
        self.z, self.x = (_rows(a, axes, a.shape[-1:]) for a in (z, x))
        self.L, self.R = _rows(L, axes, (n, n)), _rows(R, axes, (k, k))
        noise = conditioned(np.zeros((n, n)), np.zeros((k, n)), R + ROUNDING * S, np.zeros(k))
        T, s = _rows(noise.unmixed, axes, (k, k)), _rows(noise.variances, axes, (k,))
        # of e = T ν, which have nothing in common, and of each its 1/sᵢ
        self.unmixed, self.weights = T, np.divide(1.0, s, out=np.zeros(s.shape), where=s > 0)

    @twinned
    def descend(
        self, ν: Array, h: Array, H: Array, used: Booleans, most: int
    ) -> tuple[Array, Booleans]:
        """The most probable x : (…, n), and whether the search came to rest within so many steps :
        (…)

        It begins at the prior, where ν, h and H are, for the runs whose reading is used.
        """
        n = self.x.shape[-1]
        x, w = self.x.copy(), np.zeros_like(self.x)
        ν, h, H = (
            _rows(a, self.axes, a.shape[len(a.shape) - m :]).copy()
            for a, m in ((ν, 1), (h, 1), (H, 2))
        )
        going = np.flatnonzero(np.broadcast_to(used, self.axes))
        J, share, left = np.zeros(len(x)), np.ones(len(x)), np.full(len(x), float(most))
        tries = TRIES * most
        J[going] = self._cost(going, w[going], ν[going], h[going])[0]
        step, going = self._step(going, w, ν, h, H)
        while len(going) and tries:
            tries -= 1
            w_t = w[going] + share[going, None] * step[going]
            x_t = wrapped(self.x[going] + np.matvec(self.L[going], w_t), self.headings)
            h_t, H_t, _ = of_rows(self.sensor, going).linearize(x_t)
            ν_t = self.sensor.residual(self.z[going], h_t)
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
        return x.reshape(*self.axes, n), settled.reshape(self.axes)

    def _step(
        self, some: Integers, w: Array, ν: Array, h: Array, H: Array
    ) -> tuple[Array, Integers]:
        """To where the linearised problem has its least J : (N, n), and which of some are not there
        yet.
        """
        steps = np.zeros_like(w)
        if len(some):
            D = slope(H[some], self.L[some])
            K = conditioned(np.eye(w.shape[-1]), D, self.R[some], h[some]).K  # Dᵀ (D Dᵀ + R)⁻¹
            steps[some] = np.matvec(K, ν[some] + np.matvec(D, w[some])) - w[some]
            # what the rounding of h is worth
            unsure = ROUNDING * np.matvec(np.abs(K), np.abs(h[some]))
            some = some[np.any(np.abs(steps[some]) > CONVERGED + unsure, axis=-1)]
        return steps, some

    def _cost(self, some: Integers, w: Array, ν: Array, h: Array) -> tuple[Array, Array]:
        """J : (m,), and how much of it may be the rounding of h."""
        T, per = self.unmixed[some], self.weights[some]
        e = np.matvec(T, ν)
        J = np.vecdot(w, w) + np.vecdot(e * e, per)
        slack = np.vecdot(np.abs(e) * per, np.matvec(np.abs(T), np.abs(h))) + np.where(
            np.isnan(J), 0.0, J
        )
        return np.where(np.isnan(J), np.inf, J), ROUNDING * slack


def _rows(a: Array, axes: tuple[int, ...], shape: tuple[int, ...]) -> Array:
    """(…, *shape) → (N, *shape), one row for each run."""
    return np.broadcast_to(a, (*axes, *shape)).reshape(-1, *shape)
