"""By what each kind of plan is recognised. Nothing heavy is imported here: every `check` asks."""

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ekfsim.files.maps.reading import Head

OF_ROS_MAPS = {"image", "resolution", "origin", "negate", "occupied_thresh", "free_thresh"}
MOST_OF_THEM = 3


def is_ros_map(head: "Head") -> bool:
    """A YAML file with most of the keys of a ROS map, none of which is a world's."""
    if head.root is None or not isinstance(head.root.value, dict):
        return False
    return len(OF_ROS_MAPS & head.root.value.keys()) >= MOST_OF_THEM
