"""Files to start from: templates that tell every key with its unit and its default, or every
equation with its place; and the files that come along.
"""

import re
from importlib.resources import files
from pathlib import Path
from typing import Literal

from ekfsim.errors import UsageError
from ekfsim.files.looking import is_file, read_from
from ekfsim.files.packaged import packaged, resolve
from ekfsim.files.source import as_written

# how every packaged commands file says it
WORLD = re.compile(r"^world: *\S*/([\w-]+)\.yaml\b.*$", re.MULTILINE)

Kind = Literal["world", "commands", "homework", "filter", "filter-complete"]
TEXTS: dict[Kind, str] = {
    "world": "world.yaml",
    "commands": "commands.yaml",
    "homework": "homework.yaml",
    "filter": "filter.py.txt",  # no .py: this program itself does not begin so
    "filter-complete": "filter-complete.py.txt",
}


def template(kind: Kind) -> str:
    """The text of a small file of a kind, explained in comments.

    >>> template("commands").splitlines()[-1].strip().startswith("- sense:")
    True
    """
    return files("ekfsim.files").joinpath("templates", TEXTS[kind]).read_text(encoding="utf-8")


def starting_from(name: str, copy: Path) -> str:
    """The text of a packaged commands file that plays alike from where its copy is to lie: it names
    its world as one that comes along.

    Raises UsageError where nothing of this name comes along, and where beside the copy lies what
    its world would be taken for.
    """
    if name not in packaged("commands"):
        if name in packaged("worlds"):
            raise UsageError(f"{name!r} is a world; `ekfsim show {name} -o {copy}` copies it")
        resolve(name, "commands")  # tells what is nearly named so
        raise UsageError(f"{name!r} is no packaged commands file; see `ekfsim list`")
    path = packaged("commands")[name]
    text = as_written(path, str(path))
    if not (found := WORLD.findall(text)):  # its log brings one
        return text
    (world,) = found
    with read_from(copy):
        taken = is_file(copy.parent / world)
    if taken:
        raise UsageError(
            f"{copy}: beside it lies {world!r}, which would be taken for the world that the copy "
            "names; choose another folder"
        )
    return WORLD.sub(f"world: {world} # comes along; `ekfsim show {world} -o FILE` copies it", text)
