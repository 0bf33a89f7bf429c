"""Which wall a beam was predicted to meet, and which it truly met."""

import math
from typing import NamedTuple

import numpy as np

from ekfsim.filters.belief import Refused, posed
from ekfsim.floor import BOUNDARY
from ekfsim.geometry import Array
from ekfsim.models.sensors.laser import Laser
from ekfsim.records import Reading, Step
from ekfsim.scene import Scene
from ekfsim.views.picture.written.lettering import shortened
from ekfsim.views.words.numbers import length

NAME = 30  # signs of a wall's name


class Met(NamedTuple):
    """A beam of the laser as the filter saw it and as it was. All lengths in m."""

    step: int
    pose: Array  # (3,) of the estimate before the reading, the heading along the beam
    predicted: float  # how far its wall was predicted to be; nan where none was
    measured: float  # the reading; nan where there was no echo
    expected: str | None  # the name of the wall that was predicted, None where none was
    expected_edge: int
    truth: Array | None  # (3,) of the true robot, the heading along the beam
    range: float  # to the wall that the beam truly meets; nan where there is none or no truth
    actual: str | None
    actual_edge: int
    sigma: float  # √S
    used: bool

    @property
    def wrong(self) -> bool:
        """Whether another wall was met than the one that was predicted."""
        known = self.truth is not None
        return known and (self.expected, self.expected_edge) != (self.actual, self.actual_edge)

    @property
    def surprise(self) -> float:
        """|ν| / √S; nan where there is none."""
        ν = self.measured - self.predicted
        return abs(ν) / self.sigma if self.sigma > 0 else math.nan


def met(step: Step, scene: Scene) -> Met | None:
    """What a step's beam met; None where it was no beam of a laser."""
    given, correction = step.entry.given, step.correction
    if not isinstance(given, Reading) or not isinstance(given.sensor, Laser) or correction is None:
        return None
    laser, truth = given.sensor, step.entry.truth
    turned = np.array([0.0, 0.0, laser.bearing])
    pose = posed(step.prior, step.layout).mean + turned
    _, expected = laser.walls.first(*pose.tolist())
    far, actual, along = math.nan, -1, None
    if truth is not None:
        along = truth + turned
        far, actual = scene.world.map.walls.first(*along.tolist())
    name, edge = ("", -1) if expected < 0 else laser.walls.name(expected)
    true, true_edge = ("", -1) if actual < 0 else scene.world.map.walls.name(actual)
    return Met(
        step.entry.index, pose, float(correction.predicted[0]), float(given.z[0]),
        name or None, edge, along, far, true or None, true_edge,
        math.sqrt(float(correction.S[0, 0])), Refused(int(correction.refused)) is Refused.NOT,
    )  # fmt: skip


def told(beam: Met) -> str:
    """What was predicted and what was met, in a clause.

    was predicted to meet the desk at 1.11 m and met the room's wall behind it at 5.38 m
    """
    expected = called(beam.expected)
    where = "" if math.isnan(beam.predicted) else f" at {length(beam.predicted)}"
    if beam.actual is None:
        return f"was predicted to meet {expected}{where} and met no wall"
    if beam.expected == beam.actual:
        return (
            f"was predicted to meet {expected}{where} and met another side of it "
            f"at {length(beam.range)}"
        )
    side = ""
    if beam.expected is not None and not math.isnan(beam.predicted):
        side = " behind it" if beam.range > beam.predicted else " before it"
    return (
        f"was predicted to meet {expected}{where} and met {called(beam.actual)}{side} "
        f"at {length(beam.range)}"
    )


def called(name: str | None) -> str:
    """A wall as it is named in a sentence."""
    if name is None:
        return "no wall"
    if name == BOUNDARY:
        return "the room's wall"
    told = shortened(name, NAME)
    return told if told[-1:].isdigit() else f"the {told}"  # "south 7" is a name by itself
