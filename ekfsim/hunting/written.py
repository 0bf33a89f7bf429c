"""What was found → a commands file that keeps its word, and a world file where the world is
another than any file holds.
"""

import json
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

from ekfsim.errors import UsageError
from ekfsim.files.results.writing import refuse_existing, whole_text
from ekfsim.files.scene_text import body
from ekfsim.files.scenes.settings import kind_of, setting
from ekfsim.hunting.hunt import Hunted
from ekfsim.hunting.worlds import plain_of, text_of
from ekfsim.scene import Expect
from ekfsim.version import VERSION


def world_beside(path: Path) -> Path:
    """Where the world file comes to lie, if one is written."""
    return path.with_name(f"{path.stem}-world{path.suffix}")


def refuse_unwritable(path: Path, force: bool) -> None:
    """Raises UsageError where either file may not be written."""
    if path.suffix.lower() not in (".yaml", ".yml"):
        raise UsageError(f"{path}: a commands file is written; name it e.g. hunt.yaml")
    for file in (path, world_beside(path)):
        refuse_existing(file, force)


def write(hunted: Hunted, description: str, repeated: str, path: Path, force: bool) -> list[Path]:
    """Write what was found; the files that were written.

    repeated : the command line that finds it again
    """
    scene = replace(hunted.scene, description="")
    if not needs_world(hunted):
        with whole_text(path, force) as file:
            file.write(_text(hunted, description, repeated, path))
        return [path]
    world = world_beside(path)
    plain = plain_of(scene.world)
    if plain is None:
        raise UsageError(f"{path}: cannot be written: the world {scene.world.name!r} is no file's")
    own = replace(hunted, scene=replace(scene, world_file=world))
    with whole_text(world, force) as of_world, whole_text(path, force) as file:
        of_world.write(f"# Made by ekfsim {VERSION}: {repeated}\n{text_of(plain)}")
        file.write(_text(own, description, repeated, path))
    return [path, world]


def needs_world(hunted: Hunted) -> bool:
    """Whether no file holds the world as it is."""
    told = (kind_of(setting(one)) for one in hunted.scene.settings)
    return hunted.is_barer or "world" in told


def _text(hunted: Hunted, description: str, repeated: str, path: Path) -> str:
    return "".join(f"{line}\n" for line in _lines(hunted, description, repeated, path))


def _lines(hunted: Hunted, description: str, repeated: str, path: Path) -> Iterator[str]:
    yield f"# Found by ekfsim {VERSION}: {repeated}"
    yield f"# `ekfsim study {path.name} --expect` holds it to its word"
    yield "description: |"
    yield from (f"  {line}" for line in description.splitlines())
    assert hunted.scene.expect is not None
    yield f"expect: {expect_text(hunted.scene.expect)}"
    yield from body(replace(hunted.scene, description="", expect=None), path)


def expect_text(expect: Expect) -> str:
    """The promise as a file holds it.

    >>> expect_text(Expect(lost=(0.5, 0.6), nees="high", runs=1000))
    '{lost: [0.5, 0.6], nees: high, runs: 1000}'
    """
    told = [] if expect.lost is None else [f"lost: {json.dumps(list(expect.lost))}"]
    told += [] if expect.nis is None else [f"nis: {expect.nis}"]
    told += [] if expect.nees is None else [f"nees: {expect.nees}"]
    return f"{{{', '.join([*told, f'runs: {expect.runs}'])}}}"
