"""A textbook table a file: predict and update of each filter, and the records that go in and out.

    ekf.py     extended: read this one first    kalman.py    predict, gain, update: what the Kalman
    kf.py      linear, about the first belief                filters share, and how readings are
    iekf.py    iterated                                      refused
    ukf.py     unscented                        protocol.py  what every filter offers
    pf.py      particles                        belief.py    Gaussian, Particles, Correction
    stretch.py many predictions in a row        tuning.py    numbers that a person may set
    choice.py  the filter that a scene names    place.py     where one of one's own is found

    variants/    about a plan; noise in the sigma points; a document's listing; counter-examples
    arithmetic/  square roots of P, sigma points, the iterated filter's search, quantiles of χ²

The filters know no robot and no sensor: f, F, G, M, Q and h, H, R come from the models (see
models/protocols.py). What is quicker than kalman.py and square_root.py as they stand is in
ekfsim/fast/.
"""

from ekfsim.filters.ekf import EKF
from ekfsim.filters.iekf import IEKF
from ekfsim.filters.kf import KF
from ekfsim.filters.pf import PF
from ekfsim.filters.protocol import Kind
from ekfsim.filters.ukf import UKF
from ekfsim.filters.variants.nominal import NominalKF
from ekfsim.filters.variants.ukf_augmented import AugmentedUKF

FILTERS: dict[str, Kind] = {
    "kf": KF,
    "kf-nominal": NominalKF,
    "ekf": EKF,
    "iekf": IEKF,
    "ukf": UKF,
    "ukf-augmented": AugmentedUKF,
    "pf": PF,
}
