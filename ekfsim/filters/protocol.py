"""What every filter offers: two pure functions."""

from typing import Protocol

from ekfsim.filters.belief import Correction, Gaussian, Prediction
from ekfsim.geometry import Array, Booleans
from ekfsim.models.protocols import Motion, Sensor


class Filter(Protocol):
    """A filter holds its settings and nothing else; beliefs go in and come out."""

    def __init__(self, gate: float | None = None) -> None: ...

    def predict(self, belief: Gaussian, motion: Motion, u: Array) -> tuple[Gaussian, Prediction]:
        """The belief after a motion input u : (…, m)."""

    def update(
        self, prior: Gaussian, sensor: Sensor, z: Array, skip: Booleans | bool = False
    ) -> tuple[Gaussian, Correction]:
        """The belief after a reading z : (…, k). Where skip : (…) is set the reading is judged but not used."""
