"""Values of Python → the tree that the text of a file grows to, so that all its checks hold."""

from collections.abc import Mapping

import numpy as np

from ekfsim.errors import Mistake, Place
from ekfsim.files.source import character, unprintable
from ekfsim.files.yaml.marked import NOTHING, Node, Path, Scalar, field_of
from ekfsim.files.yaml.parsing import MAX_DEPTH
from ekfsim.printable import quoted, short

NOWHERE = (0, 0)  # a value of Python stands on no line
EXAMPLE = "write numbers, text, lists and dicts"


def tree_of(value: object, shown: str, mistakes: list[Mistake], path: Path = ()) -> Node:
    """The tree of a value; what no file can hold is told in `mistakes`, each at its path."""
    if isinstance(value, np.generic | np.ndarray):
        value = value.tolist()
    if len(path) > MAX_DEPTH:
        return _refused(f"values are nested more than {MAX_DEPTH} levels deep", shown, mistakes)
    match value:
        case Mapping():
            return _mapping(value, shown, mistakes, path)
        case list() | tuple():
            items = [tree_of(one, shown, mistakes, (*path, n)) for n, one in enumerate(value)]
            return Node(NOWHERE, items)
        case None:
            return Node(NOWHERE, NOTHING, "None")
        case str():
            if found := unprintable(value):
                wrong = f"{character(found[0])} cannot stand in text"
                return _refused(wrong, shown, mistakes, path, "delete it")
            return Node(NOWHERE, str(value), str(value), quoted=True)
        case bool() | int() | float():
            return Node(NOWHERE, value, written(value))
    wrong = f"{quoted(type(value).__name__)} is no kind of value that a file can hold"
    return _refused(wrong, shown, mistakes, path, EXAMPLE)


def written(value: Scalar | None) -> str:
    """A value as one writes it into a file.

    >>> written(0.1), written(True), written("ekf"), written(float("nan"))
    ('0.1', 'true', 'ekf', '.nan')
    """
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, float) and value != value:
        return ".nan"
    return repr(value).replace("inf", ".inf") if isinstance(value, float) else str(value)


def _mapping(
    value: Mapping[object, object], shown: str, mistakes: list[Mistake], path: Path
) -> Node:
    held = dict[str, Node]()
    for key, inner in value.items():
        if isinstance(key, str):
            held[key] = tree_of(inner, shown, mistakes, (*path, key))
        else:
            wrong = f"the key {short(repr(key))} is no text"
            _refused(wrong, shown, mistakes, path, "write a word, as in {'name': 'desk'}")
    return Node(NOWHERE, held, keys=dict.fromkeys(held, NOWHERE))


def _refused(
    wrong: str, shown: str, mistakes: list[Mistake], path: Path = (), right: str = "write fewer"
) -> Node:
    mistakes.append(Mistake(Place(shown, *NOWHERE), field_of(path), wrong, right))
    return Node(NOWHERE, NOTHING, faulty=True)
