"""The keys of a study file, as editors and messages read them."""

import json

from ekfsim.files.schema import json_schema, schema_at
from ekfsim.filters import FILTERS


def test_every_key_is_told_with_an_example():
    schema = json_schema("study")
    assert schema["title"] == "ekfsim study"
    assert schema["required"] == ["study"]
    assert schema["additionalProperties"] is False
    assert "anyOf" not in json.dumps(schema)
    for key, part in schema["properties"].items():
        assert part["description"].endswith("."), key
        assert part["examples"], key
        assert "default" not in part or part["default"] is not None, key


def test_the_filters_of_the_schema_are_those_there_are():
    assert schema_at("study", ("filters", 0))["enum"] == list(FILTERS)


def test_a_swept_value_is_a_number_or_a_word():
    assert schema_at("study", ("sweep", "noise.rangeSigmaRatio", 0))["type"] == ["number", "string"]
    assert schema_at("study", ("set", "guard"))["type"] == ["number", "string"]
