"""How bright a pixel is → whether its cell is occupied, free or unknown."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from ekfsim.files.maps.pixels.image import Grey
from ekfsim.geometry import Array, Booleans

HAIR = 1e-12  # of a brightness that was divided


@dataclass(frozen=True, slots=True)
class Reading:
    """How a map says that its picture is to be read."""

    negate: bool
    occupied: float  # a probability above which a cell is occupied
    free: float  # below which it is free
    mode: Literal["trinary", "scale", "raw"]

    def probability(self, grey: Grey) -> Array:
        """Of each cell to be occupied : (rows, columns), nan where the picture does not tell.

        (255 − v) / 255, or v / 255 with `negate`, v being the mean of the channels; transparency is
        one of them where the mode is trinary, and leaves a cell unknown where it is scale. In raw
        pictures v itself is the probability in percent, and anything beyond 100 is unknown.
        """
        bright = grey.bright
        if self.mode == "raw":
            percent = np.round(bright * 255)
            return np.where(percent <= 100, percent / 100, np.nan)
        if grey.clear is not None and self.mode == "trinary":
            channels = grey.channels
            bright = (bright * channels + grey.clear) / (channels + 1)
        p = bright if self.negate else 1 - bright
        if grey.clear is not None and self.mode == "scale":
            p = np.where(grey.clear < 1, np.nan, p)
        return p

    def cells(self, grey: Grey) -> tuple[Booleans, Booleans]:
        """Which cells are occupied, and which are free; the others are unknown."""
        p = self.probability(grey)
        with np.errstate(invalid="ignore"):
            return p > self.occupied + HAIR, p < self.free - HAIR
