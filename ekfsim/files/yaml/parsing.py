"""YAML text → a tree of values with their places, and the mistakes in it.

PyYAML only cuts the text into events. What they mean is decided here: no tags, no merge keys, no
key twice, aliases that cannot explode, nesting that ends.
"""

import gc
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from functools import lru_cache
from itertools import islice
from typing import Any, NoReturn

import yaml

from ekfsim.errors import InputError, Mistake, Place
from ekfsim.files.source import character, unprintable
from ekfsim.files.yaml.marked import NOTHING, Mark, Node, field_of, scalar
from ekfsim.files.yaml.numbers import Cut
from ekfsim.files.yaml.syntax import syntax_mistake
from ekfsim.printable import quoted

MAX_VALUES = 1_000_000
MAX_DEPTH = 64
OLD_BREAKS = "\x85\u2028\u2029"
LONG = 2_000_000  # characters, which can be as many values
TOO_MANY = "the file holds more than 1 000 000 values, aliases written out"
VALUES = (yaml.ScalarEvent, yaml.CollectionStartEvent)
TOO_DEEP = "maximum nesting depth"
LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


@dataclass(slots=True)
class Open:
    """A mapping or list that is still being read."""

    node: Node
    anchor: str | None
    key: tuple[str, Mark] | None = None  # of a mapping: the key whose value comes next
    unusable: bool = False  # that key was refused: its value is dropped


def parse(text: str, file: str) -> tuple[Node, list[Mistake]]:
    """The tree of a YAML text, and the mistakes that leave a tree.

    Raises InputError where none is left: the text is not YAML, or explodes, or nests without end.
    """
    root, mistakes = _parsed(text, file)
    return root, list(mistakes)


@lru_cache(maxsize=4)
def _parsed(text: str, file: str) -> tuple[Node, tuple[Mistake, ...]]:
    """The same, remembered: a study reads its files for each of its cells.
    Nobody changes a tree.
    """
    with without_collection():
        if (root := quickly(text, file)) is not None:
            return root, ()
    tree = Tree(file)
    try:
        with without_collection():
            tree.grow(text, LOADER)
    except yaml.YAMLError as error:
        # libyaml's own limit, met before it tells of the level that is too deep here
        if TOO_DEEP in str(error):
            tree = Tree(file)
            with suppress(yaml.YAMLError):
                tree.grow(text, yaml.SafeLoader)
        raise InputError([*tree.mistakes, syntax_mistake(error, text, file)]) from None
    if tree.root is None:
        raise InputError(
            [
                Mistake(
                    Place(file), "", "the file is empty", "see `ekfsim new` for one to start from"
                )
            ]
        )
    return tree.root, tuple(tree.mistakes)


def quickly(text: str, file: str) -> Node | None:
    """The tree of a long text whose lists of numbers are read in one go each; None of one that is
    not long, or in which anything is wrong.
    """
    cut = Cut(text)
    if not cut.places:
        return None
    tree = Tree(file, cut)
    try:
        tree.grow(cut.text, LOADER)
    except (yaml.YAMLError, InputError):
        return None
    return None if tree.mistakes else tree.root


def grown(text: str, file: str) -> Node:
    """The tree of a text in which nothing is wrong."""
    tree = Tree(file)
    tree.grow(text, LOADER)
    assert tree.root is not None
    return tree.root


@contextmanager
def without_collection() -> Iterator[None]:
    """No search for cycles while a tree grows, which has none:
    among a million new values it takes longer than they.
    """
    was_on = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if was_on:
            gc.enable()


class Tree:
    """A tree that grows with the events of a YAML text; nothing here recurses."""

    def __init__(self, file: str, cut: Cut | None = None) -> None:
        self.file = file
        self.cut = cut  # what was cut out of the text
        self.root: Node | None = None
        self.mistakes: list[Mistake] = []
        self.open: list[Open] = []
        self.anchors: dict[str, Node] = {}
        self.came_back: dict[int, str] = {}  # the sign that stands in for a break → that break

    def grow(self, text: str, loader: Any) -> None:
        """Grow by the first document of a text. Raises YAMLError where it is none."""
        text = self.without_breaks(text)
        if len(text) > LONG:
            self.count(text, loader)
        for event in yaml.parse(text, Loader=loader):
            if self.root is not None and isinstance(event, yaml.DocumentStartEvent):
                right = "keep one per file: delete from '---' on"
                self.refuse(mark_of(event), "a second document begins here", right)
                break
            self.take(event)

    def without_breaks(self, text: str) -> str:
        """The text with other signs for those that end a line in YAML 1.1 alone, neither in YAML
        1.2 nor in an editor.

        They come back in the values; so lines are counted as whoever wrote the file sees them.
        """
        if breaks := [sign for sign in OLD_BREAKS if sign in text]:
            free = (sign for sign in map(chr, range(0xE000, 0xF900)) if sign not in text)
            stand_ins = dict(zip(breaks, free, strict=False))
            self.came_back = {ord(stand_in): sign for sign, stand_in in stand_ins.items()}
            return text.translate({ord(sign): stand_in for sign, stand_in in stand_ins.items()})
        return text

    def count(self, text: str, loader: Any) -> None:
        """Raises InputError where a text holds too many values,
        sooner than a tree of them would be made.
        """
        values = (event for event in yaml.parse(text, Loader=loader) if isinstance(event, VALUES))
        if (first_too_many := next(islice(values, MAX_VALUES, None), None)) is not None:
            self.give_up(mark_of(first_too_many), TOO_MANY, "write fewer")

    def take(self, event: yaml.Event) -> None:
        """Grow by one event. A long file has a million:
        what is rare is seen in a word before it is looked into.
        """
        if isinstance(event, yaml.ScalarEvent):
            if self.cut is not None and self.cut.sign in event.value:
                self.put_back(event)
                return
            text, quoted = event.value, not event.implicit[0]
            if self.came_back:
                text = text.translate(self.came_back)
            node = Node(mark_of(event), text if quoted else scalar(text), text, quoted)
            if event.tag is not None:
                self.check_tag(event, node)
            if quoted:  # text can escape there what no file may hold
                self.check_characters(node)
            if event.anchor is not None:
                self.anchors[event.anchor] = node
            self.attach(node)
        elif isinstance(event, yaml.CollectionStartEvent):
            node = Node(mark_of(event), {} if isinstance(event, yaml.MappingStartEvent) else [])
            if event.tag is not None:
                self.check_tag(event, node)
            self.open.append(Open(node, event.anchor))
            self.check_levels(node)
        elif isinstance(event, yaml.CollectionEndEvent):
            done = self.open.pop()
            if done.anchor is not None:
                self.anchors[done.anchor] = done.node
            self.attach(done.node)
        elif isinstance(event, yaml.AliasEvent):
            self.attach(self.alias(event))

    def put_back(self, event: yaml.ScalarEvent) -> None:
        """Grow by a list that was cut out of the text.
        Refuses what is none, so that the text is read as it stands.
        """
        assert self.cut is not None
        node = self.cut.numbers(event.value, mark_of(event), lambda text: grown(text, self.file))
        if node is None or event.tag is not None or not event.implicit[0]:
            self.give_up(mark_of(event), "no list of numbers", "")
        self.check_levels(node)
        if event.anchor is not None:
            self.anchors[event.anchor] = node
        self.attach(node)

    def attach(self, node: Node) -> None:
        """Put a finished value where it belongs: at the top, into a list, or into a mapping as a
        key or under one.
        """
        if not self.open:
            self.root = node
            return
        above = self.open[-1]
        holder = above.node
        holder.values += node.values
        if node.levels >= holder.levels:
            holder.levels = 1 + node.levels
        if holder.values > MAX_VALUES:
            self.give_up(node.mark, TOO_MANY, "write fewer")
        held = holder.value
        if type(held) is list:
            held.append(node)
        elif type(held) is dict:
            if above.key is None:
                above.key = self.key(holder, node)
            else:
                key, mark = above.key
                if not above.unusable:
                    held[key] = node
                    holder.keys[key] = mark
                above.key, above.unusable = None, False

    def key(self, mapping: Node, node: Node) -> tuple[str, Mark]:
        """The key that a node is, told of where it cannot be one."""
        above = self.open[-1]
        above.unusable = True
        if isinstance(node.value, list | dict):
            self.refuse(
                node.mark,
                "a list or mapping stands where a key belongs",
                "write a word, as in 'name: desk'",
            )
            return "?", node.mark
        if node.written == "<<" and not node.quoted:
            self.refuse(node.mark, "merge keys ('<<') are not read", "write the keys out")
        elif node.written in mapping.keys:
            line = mapping.keys[node.written][0]
            wrong = f"the key {quoted(node.written)} is given twice, first on line {line}"
            self.refuse(node.mark, wrong, "delete one")
        else:
            above.unusable = node.faulty
        return node.written, node.mark

    def alias(self, event: yaml.AliasEvent) -> Node:
        """The value that an alias (`*name`) stands for."""
        name, alias = event.anchor, quoted(f"*{event.anchor}")
        if any(above.anchor == name for above in self.open):
            self.refuse(
                mark_of(event),
                f"{alias} stands inside the value it refers to",
                "write the value out",
            )
        elif name not in self.anchors:
            right = f"mark a value above it with {quoted(f'&{name}')}"
            self.refuse(mark_of(event), f"{alias} refers to nothing", right)
        else:
            self.check_levels(self.anchors[name])
            return self.anchors[name]
        return Node(mark_of(event), NOTHING, faulty=True)

    def check_tag(self, event: yaml.ScalarEvent | yaml.CollectionStartEvent, node: Node) -> None:
        """Tags (`!!python/…`) are refused, all of them."""
        if event.tag is not None:
            tag = event.tag.replace("tag:yaml.org,2002:", "!!")
            self.refuse(
                node.mark, f"the tag {quoted(tag)} is not read", "write the value without it"
            )
            node.faulty = True

    def check_characters(self, node: Node) -> None:
        """Refuse what no file may hold; quoted text can escape it."""
        if found := unprintable(node.written):
            self.refuse(node.mark, f"{character(found[0])} cannot stand in text", "delete it")
            node.faulty = True

    def check_levels(self, node: Node) -> None:
        """Raises InputError where values are nested too deep for anything that follows."""
        if len(self.open) + node.levels > MAX_DEPTH + 1:
            self.give_up(
                node.mark,
                f"values are nested more than {MAX_DEPTH} levels deep",
                "write fewer levels",
            )

    def refuse(self, mark: Mark, wrong: str, right: str) -> None:
        """Note a mistake, and read on."""
        path: list[str | int] = []
        for above in self.open:
            if isinstance(above.node.value, list):
                path.append(len(above.node.value))
            elif above.key is not None:
                path.append(above.key[0])
        self.mistakes.append(Mistake(Place(self.file, *mark), field_of(path), wrong, right))

    def give_up(self, mark: Mark, wrong: str, right: str) -> NoReturn:
        """Raises InputError with every mistake so far."""
        raise InputError([*self.mistakes, Mistake(Place(self.file, *mark), "", wrong, right)])


def mark_of(event: yaml.Event) -> Mark:
    """Where an event begins."""
    mark = event.start_mark
    return (mark.line + 1, mark.column + 1) if mark else (1, 1)
