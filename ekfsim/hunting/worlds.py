"""A world of which something is left out, by the text of its file: what is written is what was
judged.
"""

import copy
from dataclasses import replace
from typing import Any

import yaml

from ekfsim.errors import InputError
from ekfsim.files.given.given import Given
from ekfsim.files.scenes.load import read_world
from ekfsim.files.scenes.overruling import overruled
from ekfsim.scene import Scene
from ekfsim.world import World


def without(scene: Scene, obstacle: str) -> Scene | None:
    """The scene without an obstacle, which the filter is not told of either; None where its file
    does not list it, or tells the filter of another map.
    """
    plain = plain_of(scene.world)
    if plain is None or scene.world.told.map != scene.world.map:
        return None
    listed = plain.get("obstacles")
    left = [one for one in listed or [] if one.get("name") != obstacle]
    if not listed or len(left) != len(listed) - 1:
        return None
    return with_world(scene, {**plain, "obstacles": left})


def with_world(scene: Scene, plain: dict[str, Any]) -> Scene | None:
    """The scene in a world of other keys; None where that is no sound world."""
    try:
        return replace(scene, world=read_world(Given.values(plain, scene.world.name)).get())
    except InputError:
        return None


def plain_of(world: World) -> dict[str, Any] | None:
    """The keys of a world's file, with what overrules them; None where it was read from none."""
    given = world.given
    if not isinstance(given, Given):
        return None
    root, _ = given.tree()
    plain: Any = overruled(root, "world", given.settings).plain()
    return copy.deepcopy(plain) if isinstance(plain, dict) else None


def text_of(plain: dict[str, Any]) -> str:
    """The text of a world file."""
    return yaml.safe_dump(plain, sort_keys=False, allow_unicode=True, default_flow_style=None)
