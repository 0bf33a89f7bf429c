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

from collections.abc import Iterator, Mapping
from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ekfsim.filters.protocol import Kind

_HOMES = {  # the module of each filter, and its name there
    "kf": ("kf", "KF"),
    "kf-nominal": ("variants.nominal", "NominalKF"),
    "ekf": ("ekf", "EKF"),
    "iekf": ("iekf", "IEKF"),
    "ukf": ("ukf", "UKF"),
    "ukf-augmented": ("variants.ukf_augmented", "AugmentedUKF"),
    "pf": ("pf", "PF"),
}


class _Filters(Mapping[str, "Kind"]):
    """The filters by their names, each imported when it is first asked for: a run of one must not
    wait for all the others.
    """

    def __getitem__(self, name: str) -> "Kind":
        module, of = _HOMES[name]
        kind: Kind = getattr(import_module(f"ekfsim.filters.{module}"), of)
        return kind

    def __contains__(self, name: object) -> bool:
        return name in _HOMES

    def __iter__(self) -> Iterator[str]:
        return iter(_HOMES)

    def __len__(self) -> int:
        return len(_HOMES)


FILTERS = _Filters()
