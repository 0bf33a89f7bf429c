"""Many EKF predictions in a row, for planar odometry."""

import numpy as np

from ekfsim.filters.belief import Belief, Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.geometry import Array
from ekfsim.models.protocols import Motion
from ekfsim.twins import twinned


@twinned
def stretch(belief: Belief, motion: Motion, U: Array) -> Gaussian:
    """The beliefs after each of N inputs, as EKF.predict gives them one by one: (N, …, 3), (N, …,
    3, 3). U : (N, …, m)

    For motions of x = (x, y, θ) that are the same everywhere: a robot that is moved and turned goes
    the same way, moved and turned.
    """
    x, P = belief
    means, covariances = np.empty((len(U), *x.shape)), np.empty((len(U), *P.shape))
    for i, u in enumerate(U):
        belief, _ = EKF().predict(belief, motion, u)
        means[i], covariances[i] = belief
    return Gaussian(means, covariances)
