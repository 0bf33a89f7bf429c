"""Belief and correction records, and a textbook table a file."""

from ekfsim.filters.ekf import EKF
from ekfsim.filters.protocol import Filter

FILTERS: dict[str, type[Filter]] = {"ekf": EKF}
