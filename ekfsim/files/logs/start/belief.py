"""With which belief the filter of a recorded log begins. What somebody told goes before what the
log tells, and that before the world's own start.
"""

import math
from collections.abc import Sequence

import numpy as np

from ekfsim.files.given.given import called, is_own
from ekfsim.files.logs.start import words
from ekfsim.files.logs.start.course import ALL_ROUND, APART, UNSURE, course_of
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.ekf import EKF
from ekfsim.geometry import Array
from ekfsim.geometry.angles import wrap
from ekfsim.records import Control, Entry, Reading
from ekfsim.systems.document import DocumentReading
from ekfsim.world import World

ANY = math.pi / math.sqrt(3)  # rad, the standard deviation of a heading of which nothing is known
# as unsure as this times a course that was found is a filter that is to read the same fixes again
WIDER = 1.5
# standard deviations by which x, y, θ of a start may differ from what is found; θ is told wider
POSSIBLE = np.array([3.0, 3.0, 3.0 / WIDER])


def at_truth(world: World, reading: DocumentReading, pose: Array) -> Gaussian:
    """The belief at a true pose : (3,)"""
    mean = np.where(world.told.start_said, world.told.start, pose)
    return Gaussian(world.layout.state(mean), world.first_covariance(reading))


def assumed(world: World, reading: DocumentReading, name: str, warnings: list[str]) -> Gaussian:
    """The belief where nothing in the log tells a pose. name : the log, as messages call it"""
    first = Gaussian(world.layout.state(world.told.start), world.first_covariance(reading))
    if not (all(world.told.start_said) and all(world.sigma_said)):
        warnings.append(f"{name}: {words.assumed(world, first)}{words.otherwise(world)}")
    return first


def at_fix(
    world: World,
    reading: DocumentReading,
    fix: Reading,
    entries: Sequence[Entry],
    name: str,
    warnings: list[str],
) -> Gaussian:
    """The belief at a first fix, with a heading by the fixes that follow in the entries, the first
    of which is the start.
    """
    heading, sigma, told = float(world.told.start[2]), None, "its heading as told"
    if not world.told.start_said[2]:
        if _tells_heading(entries, world):
            told = "its heading by its motion inputs"
        else:
            around = _around(world, reading, fix, ALL_ROUND, APART)
            found = course_of(entries[1:], around, world.layout)
            sigma, told = ANY, "its heading unknown: its fixes tell no course"
            if found is not None:
                heading, sigma = found.heading, min(WIDER * found.sigma, ANY)
                hardly = "hardly told" if found.sigma > UNSURE else "told"
                fixes = f"{found.fixes} fixes" if found.fixes > 1 else "1 fix"
                told = f"its heading {hardly} by the course of {fixes}"
    first = _around(world, reading, fix, np.array(heading), sigma)
    at = entries[0].t
    assert at is not None
    if is_own(world) and not any(world.told.start_said):
        told += f", not at the start of {called(world)}, which the fixes do not bear out"
    warnings.append(f"{name}: {words.at_fix(world, first, at, told)}{words.otherwise(world)}")
    return first


def bears_out(
    world: World, reading: DocumentReading, first: Gaussian, before: Sequence[Control]
) -> bool:
    """Whether a belief that was found at a fix leaves the world's own start possible, after the
    motion inputs before that fix.
    """
    layout, ekf = world.layout, EKF(headings=world.layout.headings)
    own = Gaussian(layout.state(world.told.start), world.first_covariance(reading))
    for given in before:
        own, _ = ekf.predict(own, given.motion, given.u)
    off = layout.pose(first.mean) - layout.pose(own.mean)
    off[2] = wrap(off[2])
    P = layout.pose_covariance(own.covariance) + layout.pose_covariance(first.covariance)
    return bool(np.all(np.abs(off) <= POSSIBLE * np.sqrt(np.diag(P))))


def _tells_heading(entries: Sequence[Entry], world: World) -> bool:
    """Whether a motion input says which way the robot looks, and not how far it turns."""
    given = next((e.given for e in entries if isinstance(e.given, Control)), None)
    if given is None:
        return False
    place, x = world.layout.heading, world.layout.state(np.zeros(3))
    return not given.motion.F(x, given.u)[place, place]


def _around(
    world: World, reading: DocumentReading, fix: Reading, heading: Array, sigma: float | None
) -> Gaussian:
    """The belief at a fix with a heading (…), so unsure of it, or as the robot's document has it :
    (…, n), (…, n, n). What somebody told goes before.

    z = p + h(0, θ) + noise for any sensor of the position: p = z − h(0, θ), with the covariance
    R + g σ² gᵀ and that with θ −g σ², g = ∂h/∂θ
    """
    layout, told, P = world.layout, world.told, world.first_covariance(reading)
    own = layout.pose_covariance(P)
    variance = own[2, 2] if sigma is None or world.sigma_said[2] else sigma**2
    pose = np.zeros((*heading.shape, 3))
    pose[..., 2] = heading
    x = layout.state(pose)
    g = fix.sensor.H(x)[..., layout.heading, None]
    pose[..., :2] = fix.z - fix.sensor.h(x)
    B = np.zeros((*heading.shape, 3, 3))
    B[..., :2, :2] = fix.sensor.R(x) + g * variance * g.mT
    B[..., :2, 2:] = -g * variance
    B[..., 2:, :2] = B[..., :2, 2:].mT
    B[..., 2, 2] = variance
    for axis in np.flatnonzero(np.array(told.start_said) | world.sigma_said):
        B[..., axis, :] = B[..., :, axis] = 0
        B[..., axis, axis] = own[axis, axis]
    P = np.broadcast_to(P, (*heading.shape, *P.shape)).copy()
    places = np.array(layout.places)
    P[..., places[:, None], places] = B
    return Gaussian(layout.state(np.where(told.start_said, told.start, pose)), P)
