"""A world or a scene with other numbers, which mean what `--set` means on the command line."""

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace

import numpy as np
from pydantic import ValidationError

from ekfsim.errors import UsageError
from ekfsim.files.given.given import Given
from ekfsim.files.given.tree import NOWHERE, written
from ekfsim.files.keys.commands import CommandsKeys
from ekfsim.files.scenes.checking.filter_checks import check_filter_settings, refuse_unread
from ekfsim.files.scenes.checking.sound import Sound
from ekfsim.files.scenes.load import overruled
from ekfsim.files.scenes.logged import LogGiven, read_into
from ekfsim.files.scenes.overruling import idle_on_log, of_log, refusal
from ekfsim.files.scenes.overruling import overruled as with_settings
from ekfsim.files.scenes.settings import (
    OF_COMMANDS,
    OF_FILTERS,
    OF_WORLDS,
    Setting,
    filters_in,
    kind_of,
    path_of,
)
from ekfsim.files.yaml.marked import Node
from ekfsim.files.yaml.telling import nearest, tell
from ekfsim.filters.choice import brought
from ekfsim.printable import quoted
from ekfsim.scene import Scene
from ekfsim.world import World

SEED, RUN = "seed", "run"
MOST_RUN = 2**63 - 1
OWN = (SEED, RUN, OF_FILTERS)  # of a scene, and nothing that --set sets
KNOWN = (*OF_WORLDS, *OF_COMMANDS, *OWN)


def changed_world(world: World, pairs: Sequence[object], more: Mapping[str, object]) -> World:
    """The same world with other numbers. Raises UsageError or InputError where one is wrong."""
    settings = [_setting(key, value) for key, value in _asked(pairs, more).items()]
    for one in settings:
        if path_of(one) and kind_of(one) != "world":
            raise UsageError(f"{one.told}: a world has no '{one.key}'; a scene has")
    changed, remarks = _with(world, settings)
    for remark in remarks:
        warnings.warn(remark, stacklevel=3)
    return changed


def changed_scene(scene: Scene, pairs: Sequence[object], more: Mapping[str, object]) -> Scene:
    """The same scene with other numbers, its log read again for the robot as it then is told.

    Raises UsageError or InputError where a key or a value is wrong.
    """
    scene, remarks = scene_with(scene, _asked(pairs, more))
    for remark in remarks:
        warnings.warn(remark, stacklevel=3)
    return scene


def scene_with(scene: Scene, asked: Mapping[str, object]) -> tuple[Scene, list[str]]:
    """The same, and what is to be said of it."""
    settings = settings_of(asked)
    if OF_FILTERS in asked:
        first, *others = filters_in(_names(asked[OF_FILTERS]), OF_FILTERS, brought())
        scene = replace(scene, filter=first, beside=tuple(others))
    if SEED in asked:
        scene = replace(scene, seed=_seed(asked[SEED]))
    if RUN in asked:
        scene = replace(scene, run=_run(asked[RUN]))
    refuse_unread(settings, (scene.filter, *scene.beside), OF_FILTERS)
    scene, remarks = _with_own(scene, settings), list[str]()
    if of_world := [one for one in settings if kind_of(one) == "world"]:
        scene, remarks = _in_other_world(scene, of_world)
    keys = {one.key for one in settings}
    kept = (told for told in scene.settings if told.partition("=")[0] not in keys)
    new = (str(one) for one in settings if one.key not in OF_COMMANDS)
    return replace(scene, settings=(*kept, *new)), remarks


def settings_of(asked: Mapping[str, object]) -> list[Setting]:
    """What of it `--set` would set. Raises UsageError where no file has such a key."""
    settings = [_setting(key, value) for key, value in asked.items() if key not in OWN]
    for one in settings:
        path_of(one)
    return settings


def _asked(pairs: Sequence[object], more: Mapping[str, object]) -> dict[str, object]:
    """Keys and their values. Raises UsageError where a key has none, or is given twice."""
    if len(pairs) % 2 or not all(isinstance(key, str) for key in pairs[::2]):
        raise UsageError(
            "with_ takes a key and its value, one after the other: "
            "with_('noise.rangeSigmaRatio', 0.1, 'gate', 0.99)"
        )
    found = dict[str, object]()
    for key, value in [*zip(map(str, pairs[::2]), pairs[1::2], strict=True), *more.items()]:
        if key in found:
            raise UsageError(f"{key}: it is set twice; keep one of them")
        if "." not in key and key not in KNOWN and (near := nearest(key, list(KNOWN))):
            raise UsageError(f"{key}: unknown key {quoted(key)}; did you mean {near!r}?")
        found[key] = value
    return found


def _setting(key: str, value: object) -> Setting:
    """The setting of a key. Raises UsageError where the value is no single one."""
    if isinstance(value, np.generic | np.ndarray) and np.ndim(value) == 0:
        value = value.item()
    if value is None and key == "gate":
        value = "off"
    if not isinstance(value, str | bool | int | float):
        what = quoted(type(value).__name__)
        raise UsageError(f"{key}: {what} is no single value; write e.g. with_({key!r}, 0.1)")
    return Setting(key, written(value), f"{key}={written(value)}")


def _names(value: object) -> str:
    if isinstance(value, str):
        return value
    if isinstance(value, list | tuple) and value and all(isinstance(one, str) for one in value):
        return ",".join(value)
    raise UsageError(f"filter: {quoted(str(value))} is no name of a filter; write e.g. 'ukf'")


def _run(value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int | np.integer):
        raise UsageError(f"run={value}: it is no whole number; write e.g. 3")
    if not 0 <= value <= MOST_RUN:
        raise UsageError(f"run={value}: runs are numbered from 0 to {MOST_RUN}")
    return int(value)


def _seed(value: object) -> int:
    one = _setting(SEED, value)
    plain = value.item() if isinstance(value, np.integer) else value
    try:
        return CommandsKeys.model_validate({"commands": [], SEED: plain}).seed
    except ValidationError as error:
        assert isinstance(plain, str | bool | int | float)
        held = {SEED: Node(NOWHERE, plain, one.value)}
        (mistake,) = tell(error, "commands", Node(NOWHERE, held, keys={SEED: NOWHERE}), "")
    raise UsageError(f"{one.told}: {mistake.wrong}; {mistake.right}")


def _with_own(scene: Scene, settings: Sequence[Setting]) -> Scene:
    """A scene with what a commands file may set: gate, guard and the filter's numbers."""
    own = [one for one in settings if kind_of(one) == "commands"]
    held = {"world": Node(NOWHERE, "world"), "commands": Node(NOWHERE, [])}
    root = Node(NOWHERE, held, keys=dict.fromkeys(held, NOWHERE))
    root = with_settings(root, "commands", own)
    try:
        keys = CommandsKeys.model_validate(root.plain())
    except ValidationError as error:
        raise refusal(tell(error, "commands", root, ""), own) from None
    if wrong := list(check_filter_settings(Sound("", root, set()), keys, scene.world)):
        raise refusal(wrong, own)
    tuned = keys.filter_settings.model_dump(exclude_unset=True) if keys.filter_settings else {}
    asked = {one.key for one in own}
    changed = {name: getattr(keys, name) for name in OF_COMMANDS if name in asked}
    return replace(scene, **changed, tuning=replace(scene.tuning, **tuned))


def _in_other_world(scene: Scene, settings: Sequence[Setting]) -> tuple[Scene, list[str]]:
    """A scene in its world with other numbers, and what is to be said of that; a log is read again,
    for it is read as the robot is told.
    """
    log = scene.log
    meant = settings if log is None else of_log(settings)
    world, remarks = _with(scene.world, meant, log is not None)
    scene = replace(scene, world=world)
    if log is None:
        return scene, remarks
    if not isinstance(log.given, LogGiven):
        wrong = "the log was not read, but put together by `replace`; use with_ before"
        raise UsageError(f"{settings[0].told}: {wrong}")
    return read_into(scene, *log.given, []), [*remarks, *idle_on_log(settings)]


def _with(
    world: World, settings: Sequence[Setting], logged: bool = False
) -> tuple[World, list[str]]:
    found = overruled(world, settings, logged)
    if found.mistakes:
        raise refusal(found.mistakes, settings)
    return found.get(), [told for told in found.warnings if not _of_before(told, world, settings)]


def _of_before(told: str, world: World, settings: Sequence[Setting]) -> bool:
    """Whether a warning is of a number that was set before, and told then."""
    before = world.given.settings if isinstance(world.given, Given) else ()
    keys = {one.key for one in before} - {one.key for one in settings}
    return any(told.startswith(f"{key}: ") for key in keys)
