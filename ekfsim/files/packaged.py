"""The worlds and commands that come with ekfsim, and how outputs name files."""

import os
import re
from pathlib import Path
from typing import Literal, NamedTuple

from ekfsim.errors import EkfsimError, UsageError
from ekfsim.files.looking import exists, is_file, is_folder
from ekfsim.printable import in_a_line

Folder = Literal["worlds", "commands"]
PACKAGE = Path(__file__).resolve().parent.parent


def folder(kind: Folder) -> Path:
    """Where the packaged files of a kind lie:
    inside the installed package, or beside it in a checkout.
    """
    installed = PACKAGE / "_packaged" / kind
    return installed if installed.is_dir() else PACKAGE.parent / kind


def packaged(kind: Folder) -> dict[str, Path]:
    """The packaged files of a kind by their bare names, in alphabetical order."""
    return {path.stem: path for path in sorted(folder(kind).glob("*.yaml"))}


def kind_of(name: str) -> Folder:
    """What a name stands for where nobody says it: a world if only a world is called so."""
    return "worlds" if name in packaged("worlds").keys() - packaged("commands") else "commands"


def resolve(name_or_path: str | Path, kind: Folder) -> Path:
    """The file that a path, or the bare name of a packaged file, stands for. A file that exists
    wins over a name.

    Raises UsageError where it is neither, and where it is a filter.
    """
    path = Path(name_or_path)
    if path.suffix == ".py":
        what = "a world is" if kind == "worlds" else "commands are"
        raise UsageError(f"{path}: {what} asked for here; a filter is named after --filter")
    known = packaged(kind)
    name = os.fspath(name_or_path)
    try:
        # `render tour -o tour` made that folder
        there = exists(path) and not (name in known and is_folder(path))
    except (OSError, ValueError):
        there = name not in known  # as something that cannot be read, which its reader tells
    if there or name not in known:
        is_bare = not path.suffix and path.name == name and name.isprintable()
        if not there and is_bare:
            import difflib

            near = difflib.get_close_matches(name.lower(), known, 3, 0.7)
            right = (
                f"did you mean {' or '.join(map(repr, near))}?"
                if near
                else "see `ekfsim list`, or name a file"
            )
            raise UsageError(f"{name!r} is neither a file nor one of the packaged {kind}; {right}")
        return path
    return known[name]


START = "tour", "square", "theta"  # in the order to look at them
LOGS = "logs"
GROUPS = (  # of the other commands that come along: what their names begin or end with
    ("proofs", "proofs: each shows one thing", re.compile("proof-.*")),
    (
        "divergence",
        "divergence: how a filter gets lost, and why",
        re.compile("diverge-.*|kidnap|unknown-start"),
    ),
    ("systems", "other systems", re.compile("(?!(log|bag)$).*(?<!_log)")),
    (LOGS, "recorded logs, by --log", re.compile("(.*_)?log|bag")),
)


class Group(NamedTuple):
    """Packaged commands that serve one purpose."""

    name: str  # by which it is asked for
    title: str
    files: dict[str, Path]  # by their bare names


def grouped() -> list[Group]:
    """The packaged commands in groups, those to begin with first."""
    left = packaged("commands")
    groups = [Group("start", "start here", {name: left.pop(name) for name in START})]
    for name, title, pattern in GROUPS:
        chosen = [each for each in left if pattern.fullmatch(each)]
        groups.append(Group(name, title, {each: left.pop(each) for each in chosen}))
    return groups


def world_beside(path: Path, named: str) -> Path:
    """The world that a commands file names:
    a file relative to it, else one that comes along, by its bare name.
    """
    near = path.parent / named
    known = packaged("worlds")
    try:
        is_there = named not in known or is_file(near)
    except OSError:
        is_there = False
    return near if is_there else known[named]


def world_of(path: Path) -> Path:
    """The world that a commands file names, whatever else may be wrong with it.

    Raises UsageError where there is no such file to read, or where it names no world.
    """
    if not (named := said_first(path, "world")):
        raise UsageError(f"{path}: names no world; see `ekfsim new` for a file that does")
    return world_beside(path, named)


def is_packaged(path: str | Path) -> bool:
    """Whether a file is one of those that come along."""
    here = Path(os.path.realpath(path)).parent
    return any(here == folder(kind).resolve() for kind in ("worlds", "commands"))


def source_name(path: str | Path) -> str:
    """How outputs name a file, in a line:
    a packaged one alike on every machine, any other as it was given.
    """
    given = in_a_line(os.path.normpath(path))
    here = Path(os.path.realpath(path))
    for kind in ("worlds", "commands"):
        if here.parent == folder(kind).resolve():
            return f"{kind}/{here.name}"
    return given


def description_of(path: Path) -> str:
    """The first line of a file's description, "" where it has none or cannot be read."""
    try:
        return described(path).partition("\n")[0]
    except EkfsimError:
        return ""


def described(path: Path) -> str:
    """A file's description, "" where it has none.

    Raises UsageError where there is no such file to read.
    """
    return said_first(path, "description").strip()


def said_first(path: Path, key: str) -> str:
    """The text of a key at the head of a file, "" where it has none. Reads no further than that.

    Raises UsageError where there is no such file to read.
    """
    import yaml

    from ekfsim.files.source import as_written
    from ekfsim.files.yaml.parsing import LOADER, Tree

    tree, text = Tree(str(path)), None
    try:
        for event in yaml.parse(as_written(path, str(path)), Loader=LOADER):
            tree.take(event)
            if tree.open and (told := tree.open[0].node.get(key)):
                text = told.value
                break
    except yaml.YAMLError:
        return ""
    return text if isinstance(text, str) else ""
