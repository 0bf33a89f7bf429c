"""A scene → the text of a commands file, as a person would write it, and what plays it again.

Read again, every number is the same to the last digit.
"""

import json
import math
import os
import re
import shlex
from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import fields
from pathlib import Path

import numpy as np

from ekfsim.commands import Command, Kidnap, Move, Repeat, Say, Sense
from ekfsim.errors import UsageError
from ekfsim.files.keys.fields import aliases
from ekfsim.files.keys.filters import TuningKeys
from ekfsim.files.looking import is_file, read_from
from ekfsim.files.packaged import folder, packaged
from ekfsim.files.scenes.settings import kind_of, setting
from ekfsim.files.source import UNPRINTABLE, unprintable
from ekfsim.files.yaml.marked import scalar
from ekfsim.filters.place import is_file as is_files_place
from ekfsim.filters.place import parts
from ekfsim.filters.tuning import UNTUNED
from ekfsim.geometry.angles import wrap
from ekfsim.printable import in_a_line
from ekfsim.scene import Scene
from ekfsim.twins import taken
from ekfsim.version import VERSION

PLAIN = re.compile(r"(?!-)[\w./-](?:[\w ./,;()+-]*[\w./)])?")  # texts that need no quotes
FEWEST, MOST = 6, 17  # digits of a float that are tried
TURNS = (0, 360, -360)  # degrees that a heading may have had, too, before it was wrapped


def scene_text(scene: Scene, path: Path, options: Sequence[str] = ()) -> str:
    """The text of a commands file at a path that plays a scene of commands; what stands in its
    first lines is `replay`.

    Raises UsageError where its world stands in no file.
    """
    return "".join(f"{line}\n" for line in _lines(scene, path, options))


def replay(scene: Scene, path: Path, options: Sequence[str] = ()) -> str:
    """The command line that plays the file again, with all that no commands file holds.

    options : what else is to stand in it
    """
    words = ["ekfsim", "play", str(path)]
    if scene.run:
        words += ["--run", str(scene.run)]
    if scene.beside:
        words += ["--filter", ",".join((scene.filter, *scene.beside))]
    for text in scene.settings:
        if kind_of(setting(text)) == "world":
            words += ["--set", text]
    if scene.reading != "corrected":
        words += ["--reading", scene.reading]
    if taken() == "plain":
        words.append("--plain")
    return in_a_line(shlex.join([*words, *options]))


def _lines(scene: Scene, path: Path, options: Sequence[str]) -> Iterator[str]:
    yield f"# Driven by hand with ekfsim {VERSION}; this shows the same run:"
    yield f"#   {re.sub(UNPRINTABLE, '?', replay(scene, Path(path.name), options))}"
    yield from body(scene, path)


def body(scene: Scene, path: Path) -> Iterator[str]:
    """The lines of the file, without those that tell where it comes from."""
    yield f"world: {_text(_world(scene, path))}"
    yield f"seed: {scene.seed}"
    yield f"filter: {_text(_filter(scene.filter, path))}"
    if scene.gate is not None:
        yield f"gate: {_number(scene.gate)}"
    if scene.guard != "warn":
        yield f"guard: {scene.guard}"
    if scene.tuning != UNTUNED:
        yield f"filterSettings: {{{', '.join(_tuning(scene))}}}"
    if scene.description:
        yield f"description: {_text(scene.description)}"
    if not scene.commands:
        yield "commands: []"
        return
    yield "commands:"
    yield from _commands(scene.commands, "  ")


def _world(scene: Scene, path: Path) -> str:
    """How a file at that path names the world: by its bare name where it comes along."""
    world, beside = scene.world_file, Path(os.path.abspath(path)).parent
    if world is None:
        raise UsageError(f"{path}: cannot be written: the world {scene.world.name!r} is no file's")
    if world.resolve().parent == folder("worlds").resolve() and world.stem in packaged("worlds"):
        with read_from(path):
            if not is_file(beside / world.stem):
                return world.stem
    return _way(str(world), beside)


def _filter(name: str, path: Path) -> str:
    """How a file at that path names the filter."""
    if not is_files_place(name):
        return name
    file, called = parts(name)
    way = _way(file, Path(os.path.abspath(path)).parent)
    return f"{way}:{called}" if called else way


def _way(file: str, folder: Path) -> str:
    """The way from a folder to a file; its whole path where there is none."""
    try:
        way = Path(os.path.relpath(file, folder)).as_posix()
    except ValueError:  # it lies on another drive
        way = Path(file).as_posix()
    if unprintable(way):
        raise UsageError(f"{folder}: no file in it can name {way!r}: that is no text; rename it")
    return way


def _tuning(scene: Scene) -> Iterator[str]:
    """The numbers of a filter's own that are not as they come."""
    keys = aliases(TuningKeys)
    for one in fields(scene.tuning):
        value = getattr(scene.tuning, one.name)
        if value != getattr(UNTUNED, one.name):
            yield f"{keys[one.name]}: {value if isinstance(value, str) else _number(value)}"


def _commands(commands: Iterable[Command], indent: str) -> Iterator[str]:
    for command in commands:
        match command:
            case Move(d, a, slip):
                slips = f", slip: {_number(slip)}" if slip else ""
                told = f"move: {{distance: {_number(d)}, angle: {_degrees(a)}{slips}}}"
            case Sense(a):
                told = f"sense: {{angle: {_degrees(a)}}}"
            case Kidnap(x, y, θ):
                told = f"kidnap: {{x: {_number(x)}, y: {_number(y)}, theta: {_heading(θ)}}}"
            case Say(words):
                told = f"say: {_text(words)}"
            case Repeat(times, repeated):
                yield f"{indent}- repeat:"
                yield f"{indent}    times: {times}"
                yield f"{indent}    commands:"
                yield from _commands(repeated, f"{indent}      ")
                continue
        yield f"{indent}- {told}"


def _number(value: float) -> str:
    """The shortest text of a number.

    >>> _number(0.25), _number(1.0), _number(-1e-7)
    ('0.25', '1', '-1e-07')
    """
    return repr(value).removesuffix(".0")


def _degrees(angle: float) -> str:
    """The shortest text of degrees that a file is read with as this angle in rad.

    >>> _degrees(math.radians(-86)), _degrees(math.radians(33.3)), _degrees(0.0)
    ('-86', '33.3', '0')
    """
    return _written(math.degrees(angle), lambda told: float(np.radians(told)) == angle)


def _heading(θ: float) -> str:
    """The same of a heading, which is wrapped once it is read."""
    for turn in TURNS:
        text = _written(math.degrees(θ) + turn, lambda told: _wrapped(told) == θ)
        if _wrapped(float(text)) == θ:
            return text
    return _number(math.degrees(θ))


def _wrapped(degrees: float) -> float:
    return float(wrap(np.radians(degrees)))


def _written(about: float, suits: Callable[[float], bool]) -> str:
    """The shortest text of a number that suits, at or beside one; of that, where none does, as of
    an angle that no file has told.
    """
    near = (about, math.nextafter(about, math.inf), math.nextafter(about, -math.inf))
    texts = [f"{about:.{digits}g}" for digits in range(FEWEST, MOST)]
    texts += map(repr, near)
    found = next((text for text in texts if suits(float(text))), repr(about))
    return _number(float(found))


def _text(text: str) -> str:
    """A text as YAML reads it again."""
    if PLAIN.fullmatch(text) and isinstance(scalar(text), str):
        return text
    return json.dumps(text, ensure_ascii=False)
