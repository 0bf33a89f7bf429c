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
    given: str = ""  # the class of the first argument, where the twin is for one class alone
    compiled: bool = False  # by Numba: only where that is asked for


MANY = "ekfsim.fast.many"
NEES = "ekfsim.diagnostics.nees"
TWINS: tuple[Twin, ...] = (
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
    Twin("ekfsim.diagnostics.ambiguity:sighting", "ekfsim.fast.one.ambiguity:sighting", "one pose"),
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
        of="ekfsim.study.block:tally_of",
        form="ekfsim.fast.compiled.block:tally_of",
        when="commands of the classroom, an EKF as it comes, no guard that looks about",
        compiled=True,
    ),
)


def twins_of(name: str, way: Way, first: type) -> tuple[Callable[..., Any], ...]:
    """The twins of a function, the quickest first, for a first argument of this type."""
    kinds = {kind.__name__ for kind in first.__mro__}
    return tuple(
        function(twin.form)
        for twin in TWINS
        if twin.of == name
        and (not twin.given or twin.given in kinds)
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
