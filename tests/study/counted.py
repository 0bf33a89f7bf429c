"""Results of a study made of counts, everything that is not told as it should be."""

import numpy as np

from ekfsim.study.results import Result
from ekfsim.study.tally import AtSteps, Bin, Extreme, OfRuns, Tally


def counted(
    above=(500,), ellipse=(954,), lost_from=None, runs=1000, ellipse_runs=None, times=None, **more
):
    """A result of so many runs a step. nis : the mean of so many readings; beyond : runs beyond the
    99.9 % quantile"""
    k = len(above)
    full, none = np.full(k, runs), np.zeros(k, np.int64)
    at = AtSteps(
        judged=np.array(more.get("judged", full)), impossible=none, above_50=np.array(above),
        above_95=full // 20,
        above_999=np.array(more.get("beyond", full // 1000)), in_ellipse=np.array(ellipse),
        ellipse_runs=full if ellipse_runs is None else np.array(ellipse_runs),
        in_cone=full, cone_runs=full, nees_runs=full, nees_dof=3 * full, nees_sum=3.0 * full,
        position_square=0.01 * full, heading_square=0.0004 * full,
    )  # fmt: skip
    nis, readings = more.get("nis", (1.0, 10_000))
    above_band, below_band = more.get("outside", (0, 0))
    of = OfRuns(
        nis_runs=runs,
        nis_above=above_band,
        nis_below=below_band,
        nis_readings=readings,
        nis_dof=readings,
        nis_sum=nis * readings,
    )
    spread, worst = more.get("spread", {0: Bin(runs, 0)}), Extreme(False, 9.0, 7)
    clock = np.full(k, np.nan) if times is None else np.array(times)
    return Result(
        None,
        Tally(
            runs=runs,
            steps=np.arange(k),
            times=clock,
            at=at,
            of=of,
            lost_from=lost_from or {},
            spread=spread,
            worst=worst,
        ),
    )
