"""The numbers of a filter's own, which a person may set, and which filter reads which."""

from dataclasses import dataclass
from typing import Literal

RangeVariance = Literal["prediction", "reading"]
CrossCovariances = Literal["kept", "dropped"]
MOST_PARTICLES = 1_000_000
MOST_HYPOTHESES = 64
UNSCENTED = "ukf", "ukf-augmented"
CROWDS = {"pf": 1000, "amcl": 5000}  # of how many particles, where nobody says; they have no P
OF_SOME = {  # whose number it is
    "particles": tuple(CROWDS), "alpha": UNSCENTED, "beta": UNSCENTED, "kappa": UNSCENTED,
    "iterations": ("iekf",), "hypotheses": ("mhekf",), "huber": ("huber",),
    "adaptive": ("adaptive",), "clutter": ("pdaf",), "clutter_density": ("pdaf",),
}  # fmt: skip


@dataclass(frozen=True)
class Tuning:
    """What may be set of a filter besides gate and guard; as it comes, every filter is its
    textbook's.
    """

    particles: int | None = None  # of each run, of the amcl at most; None: those of CROWDS
    alpha: float = 1.0  # of the sigma points: √(α² (n + κ)) standard deviations from the mean
    beta: float = 0.0  # what is known of the shape: 2 for a Gaussian, where α is small
    kappa: float | None = None  # None: max(3 − n, 0)
    # steps of the iterated filter's search at most, half a step counting as half; 0 is the EKF
    iterations: int = 50
    huber: float = 2.0  # σ of an innovation; beyond it a reading pulls no harder than there
    clutter: float = 0.1  # share of readings that are of something else than is expected
    clutter_density: float = 0.1  # of those, per unit (m, rad) of each number: 0.1/m is in 10 m
    adaptive: float = 0.9  # what a reading leaves of what was learnt of its sensor's noise
    hypotheses: int = 8  # Gaussians of the mhekf at most
    # whence the classroom's C_v = (ratio · r)² takes its r
    range_variance: RangeVariance = "prediction"
    cross_covariances: CrossCovariances = "kept"  # σ_xθ and σ_yθ, which no picture shows

    def crowd(self, filter_name: str) -> int:
        """Of how many particles, at most, a run of this filter is.

        >>> Tuning().crowd("amcl"), Tuning(particles=300).crowd("pf-smoothed")
        (5000, 300)
        """
        if self.particles is not None:
            return self.particles
        return CROWDS[filter_name.removesuffix("-smoothed")]


UNTUNED = Tuning()


def reads(filter_name: str, number: str) -> bool:
    """Whether a filter reads one of the numbers.

    >>> reads("pf", "particles"), reads("ekf", "particles"), reads("ekf", "range_variance")
    (True, False, True)
    """
    alone = filter_name.removesuffix("-smoothed")
    if number in OF_SOME:
        return alone in OF_SOME[number]
    return number != "cross_covariances" or alone not in CROWDS
