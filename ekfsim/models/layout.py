"""What the entries of a state are: where the pose stands among them, and which are headings."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from ekfsim.geometry import Array


@dataclass(frozen=True)
class Layout:
    """The order of a state's entries.

    Every state holds a pose; what else it holds, only its models know.
    """

    names: tuple[str, ...]
    position: tuple[int, int] = (0, 1)
    heading: int = 2
    headings: tuple[int, ...] = (2,)  # all entries that are angles on the circle, kept in (−π, π]

    @cached_property
    def places(self) -> tuple[int, int, int]:
        """Where x, y and θ stand in the state."""
        return (*self.position, self.heading)

    @cached_property
    def is_pose(self) -> bool:
        """Whether the state is the pose and nothing else."""
        return len(self.names) == 3 and self.places == (0, 1, 2)

    def pose(self, x: Array) -> Array:
        """x, y, θ of a state (…, n) : (…, 3)"""
        return x if self.is_pose else x[..., self.places]

    def pose_covariance(self, P: Array) -> Array:
        """The pose's block of a covariance (…, n, n) : (…, 3, 3)"""
        return P if self.is_pose else P[..., np.array(self.places)[:, None], np.array(self.places)]

    def state(self, pose: Array) -> Array:
        """A state (…, n) with this pose (…, 3), and 0 in all other entries."""
        if self.is_pose:
            return pose
        x = np.zeros((*pose.shape[:-1], len(self.names)))
        x[..., self.places] = pose
        return x


POSE = Layout(("x", "y", "theta"))  # classroom, mower, pioneer
SPEED_POSE = Layout(("v", "phi", "x", "y"), position=(2, 3), heading=1, headings=(1,))  # gnss
INERTIAL = Layout(
    ("xdot", "x", "ydot", "y", "thetadot", "theta", "theta_prev"),
    position=(1, 3),
    heading=5,
    headings=(5, 6),
)  # pylon, eq. 5
