"""Single numbers that overrule a world or commands file:
`noise.rangeSigmaRatio=0.02`, set once or swept.
"""

import dataclasses
import os
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from ekfsim.errors import Place, UsageError
from ekfsim.files.yaml.marked import Path as Route
from ekfsim.files.yaml.marked import Scalar, field_of, scalar
from ekfsim.files.yaml.schema import Kind, keys_at, schema_at
from ekfsim.files.yaml.telling import nearest, quoted, short
from ekfsim.filters import FILTERS
from ekfsim.filters.place import absolute, forward, is_place, label, stem

OF_COMMANDS = ("gate", "guard")  # the rest belongs to the world
# filter.particles=… is a commands file's filterSettings
OF_FILTERS, FILTER_SETTINGS = "filter", "filterSettings"
OF_LOGS = "recording"  # recording.timeUnit=…
SENSORS = ("sensors",), ("belief", "sensors"), ("faults", "sensors")  # each by its name
OF_WORLDS = ("noise", "belief", "faults", "start", "robot", "sensors")


@dataclass(frozen=True, slots=True)
class Setting:
    """A key of a file, by its path with dots,
    and the value that it is to have, as it is written.
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
        named = option in ("--a", "--b") and (is_place(key) or key in FILTERS)
        right = f"filter={key}" if named else "noise.rangeSigmaRatio=0.02"
        raise UsageError(f"{option} {text}: this is no KEY=VALUE; write e.g. {option} {right}")
    made = Setting(key, value, f"{option} {key}={value}")
    path_of(made)
    return made


def numbers_of(particles: int | None, hypotheses: int | None) -> tuple[Setting, ...]:
    """What --particles and --hypotheses are short for; none where they were not given."""
    given = {"particles": particles, "hypotheses": hypotheses}
    return tuple(
        Setting(f"filter.{key}", str(number), f"--{key} {number}")
        for key, number in given.items()
        if number is not None
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
    """The first of some settings of one key that gives it a value which another gave before;
    None where none does.
    """
    seen = set[Scalar]()
    for one in settings:
        value = scalar(one.value)
        if value in seen:
            return one
        seen.add(value)
    return None


def filters_in(text: str, option: str = "--filter", brought: Sequence[str] = ()) -> tuple[str, ...]:
    """The filters that NAME,… names, each a built-in name or the absolute place of one's own.
    brought : names of those that were made of functions here

    Raises UsageError where one of them is none, or stands twice; FaultError where the code of one
    fails.
    """
    names = tuple(filter_in(name.strip(), option, brought) for name in text.split(","))
    for n, name in enumerate(names):
        if name in names[:n]:
            raise UsageError(f"{option} {text}: '{label(name)}' stands twice; delete one")
        if stem(name) in map(stem, names[:n]):
            right = "give one of the files another name"
            raise UsageError(f"{option} {text}: two filters are called {label(name)}; {right}")
    return names


def filter_in(name: str, option: str, brought: Sequence[str] = ()) -> str:
    """The filter that a name or a place means. Raises UsageError where it means none."""
    from ekfsim.filters import FILTERS
    from ekfsim.filters.choice import registered, verify

    if forward(name) in FILTERS:
        return name
    known = [*FILTERS, *registered(), *brought]
    if is_place(name) or forward(name) in known:
        name = absolute(name)
        verify(name)
        return name
    if os.path.isdir(name):
        raise UsageError(f"{option} {short(name)}: is a folder; name a file in it: FILE.py")
    near = f"{name}.py" if os.path.isfile(f"{name}.py") else nearest(name, known)
    right = f"known: {', '.join(known)}, or one of your own: FILE.py"
    if near:
        right = f"did you mean '{near}'?"
    raise UsageError(f"{option} {short(name)}: there is no such filter; {right}")


def kind_of(one: Setting) -> Kind:
    """Which of the two files a setting overrules."""
    own = one.key in OF_COMMANDS or one.key.split(".")[0] in (OF_FILTERS, OF_LOGS)
    return "commands" if own else "world"


def path_of(one: Setting) -> Route:
    """The path of a setting's key, its sensor by its kind.
    Raises UsageError where no file has such a key.
    """
    if fault := fault_of(one):
        raise UsageError(f"{one.told}: {'; '.join(fault)}")
    first, *rest = one.key.split(".")
    return FILTER_SETTINGS if first == OF_FILTERS else first, *rest


def fault_of(one: Setting, is_told: bool = True) -> tuple[str, str] | None:
    """Why the key of a setting is none,
    and, where it is told, what was meant; None where a file has it.
    """
    parts, kind = one.key.split("."), kind_of(one)
    path: Route = ()
    for n, part in enumerate(parts):
        known = _known(kind, path)
        if not known:
            return (
                f"'{field_of(path)}' is one value and holds no {quoted(part)}",
                f"write {field_of(path)}",
            )
        if part not in known:
            if _names_a_sensor(one, n, known):
                return None
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
    found = schema_at(kind, indexed(path, 0))
    if any(choice.get("type") == "string" for choice in found.get("oneOf", ())):
        return None  # a word or more, as the topic of a bag
    if known := _known(kind, path):
        name = ", and name the filter itself by --filter" if path == (OF_FILTERS,) else ""
        return f"'{one.key}' is no single value", f"write e.g. {one.key}.{known[0]}{name}"
    if found.get("type") == "array":
        return f"'{one.key}' is a list", "only single values can be set, e.g. noise.rangeSigmaRatio"
    return None


def _names_a_sensor(one: Setting, n: int, kinds: list[str]) -> bool:
    """Whether the part n of a setting's key can be the name of a sensor, known where its world is:
    some kind has the keys that follow.
    """
    parts = one.key.split(".")
    if tuple(parts[:n]) not in SENSORS or n + 1 == len(parts):
        return False
    keys = (".".join([*parts[:n], kind, *parts[n + 1 :]]) for kind in kinds)
    return any(fault_of(dataclasses.replace(one, key=key), is_told=False) is None for key in keys)


def _known(kind: Kind, path: Route) -> list[str]:
    """The keys that stand under a path, as settings name them; of a sensor by its kind."""
    if not path:
        return [*OF_WORLDS, *OF_COMMANDS, OF_FILTERS, OF_LOGS]
    return list(keys_at(kind, ("sensors", 0) if path == ("sensors",) else indexed(path, 0)))


def indexed(path: Route, index: int) -> Route:
    """The path in a file: of a sensor by its number in the list,
    of a filter's settings by their own key.
    """
    if path[0] == OF_FILTERS:
        return FILTER_SETTINGS, *path[1:]
    return (path[0], index, *path[1:]) if path[0] == "sensors" and len(path) > 1 else path
