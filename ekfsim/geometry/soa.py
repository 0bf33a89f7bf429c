"""Structure of arrays: small matrices of many runs, laid out so that NumPy is quick at them.

Everywhere an array of matrices is (…, n, m). In memory, however, the same entry of all runs may lie
side by side: then `M[..., i, j]` is one stretch of numbers, and what is worked out entry by entry
costs a fraction.
"""

import numpy as np

from ekfsim.geometry import Array


def soa_zeros(axes: tuple[int, ...], *inner: int) -> Array:
    """Zeros (*axes, *inner), the same entry of all runs side by side in memory.

    >>> soa_zeros((1000,), 3, 3)[:, 0, 1].strides
    (8,)
    """
    d = len(inner)
    return np.zeros((*inner, *axes)).transpose(*range(d, d + len(axes)), *range(d))


def to_soa(M: Array, inner: int = 2) -> Array:
    """A view of matrices (…, n, m) with their entries in front : (n, m, …)

    inner : how many axes at the end are entries, 2 of a matrix, 1 of a vector
    """
    axes = M.ndim - inner
    return M.transpose(*range(axes, M.ndim), *range(axes))


def from_soa(M: Array, inner: int = 2) -> Array:
    """What `to_soa` took apart: a view of (n, m, …) as (…, n, m)."""
    return M.transpose(*range(inner, M.ndim), *range(inner))
