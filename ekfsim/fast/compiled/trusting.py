"""How far a filter believes a reading of one number, compiled by Numba: an EKF wholly, those of
filters/cures/ as they weigh it.
"""

import math

from ekfsim.twins import compiled

SURELY_CLUTTER = 700.0  # as in pdaf.py, and written again, as is told in beams.py


@compiled
def weighed(nis: float, S: float, limit: float, ln_clutter: float) -> tuple[float, float]:
    """w and v of x = x⁻ + w K ν and P = P⁻ − v K S Kᵀ

    limit : the NIS beyond which `Huber` weighs a reading, ∞ for other filters; ln_clutter : of the
    odds of `PDAF` for clutter what does not depend on the reading, −∞ for others
    """
    if nis > limit:
        w = math.sqrt(limit / nis)
        return w, w
    if ln_clutter > -math.inf:
        β = 1 / (1 + math.exp(min(ln_clutter + (math.log(S) + nis) / 2, SURELY_CLUTTER)))
        return β, β * (1 - (1 - β) * nis)  # what parts the two halves of the mixture included
    return 1.0, 1.0
