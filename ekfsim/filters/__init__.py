"""A textbook table a file: predict and update of each filter, and the records that go in and out.

    ekf.py     extended: read this one first    kalman.py    predict, gain, update: what the Kalman
    kf.py      linear, about the first belief                filters share, and how readings are
    iekf.py    iterated                                      refused
    ukf.py     unscented                        protocol.py  what every filter offers
    pf.py      particles                        belief.py    Gaussian, Particles, Correction
    stretch.py many predictions in a row        tuning.py    numbers that a person may set
    choice.py  the filter that a scene names    place.py     where one of one's own is found

    cures/       for bad readings, each with what it assumes
    variants/    about a plan; noise in the sigma points; a document's listing; counter-examples
    particles/   crowds whose number varies: how many are enough, and how they are drawn anew
    mixture/     a few Gaussians: mhekf.py, and how they are merged
    arithmetic/  square roots of P, sigma points, the iterated filter's search, quantiles of χ²

The filters know no robot and no sensor: f, F, G, M, Q and h, H, R come from the models (see
models/protocols.py). What is quicker than kalman.py and square_root.py as they stand is in
ekfsim/fast/.
"""

from typing import TYPE_CHECKING

from ekfsim.late import Table

if TYPE_CHECKING:
    from ekfsim.filters.protocol import Kind

FILTERS: Table["Kind"] = Table(
    {
        "kf": "ekfsim.filters.kf:KF",
        "kf-nominal": "ekfsim.filters.variants.nominal:NominalKF",
        "ekf": "ekfsim.filters.ekf:EKF",
        "iekf": "ekfsim.filters.iekf:IEKF",
        "ukf": "ekfsim.filters.ukf:UKF",
        "ukf-augmented": "ekfsim.filters.variants.ukf_augmented:AugmentedUKF",
        "huber": "ekfsim.filters.cures.huber:Huber",
        "pdaf": "ekfsim.filters.cures.pdaf:PDAF",
        "adaptive": "ekfsim.filters.cures.adaptive:Adaptive",
        "invariant": "ekfsim.filters.cures.invariant:Invariant",
        "pf": "ekfsim.filters.pf:PF",
        "amcl": "ekfsim.filters.cures.amcl:AMCL",
        "mhekf": "ekfsim.filters.mixture.mhekf:MHEKF",
    }
)
