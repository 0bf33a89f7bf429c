"""The tables of docs/reference/formats.md are those of the schemas, by which files are checked."""

import re
from pathlib import Path

import pytest

from ekfsim.files.yaml.reference import reference
from ekfsim.files.yaml.schema import json_schema

PAGE = (Path(__file__).parents[2] / "docs/reference/formats.md").read_text(encoding="utf-8")
KINDS = ["world", "commands", "study", "homework"]


@pytest.mark.parametrize("kind", KINDS)
def test_the_page_has_the_tables_of_today(kind):
    """`ekfsim schema KIND --markdown` prints them anew."""
    (shown,) = re.findall(rf"<!-- {kind} -->\n(.*?)<!-- end -->", PAGE, re.DOTALL)
    assert shown == reference(kind)


@pytest.mark.parametrize("kind", KINDS)
def test_every_key_of_every_mapping_has_its_row(kind):
    schema, tables = json_schema(kind), reference(kind)
    rows = re.findall(r"^\| `(\w+)` \|", tables, re.MULTILINE)
    keys = [
        key
        for part in (schema, *schema.get("$defs", {}).values())
        for key in part.get("properties", {})
    ]
    assert sorted(rows) == sorted(keys)


def test_what_must_be_there_and_what_stands_for_what_is_left_out_is_told():
    tables = reference("world")
    assert "| `name` | What pictures and reports call this world. | must be there | " in tables
    assert (
        "| `rangeScale` | Every range is multiplied by it. Only in the classroom. | `1` |" in tables
    )
    assert "from 0 to 1. (≥ 0, ≤ 1) |" in reference("commands")
