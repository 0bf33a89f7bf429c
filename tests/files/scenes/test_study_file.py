"""The keys of a study file, as editors and messages read them."""

import json

import pytest

from ekfsim.errors import InputError
from ekfsim.files.scenes.load_study import read_request
from ekfsim.files.yaml.schema import json_schema, schema_at, words_of
from ekfsim.filters import FILTERS


def test_every_key_is_told_with_an_example():
    schema = json_schema("study")
    assert schema["title"] == "ekfsim study"
    assert schema["required"] == ["study"]
    assert schema["additionalProperties"] is False
    assert json.dumps(schema).count("anyOf") == 1  # of the filters
    for key, part in schema["properties"].items():
        assert part["description"].endswith("."), key
        assert part["examples"], key
        assert "default" not in part or part["default"] is not None, key


def test_the_filters_of_the_schema_are_those_there_are():
    assert words_of(schema_at("study", ("filters", 0))) == [*FILTERS, "FILE.py"]


def test_a_swept_value_is_a_number_or_a_word():
    assert schema_at("study", ("sweep", "noise.rangeSigmaRatio", 0))["type"] == ["number", "string"]
    assert schema_at("study", ("set", "guard"))["type"] == ["number", "string"]


def test_all_mistakes_of_a_study_file_are_told_at_once(tmp_path):
    (tmp_path / "s.yaml").write_text(
        "study: tour\nruns: ten\nsweep: {noise.rangeSigmaRatio: [0.1, 0.1], nois.x: "
        "[1]}\nfilters: [ekf, foo]\n"
    )
    with pytest.raises(InputError) as refused:
        read_request(str(tmp_path / "s.yaml"))
    assert [str(mistake).removeprefix(f"{tmp_path}/") for mistake in refused.value.mistakes] == [
        "s.yaml:2:7: runs: 'ten' is text where a whole number belongs; write e.g. 10000",
        "s.yaml:3:38: sweep.noise.rangeSigmaRatio[1]: 0.1 stands twice; delete one",
        "s.yaml:3:44: sweep: unknown key 'nois'; did you mean 'noise'?",
        f"s.yaml:4:10: filters: 'foo' is no filter; known: {', '.join(FILTERS)}, or one of your "
        "own: FILE.py",
    ]
