"""arithmetic/square_root.py of many runs."""

import numpy as np

from ekfsim.geometry import Array


def covariance(P: Array) -> Array | None:
    """The symmetric part where that is a covariance in every run, as it mostly is."""
    P = 0.5 * (P + P.mT)
    variances = np.diagonal(P, axis1=-2, axis2=-1)
    square = variances[..., :, None] * variances[..., None, :]
    return P if (square >= P * P).all() and (variances >= 0).all() else None
