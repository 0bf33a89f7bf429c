"""What a change puts right, in words."""

import re
from collections.abc import Sequence

from ekfsim.floor import BOUNDARY
from ekfsim.why.records import Change, Kind, Tried

PLURALS: dict[Kind, str] = {
    "noise": "told noises, each made true",
    "number": "told numbers, each made true",
    "start": "told starts, each made true",
    "sigma": "told sigmas of the start, each made true",
    "map": "things of the told map, each put right",
    "fault": "faults, each taken out",
    "beams": "classes of beams, each left out",
    "wall": "rules of the wall that is met",
    "linear": "ways not to make it linear",
    "reading": "readings, each left out",
    "move": "moves, each made exact",
    "guess": "guesses, each put right",
}


DEED = "left out"  # what becomes of a class of beams, where its name does not say it


def put_right(change: Change) -> str:
    """What a change makes of a run, after "with" or "without".

    >>> put_right(Change("reading", "the beam of step 13", step=13))
    'without the beam of step 13'
    >>> put_right(Change("noise", "the told rangeSigmaRatio", "0.01 told, 0.02 true"))
    'with the told rangeSigmaRatio made true'
    """
    name, deed = named(change), change.told.partition(",")[0]
    match change.kind:
        case "noise" | "number" | "start" | "sigma":
            return f"with {name} made true"
        case "map":
            return f"with {name} put right"
        case "fault" | "reading":
            return f"without {name}"
        case "beams":
            return f"with {name}" + (f" {deed}" if deed.startswith(DEED) else "")
        case "move":
            return f"with {name} made exact"
    return f"with {name}"


def named(change: Change) -> str:
    """What a change is of, for a person: the room's own ring has a name of the files'.

    >>> named(Change("map", "edge 1 of boundary in the map"))
    "edge 1 of the room's wall in the map"
    """
    return _of_room(change.name) if change.kind == "map" else change.name


def ringed(change: Change) -> str:
    """What is said of it, likewise."""
    return _of_room(change.told) if change.kind == "map" else change.told


def _of_room(text: str) -> str:
    return re.sub(rf"\b{BOUNDARY}\b", "the room's wall", text)


def all_of(changes: Sequence[Change]) -> str:
    """Several changes, as one that is made: "with a made true, b put right and without c"."""
    return joined([put_right(one) for one in changes])


def joined(words: Sequence[str]) -> str:
    """Words in a row.

    >>> joined(["a", "b", "c"])
    'a, b and c'
    """
    *first, last = words
    return f"{', '.join(first)} and {last}" if first else last


def ends(tried: Tried) -> str:
    """How a run ends."""
    if tried.outcome == "lost":
        return "lost" if tried.lost_from is None else f"lost since {tried.lost_from}"
    return tried.outcome
