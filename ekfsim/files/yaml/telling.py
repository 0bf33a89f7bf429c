"""Each mistake that a model finds in a file, in words for the one who wrote it."""

import math
import re
from typing import Any

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from ekfsim.errors import MOST_TOLD, Mistake, Place
from ekfsim.files.yaml.marked import Mark, Node, Path, field_of
from ekfsim.files.yaml.schema import Kind, Schema, keys_at, schema_at, words_of
from ekfsim.printable import quoted as quoted
from ekfsim.printable import short as short

NOUNS = {
    "number": "a number",
    "integer": "a whole number",
    "string": "text",
    "boolean": "true or false",
    "array": "a list",
    "object": "a mapping 'key: value'",
}
EACH = "[]"  # of a list
OF_SEVERAL_KINDS = (
    ("drive",),
    ("walls", EACH),
    ("belief", "walls", EACH),
    ("belief", "start"),
    *(("recording", "topics", topic) for topic in ("fix", "scan", "landmarks")),
)


def tell(error: ValidationError, kind: Kind, root: Node, file: str) -> list[Mistake]:
    """Every mistake that a model found, each at its place.

    Nothing more is told of a value that a mistake was told of already, nor of a missing key that
    was only misspelt. To find what was meant takes time: it is looked for where it will be told.
    """
    details = sorted(details_of(error), key=lambda detail: mark_of(detail, root))
    unknown = [detail["loc"] for detail in details if detail["type"] == "extra_forbidden"]
    misspelt = {(*path[:-1], meant(str(path[-1]), kind, path[:-1])) for path in unknown[:MOST_TOLD]}
    wrong = [
        detail
        for detail in details
        if not root.nearest(detail["loc"]).faulty
        and not (detail["type"] == "missing" and detail["loc"] in misspelt)
    ]
    return [
        tell_one(detail, kind, root, file, is_told=n < MOST_TOLD) for n, detail in enumerate(wrong)
    ]


def mark_of(detail: ErrorDetails, root: Node) -> Mark:
    """Where it is told: an unknown key at the key."""
    *above, last = detail["loc"] or ("",)
    if detail["type"] == "extra_forbidden":
        return root.nearest(above).keys[str(last)]
    return root.nearest(detail["loc"]).mark


def details_of(error: ValidationError) -> list[ErrorDetails]:
    """All that a model found, each at the path of the file: in those of a drive's way, of a wall
    and of a bag's topic stands which of the kinds it is.
    """
    details = error.errors(include_url=False, include_input=False, include_context=False)
    for detail in details:
        path = detail["loc"]
        for kind in OF_SEVERAL_KINDS:
            depth = len(kind)
            if len(path) > depth and all(
                part == key or (key == EACH and isinstance(part, int))
                for part, key in zip(path, kind, strict=False)
            ):
                detail["loc"] = (*path[:depth], *path[depth + 1 :])
    return details


def tell_one(
    detail: ErrorDetails, kind: Kind, root: Node, file: str, is_told: bool = True
) -> Mistake:
    """One mistake; of an unknown key that is only counted, no more than what it is."""
    path: Path = detail["loc"]
    node, schema, mark = root.nearest(path), schema_at(kind, path), mark_of(detail, root)
    match detail["type"]:
        case "missing":
            wrong, right = "the key is missing", f"write {path[-1]}: {example(schema)}"
        case "extra_forbidden":
            key, path = str(path[-1]), path[:-1]
            wrong, right = (
                unknown_key(key, root.nearest(path), kind, path)
                if is_told
                else (f"unknown key {key}", "")
            )
        case "order":
            wrong, _, right = detail["msg"].partition("; ")
        case "literal_error":
            wrong, right = unknown_word(node, schema)
        case "too_short" | "too_long":
            wrong, right = wrong_length(node, schema)
        case "string_pattern_mismatch":
            wrong, right = (
                f"{shown(node)} is no name",
                f"write one line of text, e.g. {example(schema)}",
            )
        case (
            "finite_number"
            | "greater_than"
            | "greater_than_equal"
            | "less_than"
            | "less_than_equal"
        ):
            wrong, right = out_of_range(node, schema)
        case _:
            wrong, right = wrong_kind(node, schema)
    return at(file, mark, path, wrong, right)


def at(file: str, mark: Mark, path: Path, wrong: str, right: str) -> Mistake:
    """A mistake at a place of a file."""
    return Mistake(Place(file, *mark), field_of(path), wrong, right)


def unknown_key(key: str, mapping: Node, kind: Kind, path: Path) -> tuple[str, str]:
    """A key that nothing reads."""
    schema = schema_at(kind, path)
    what = {"a command": "command", "a sensor": "sensor"}.get(schema.get("title", ""))
    wrong = f"{quoted(key)} is not a {what}" if what else f"unknown key {quoted(key)}"
    for other in keys_at(kind, path):
        if other in mapping.keys and key in keys_at(kind, (*path, other)):
            return wrong, f"indent it further than '{other}' to put it under it"
    if known := meant(key, kind, path):
        name, colon, value = key.partition(":")
        spaced_out = f"write a space after the colon: '{known}: {short(value)}'"
        return wrong, spaced_out if colon and name == known else f"did you mean '{known}'?"
    return wrong, f"known {what or 'key'}s here: {', '.join(keys_at(kind, path))}"


def meant(key: str, kind: Kind, path: Path) -> str:
    """The known key of a mapping that an unknown one was meant to be, "" where none is near."""
    known = list(keys_at(kind, path))
    name = key.partition(":")[0]
    return name if name in known else nearest(key, known)


def unknown_word(node: Node, schema: Schema) -> tuple[str, str]:
    """A word that is none of the few allowed."""
    words = words_of(schema)
    if not isinstance(node.value, str):
        if "oneOf" in schema and "title" in schema:  # or a mapping
            right = f"write e.g. {example(schema)}, or {one_of(words)}"
            return f"{what_stands(node)} where {noun(schema)} belongs", right
        return f"{what_stands(node)} where a word belongs", f"write {one_of(words)}"
    near = nearest(node.value, words)
    right = f"did you mean '{near}'?" if near else f"write {one_of(words)}"
    return f"{shown(node)} is not known here", right


def one_of(words: list[str]) -> str:
    """The words to choose from: silent, high or low."""
    return " or ".join(filter(None, (", ".join(words[:-1]), words[-1])))


def wrong_length(node: Node, schema: Schema) -> tuple[str, str]:
    """Too few points, no pair, or nothing in a list."""
    count = len(node.value) if isinstance(node.value, list) else 0
    if count == 0 and schema.get("minItems", 1) == 1:
        return "an empty list stands here", f"write e.g. {example(schema)}"
    values = f"{count} value{'' if count == 1 else 's'}"
    if "maxItems" in schema:
        return (
            f"{values} stand{'s' if count == 1 else ''} where {noun(schema)} belongs",
            f"write e.g. {example(schema)}",
        )
    schema = next((one for one in schema.get("oneOf", ()) if "items" in one), schema)
    points = values.replace("value", "point")
    least = {2: "two", 3: "three"}[schema["minItems"]]
    what = noun(schema).removeprefix("a ")
    return (
        f"{points} make{'s' if count == 1 else ''} no {what}",
        f"write at least {least}, e.g. {example(schema)}",
    )


def wrong_kind(node: Node, schema: Schema) -> tuple[str, str]:
    """Text for a number, a number for text, a list for a mapping, …"""
    if words_of(schema):
        return unknown_word(node, schema)
    wanted, value = schema.get("type"), node.value
    right = f"write e.g. {example(schema)}"
    if wanted == "integer" and isinstance(value, float):
        if not abs(value) <= schema.get("maximum", 2**63):
            return out_of_range(node, schema)
        if value == int(value):
            right = f"write {int(value)}"
        return f"{shown(node)} is not written as a whole number", right
    if wanted in ("number", "integer") and isinstance(value, str) and (number := number_in(value)):
        right = f"write {number}"
    if wanted == "string" and node.written:
        right = f"write it in quotes: {quoted(node.written)}"
    return f"{what_stands(node)} where {noun(schema)} belongs", right


def number_in(text: str) -> str:
    """The number that a text holds beside a unit,
    a separator or a decimal comma; "" where it holds none.

    >>> number_in("1,5"), number_in("90°"), number_in("1_000"), number_in("two")
    ('1.5', '90', '1000', '')
    """
    number = re.fullmatch(
        r"\s*([-+]?[0-9_]*[.,]?[0-9_]+([eE][-+]?[0-9]+)?)\s*(°|[a-zA-Z]*)\s*", text
    )
    return number[1].replace(",", ".").replace("_", "") if number else ""


def what_stands(node: Node) -> str:
    """What was written, as the beginning of a sentence."""
    match node.value:
        case str():
            return f"{shown(node)} is text"
        case bool():
            return f"{node.written} is a yes-or-no value"
        case int() | float():
            return f"{shown(node)} is a number"
        case list():
            return "a list stands"
        case dict():
            return "a mapping stands"
    return "nothing stands"


def out_of_range(node: Node, schema: Schema) -> tuple[str, str]:
    """A number that is too small, too large or none."""
    value, right = node.value, f"write e.g. {example(schema)}"
    if isinstance(value, float) and not math.isfinite(value):
        huge = node.written.strip("+-")[:1].isdigit()
        return f"{shown(node)} is {'too large' if huge else 'not a finite number'}", right
    above, below = "exclusiveMinimum" in schema, "exclusiveMaximum" in schema
    low = schema["exclusiveMinimum" if above else "minimum"]
    high = schema["exclusiveMaximum" if below else "maximum"]
    if above and below:
        return f"{shown(node)} is not strictly between {low} and {high}", right
    small = isinstance(value, int | float) and value <= low
    if small and above:
        return (
            f"{shown(node)} is {'too small' if value == low else 'negative'}",
            f"write more than {spaced(low)}",
        )
    if high == 1 and not (above or below):
        right = f"write {noun(schema)} from 0 to 1"
    elif small:
        right = f"write {noun(schema)} of {spaced(low)} or more"
    else:
        right = f"write {noun(schema)} of {'less than' if below else 'at most'} {spaced(high)}"
    why = f": {schema['$comment']}" if "$comment" in schema and not small else ""
    return (
        f"{shown(node)} is "
        f"{'negative' if small and low == 0 else 'too small' if small else 'too large'}{why}",
        right,
    )


def spaced(number: float) -> str:
    """A bound, in groups of three digits."""
    return f"{int(number):,}".replace(",", " ")


def noun(schema: Schema) -> str:
    """What belongs at a place."""
    title = str(schema.get("title", ""))
    if title.startswith(("a ", "an ")):
        return title
    kinds = [schema["type"]] if isinstance(schema["type"], str) else schema["type"]
    return " or ".join(NOUNS[kind] for kind in kinds)


def example(schema: Schema) -> str:
    """A value that would be right."""
    return flow(schema["examples"][0])


def flow(value: Any) -> str:
    """A value as one writes it on a line of YAML.

    >>> flow([{"name": "desk", "points": [[4, 3.5]]}])
    '[{name: desk, points: [[4, 3.5]]}]'
    """
    if isinstance(value, dict):
        return "{" + ", ".join(f"{key}: {flow(inner)}" for key, inner in value.items()) + "}"
    if isinstance(value, list):
        return "[" + ", ".join(map(flow, value)) + "]"
    return str(value).lower() if isinstance(value, bool) else str(value)


def shown(node: Node) -> str:
    """A scalar as it was written: numbers bare, text in quotes, both short."""
    return quoted(node.written) if isinstance(node.value, str) else short(node.written)


def nearest(word: str, known: list[str]) -> str:
    """The known word that is nearest to another, "" where none is near."""
    lower = {name.lower(): name for name in known}
    import difflib

    near = difflib.get_close_matches(word.lower()[:100], lower, 1)
    return lower[near[0]] if near else ""
