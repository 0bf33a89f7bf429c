"""Quantiles of the χ² distribution, each computed once, and its tail."""

from functools import lru_cache

import numpy as np

from ekfsim.geometry import Array
from ekfsim.twins import twinned


@twinned
@lru_cache(maxsize=4096)
def quantile(probability: float, dof: int) -> float:
    """The value that a χ² variable of `dof` degrees of freedom stays below with this probability; 0
    for no freedom.

    >>> round(quantile(0.999, 3), 2)
    16.27
    """
    if dof == 0:
        return 0.0
    from scipy.special import chdtri  # takes a fifth of a second to import

    return float(chdtri(dof, 1 - probability))


def survival(value: Array, dof: int) -> Array:
    """P(χ² > value) of `dof` degrees of freedom : (…); nan where the value is.

    >>> survival(np.array([0.0, 3.841458820694124]), 1).round(6).tolist()
    [1.0, 0.05]
    """
    from scipy.special import chdtrc  # takes a fifth of a second to import

    return np.asarray(chdtrc(dof, value))


def band(probability: float, dof: int) -> tuple[float, float]:
    """The two-sided interval that holds a χ² variable with this probability.

    >>> [round(bound, 3) for bound in band(0.95, 1)]
    [0.001, 5.024]
    """
    tail = (1 - probability) / 2
    return quantile(tail, dof), quantile(1 - tail, dof)
