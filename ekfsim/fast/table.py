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


MANY = "ekfsim.fast.many"
NEES = "ekfsim.diagnostics.nees"
ALONE = "one robot: no leading axes"
ANY = "whatever the leading axes"
MOTION, SENSOR = (f"ekfsim.models.protocols:{kind}.linearize" for kind in ("Motion", "Sensor"))
MOTIONS, MARKER = "ekfsim.models.motions", "ekfsim.models.sensors.landmarks:MarkerAngles"
AMBIGUITY = "ekfsim.diagnostics.ambiguity"

TWINS: tuple[Twin, ...] = (
    Twin(MOTION, "ekfsim.fast.one.motions:move_turn", ALONE, "MoveTurn"),
    Twin(MOTION, "ekfsim.fast.compiled.models:move_turn", "x, u : (N, …)", "MoveTurn", True),
    Twin(MOTION, "ekfsim.fast.many.motions:move_turn", ANY, "MoveTurn"),
    Twin(MOTION, "ekfsim.fast.one.motions:gyro_wheels", ALONE, "GyroWheels"),
    Twin(MOTION, "ekfsim.fast.one.motions:unicycle", ALONE, "Unicycle"),
    Twin(MOTION, "ekfsim.fast.one.motions:wheel_speeds", ALONE, "WheelSpeeds"),
    Twin(f"{MOTIONS}.move_turn:MoveTurn.f", "ekfsim.fast.one.motions:move_turn_f", ALONE),
    Twin(f"{MOTIONS}.move_turn:MoveTurn.f", "ekfsim.fast.many.motions:move_turn_f", ANY),
    Twin(f"{MOTIONS}.wheels:GyroWheels.f", "ekfsim.fast.one.motions:gyro_wheels_f", ALONE),
    Twin(f"{MOTIONS}.unicycle:Unicycle.f", "ekfsim.fast.one.motions:unicycle_f", ALONE),
    Twin(SENSOR, "ekfsim.fast.one.sensors:laser", ALONE, "Laser"),
    Twin(SENSOR, "ekfsim.fast.compiled.models:laser", "x : (N, …)", "Laser", True),
    Twin(SENSOR, "ekfsim.fast.many.sensors:laser", ANY, "Laser"),
    Twin(SENSOR, "ekfsim.fast.many.sensors:laser_by_reading", ANY, "LaserByReading"),
    Twin(SENSOR, "ekfsim.fast.many.sensors:ultrasonic", ANY, "UltrasonicBeam"),
    Twin(SENSOR, "ekfsim.fast.many.sensors:infrared", ANY, "InfraredBeam"),
    Twin(SENSOR, "ekfsim.fast.many.sensors:frozen", "as many x as it holds", "Frozen"),
    Twin(SENSOR, "ekfsim.fast.one.sensors:marker_angles", ALONE, "MarkerAngles"),
    Twin(f"{MARKER}.residual", "ekfsim.fast.one.sensors:marker_residual", ALONE),
    Twin(f"{AMBIGUITY}:sighting", "ekfsim.fast.one.ambiguity:sighting", ALONE),
    Twin(
        "ekfsim.raycast.walls:Walls.cast",
        "ekfsim.raycast.searches.compiled:cast",
        "many beams",
        compiled=True,
    ),
    Twin("ekfsim.raycast.walls:Walls.cast", "ekfsim.raycast.searches.choice:cast", "any beams"),
    Twin(
        "ekfsim.raycast.walls:Walls.first", "ekfsim.raycast.searches.single_beam:first", "any beam"
    ),
    Twin("ekfsim.raycast.ground:Ground.reach", "ekfsim.fast.one.ground:reach", "from one place"),
    Twin(f"{NEES}:nees", "ekfsim.fast.one.nees:nees", "one pose, its P clearly of full rank"),
    Twin(f"{NEES}:nees", f"{MANY}.nees:nees", "64 runs or more"),
    Twin(
        f"{NEES}:squared_mahalanobis",
        "ekfsim.fast.many.nees:squared_mahalanobis",
        "64 runs or more",
    ),
    Twin(
        of="ekfsim.filters.chi_square:quantile",
        form="ekfsim.fast.chi_square:quantile",
        when="up to 5 000 degrees of freedom, and a probability that is neither 0 nor 1",
    ),
    Twin(
        of="ekfsim.study.block:watched",
        form="ekfsim.fast.compiled.block:watched",
        when="commands of the classroom, an EKF as it comes, no guard that looks about",
        compiled=True,
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
    Twin("ekfsim.simulation.driven:written", "ekfsim.fast.written:written", "any ticks"),
    Twin(
        of="ekfsim.localization:localize",
        form="ekfsim.fast.stretches:localize",
        when="an EKF of planar odometry: inputs that follow one another are taken together",
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
