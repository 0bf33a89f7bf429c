"""Belief and correction records, and a textbook table a file."""

from ekfsim.filters.ekf import EKF
from ekfsim.filters.iekf import IEKF
from ekfsim.filters.kf import KF
from ekfsim.filters.pf import PF
from ekfsim.filters.protocol import Filter
from ekfsim.filters.ukf import UKF

FILTERS: dict[str, type[Filter]] = {"kf": KF, "ekf": EKF, "iekf": IEKF, "ukf": UKF, "pf": PF}
