"""The table of twins: which function of the text each stands in for, and when.

A function is named "module:name". One room below the text, and imported when the first function of
the text is called that may have a twin; a twin itself is imported when it is first needed.
"""

from collections.abc import Callable
from dataclasses import dataclass
from importlib import import_module
from typing import Any

from ekfsim.twins import Way


@dataclass(frozen=True, slots=True)
class Twin:
    """A quicker form of a function, with the condition under which it may stand in for it."""

    of: str  # the function of the text
    form: str  # what stands in for it; it returns None where it sees that it cannot
    when: str  # in words: the arguments that it is for
    # the class of the first argument, where it is for that one alone: no class that inherits of it
    given: str = ""
    compiled: bool = False  # by Numba: only where that is asked for


ONE, MANY, COMPILED = (f"ekfsim.fast.{room}" for room in ("one", "many", "compiled"))
RAYS, SEARCHES = "ekfsim.raycast", "ekfsim.raycast.searches"
MOTION, SENSOR = (f"ekfsim.models.protocols:{kind}.linearize" for kind in ("Motion", "Sensor"))
MOTIONS, MARKER = "ekfsim.models.motions", "ekfsim.models.sensors.landmarks:MarkerAngles"
KALMAN, ROOT = "ekfsim.filters.kalman", "ekfsim.filters.arithmetic.square_root"
DESCEND = "ekfsim.filters.arithmetic.descent:Search.descend"
CLASSROOM = "ekfsim.simulation.classroom"
NEES, AMBIGUITY = "ekfsim.diagnostics.nees", "ekfsim.diagnostics.ambiguity"

ALONE = "one robot: no leading axes"
ANY = "whatever the leading axes"
OF_MANY = "64 runs or more"
ALIKE = f"{OF_MANY}, a state of three, a motion that is the same everywhere, of independent noises"
ONE_NUMBER = f"{OF_MANY}, a state of three, one of it a heading, and a reading of one number"
SURE_OF_YAW = "a yaw that turned the reading without noise"
SOUND = "a covariance that needs no force but to be symmetric, as mostly"

# The quickest of one function first. How to add a row is told in tests/fast/test_table.py.
TWINS: tuple[Twin, ...] = (
    # geometry/
    Twin("ekfsim.geometry.ellipse:ellipse", f"{ONE}.geometry.ellipse:ellipse", ALONE),
    # raycast/
    Twin(f"{RAYS}.walls:Walls.cast", f"{SEARCHES}.compiled:cast", "many beams", compiled=True),
    Twin(f"{RAYS}.walls:Walls.cast", f"{SEARCHES}.choice:cast", "any beams"),
    Twin(f"{RAYS}.walls:Walls.first", f"{SEARCHES}.single_beam:first", "any beam"),
    Twin(f"{RAYS}.ground:Ground.reach", f"{ONE}.geometry.ground:reach", "from one place"),
    # models/
    Twin(MOTION, f"{ONE}.motions:move_turn", ALONE, "MoveTurn"),
    Twin(MOTION, f"{COMPILED}.models:move_turn", "x, u : (N, …)", "MoveTurn", True),
    Twin(MOTION, f"{MANY}.motions:move_turn", ANY, "MoveTurn"),
    Twin(MOTION, f"{ONE}.motions:gyro_wheels", ALONE, "GyroWheels"),
    Twin(MOTION, f"{ONE}.motions:unicycle", ALONE, "Unicycle"),
    Twin(MOTION, f"{ONE}.motions:wheel_speeds", ALONE, "WheelSpeeds"),
    Twin(f"{MOTIONS}.move_turn:MoveTurn.f", f"{ONE}.motions:move_turn_f", ALONE),
    Twin(f"{MOTIONS}.move_turn:MoveTurn.f", f"{MANY}.motions:move_turn_f", ANY),
    Twin(f"{MOTIONS}.wheels:GyroWheels.f", f"{ONE}.motions:gyro_wheels_f", ALONE),
    Twin(f"{MOTIONS}.unicycle:Unicycle.f", f"{ONE}.motions:unicycle_f", ALONE),
    Twin(SENSOR, f"{ONE}.sensors:laser", ALONE, "Laser"),
    Twin(SENSOR, f"{COMPILED}.models:laser", "x : (N, …)", "Laser", True),
    Twin(SENSOR, f"{MANY}.sensors:laser", ANY, "Laser"),
    Twin(SENSOR, f"{MANY}.sensors:laser_by_reading", ANY, "LaserByReading"),
    Twin(SENSOR, f"{MANY}.sensors:ultrasonic", ANY, "UltrasonicBeam"),
    Twin(SENSOR, f"{MANY}.sensors:infrared", ANY, "InfraredBeam"),
    Twin(SENSOR, f"{MANY}.sensors:frozen", "as many x as it holds", "Frozen"),
    Twin(SENSOR, f"{MANY}.sensors:mounted", ANY, "Mounted"),
    Twin(SENSOR, f"{ONE}.landmarks:marker_angles", ALONE, "MarkerAngles"),
    Twin(SENSOR, f"{ONE}.landmarks:range_bearing", ALONE, "RangeBearing"),
    Twin(SENSOR, f"{ONE}.landmarks:range_only", ALONE, "RangeOnly"),
    Twin(SENSOR, f"{ONE}.landmarks:bearing_only", ALONE, "BearingOnly"),
    Twin(SENSOR, f"{MANY}.landmarks:marker_angles", ANY, "MarkerAngles"),
    Twin(SENSOR, f"{MANY}.landmarks:range_bearing", ANY, "RangeBearing"),
    Twin(SENSOR, f"{MANY}.landmarks:range_only", ANY, "RangeOnly"),
    Twin(SENSOR, f"{MANY}.landmarks:bearing_only", ANY, "BearingOnly"),
    Twin(SENSOR, f"{MANY}.landmarks:lidar_offset", ANY, "LidarOffset"),
    Twin(SENSOR, f"{MANY}.landmarks:landmark_offset", SURE_OF_YAW, "LandmarkOffset"),
    Twin(f"{MARKER}.residual", f"{ONE}.landmarks:marker_residual", ALONE),
    # filters/
    Twin(f"{KALMAN}:predict", f"{COMPILED}.kalman:predict", ALIKE, compiled=True),
    Twin(f"{KALMAN}:predict", f"{MANY}.kalman:predict", ALIKE),
    Twin(f"{KALMAN}:update", f"{ONE}.filtering.kalman:update", ALONE),
    Twin(f"{KALMAN}:update", f"{COMPILED}.kalman:update", ONE_NUMBER, compiled=True),
    Twin(f"{KALMAN}:update", f"{MANY}.kalman:update", ONE_NUMBER),
    Twin(f"{ROOT}:covariance", f"{ONE}.filtering.square_root:covariance", f"{ALONE}; {SOUND}"),
    Twin(f"{ROOT}:covariance", f"{MANY}.square_root:covariance", f"{ANY}; {SOUND}"),
    Twin(f"{ROOT}:square_root", f"{ONE}.filtering.square_root:square_root", ALONE),
    Twin(f"{ROOT}:slope", f"{ONE}.filtering.square_root:slope", ALONE),
    Twin(f"{ROOT}:conditioned", f"{ONE}.filtering.square_root:conditioned", ALONE),
    Twin(DESCEND, f"{ONE}.filtering.descent:descend", ALONE),
    Twin("ekfsim.filters.stretch:stretch", "ekfsim.fast.many_steps:stretch", ANY),
    Twin(
        of="ekfsim.filters.arithmetic.chi_square:quantile",
        form="ekfsim.fast.chi_square:quantile",
        when="up to 5 000 degrees of freedom, and a probability that is neither 0 nor 1",
    ),
    # simulation/
    Twin("ekfsim.simulation.draws:draw", f"{ONE}.draws:draw", "draws after the first few"),
    Twin(f"{CLASSROOM}:until_wall", f"{ONE}.classroom:until_wall", ALONE),
    Twin(f"{CLASSROOM}:paired", f"{ONE}.classroom:paired", ALONE),
    Twin(f"{CLASSROOM}:until_wall", f"{MANY}.classroom:until_wall", "pose : (N, 3)"),
    # diagnostics/
    Twin(f"{AMBIGUITY}:sighting", f"{ONE}.geometry.ambiguity:sighting", ALONE),
    Twin(f"{NEES}:nees", f"{ONE}.filtering.nees:nees", f"{ALONE}; P clearly of full rank"),
    Twin(f"{NEES}:nees", f"{MANY}.nees:nees", OF_MANY),
    Twin(
        of=f"{NEES}:squared_mahalanobis",
        form=f"{COMPILED}.nees:squared_mahalanobis",
        when=f"{OF_MANY}, three dimensions",
        compiled=True,
    ),
    Twin(f"{NEES}:squared_mahalanobis", f"{MANY}.nees:squared_mahalanobis", OF_MANY),
    # whole loops
    Twin(
        of="ekfsim.study.block:watched",
        form="ekfsim.fast.compiled.block:watched",
        when="commands of the classroom; ekf, huber or pdaf as it comes; no guard that looks about",
        compiled=True,
    ),
    Twin(
        of="ekfsim.study.block:follow",
        form="ekfsim.fast.many.following:follow",
        when="any instants: those that are not told of are taken together",
    ),
    Twin(
        of="ekfsim.diagnostics.summary:Summary.following",
        form="ekfsim.fast.summary:following",
        when="states that are a pose: inputs that follow one another are taken together",
    ),
    Twin(
        of="ekfsim.diagnostics.coverage:inside_ellipse",
        form="ekfsim.fast.one.told:inside_ellipse",
        when="one pose, its position clearly uncertain in both directions",
    ),
    Twin("ekfsim.diagnostics.coverage:inside_cone", "ekfsim.fast.one.told:inside_cone", "one pose"),
    Twin("ekfsim.views.words.numbers:cleared", "ekfsim.fast.one.told:cleared", "small matrices"),
    Twin("ekfsim.simulation.driver:driven", "ekfsim.fast.one.driver:driven", "one robot"),
    Twin("ekfsim.simulation.driver:driven", "ekfsim.fast.many.driver:driven", "many robots"),
    Twin("ekfsim.simulation.driven:written", "ekfsim.fast.written:written", "any ticks"),
    Twin(
        of="ekfsim.localization:localize",
        form="ekfsim.fast.stretches:localize",
        when="planar odometry, predicted as by the EKF: inputs in a row are taken together",
    ),
)


def twins_of(name: str, way: Way, first: type) -> tuple[Callable[..., Any], ...]:
    """The twins of a function, the quickest first, for a first argument of this type."""
    return tuple(
        function(twin.form)
        for twin in TWINS
        if twin.of == name
        and twin.given in ("", first.__name__)
        and (way == "compiled" or not twin.compiled)
    )


def function(name: str) -> Callable[..., Any]:
    """The function of a name "module:function" or "module:Class.method"."""
    module, _, path = name.partition(":")
    found: Any = import_module(module)
    for part in path.split("."):
        found = getattr(found, part)
    made: Callable[..., Any] = found
    return made
