"""A student's own commands files: whether they keep what they promise, and what they expose.

They are read here, by us: nothing in them is run. What they name lies in the student's folder or
comes along; a link that leads out of it is not followed, and a file that is too much is told so
before anything is played.
"""

import os
import stat
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

from ekfsim.commands import expanded_length
from ekfsim.errors import EkfsimError, InputError, UsageError
from ekfsim.files.keys.homework import InputsKeys
from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import read_scene
from ekfsim.files.scenes.one_file import kind_of_tree
from ekfsim.files.source import as_written
from ekfsim.files.yaml.marked import Node
from ekfsim.files.yaml.parsing import parse
from ekfsim.printable import in_a_line, short, some
from ekfsim.scene import Scene
from ekfsim.student.exposing.exposed import exposed
from ekfsim.student.grading.scores import Scored
from ekfsim.study.block import run_blocks
from ekfsim.study.expectation import findings
from ekfsim.study.results import Result

MOST_BYTES = 200_000  # of one of them
MOST_FILES = 50
MOST_MISTAKES = 3  # of one file that are told


@dataclass
class Inputs:
    """What became of a student's commands files, each a line."""

    kept: list[str] = field(default_factory=list)  # the names of those that keep a promise
    exposed: dict[str, str] = field(default_factory=dict)  # known mistakes, and by which file first
    words: list[str] = field(default_factory=list)


def graded_inputs(score: Scored, keys: InputsKeys, folder: Path) -> Scored:
    """One of the two things that are asked of a student's commands files."""
    if not folder.is_dir():
        told = "a file was handed in; commands files are looked for beside it, in a folder"
        return replace(score, words=(told,)).earned(0.0)
    promises = score.check.about == "promises"
    wanted = keys.files if promises else keys.exposed
    assert wanted is not None
    found = Inputs()
    for path in _files(folder):
        try:
            scene = _scene(path, folder, keys)
            if scene is None:
                continue
            if promises:
                _promise(path.name, scene, keys.runs, found)
            else:
                _expose(path.name, scene, found)
        except InputError as error:
            lines = [str(mistake).removeprefix(f"{folder}{os.sep}") for mistake in error.mistakes]
            found.words += [short(line, 300) for line in lines[:MOST_MISTAKES]]
        except EkfsimError as error:
            found.words.append(short(f"{in_a_line(path.name)}: {_told(error, folder)}", 300))
    got = len(found.kept if promises else found.exposed)
    what = "files that keep what they promise" if promises else "known mistakes exposed"
    if not found.words:
        found.words.append("no commands file (.yaml) was handed in")
    summed = f"{what}: {got}; {wanted} {'is' if wanted == 1 else 'are'} worth all points"
    words = (summed, *found.words)
    return replace(score, words=words).earned(1.0 if got >= wanted else got / wanted)


def _told(error: EkfsimError, folder: Path) -> str:
    return str(error).replace(f"{folder}{os.sep}", "")


def _files(folder: Path) -> Iterator[Path]:
    """The plain .yaml files of a folder in the order of their names, not too many."""
    names = sorted(name for name in os.listdir(folder) if name.endswith((".yaml", ".yml")))
    for name in names[:MOST_FILES]:
        path = folder / name
        if stat.S_ISREG(os.lstat(path).st_mode):
            yield path


def _scene(path: Path, folder: Path, keys: InputsKeys) -> Scene | None:
    """The scene of a commands file; None where it is of another kind.

    Raises InputError where there are mistakes in it, UsageError where it is too much.
    """
    root = _tree(path)
    if kind_of_tree(root) != "commands":
        return None
    if "recording" in root.keys:
        raise UsageError("has a recording; hand in one with commands")
    world = root.at(("world",))
    if world is not None and isinstance(world.value, str):
        _refuse_outside(world.value, path, folder)
    loaded = read_scene(path)
    scene = loaded.get()
    length = expanded_length(scene.commands)
    if scene.drive is not None:
        raise UsageError("has a drive; hand in one with commands")
    if length > keys.commands:
        raise UsageError(f"has {length} commands, repetitions written out; {keys.commands} at most")
    return replace(scene, filter="ekf", beside=())


def _tree(path: Path) -> Node:
    if path.stat().st_size > MOST_BYTES:
        raise UsageError(f"is larger than {MOST_BYTES // 1000} kB; write a smaller one")
    root, _ = parse(as_written(path, str(path)), str(path))
    return root


def _refuse_outside(named: str, path: Path, folder: Path) -> None:
    """Raise UsageError where a world is named that lies outside of the folder."""
    near = Path(os.path.realpath(path.parent / named))
    if near.is_relative_to(os.path.realpath(folder)):
        if near.is_file():
            _tree(near)
        elif near.exists():
            raise UsageError(f"names the world '{short(in_a_line(named), 60)}', which is no file")
        return
    if named not in packaged("worlds"):
        name = short(in_a_line(named), 60)
        raise UsageError(
            f"names the world '{name}', which lies outside of the folder; hand it in beside, or "
            "name one that comes along"
        )


def _promise(name: str, scene: Scene, most: int, found: Inputs) -> None:
    """Whether the reference keeps what a scene promises."""
    told = in_a_line(name)
    if scene.expect is None or not list(findings(scene.expect, None)):
        found.words.append(f"{told}: promises nothing; write e.g. expect: {{lost: [0, 0.02]}}")
        return
    runs = min(scene.expect.runs, most)
    result = findings(scene.expect, Result.alone(scene, run_blocks(scene, runs)))
    broken = [one for one in result if not one.kept]
    for one in broken:
        side = f" {one.side} the band" if one.side else ""
        found.words.append(
            f"{told}: {one.name}: {100 * one.share.value:.3g} % of {one.share.of} runs{side}, "
            f"where {100 * one.low:.3g} to {100 * one.high:.3g} % were promised"
        )
    if not broken:
        found.kept.append(name)
        found.words.append(f"{told}: keeps what it promises, over {runs} runs")


def _expose(name: str, scene: Scene, found: Inputs) -> None:
    """Which known mistakes show in the run of a scene."""
    shown = [one for one in exposed(scene) if one.first is not None]
    new = [one.mistake.name for one in shown if one.mistake.name not in found.exposed]
    found.exposed.update(dict.fromkeys(new, name))
    more = f", {len(new)} of them new: {some(new)}" if new else ""
    found.words.append(f"{in_a_line(name)}: exposes {len(shown)} known mistakes{more}")
