"""Which way a robot looks whose position alone is read.

A fix tells no heading; the course from one to the next does, as far as they lie apart against their
noise and that of the odometry, which says how much of the way the robot turned and whether it drove
in reverse. All of that is in the models: filters that begin with headings all round follow the
first fixes side by side, and how well each predicts them is how likely its heading is.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

import numpy as np

from ekfsim.filters.belief import Correction, Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.models.layout import Layout
from ekfsim.models.sensors.mounted import bare
from ekfsim.models.sensors.position import Position
from ekfsim.records import Control, Entry, Reading

FILTERS = 36  # side by side
APART = 2 * math.pi / FILTERS  # rad; each is so unsure of its own heading
ALL_ROUND = wrap(np.array([APART * (k + 0.5) for k in range(FILTERS)]))  # (FILTERS,) rad
LITTLE = 0.25  # of how unsure its place is: a robot that has gone no farther stands
SURE = 0.25  # rad; a course that is known so well is taken
UNSURE = 1.0  # rad; one that is known no better is hardly any
LEAST = 5  # fixes that a course takes, for their own scatter tells how far they may be trusted
SETTLED = 10  # fixes that made a course hardly any surer: the odometry forgets, and it is taken
MOST_FIXES, MOST_INPUTS = 400, 4000  # of a moving robot, after which the search is given up


class Course(NamedTuple):
    """A heading at the first of some entries."""

    heading: float  # rad
    sigma: float  # rad
    fixes: int  # how many told it


def is_fix(reading: object) -> bool:
    """Whether it reads the position, and nothing else, wherever the sensor sits."""
    return isinstance(reading, Reading) and isinstance(bare(reading.sensor), Position)


def course_of(entries: Sequence[Entry], around: Gaussian, layout: Layout) -> Course | None:
    """The heading at the first entry, None where the fixes after it tell none.
    around : (FILTERS, n), the belief there, with the headings ALL_ROUND
    """
    moving, turned, doubt = _standing(entries, around, layout)
    x = around.mean.copy()
    x[:, layout.heading] = wrap(x[:, layout.heading] + turned)
    found = _searched(entries[moving:], Gaussian(x, around.covariance), layout)
    if found is None:
        return None
    return Course(
        float(wrap(np.array(found.heading - turned))), math.hypot(found.sigma, doubt), found.fixes
    )


class Standing(NamedTuple):
    """A robot that has not gone yet."""

    entries: int  # how many
    turned: float  # rad, by its odometry
    doubt: float  # rad, of that


def _standing(entries: Sequence[Entry], around: Gaussian, layout: Layout) -> Standing:
    """How long it stands: until it moves by a small part of how unsure its place is."""
    ekf, x = EKF(headings=layout.headings), around.mean[0]
    belief, start = Gaussian(x, np.zeros((len(x), len(x)))), layout.pose(x)
    place = layout.pose_covariance(around.covariance[0])[:2, :2]
    far, stood = LITTLE * math.sqrt(np.trace(place)), 0
    for entry in entries:
        if isinstance(entry.given, Control):
            after, _ = ekf.predict(belief, entry.given.motion, entry.given.u)
            if math.hypot(*(layout.pose(after.mean) - start)[:2].tolist()) > far:
                break
            belief = after
        stood += 1
    turned = float(wrap(layout.pose(belief.mean)[2] - start[2]))
    doubt = math.sqrt(max(float(belief.covariance[layout.heading, layout.heading]), 0.0))
    return Standing(stood, turned, doubt)


def _searched(entries: Sequence[Entry], belief: Gaussian, layout: Layout) -> Course | None:
    """The heading that predicts the fixes, found by filters side by side."""
    ekf, sums, courses = EKF(headings=layout.headings), Sums(), list[Course]()
    begun, inputs, z = belief.mean[:, layout.heading], 0, None
    for entry in entries:
        match entry.given:
            case Control(motion, u):
                belief, _ = ekf.predict(belief, motion, u)
                inputs += 1
            case Reading(sensor, read) if is_fix(entry.given):
                # a receiver that repeats its last fix says nothing of a course
                if z is not None and np.array_equal(read, z):
                    continue
                z = read
                belief, correction = ekf.update(belief, sensor, np.broadcast_to(z, (FILTERS, 2)))
                sums.add(correction)
                courses.append(sums.course(begun))
                if _enough(courses):
                    break
        if len(courses) == MOST_FIXES or inputs == MOST_INPUTS:
            break
    return courses[-1] if courses else None


def _enough(courses: Sequence[Course]) -> bool:
    """Whether more fixes would hardly make a course surer."""
    sigma = courses[-1].sigma
    if len(courses) < LEAST or sigma > UNSURE:
        return False
    settled = len(courses) > SETTLED and sigma > 0.99 * courses[-1 - SETTLED].sigma
    return sigma <= SURE or settled


@dataclass
class Sums:
    """How well each of the filters has predicted the fixes."""

    nis: Array = field(default_factory=lambda: np.zeros(FILTERS))
    log_likelihood: Array = field(default_factory=lambda: np.zeros(FILTERS))
    fixes: int = 0

    def add(self, correction: Correction) -> None:
        """Take one more fix into account."""
        self.nis += correction.nis
        self.log_likelihood -= (correction.nis + np.log(np.linalg.det(correction.S))) / 2
        self.fixes += 1

    def course(self, headings: Array) -> Course:
        """The mean and the spread of the headings (FILTERS,), each as likely as it predicts.

        Fixes that scatter more than their sensor says, about the best of the filters, too, are
        believed the less.
        """
        scatter = max(1.0, float(self.nis.min()) / (2 * self.fixes))
        w = np.exp((self.log_likelihood - self.log_likelihood.max()) / scatter)
        w /= w.sum()
        heading = float(np.angle(w @ np.exp(1j * headings)))
        return Course(heading, math.sqrt(w @ wrap(headings - heading) ** 2), self.fixes)
