"""By what each kind of plan is recognised. Nothing heavy is imported here: every `check` asks."""

import re
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ekfsim.files.maps.reading import Head

OF_ROS_MAPS = {"image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"}
MOST_OF_THEM = 3
OF_IRSIM = {"robot", "obstacle", "robots", "obstacles"}
OF_ITS_WORLD = {"height", "width", "step_time", "sample_time", "obstacle_map"}
OF_GEOJSON = {
    *("FeatureCollection", "Feature", "GeometryCollection", "Polygon", "MultiPolygon"),
    *("LineString", "MultiLineString", "Point", "MultiPoint"),
}
WKT = re.compile(
    rb"\s*(#[^\n]*\n\s*)*(SRID\s*=\s*\d+\s*;\s*)?"
    rb"(MULTI)?(POINT|LINESTRING|POLYGON|GEOMETRYCOLLECTION)\b",
    re.IGNORECASE,
)


def is_ros_map(head: "Head") -> bool:
    """A YAML file with most of the keys of a ROS map, none of which is a world's."""
    if head.root is None or not isinstance(head.root.value, dict):
        return False
    return len(OF_ROS_MAPS & head.root.value.keys()) >= MOST_OF_THEM


def is_irsim(head: "Head") -> bool:
    """A YAML file with a mapping `world`, and robots or obstacles, or the world's measures."""
    if head.root is None or not isinstance(head.root.value, dict):
        return False
    world = head.root.value.get("world")
    if world is None or not isinstance(world.value, dict):
        return False
    return bool(OF_IRSIM & head.root.value.keys()) or bool(OF_ITS_WORLD & world.value.keys())


def is_geojson(head: "Head") -> bool:
    """A JSON file whose type is one of GeoJSON's."""
    return isinstance(head.data, dict) and head.data.get("type") in OF_GEOJSON


def is_wkt(head: "Head") -> bool:
    """A text that begins with the name of a geometry."""
    named = head.path.suffix.lower() == ".wkt"
    return named or (head.root is None and WKT.match(head.raw[:4096]) is not None)


def is_dxf(head: "Head") -> bool:
    """A file whose name says so."""
    return head.path.suffix.lower() == ".dxf"


def is_svg(head: "Head") -> bool:
    """A file whose name or whose first lines say so."""
    if head.path.suffix.lower() == ".svg":
        return True
    return head.root is None and head.raw.lstrip()[:1] == b"<" and b"<svg" in head.raw[:4096]
