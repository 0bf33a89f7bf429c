"""A textbook table a file: predict and update of each filter, and the records that go in and come
out.

    protocol.py    what every filter offers              kf.py      linear, about the first belief
    belief.py      Gaussian, Particles, Correction
    nominal.py linear, about a trajectory that is planned
    algebra.py     inverse, wrapping, refusals           ekf.py     extended: read this one first
    conditioning.py  what a reading leaves of P          iekf.py
    iterated, by the search of descent.py
    correcting.py  the end that the updates share        ukf.py
    unscented, by the transform of unscented.py
    chi_square.py  quantiles of χ²
    ukf_augmented.py  the same, with noise in its sigma points
    tuning.py      numbers that a person may set         pf.py      particles
    shadows.py     a counter-example: P without σ_xθ, σ_yθ
                                                         listing.py the EKF that two of the
                                                         documents' listings are

The filters know no robot and no sensor: f, F, G, M, Q and h, H, R come from the models (see
models/protocols.py).

Four files are speed alone; tests hold each equal to what ekf.py, correcting.py and conditioning.py
have:

    conditioning_one.py  one robot, in plain floats
    unrolled.py
    many runs side by side, a state of three and a reading of one number: entry by entry
    compiled.py    the same by Numba, where twins.py has been told to take it
    stretch.py     many predictions of one run in a row, for planar odometry
"""

from ekfsim.filters.ekf import EKF
from ekfsim.filters.iekf import IEKF
from ekfsim.filters.kf import KF
from ekfsim.filters.nominal import NominalKF
from ekfsim.filters.pf import PF
from ekfsim.filters.protocol import Filter
from ekfsim.filters.ukf import UKF
from ekfsim.filters.ukf_augmented import AugmentedUKF

FILTERS: dict[str, type[Filter]] = {
    "kf": KF,
    "kf-nominal": NominalKF,
    "ekf": EKF,
    "iekf": IEKF,
    "ukf": UKF,
    "ukf-augmented": AugmentedUKF,
    "pf": PF,
}
