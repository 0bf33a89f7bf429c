"""A filter of ours as a reference: what it makes of what a student's code is asked."""

from dataclasses import dataclass

from ekfsim.filters.belief import Correction, Gaussian, Prediction
from ekfsim.filters.protocol import Filter
from ekfsim.geometry import Array
from ekfsim.records import Control, Reading
from ekfsim.student.asked import Answer, Asked


def made_by(filter: Filter, asked: Asked) -> tuple[Gaussian, Prediction | Correction]:
    """The belief that a filter makes of it, and what it did to come to that."""
    prior = Gaussian(asked.x, asked.P)
    made: Prediction | Correction
    match asked.given:
        case Control(motion, u):
            after, made = filter.predict(prior, motion, u)
        case Reading(sensor, z):
            after, made = filter.update(prior, sensor, z)
    return Gaussian(*after), made


@dataclass(frozen=True)
class Around:
    """Calls a filter of the full protocol as it calls two functions; a `Caller`."""

    filter: Filter
    label: str = ""  # what people see of it

    def begin(self, x: Array, P: Array) -> None:
        """It keeps nothing."""

    def call(self, asked: Asked) -> Answer:
        """The belief that the filter makes of it."""
        return Answer(*made_by(self.filter, asked)[0])

    def place_of(self, given: Control | Reading) -> str:
        """What people see of the filter."""
        return self.label
