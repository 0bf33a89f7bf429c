"""Covariances of noises that do not depend on each other."""

from functools import lru_cache

import numpy as np

from ekfsim.geometry import Array


@lru_cache(maxsize=256)
def independent(*sigmas: float) -> Array:
    """diag(σ₁², σ₂², …) : (k, k), made once and not to be written to.

    >>> independent(2.0, 0.5).tolist()
    [[4.0, 0.0], [0.0, 0.25]]
    """
    covariance = np.diag(np.square(np.array(sigmas, float)))
    covariance.setflags(write=False)
    return covariance


def alike(covariance: Array, axes: tuple[int, ...]) -> Array:
    """The same covariance for every run : (*axes, k, k)"""
    return np.broadcast_to(covariance, (*axes, *covariance.shape[-2:])) if axes else covariance
