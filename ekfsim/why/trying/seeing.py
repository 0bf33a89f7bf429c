"""A direction that no beam sees: the belief grows along it as if nothing were read."""

from collections.abc import Sequence

import numpy as np

from ekfsim.records import Step
from ekfsim.scene import Scene
from ekfsim.why.changes.singles import blind
from ekfsim.why.trying.replaying import replayed

KEPT = 0.9  # of the standard deviation without readings, along what is not seen
LONG = 3.0  # times as long as wide


def unseen(scene: Scene, steps: Sequence[Step]) -> bool:
    """Whether the position of one run is as unsure in some direction as without any reading, and
    far less so across it.
    """
    P = steps[-1].posterior.covariance[:2, :2]
    λ, V = np.linalg.eigh(P)
    long = V[:, 1]
    if not λ[1] > LONG**2 * max(λ[0], 0.0):
        return False
    *_, last = replayed(scene, (blind(),))
    D = last.posterior.covariance[:2, :2]
    return bool(λ[1] >= KEPT**2 * (long @ D @ long) > 0)
