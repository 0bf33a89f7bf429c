"""arithmetic/descent.py of one robot: the same search without picking runs out of arrays.

What sums is the same function of numpy, and so are the last digits, on which it depends when a
search ends.
"""

import numpy as np

from ekfsim.fast.one.filtering.square_root import Rows, conditioned_one, slope_one
from ekfsim.filters.arithmetic.algebra import wrapped
from ekfsim.filters.arithmetic.descent import SHORTEST, TRIES, Search
from ekfsim.filters.arithmetic.tolerances import CONVERGED, ROUNDING
from ekfsim.geometry import Array, Booleans


def descend(
    search: Search, ν: Array, h: Array, H: Array, used: Booleans, most: int
) -> tuple[Array, Booleans] | None:
    """The most probable x : (n,), and whether the search came to rest within so many steps."""
    if search.axes:
        return None
    x0, L, z = search.x[0], search.L[0], search.z[0]
    rows, R = L.tolist(), search.R[0].tolist()
    x, w = x0.copy(), np.zeros_like(x0)
    if not used:
        return x, np.array(most > 0)
    left, tries, share = float(most), TRIES * most, 1.0
    J, _ = _cost(search, w, ν, h)
    step = _step(rows, R, w, ν, h, H)
    while step is not None and tries:
        tries -= 1
        w_t = w + share * step
        x_t = wrapped(x0 + np.matvec(L, w_t), search.headings)
        h_t, H_t, _ = search.sensor.linearize(x_t)
        ν_t = search.sensor.residual(z, h_t)
        J_t, slack = _cost(search, w_t, ν_t, h_t)
        if J_t <= J + slack:
            w, x, ν, h, H, J = w_t, x_t, ν_t, h_t, H_t, J_t
            left -= share
            share = min(4 * share, 1.0)
            step = _step(rows, R, w, ν, h, H) if left > 0 else None
        else:
            share /= 2
            if share <= SHORTEST:
                step = None
    return x, np.array(left > 0 and step is None)


def _step(L: Rows, R: Rows, w: Array, ν: Array, h: Array, H: Array) -> Array | None:
    """To where the linearised problem has its least J : (n,); None where that is here."""
    n = len(L)
    D = slope_one(H.tolist(), L)
    one = [[float(i == j) for j in range(n)] for i in range(n)]
    K = np.array(conditioned_one(one, D, R, h.tolist())[1])
    step = np.matvec(K, ν + np.matvec(np.array(D), w)) - w
    unsure = ROUNDING * np.matvec(np.abs(K), np.abs(h))
    return step if (np.abs(step) > CONVERGED + unsure).any() else None


def _cost(search: Search, w: Array, ν: Array, h: Array) -> tuple[float, float]:
    """J, and how much of it may be the rounding of h."""
    T, per = search.unmixed[0], search.weights[0]
    e = np.matvec(T, ν)
    J = float(np.vecdot(w, w) + np.vecdot(e * e, per))
    if J != J:
        return np.inf, np.nan
    return J, ROUNDING * float(np.vecdot(np.abs(e) * per, np.matvec(np.abs(T), np.abs(h))) + J)
