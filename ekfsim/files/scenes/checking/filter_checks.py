"""What of a filter no single key can tell: whether it reads its settings, whether they fit the
world; and whether its code lies where a file names it. Nothing of that code is run here.
"""

import os
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path

from ekfsim.errors import Mistake, UsageError
from ekfsim.files.keys.commands import CommandsKeys
from ekfsim.files.keys.fields import aliases
from ekfsim.files.keys.filters import TuningKeys
from ekfsim.files.looking import is_file as is_there
from ekfsim.files.looking import read_from
from ekfsim.files.scenes.checking.sound import Sound
from ekfsim.files.scenes.settings import FILTER_SETTINGS, Setting, path_of
from ekfsim.filters import FILTERS
from ekfsim.filters.place import absolute, is_file, label, parts, stem
from ekfsim.filters.tuning import reads
from ekfsim.printable import quoted
from ekfsim.world import World

NUMBER = {key: name for name, key in aliases(TuningKeys).items()}  # the program's name of each key
OF_THE_CLASSROOM = ("rangeVariance", "crossCovariances")


def check_filter_settings(file: Sound, keys: CommandsKeys, world: World) -> Iterator[Mistake]:
    """Settings of a filter that do not fit the world."""
    told = file.root.at((FILTER_SETTINGS,))
    for key in told.keys if told else ():
        if key in OF_THE_CLASSROOM and world.robot is not None:
            right = f"delete it: this is the system '{world.system}'"
            yield file.mistake(
                (FILTER_SETTINGS, key), f"'{key}' belongs to the classroom's filter", right
            )
    settings, n = keys.filter_settings, len(world.layout.names)
    if settings is not None and settings.kappa is not None and settings.kappa <= -n:
        wrong = f"{settings.kappa:g} leaves no sigma points, for the state has {n} numbers"
        yield file.mistake((FILTER_SETTINGS, "kappa"), wrong, f"write more than {-n}")


def filter_warnings(file: Sound, keys: CommandsKeys) -> Iterator[str]:
    """Settings that the file's own filter does not read.
    It is no mistake: the command line may name another.
    """
    told = file.root.at((FILTER_SETTINGS,))
    for key in told.keys if told else ():
        if not reads(keys.filter, NUMBER[key]):
            right = f"{who_reads(key)} would read it"
            yield str(
                file.mistake(
                    (FILTER_SETTINGS, key), f"the filter '{keys.filter}' has no {key}", right
                )
            )


def who_reads(key: str) -> str:
    """The filters that read a key."""
    return " or ".join(name for name in FILTERS if reads(name, NUMBER[key]))


def unread(settings: Iterable[Setting], names: Sequence[str]) -> list[Setting]:
    """The settings of a filter that none of those who watch reads."""
    of_filters = [one for one in settings if path_of(one)[0] == FILTER_SETTINGS]
    return [
        one
        for one in of_filters
        if not any(reads(name, NUMBER[str(path_of(one)[1])]) for name in names)
    ]


def refuse_unread(
    settings: Iterable[Setting], names: Sequence[str], option: str = "--filter"
) -> None:
    """Raises UsageError where a setting would change nothing,
    for no filter that watches reads it.
    """
    lines = []
    for one in unread(settings, names):
        key = str(path_of(one)[1])
        wrong = f"no filter here ({', '.join(map(label, names))}) reads it"
        lines.append(f"{one.told}: {wrong}; name one that does: {option} {who_reads(key)}")
    if lines:
        raise UsageError(*lines)


def filter_beside(file: str | Path, named: str) -> str:
    """The filter that a file names: a built-in one, or the place of another."""
    if not is_file(named):
        return named
    return absolute(os.path.join(os.path.dirname(file), os.path.expanduser(named)))


def missing(file: str | Path, named: str) -> tuple[str, str] | None:
    """What is wrong with the place of a filter that a file names, and what would be right; None
    where a file is there.
    """
    place = filter_beside(file, named)
    if not is_file(place):
        return None
    path, _ = parts(place)
    try:
        with read_from(quoted(named)):
            if is_there(Path(path)):
                return None
    except UsageError as refusal:
        return str(refusal), "name a file that can be read"
    return f"{quoted(named)}: there is no such file", "write its path relative to this file"


def alike(filters: Sequence[str]) -> Iterator[tuple[str, str] | None]:
    """Of each filter, whether it cannot be told from one before it: what is wrong, and what would
    be right; None where it can.
    """
    for n, one in enumerate(filters):
        if one in filters[:n]:
            yield f"{quoted(label(one))} stands twice", "delete one"
        elif stem(one) in map(stem, filters[:n]):
            yield f"two filters are called {label(one)}", "give one of the files another name"
        else:
            yield None
