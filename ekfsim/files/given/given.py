"""What scenes and worlds are read from: the text of a file, or values of Python."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Self

from ekfsim.errors import Mistake
from ekfsim.files.given.tree import tree_of
from ekfsim.files.packaged import is_packaged, source_name
from ekfsim.files.scenes.settings import Setting
from ekfsim.files.source import as_written, readable
from ekfsim.files.yaml.marked import Node
from ekfsim.files.yaml.parsing import parse
from ekfsim.world import World

TEXT, VALUES = "text", "dict"  # how messages name what has no file
FIRST_KEY = re.compile(r"\s*(\{|[A-Za-z]\w*\s*:(\s|$))")  # which no name of a file begins with


@dataclass(frozen=True)
class Given:
    """What is read, and how messages name it."""

    shown: str
    held: str | Node  # the text, or the tree of values
    mistakes: tuple[Mistake, ...] = ()  # in the values
    is_file: bool = False
    settings: tuple[Setting, ...] = ()  # what overrules it
    made: bool = False  # by the program, of what a log holds

    @classmethod
    def file(cls, path: Path, shown: str) -> Self:
        """The text of a file. Raises UsageError where there is none, InputError where it holds no
        text.
        """
        return cls(shown, as_written(path, shown), is_file=True)

    @classmethod
    def text(cls, text: str) -> Self:
        """A text that was handed over. Raises InputError where no file may hold it."""
        return cls(TEXT, readable(text, TEXT))

    @classmethod
    def made_for(cls, values: object, log: str) -> Self:
        """A world that the program makes, where nobody names one."""
        return replace(cls.values(values, log), made=True)

    @classmethod
    def values(cls, values: object, shown: str = VALUES) -> Self:
        """Dicts, lists, numbers and texts; arrays, too."""
        mistakes = list[Mistake]()
        return cls(shown, tree_of(values, shown, mistakes), tuple(mistakes))

    def tree(self) -> tuple[Node, list[Mistake]]:
        """Its tree, and the mistakes that leave one. Raises InputError where none is left."""
        if isinstance(self.held, str):
            return parse(self.held, self.shown)
        return self.held, list(self.mistakes)

    def overruled(self, settings: tuple[Setting, ...]) -> Self:
        """The same with more settings, which win over those of one key that were there before."""
        keys = {one.key for one in settings}
        kept = (one for one in self.settings if one.key not in keys)
        return replace(self, settings=(*kept, *settings))


def given_in(what: object) -> Given | None:
    """What a text or a dict gives, None for what names a file.
    Raises InputError where no file may hold the text.
    """
    if isinstance(what, str):
        return Given.text(what) if "\n" in what or FIRST_KEY.match(what) else None
    return Given.values(what) if isinstance(what, Mapping) else None


def called(world: World) -> str:
    """How outputs name a world that was handed over: by its file, else by its own name."""
    given = world.given
    return source_name(given.shown if isinstance(given, Given) and given.is_file else world.name)


def is_own(world: World) -> bool:
    """Whether somebody wrote it: it neither comes along with the program nor is made by it."""
    given = world.given
    if not isinstance(given, Given):
        return True
    return not (given.made or (given.is_file and is_packaged(given.shown)))
