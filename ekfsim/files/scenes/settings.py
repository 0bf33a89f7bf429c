"""Single numbers that overrule a world or commands file: `noise.rangeSigmaRatio=0.02`, set once or
swept.
"""

import dataclasses
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from ekfsim.errors import InputError, Mistake, Place, UsageError
from ekfsim.files.yaml.marked import Node, Path, Scalar, field_of, scalar
from ekfsim.files.yaml.schema import Kind, keys_at, schema_at
from ekfsim.files.yaml.telling import nearest, quoted, short
from ekfsim.printable import some

OF_COMMANDS = ("gate", "guard")  # the rest belongs to the world
# filter.particles=… is a commands file's filterSettings
OF_FILTERS, FILTER_SETTINGS = "filter", "filterSettings"
OF_WORLDS = ("noise", "belief", "faults", "start", "robot", "sensors")
OFF = "off"
POSE = ("x", "y", "theta")
BELIEVED = {  # unless told apart
    "noise.": "belief.noise.",
    "start.sigma.": "belief.sigma.",
    "start.": "belief.start.",
    "robot.": "belief.robot.",
    "sensors.": "belief.sensors.",
}


@dataclass(frozen=True, slots=True)
class Setting:
    """A key of a file, by its path with dots, and the value that it is to have, as it is
    written.
    """

    key: str
    value: str
    told: str  # how a mistake in it is told: "--set gate=2", or the place in a file and the field
    place: Place | None = None  # in a file

    def __str__(self) -> str:
        return f"{self.key}={self.value}"


def setting(text: str, option: str = "--set") -> Setting:
    """The setting that KEY=VALUE means. Raises UsageError where it means none."""
    key, _, value = (part.strip() for part in text.partition("="))
    if not key or not value:
        raise UsageError(
            f"{option} {text}: this is no KEY=VALUE; write e.g. {option} noise.rangeSigmaRatio=0.02"
        )
    made = Setting(key, value, f"{option} {key}={value}")
    path_of(made)
    return made


def particles_of(number: int | None) -> tuple[Setting, ...]:
    """The setting that --particles is short for; none where it was not given."""
    return (
        ()
        if number is None
        else (Setting("filter.particles", str(number), f"--particles {number}"),)
    )


def swept(text: str, option: str = "--sweep") -> tuple[Setting, ...]:
    """The settings that KEY=V1,V2,… means. Raises UsageError where it means none."""
    key, _, values = (part.strip() for part in text.partition("="))
    if not key or not all(value.strip() for value in values.split(",")):
        right = f"write e.g. {option} noise.rangeSigmaRatio=0.01,0.02,0.05"
        raise UsageError(f"{option} {text}: this is no KEY=VALUE,VALUE,…; {right}")
    return distinct(setting(f"{key}={value}", option) for value in values.split(","))


def distinct(settings: Iterable[Setting]) -> tuple[Setting, ...]:
    """The same settings. Raises UsageError where two give one key the same value."""
    found = tuple(settings)
    if (second := repeated(found)) is not None:
        raise UsageError(f"{second.told}: the value stands twice; delete one")
    return found


def repeated(settings: Sequence[Setting]) -> Setting | None:
    """The first of some settings of one key that gives it a value which another gave before; None
    where none does.
    """
    seen = set[Scalar]()
    for one in settings:
        value = scalar(one.value)
        if value in seen:
            return one
        seen.add(value)
    return None


def filters_in(text: str, option: str = "--filter") -> tuple[str, ...]:
    """The filters that NAME,… names. Raises UsageError where one of them is none, or stands
    twice.
    """
    from ekfsim.filters import FILTERS

    names = tuple(name.strip() for name in text.split(","))
    for n, name in enumerate(names):
        if name not in FILTERS:
            near = nearest(name, list(FILTERS))
            right = f"did you mean '{near}'?" if near else f"known: {', '.join(FILTERS)}"
            raise UsageError(f"{option} {short(name)}: there is no such filter; {right}")
        if name in names[:n]:
            raise UsageError(f"{option} {text}: '{name}' stands twice; delete one")
    return names


def kind_of(one: Setting) -> Kind:
    """Which of the two files a setting overrules."""
    return "commands" if one.key in OF_COMMANDS or one.key.split(".")[0] == OF_FILTERS else "world"


def path_of(one: Setting) -> Path:
    """The path of a setting's key, its sensor by its kind. Raises UsageError where no file has such
    a key.
    """
    if fault := fault_of(one):
        raise UsageError(f"{one.told}: {'; '.join(fault)}")
    first, *rest = one.key.split(".")
    return FILTER_SETTINGS if first == OF_FILTERS else first, *rest


def fault_of(one: Setting, is_told: bool = True) -> tuple[str, str] | None:
    """Why the key of a setting is none, and, where it is told, what was meant; None where a file
    has it.
    """
    parts, kind = one.key.split("."), kind_of(one)
    path: Path = ()
    for n, part in enumerate(parts):
        known = _known(kind, path)
        if not known:
            return (
                f"'{field_of(path)}' is one value and holds no {quoted(part)}",
                f"write {field_of(path)}",
            )
        if part not in known:
            if n == 0 and part in keys_at("commands", (FILTER_SETTINGS,)):
                return f"unknown key {quoted(part)}", f"did you mean '{OF_FILTERS}.{part}'?"
            near = nearest(part, known) if is_told else ""
            if not near:
                return f"unknown key {quoted(part)}", f"known: {', '.join(known)}"
            whole = ".".join([*parts[:n], near, *parts[n + 1 :]])
            sound = fault_of(dataclasses.replace(one, key=whole)) is None
            meant = whole if sound else ".".join([*parts[:n], near])
            return f"unknown key {quoted(part)}", f"did you mean '{meant}'?"
        path = (*path, part)
    if known := _known(kind, path):
        name = ", and name the filter itself by --filter" if path == (OF_FILTERS,) else ""
        return f"'{one.key}' is no single value", f"write e.g. {one.key}.{known[0]}{name}"
    if schema_at(kind, _indexed(path, 0)).get("type") == "array":
        return f"'{one.key}' is a list", "only single values can be set, e.g. noise.rangeSigmaRatio"
    return None


def overruled(root: Node, kind: Kind, settings: Iterable[Setting]) -> Node:
    """A file's tree with what the settings of its kind say; the tree itself stays as it is."""
    for one in settings:
        if kind_of(one) == kind:
            root = _overruled(root, one)
    return root


def pinned(root: Node, settings: Sequence[Setting]) -> Iterator[str]:
    """Warnings of settings that change the truth alone, for the file tells the filter a number of
    its own.
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
    """The same settings where a run was recorded: there, what is said of the robot can mean the
    filter alone.
    """
    keys = {one.key for one in settings}

    def believed(one: Setting) -> Setting:
        as_told = dataclasses.replace(one, key=f"belief.{one.key}")
        apart = (
            one.key.startswith(("robot.", "sensors."))
            and as_told.key not in keys
            and fault_of(as_told) is None
        )
        return as_told if apart else one

    return tuple(map(believed, settings))


def idle_on_log(settings: Iterable[Setting]) -> Iterator[str]:
    """Warnings of settings that change nothing where a run was recorded."""
    for one in settings:
        if one.key.startswith("faults."):
            yield f"{one.told}: nothing changes: a recorded log holds its own faults"


def _overruled(root: Node, one: Setting) -> Node:
    path = path_of(one)
    if path[0] == "sensors":
        root, index = _with_sensor(root, str(path[1]), one)
        path = _indexed(path, index)
    if path == ("gate",) and one.value == OFF:
        return _without(root, "gate")
    if path[:2] == ("belief", "start") and root.at(("belief", "start")) is None:
        for axis in POSE:
            if (told := root.at(("start", axis))) is not None:
                root = _put(root, ("belief", "start", axis), told)
    return _put(root, path, Node(root.nearest(path).mark, scalar(one.value), one.value))


def _with_sensor(root: Node, kind: str, one: Setting) -> tuple[Node, int]:
    """The tree with the sensors of its system written out where it has none, and which of them is
    of a kind.
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
    kinds = [key for item in items for key in item.keys]
    if kind not in kinds:
        raise UsageError(
            f"{one.told}: the world has no sensor '{kind}'; it has: {some(kinds) or 'none'}"
        )
    if kinds.count(kind) > 1:
        raise UsageError(
            f"{one.told}: the world has more than one sensor '{kind}'; write the number into its "
            f"file"
        )
    return root, kinds.index(kind)


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
    """How mistakes that only the settings brought about are told: each by the settings that it is
    about.
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


def remark(warning: Mistake, settings: Sequence[Setting]) -> str:
    """How a warning is told: at its place in the file, or by the setting that it is about."""
    told = next((one.told for one in settings if _about(warning.field, one)), None)
    return str(warning) if told is None else f"{told}: {warning.wrong}; {warning.right}"


def _about(field: str, one: Setting) -> bool:
    path = path_of(one)
    told = "sensors[" if path[0] == "sensors" else field_of(path)
    return bool(field) and (field == told or field.startswith(told) or told.startswith(f"{field}."))


def _known(kind: Kind, path: Path) -> list[str]:
    """The keys that stand under a path, as settings name them; of a sensor by its kind."""
    if not path:
        return [*OF_WORLDS, *OF_COMMANDS, OF_FILTERS]
    return list(keys_at(kind, ("sensors", 0) if path == ("sensors",) else _indexed(path, 0)))


def _indexed(path: Path, index: int) -> Path:
    """The path in a file: of a sensor by its number in the list, of a filter's settings by their
    own key.
    """
    if path[0] == OF_FILTERS:
        return FILTER_SETTINGS, *path[1:]
    return (path[0], index, *path[1:]) if path[0] == "sensors" and len(path) > 1 else path
