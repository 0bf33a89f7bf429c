"""The keys of a file that people write, as tables in Markdown: its JSON Schema, to be read."""

import json
from collections.abc import Iterator
from typing import Any

from ekfsim.files.yaml.schema import Kind, json_schema

BEYOND = 1e6  # a bound that says no more than that a number must be sensible
NAMED = "NAME"  # a key that whoever writes the file chooses
LONGEST = 60  # characters of an example; a longer one stands in the files that come along
Schema = dict[str, Any]


def reference(kind: Kind) -> str:
    """A table for each mapping of such a file, the file itself first."""
    schema = json_schema(kind)
    inner = schema.get("$defs", {})
    tables = [_table(schema, inner)]
    tables += [
        f"`{place}`{_told(inner[name])}\n\n{_table(inner[name], inner)}"
        for name, place in _places(schema, inner).items()
    ]
    return "\n".join(tables)


def _places(schema: Schema, inner: Schema) -> dict[str, str]:
    """Where each of the mappings inside stands first, from the outside to the inside."""
    found: dict[str, str] = {}
    waiting = [("", schema)]
    while waiting:
        place, part = waiting.pop(0)
        others = part.get("additionalProperties")
        named = {NAMED: others} if isinstance(others, dict) else {}
        for key, value in {**part.get("properties", {}), **named}.items():
            for name, many in _named(value):
                if name not in found and name in inner:
                    found[name] = f"{place}{key}{'[]' if many else ''}"
                    waiting.append((f"{found[name]}.", inner[name]))
    return found


def _named(value: Any, many: bool = False) -> Iterator[tuple[str, bool]]:
    """The mappings that a value may be made of, and whether it is a list of them."""
    if "$ref" in value:
        yield value["$ref"].rpartition("/")[2], many
    for choice in (*value.get("anyOf", ()), *value.get("oneOf", ())):
        yield from _named(choice, many)
    if isinstance(value.get("items"), dict):
        yield from _named(value["items"], True)


def _told(part: Schema) -> str:
    return f": {_cell(part['description'])}" if part.get("description") else ""


def _table(part: Schema, inner: Schema) -> str:
    rows = ["| key | what it is | where it is left out | for example |", "|---|---|---|---|"]
    required = part.get("required", ())
    for key, value in part.get("properties", {}).items():
        absent = (
            "must be there"
            if key in required
            else f"`{_written(value['default'])}`"
            if value.get("default") not in (None, "", [], {})
            else ""
        )
        short = (one for one in map(_written, value.get("examples", ())) if len(one) <= LONGEST)
        example = "".join(f"`{_cell(one)}`" for one in list(short)[:1])
        told = _cell(value.get("description") or _of(value, inner).get("description", ""))
        rows.append(f"| `{key}` | {told}{_limits(value)} | {absent} | {example} |")
    return "\n".join(rows) + "\n"


def _of(value: Schema, inner: Schema) -> Schema:
    """What a reference refers to."""
    return dict(inner.get(value.get("$ref", "").rpartition("/")[2], {}))


def _limits(value: Schema) -> str:
    """What a number or a word must be, where the schema says more than that it is one."""
    if "enum" in value:
        return f" One of {', '.join(f'`{word}`' for word in value['enum'])}."
    bounds = [
        f"{sign} {value[name]:g}"
        for name, sign in (
            ("minimum", "≥"),
            ("exclusiveMinimum", ">"),
            ("maximum", "≤"),
            ("exclusiveMaximum", "<"),
        )
        if name in value and abs(value[name]) < BEYOND
    ]
    return f" ({', '.join(bounds)})" if bounds else ""


def _written(value: Any) -> str:
    """A value as a person may write it in YAML's flow style."""
    match value:
        case dict():
            return "{" + ", ".join(f"{key}: {_written(one)}" for key, one in value.items()) + "}"
        case list():
            return "[" + ", ".join(map(_written, value)) + "]"
        case str():
            return value
        case float():
            return f"{value:.6g}"
    return json.dumps(value)


def _cell(text: str) -> str:
    """Words that stand in a cell of a table."""
    return " ".join(text.split()).replace("|", "\\|")
