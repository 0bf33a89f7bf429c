"""A ROS map: a YAML file that says how the pixels of a picture are to be read."""

import math
from typing import Literal, cast

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.maps.pixels.cells import Reading
from ekfsim.files.maps.pixels.image import grey_of
from ekfsim.files.maps.pixels.rooms import plan_of
from ekfsim.files.maps.plan import Asked, Plan
from ekfsim.files.maps.reading import Head
from ekfsim.files.yaml.marked import Node
from ekfsim.printable import quoted

Mode = Literal["trinary", "scale", "raw"]
MODES = ("trinary", "scale", "raw")
KNOWN = (
    *("image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh", "mode"),
    *("description", "name", "yaml_version", "robot_map_version", "cost_translation_table"),
)
EXAMPLES = {
    "image": "map.pgm",
    "resolution": "0.05",
    "origin": "[-10, -10, 0]",
    "negate": "0",
    "occupied_thresh": "0.65",
    "free_thresh": "0.196",
}


def read(head: Head, asked: Asked) -> Plan:
    """The plan of a map.yaml and its picture.

    Raises InputError with all mistakes in the YAML file, UsageError where the picture cannot be
    read.
    """
    keys = _Keys(head)
    image = keys.text("image")
    resolution = keys.number("resolution", above=0)
    origin = keys.origin()
    reading = Reading(
        negate=keys.negate(),
        occupied=keys.number("occupied_thresh", 0, 1),
        free=keys.number("free_thresh", 0, 1),
        mode=keys.mode(),
    )
    keys.finish(reading)
    picture = head.path.parent / image
    grey = grey_of(picture, str(picture))
    return plan_of(head.path.stem, grey, reading, resolution, origin, asked, keys.told, head.shown)


class _Keys:
    """The keys of a map.yaml, each with its place."""

    def __init__(self, head: Head) -> None:
        if head.root is None or not isinstance(head.root.value, dict):
            raise ValueError(f"{head.shown}: no mapping, and was recognised as a ROS map")
        self.file, self.root, self.nodes = head.shown, head.root, head.root.value
        self.mistakes: list[Mistake] = []
        self.told: list[str] = []

    def text(self, key: str) -> str:
        """A text, "" where it is wrong."""
        node = self._node(key)
        if node is None:
            return ""
        if not isinstance(node.value, str) or not node.value.strip():
            self._refuse(node, key, "this is no name of a file", f"write e.g. {EXAMPLES[key]}")
            return ""
        return node.value

    def number(
        self, key: str, low: float = -math.inf, high: float = math.inf, above: float = -math.inf
    ) -> float:
        """A number in [low, high] and more than `above`; nan where it is wrong."""
        node = self._node(key)
        if node is None:
            return math.nan
        value = _float(node)
        if value is None or not (low <= value <= high and value > above):
            self._refuse(node, key, _no_number(node), f"write e.g. {EXAMPLES[key]}")
            return math.nan
        return value

    def origin(self) -> tuple[float, float, float]:
        """x, y in m, and the yaw in degrees, of the lower left corner."""
        node = self._node("origin")
        if node is None:
            return 0.0, 0.0, 0.0
        parts = node.value if isinstance(node.value, list) else []
        values = [_float(part) for part in parts]
        if len(values) != 3 or None in values:
            self._refuse(
                node, "origin", "these are not three numbers", "write [x, y, yaw], in m, m, rad"
            )
            return 0.0, 0.0, 0.0
        x, y, yaw = cast("list[float]", values)
        return x, y, math.degrees(yaw)

    def negate(self) -> bool:
        """Whether white is occupied."""
        node = self._node("negate")
        value = None if node is None else node.value
        if node is not None and value not in (0, 1, True, False):
            self._refuse(node, "negate", _no_number(node), "write 0, or 1 where white is occupied")
        return bool(value) if node is not None else False

    def mode(self) -> Mode:
        """How grey is read."""
        node = self.nodes.get("mode")
        if node is None:
            return "trinary"
        if node.value not in MODES:
            self._refuse(
                node, "mode", f"{quoted(node.written)} is no mode", "write trinary, scale or raw"
            )
        return cast("Mode", node.value)

    def finish(self, reading: Reading) -> None:
        """Raises InputError where anything was wrong."""
        if reading.free > reading.occupied:
            self._refuse(
                self.nodes["free_thresh"],
                "free_thresh",
                f"{reading.free:g} is more than occupied_thresh, {reading.occupied:g}",
                "a cell cannot be free and occupied: give the smaller number here",
            )
        if self.mistakes:
            raise InputError(
                sorted(self.mistakes, key=lambda one: (one.place.line, one.place.column))
            )
        unknown = [key for key in self.nodes if key not in KNOWN]
        self.told += [f"the key {quoted(key)} of the map is not read" for key in unknown]

    def _node(self, key: str) -> Node | None:
        node = self.nodes.get(key)
        if node is None:
            right = f"add e.g. '{key}: {EXAMPLES[key]}'"
            self._refuse(self.root, key, "the key is missing", right)
        return node

    def _refuse(self, node: Node, key: str, wrong: str, right: str) -> None:
        self.mistakes.append(Mistake(Place(self.file, *node.mark), key, wrong, right))


def _float(node: Node) -> float | None:
    """A number, however YAML 1.1 or 1.2 takes it, in quotes or not; None for anything else."""
    if isinstance(node.value, bool | list | dict):
        return None
    try:
        value = float(node.written or str(node.value))
    except ValueError:
        return None
    return value if math.isfinite(value) else None


def _no_number(node: Node) -> str:
    return f"{quoted(node.written)} does not fit here" if node.written else "this does not fit here"
