"""Which kind of plan a file holds, and the reader of that kind."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ekfsim.errors import InputError, UsageError
from ekfsim.files.maps.json_text import data_of
from ekfsim.files.maps.plan import Asked, Plan
from ekfsim.files.source import bytes_of
from ekfsim.files.yaml.marked import Node
from ekfsim.files.yaml.parsing import parse
from ekfsim.late import found


@dataclass(frozen=True, slots=True)
class Head:
    """What a plan is recognised by."""

    path: Path
    shown: str  # how messages name it
    raw: bytes
    root: Node | None  # the tree of a YAML text, None of any other
    data: Any = None  # what a JSON text holds


@dataclass(frozen=True, slots=True)
class Format:
    """A kind of plan."""

    what: str  # as in "this is …"
    recognised: str  # "module:function", Head → bool
    read: str  # "module:function", (Head, Asked) → Plan


SIGNS = "ekfsim.files.maps.signs"
FORMATS = (
    Format("a ROS map", "ekfsim.files.maps.signs:is_ros_map", "ekfsim.files.maps.formats.ros:read"),
    Format("an ir-sim world", f"{SIGNS}:is_irsim", "ekfsim.files.maps.formats.irsim:read"),
    Format("GeoJSON", f"{SIGNS}:is_geojson", "ekfsim.files.maps.formats.geojson:read"),
    Format("DXF", f"{SIGNS}:is_dxf", "ekfsim.files.maps.formats.dxf:read"),
    Format("SVG", f"{SIGNS}:is_svg", "ekfsim.files.maps.formats.svg:read"),
    Format("WKT", f"{SIGNS}:is_wkt", "ekfsim.files.maps.formats.wkt:read"),
)
TREES = (".yaml", ".yml")
JSON = (".json", ".geojson")
PICTURES = (".pgm", ".png", ".jpg", ".jpeg", ".bmp", ".gif", ".tif", ".tiff")


def read_plan(path: Path, shown: str, asked: Asked) -> tuple[Plan, str]:
    """The plan that a file holds, and what kind of plan it is.

    Raises UsageError where none is recognised, InputError with all mistakes in it.
    """
    if path.suffix.lower() in PICTURES:
        beside = path.with_suffix(".yaml")
        raise UsageError(
            f"{shown}: a picture does not tell how large its pixels are; name the map.yaml of "
            f"it{f', {str(beside)!r}' if beside.is_file() else ''}"
        )
    head = head_of(path, shown)
    if (kind := recognised(head)) is None:
        raise UsageError(
            f"{shown}: this is no plan that is known here; known are "
            + ", ".join(format.what for format in FORMATS)
        )
    reader: Callable[[Head, Asked], Plan] = found(kind.read)
    return reader(head, asked), kind.what


def head_of(path: Path, shown: str) -> Head:
    """What a file is recognised by. Raises UsageError where it cannot be read, InputError where it
    is named as a text that it is not.
    """
    raw = bytes_of(path, shown)
    root = None
    if path.suffix.lower() in TREES:
        from ekfsim.files.source import as_written

        root, _ = parse(as_written(path, shown), shown)
    is_json = path.suffix.lower() in JSON
    return Head(path, shown, raw, root, data_of(raw, shown) if is_json else None)


def recognised(head: Head) -> Format | None:
    """The kind of plan that a file is, None where it is none that is known."""
    for format in FORMATS:
        fits: Callable[[Head], bool] = found(format.recognised)
        if fits(head):
            return format
    return None


def plan_in(path: Path, shown: str) -> str | None:
    """What a file is that is no file of ours but a plan, and what makes a world of it; None of any
    other.
    """
    try:
        kind = recognised(head_of(path, shown))
    except (InputError, UsageError):
        return None  # whoever reads it tells why
    if kind is None:
        return None
    return f"{shown}: this is {kind.what}; `ekfsim world {shown} -o world.yaml` makes a world of it"
