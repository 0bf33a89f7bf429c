"""The iterated extended Kalman filter."""

from dataclasses import dataclass, replace
from typing import Self

from ekfsim.filters import kalman
from ekfsim.filters.arithmetic.descent import Search
from ekfsim.filters.arithmetic.square_root import seen, slope, square_root
from ekfsim.filters.belief import Belief, Correction, Gaussian, Refused
from ekfsim.filters.ekf import EKF
from ekfsim.filters.protocol import Beginning
from ekfsim.filters.tuning import Tuning
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Sensor


@dataclass(frozen=True)
class IEKF(EKF):
    """Iterated extended Kalman filter: Bar-Shalom, Li & Kirubarajan, Estimation, 2001, section
    10.5.2. Its update searches the most probable state, in steps that lead only down: Skoglund,
    Hendeby & Axehill, Extended Kalman filter modifications based on an optimization view point,
    2015. All else, and a linear sensor's update, is as in the EKF.
    """

    # how many steps the search takes at most, half a step counting as half
    iterations: int = Tuning.iterations

    @classmethod
    def begin(cls, beginning: Beginning) -> Self:
        """The filter for a run that begins so."""
        return cls(beginning.gate, beginning.headings, beginning.tuning.iterations)

    def update(
        self, prior: Belief, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """x₀ = x⁻      Hᵢ = H(xᵢ)      Kᵢ = P⁻ Hᵢᵀ (Hᵢ P⁻ Hᵢᵀ + R)⁻¹      P = (I − KᵢHᵢ) P⁻
        xᵢ₊₁ = xᵢ + t (x⁻ + Kᵢ (z − h(xᵢ) − Hᵢ (x⁻ − xᵢ)) − xᵢ), t = 1, ½, ¼, … until it lowers

            J(x) = (x − x⁻)ᵀ P⁻⁺ (x − x⁻) + (z − h(x))ᵀ R⁻¹ (z − h(x))

        R stays that of x⁻, for a sum of squares needs one measure; so do ν, S and NIS, by which a
        reading is judged. H and K told are those of the last i.
        """
        if self.iterations == 0:
            return super().update(prior, sensor, z, skip)
        x, P = prior
        h, H, R = sensor.linearize(x)
        L, ν = square_root(P, seen(H)), sensor.residual(z, h)
        reading = kalman.Linearized(z, h, ν, H, R)
        rule = kalman.Rule(self.gate, skip, self.headings)
        _, told = kalman.revise(Gaussian(x, P), reading, rule, L, slope(H, L))
        search = Search(sensor, z, x, L, R, told.S, self.headings)
        best, settled = search.descend(ν, h, H, told.refused == Refused.NOT, self.iterations)
        h, H, _ = sensor.linearize(best)
        last = kalman.gain(L, slope(H, L), R, h)
        found = Gaussian(best, last.covariance(P))
        posterior = kalman.where_used(told.refused, found, Gaussian(x, P))
        return posterior, replace(told, H=H, K=last.K, settled=settled)
