"""JSON, read by the standard library; a place in it is looked for only where something is wrong."""

import json
from functools import lru_cache
from typing import Any

from ekfsim.errors import InputError, Place, UsageError
from ekfsim.files.source import mistake
from ekfsim.files.yaml.marked import Node
from ekfsim.files.yaml.marked import Path as Route


def data_of(raw: bytes, shown: str) -> Any:
    """What a JSON text holds. Raises InputError where it is none."""

    def refuse(name: str) -> float:
        raise mistake(shown, 1, 1, f"{name} is no number in JSON", "write a number")

    try:
        return json.loads(raw.decode("utf-8-sig"), parse_constant=refuse)
    except UnicodeDecodeError as error:
        wrong = f"the byte 0x{raw[error.start]:02x} is not UTF-8"
        raise mistake(shown, 1, 1, wrong, "JSON is text in UTF-8") from None
    except json.JSONDecodeError as error:
        told = f"this is no JSON: {error.msg.lower()}"
        raise mistake(
            shown, error.lineno, error.colno, told, "mend it, or export it anew"
        ) from None
    except RecursionError:
        raise mistake(shown, 1, 1, "lists lie in lists too deeply", "no plan does so") from None


def place_of(raw: bytes, shown: str, route: Route) -> Place:
    """The line and the column of what stands at a path in a JSON text."""
    node, step = _tree(raw, shown), 0
    while node is not None and step < len(route):
        if (inner := node.get(route[step])) is None:
            break
        node, step = inner, step + 1
    return Place(shown, 1, 1) if node is None else Place(shown, *node.mark)


@lru_cache(maxsize=1)
def _tree(raw: bytes, shown: str) -> Node | None:
    """The text as YAML, which knows its places; None where it is none."""
    from ekfsim.files.yaml.parsing import parse

    try:
        return parse(raw.decode("utf-8-sig").replace("\t", " "), shown)[0]
    except (InputError, UsageError):
        return None
