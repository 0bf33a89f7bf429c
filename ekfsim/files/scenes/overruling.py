"""What settings make of a file's tree; how mistakes and warnings that they bring about are told."""

import dataclasses
from collections.abc import Iterable, Iterator, Sequence

from ekfsim.errors import InputError, Mistake, UsageError
from ekfsim.files.scenes.settings import Setting, fault_of, indexed, kind_of, path_of
from ekfsim.files.yaml.marked import Node, field_of, scalar
from ekfsim.files.yaml.schema import Kind
from ekfsim.files.yaml.telling import nearest, quoted, short
from ekfsim.printable import some

OFF = "off"
BELIEVED = {  # unless told apart
    "noise.": "belief.noise.",
    "start.sigma.": "belief.sigma.",
    "start.": "belief.start.",
    "robot.": "belief.robot.",
    "sensors.": "belief.sensors.",
}
OF_FILTER = ("start.sigma.", "start.", "robot.", "sensors.")  # what on a log means the filter alone


def overruled(root: Node, kind: Kind, settings: Iterable[Setting]) -> Node:
    """A file's tree with what the settings of its kind say; the tree itself stays as it is."""
    for one in settings:
        if kind_of(one) == kind:
            root = _overruled(root, one)
    return root


def pinned(root: Node, settings: Sequence[Setting]) -> Iterator[str]:
    """Warnings of settings that change the truth alone,
    for the file tells the filter a number of its own.
    """
    keys = {one.key for one in settings}
    for one in settings:
        start = next((start for start in BELIEVED if one.key.startswith(start)), None)
        belief = "" if start is None else BELIEVED[start] + one.key.removeprefix(start)
        if (
            belief
            and belief not in keys
            and (held := root.at(tuple(belief.split(".")))) is not None
        ):
            wrong = f"only the truth changes, the filter goes on believing {short(held.written)}"
            yield f"{one.key}: {wrong}: the world file has '{belief}'; set that as well"


def of_log(settings: Sequence[Setting]) -> tuple[Setting, ...]:
    """The same settings where a run was recorded:
    there, what is said of the robot and its start can mean the filter alone.
    """
    keys = {one.key for one in settings}

    def believed(one: Setting) -> Setting:
        begun = next((begun for begun in OF_FILTER if one.key.startswith(begun)), None)
        if begun is None:
            return one
        as_told = dataclasses.replace(one, key=BELIEVED[begun] + one.key.removeprefix(begun))
        return as_told if as_told.key not in keys and fault_of(as_told) is None else one

    return tuple(map(believed, settings))


def idle_on_log(settings: Iterable[Setting]) -> Iterator[str]:
    """Warnings of settings that change nothing where a run was recorded."""
    for one in settings:
        if one.key.startswith("faults."):
            yield f"{one.told}: nothing changes: a recorded log holds its own faults"


def _overruled(root: Node, one: Setting) -> Node:
    path = path_of(one)
    if path[0] == "sensors":
        root, index, kind = _with_sensor(root, str(path[1]), one)
        path = indexed((path[0], kind, *path[2:]), index)
    if path == ("gate",) and one.value == OFF:
        return _without(root, "gate")
    return _put(root, path, Node(root.nearest(path).mark, scalar(one.value), one.value))


def _with_sensor(root: Node, name: str, one: Setting) -> tuple[Node, int, str]:
    """The tree with the sensors of its system written out where it has none,
    which of them has a name, and its kind.
    """
    from ekfsim.systems import SYSTEMS

    if root.at(("sensors",)) is None:
        system = root.at(("system",))
        known = SYSTEMS.get(str(system.value)) if system else None
        names = [instrument.name for instrument in known.instruments] if known else []
        items = [_mapping(root, {name: _mapping(root, {})}) for name in names]
        root = _put(root, ("sensors",), Node(root.mark, items)) if known else root
    sensors = root.at(("sensors",))
    items = sensors.value if sensors and isinstance(sensors.value, list) else []
    kinds = [next(iter(item.keys), "") for item in items]
    called = [_name_of(item, kind) for item, kind in zip(items, kinds, strict=True)]
    if name not in called:
        near = nearest(name, called)
        right = f"did you mean '{near}'?" if near else f"it has: {some(called) or 'none'}"
        raise UsageError(f"{one.told}: the world has no sensor {quoted(name)}; {right}")
    if called.count(name) > 1:
        raise UsageError(
            f"{one.told}: the world has more than one sensor '{name}'; give each a name in its file"
        )
    index = called.index(name)
    return root, index, kinds[index]


def _name_of(item: Node, kind: str) -> str:
    """What a sensor of a file is called: its name, or its kind where it has none."""
    name = item.at((kind, "name"))
    return kind if name is None else name.written


def _put(node: Node, path: Sequence[str | int], value: Node) -> Node:
    """A tree with a value at a path; mappings on the way there are made where they are missing."""
    if not path:
        return value
    part, rest = path[0], path[1:]
    inner = node.get(part) or _mapping(node, {})
    if isinstance(part, int):
        assert isinstance(node.value, list)
        items = [*node.value[:part], _put(inner, rest, value), *node.value[part + 1 :]]
        return dataclasses.replace(node, value=items)
    held = node.value if isinstance(node.value, dict) else {}
    keys = node.keys if part in node.keys else {**node.keys, part: node.mark}
    return dataclasses.replace(node, value={**held, part: _put(inner, rest, value)}, keys=keys)


def _without(node: Node, key: str) -> Node:
    assert isinstance(node.value, dict)
    held = {name: value for name, value in node.value.items() if name != key}
    return dataclasses.replace(
        node, value=held, keys={name: mark for name, mark in node.keys.items() if name != key}
    )


def _mapping(beside: Node, held: dict[str, Node]) -> Node:
    return Node(beside.mark, held, keys=dict.fromkeys(held, beside.mark))


def refusal(mistakes: Iterable[Mistake], settings: Sequence[Setting]) -> UsageError:
    """How mistakes that only the settings brought about are told:
    each by the settings that it is about.
    """
    lines, placed = dict[str, None](), dict[Mistake, None]()
    for mistake in mistakes:
        about = [one for one in settings if _about(mistake.field, one)] or settings
        first, right = about[0], f"; {mistake.right}" if mistake.right else ""
        lines[f"{', '.join(one.told for one in about)}: {mistake.wrong}{right}"] = None
        if first.place is not None:
            field = first.told.removeprefix(f"{first.place}: ")
            placed[Mistake(first.place, field, mistake.wrong, mistake.right)] = None
    return InputError(list(placed)) if len(placed) == len(lines) else UsageError(*lines)


def is_about(mistake: Mistake, settings: Sequence[Setting]) -> bool:
    """Whether a mistake is of a key that one of the settings sets."""
    return any(_about(mistake.field, one) for one in settings)


def remark(warning: Mistake, settings: Sequence[Setting]) -> str:
    """How a warning is told: at its place in the file, or by the setting that it is about."""
    told = next((one.told for one in settings if _about(warning.field, one)), None)
    return str(warning) if told is None else f"{told}: {warning.wrong}; {warning.right}"


def _about(field: str, one: Setting) -> bool:
    path = path_of(one)
    told = "sensors[" if path[0] == "sensors" else field_of(path)
    return bool(field) and (field == told or field.startswith(told) or told.startswith(f"{field}."))
