"""The true poses of a log, at any instant."""

from dataclasses import dataclass

import numpy as np

from ekfsim.files.logs.ordering import in_order, step_of, tell_gaps
from ekfsim.files.logs.table import Rows
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap

BLIND = 1.0  # s; over a gap longer than this, and than ten usual steps, the truth is not known


@dataclass(frozen=True)
class Truth:
    """Poses and their times, in order."""

    t: Array  # (n,) s
    poses: Array  # (n, 3) m, m, rad unwrapped
    longest: float = np.inf  # s between two poses over which the truth is interpolated

    def at(self, t: Array) -> Array:
        """The pose at each instant, interpolated, the heading the short way round : (…, 3), nan
        where it is unknown
        """
        poses = np.stack(
            [np.interp(t, self.t, column, np.nan, np.nan) for column in self.poses.T], axis=-1
        )
        poses[..., 2] = wrap(poses[..., 2])
        if len(self.t) > 1:
            after = np.clip(np.searchsorted(self.t, t), 1, len(self.t) - 1)
            between = self.t[after] - self.t[after - 1] > self.longest
            poses[between & (t != self.t[after]) & (t != self.t[after - 1])] = np.nan
        return poses


def truth_of(rows: Rows, warnings: list[str]) -> Truth | None:
    """The truth in a table of t, x, y, heading; None where it has no rows."""
    rows = in_order(rows, warnings)
    distinct = np.concatenate([[True], np.diff(rows.t) > 0])[: len(rows)]
    if not distinct.all():
        warnings.append(
            f"{rows.at(int(np.argmin(distinct)))}: a second pose of the same time: left out"
        )
        rows = rows[distinct]
    if not len(rows):
        why = f"all {rows.left_out} poses are left out" if rows.left_out else "holds no poses"
        warnings.append(f"{rows.file}: {why}: the truth is unknown")
        return None
    tell_gaps(rows, warnings)
    poses = rows.values[:, 1:4].copy()
    poses[:, 2] = np.unwrap(poses[:, 2])
    return Truth(rows.t, poses, max(BLIND, 10 * step_of(rows)))
