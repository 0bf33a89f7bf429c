"""Covariances of independent noises, and what the length of a step makes of them."""

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


def per_second(dt: Array) -> Array:
    """1/dt : (…), 0 where no time has passed.

    White noise that is held over dt s has the variance density² / dt.
    """
    return np.divide(1.0, dt, out=np.zeros_like(dt), where=dt > 0)


def alike(covariance: Array, axes: tuple[int, ...]) -> Array:
    """The same covariance for every run : (*axes, k, k)"""
    return np.broadcast_to(covariance, (*axes, *covariance.shape[-2:])) if axes else covariance


def once(covariances: Array) -> Array:
    """The same as `alike` was given it: an axis along which all are one is one long.

    >>> once(alike(independent(1.0, 2.0), (5, 7))).shape
    (1, 1, 2, 2)
    """
    axes = zip(covariances.shape[:-2], covariances.strides[:-2], strict=True)
    return covariances[tuple(slice(1 if n and not stride else n) for n, stride in axes)]
