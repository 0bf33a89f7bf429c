"""What was found → a commands file that keeps its word, and a world file where the world is
another than any file holds.
"""

import json
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.files.results.writing import refuse_unwritable, whole_text
from ekfsim.files.scene_text import body
from ekfsim.files.scenes.settings import kind_of, setting
from ekfsim.hunting.worlds import plain_of, text_of
from ekfsim.scene import Expect, Scene
from ekfsim.version import VERSION
from ekfsim.world import World


def world_beside(path: Path) -> Path:
    """Where the world file comes to lie, if one is written."""
    return path.with_name(f"{path.stem}-world{path.suffix}")


def refuse_place(path: Path, force: bool) -> None:
    """Raises UsageError or RunError where either file cannot be written."""
    if path.suffix.lower() not in (".yaml", ".yml"):
        raise UsageError(f"{path}: a commands file is written; name it e.g. hunt.yaml")
    for file in (path, world_beside(path)):
        refuse_unwritable(file, force)


@dataclass(frozen=True)
class Told:
    """What stands in a file besides its scene."""

    description: str
    repeated: str  # the command line that finds it again
    held: str  # and the one that shows that it is so


def write(scene: Scene, told: Told, asked: World, path: Path, force: bool) -> list[Path]:
    """Write what was found; the files that were written.

    asked : the world that was hunted in
    """
    if not needs_world(scene, asked):
        with whole_text(path, force) as file:
            file.write(_text(scene, told, path))
        return [path]
    world = world_beside(path)
    plain = plain_of(scene.world)
    if plain is None:
        raise UsageError(f"{path}: cannot be written: the world {scene.world.name!r} is no file's")
    own = replace(scene, world_file=world)
    with whole_text(world, force) as of_world, whole_text(path, force) as file:
        of_world.write(f"# Made by ekfsim {VERSION}: {told.repeated}\n{text_of(plain)}")
        file.write(_text(own, told, path))
    return [path, world]


def needs_world(scene: Scene, asked: World) -> bool:
    """Whether no file holds the world as it is."""
    settings = (kind_of(setting(one)) for one in scene.settings)
    return scene.world is not asked or "world" in settings


def _text(scene: Scene, told: Told, path: Path) -> str:
    return "".join(f"{line}\n" for line in _lines(scene, told, path))


def _lines(scene: Scene, told: Told, path: Path) -> Iterator[str]:
    yield f"# Found by ekfsim {VERSION}: {told.repeated}"
    yield f"# {told.held}"
    yield "description: |"
    yield from (f"  {line}".rstrip() for line in told.description.splitlines())
    if scene.expect is not None:
        yield f"expect: {expect_text(scene.expect)}"
    yield from body(replace(scene, description="", expect=None), path)


def expect_text(expect: Expect) -> str:
    """The promise as a file holds it.

    >>> expect_text(Expect(lost=(0.5, 0.6), nees="high", runs=1000))
    '{lost: [0.5, 0.6], nees: high, runs: 1000}'
    """
    told = [] if expect.lost is None else [f"lost: {json.dumps(list(expect.lost))}"]
    told += [] if expect.nis is None else [f"nis: {expect.nis}"]
    told += [] if expect.nees is None else [f"nees: {expect.nees}"]
    return f"{{{', '.join([*told, f'runs: {expect.runs}'])}}}"
