"""The JSON Schema of each kind of file:
editors complete and check with it, and messages read it.
"""

from functools import cache, lru_cache
from importlib import import_module
from typing import Any, Literal

from pydantic import BaseModel
from pydantic.json_schema import GenerateJsonSchema

from ekfsim.files.keys.fields import whole

Kind = Literal["world", "commands", "study", "homework"]
Schema = dict[str, Any]
CANNOT = (  # say of any file
    "numbers that are none (.nan)",
    "merge keys ('<<'), which an editor may write out, tags, and a key that is given twice",
)
CANNOT_OF: dict[Kind, tuple[str, ...]] = {
    "world": (
        "outlines that cross themselves or have no area",
        "names, ids and sensors that stand twice",
        "obstacles that are missing and not there",
        "places where the robot cannot stand",
        "pairs whose first number is the larger",
    ),
    "commands": (
        "whether the files that are named are there",
        "whether it fits the world, as a drive in a classroom does not",
        "which numbers a drive's path has, and which kappa leaves sigma points to the "
        "filter's state",
        "pairs whose first number is the larger",
    ),
    "study": (
        "whether the files that are named are there",
        "whether a key with dots is one of the files",
        "which filters a side names",
        "values that stand twice",
    ),
    "homework": (
        "whether the files that are named are there",
        "parts and scenes that stand twice",
        "points that do not add up",
        "what is asked for and handed out",
    ),
}
MODELS: dict[Kind, tuple[str, str]] = {  # where the keys of each stand
    "world": ("ekfsim.files.keys.worlds.world", "WorldKeys"),
    "commands": ("ekfsim.files.keys.commands", "CommandsKeys"),
    "study": ("ekfsim.files.keys.study", "StudyKeys"),
    "homework": ("ekfsim.files.keys.homework", "HomeworkKeys"),
}


def model_of(kind: Kind) -> type[BaseModel]:
    """The keys of a kind of file. Those of the others are not imported: it takes its time."""
    module, name = MODELS[kind]
    found: type[BaseModel] = getattr(import_module(module), name)
    return found


class WithoutNull(GenerateJsonSchema):
    """An optional key may be left out; it may not hold null."""

    def nullable_schema(self, schema: Any) -> Schema:
        """What the key may hold."""
        return self.generate_inner(schema["schema"])

    def default_schema(self, schema: Any) -> Schema:
        """Only defaults that could be written."""
        if schema.get("default", 0) is None:
            return self.generate_inner(schema["schema"])
        return super().default_schema(schema)

    def model_schema(self, schema: Any) -> Schema:
        """A mapping, told in one line: where the code breaks its own is no editor's matter."""
        found = super().model_schema(schema)
        if "description" in found:
            found["description"] = " ".join(found["description"].split())
        return found

    def field_title_should_be_set(self, schema: Any) -> bool:
        """A key is its own title."""
        return False

    def sort(self, value: Any, parent_key: str | None = None) -> Any:
        """The order of the models is the one to read in."""
        return value


@cache
def json_schema(kind: Kind) -> Schema:
    """The schema of a kind of file, for an editor.

    >>> json_schema("world")["required"]
    ['name', 'start']
    """
    schema = whole(model_of(kind)).model_json_schema(schema_generator=WithoutNull)
    cannot = "; ".join((*CANNOT, *CANNOT_OF[kind]))
    told = f"{schema['description']}\n\nOnly `ekfsim check` sees what no schema can tell: {cannot}."
    return {"$schema": WithoutNull.schema_dialect, **schema, "description": told}


def schema_at(kind: Kind, path: tuple[str | int, ...]) -> Schema:
    """What the schema says of one value of a file; {} where it knows nothing."""
    return _schema_at(kind, tuple(0 if isinstance(part, int) else part for part in path))


@lru_cache(maxsize=4096)
def _schema_at(kind: Kind, path: tuple[str | int, ...]) -> Schema:
    whole = json_schema(kind)
    found = whole
    for part in path:
        found = one_kind(found, whole, isinstance(part, int))
        found = found.get("items", {}) if isinstance(part, int) else key_of(found, part)
        found = resolved(found, whole)
    return found


def key_of(mapping: Schema, key: str) -> Schema:
    """What the schema of a mapping says of one key; of any, where it names none of its own."""
    others = mapping.get("additionalProperties")
    found: Schema = mapping.get("properties", {}).get(
        key, others if isinstance(others, dict) else {}
    )
    return found


def words_of(schema: Schema) -> list[str]:
    """The few words that a value may be, [] where it may be any; FILE.py is a file of one's own."""
    word = next((one for one in schema.get("oneOf", ()) if "const" in one), None)
    if word is not None:
        return [word["const"]]
    words: list[str] = schema.get("enum", [])
    for one in schema.get("anyOf", []):
        words = [*one["enum"], "FILE.py"] if "enum" in one else words
    return words


def keys_at(kind: Kind, path: tuple[str | int, ...]) -> Schema:
    """What the schema says of each key of a mapping of a file; {} where it knows none."""
    whole = json_schema(kind)
    known: Schema = one_kind(schema_at(kind, path), whole, is_list=False).get("properties", {})
    return known


def one_kind(found: Schema, whole: Schema, is_list: bool) -> Schema:
    """Of what may be a list, a mapping or a word, as a drive, the list or the mapping."""
    if "oneOf" not in found or "properties" in found:
        return found
    several = (one for one in found["oneOf"] if one.get("type") != "string")
    return resolved(next(one for one in several if ("items" in one) == is_list), whole)


def resolved(found: Schema, whole: Schema) -> Schema:
    """A part of a schema, with what it refers to."""
    return (
        {**whole["$defs"][found["$ref"].rpartition("/")[2]], **found} if "$ref" in found else found
    )
