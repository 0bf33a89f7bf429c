"""What is no mistake and yet hardly meant: angles in radians, kidnappings, beams without noise."""

import math
from collections.abc import Iterator

from ekfsim.errors import Mistake
from ekfsim.files.scenes.checking.polygons import FloorPlan
from ekfsim.files.scenes.checking.sound import Sound
from ekfsim.files.yaml.telling import at
from ekfsim.floor import Map
from ekfsim.printable import short
from ekfsim.world import World


def angle_warnings(file: Sound) -> Iterator[Mistake]:
    """Angles that are hardly meant as degrees."""
    for path, node in file.root.walk():
        is_angle, is_rate = (
            path[-1:] in (("theta",), ("angle",)),
            path[-1:] in (("omega",), ("turnRate",)),
        )
        is_angle = is_angle or "bearings" in path
        number = file.value(*path) if is_angle or is_rate else None
        if not isinstance(number, int | float):
            continue
        if abs(number) > 360 and is_angle:
            wrong, right = (
                f"{short(node.written)} is more than a full turn",
                "angles are in degrees: 90 is a quarter turn",
            )
        elif is_radians(number, node.written):
            what = "angles are in degrees" if is_angle else "turn rates are in degrees per second"
            wrong, right = (
                f"{node.written} looks like radians",
                f"{what}: write {math.degrees(number):.0f}",
            )
        else:
            continue
        yield at(file.file, node.mark, path, wrong, right)


def kidnap_warnings(file: Sound, floor_plan: Map) -> Iterator[str]:
    """Kidnaps to where no robot can stand."""
    plan = FloorPlan.of(floor_plan)
    for path, node in file.root.walk():
        if path[-1:] == ("kidnap",) and (target := file.value(*path)) is not None:
            for wrong in plan.in_the_way(target["x"], target["y"]):
                yield str(
                    at(
                        file.file,
                        node.mark,
                        path,
                        f"the robot is carried to {wrong}",
                        "it cannot move there",
                    )
                )


def perfect_beam_warnings(file: Sound, world: World) -> Iterator[str]:
    """A laser that is believed without noise, by a robot that is not sure of its place."""
    if not world.perfect_beam:
        return
    for path in (("belief", "noise", "rangeSigmaRatio"), ("noise", "rangeSigmaRatio")):
        if (node := file.root.at(path)) is not None:
            wrong = (
                "a linearised filter takes a beam without noise for certain, and soon claims a "
                "place it is not at"
            )
            yield str(
                at(
                    file.file,
                    node.mark,
                    path,
                    wrong,
                    "a small ratio, such as 0.001, leaves room for the bend",
                )
            )
            return


def is_radians(angle: float, written: str) -> bool:
    """Whether an angle is a multiple of π/4 to all its decimals, of which it has two or more.

    >>> is_radians(1.5708, "1.5708"), is_radians(1.5, "1.5"), is_radians(45.25, "45.25")
    (True, False, False)
    """
    decimals = len(written.partition(".")[2])
    eighths = round(angle / (math.pi / 4))
    return (
        decimals >= 2 and 0 < abs(eighths) <= 8 and round(eighths * math.pi / 4, decimals) == angle
    )
