"""Whatever is in a file: it loads, or its mistakes are told. Never anything else."""

import json
import re

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from ekfsim.errors import InputError
from ekfsim.files.scenes.load import check, load_scene, load_world
from ekfsim.files.template import template
from ekfsim.scene import Scene
from ekfsim.world import World

MODEST = settings(
    max_examples=150, deadline=None, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
FULL = {
    "world": {
        "name": "a",
        "description": "b",
        "boundary": [[0, 0], [10, 0], [10, 8], [0, 8]],
        "obstacles": [{"name": "desk", "points": [[4, 3], [5, 3], [5, 4], [4, 4]]}],
        "landmarks": [{"id": 3, "x": 5.0, "y": 5.0}],
        "start": {"x": 1.0, "y": 1.0, "theta": 90, "sigma": {"x": 0.1, "y": 0.1, "theta": 5}},
        "noise": {
            "executionDstSigmaRatio": 0.05,
            "executionAngSigmaRatio": 0.05,
            "odometryDstSigmaRatio": 0.02,
            "odometryAngSigmaRatio": 0.02,
            "rangeSigmaRatio": 0.01,
        },
        "belief": {
            "start": {"x": 1.2, "y": 1.0, "theta": 80},
            "sigma": {"x": 0.1, "y": 0.1, "theta": 5},
            "noise": {"odometryDstSigmaRatio": 0.001},
            "missing": ["desk"],
            "boundary": [[0, 0], [11, 0], [11, 8]],
        },
        "faults": {
            "rangeBias": 0.1,
            "rangeScale": 1.0,
            "shortReturns": 0.1,
            "odometryDstScale": 1.05,
        },
    },
    "commands": {
        "world": "world.yaml",
        "seed": 7,
        "filter": "ekf",
        "gate": 0.99,
        "guard": "warn",
        "description": "b",
        "expect": {
            "lost": [0.05, 0.3],
            "nis": "silent",
            "nees": "high",
            "coverage": [0.5, 0.9],
            "runs": 3,
        },
        "commands": [
            {"move": {"distance": 1.75, "angle": 90, "slip": 0.8}},
            {"sense": {"angle": 90}},
            {
                "repeat": {
                    "times": 4,
                    "commands": [{"repeat": {"times": 2, "commands": [{"say": "x"}]}}],
                }
            },
            {"kidnap": {"x": 3, "y": 2, "theta": 0}},
        ],
    },
}
KINDS = st.sampled_from(sorted(FULL))
SCALARS = st.one_of(
    st.none(),
    st.booleans(),
    st.integers(),
    st.floats(),
    st.text(max_size=4),
    st.sampled_from([1e6, -1e-320, 2**70]),
)
KEYS = st.sampled_from(["", *sorted(set(re.findall(r'"(\w+)":', json.dumps(FULL))))]) | st.text(
    max_size=3
)
ANYTHING = st.recursive(
    SCALARS,
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(KEYS, inner, max_size=4),
    max_leaves=6,
)
SNIPPETS = st.sampled_from(list("\t\n :-[]{}#&*!|>'\"%@`,?~\r\0\x85\u2028\ufeff€🙂"))
WORDS = st.sampled_from(
    ["- ", ": ", "\n---\n", "&a ", "*a", "<<: ", "!!str ", "? ", "1e999", ".nan", "\n  ", "|\n"]
)


def survives(folder, content):
    """A file of this content loads, or its mistakes are told, one a line."""
    (folder / "world.yaml").write_text(template("world"))
    path = folder / "f.yaml"
    path.write_bytes(
        content.encode("utf-8", "surrogatepass") if isinstance(content, str) else content
    )
    for load in (load_world, load_scene):
        try:
            assert isinstance(load(path), World | Scene)
        except InputError as error:
            told = error.mistakes
        else:
            continue
        assert told
        assert not [
            line
            for line in map(str, told)
            if not re.fullmatch(r"[^\n\r]+:\d+:\d+: [^\n\r]+; [^\n\r]+", line)
        ]
    checked = check(path)
    assert (checked.value is None) == bool(checked.mistakes)


def mutate(data, value, choose):
    """Plain data with one value in it exchanged, deleted or added to."""
    if isinstance(data, dict | list) and data and choose(0, 5) > 0:
        key = choose(sorted(data) if isinstance(data, dict) else range(len(data)))
        copy = data.copy()
        match choose(0, 9):
            case 0:
                del copy[key]
            case 1 if isinstance(copy, list):
                copy.append(value)
            case _:
                copy[key] = mutate(data[key], value, choose)
        return copy
    return value


@given(text=st.text(max_size=60) | st.lists(SNIPPETS | WORDS | KEYS, max_size=25).map("".join))
@MODEST
def test_any_text(tmp_path, text):
    survives(tmp_path, text)


@given(content=st.binary(max_size=80))
@MODEST
def test_any_bytes(tmp_path, content):
    survives(tmp_path, content)


@given(kind=KINDS, value=ANYTHING, data=st.data())
@MODEST
def test_a_file_with_any_value_in_it(tmp_path, kind, value, data):
    def choose(*options):
        return data.draw(
            st.integers(*options) if len(options) == 2 else st.sampled_from(list(options[0]))
        )

    mutated = mutate(FULL[kind], value, choose)
    survives(tmp_path, json.dumps(mutated).replace("NaN", ".nan").replace("Infinity", ".inf"))


@given(kind=KINDS, data=st.data())
@MODEST
def test_a_file_with_slips_of_the_keyboard(tmp_path, kind, data):
    text = template(kind)
    for _ in range(data.draw(st.integers(1, 4))):
        at = data.draw(st.integers(0, len(text)))
        cut = data.draw(st.integers(0, 6))
        text = text[:at] + data.draw(SNIPPETS | WORDS | st.just("")) + text[at + cut :]
    survives(tmp_path, text)


@pytest.mark.parametrize("kind", sorted(FULL))
def test_the_file_that_is_mutated_is_right(tmp_path, kind):
    (tmp_path / "world.yaml").write_text(template("world"))
    path = tmp_path / "f.yaml"
    path.write_text(json.dumps(FULL[kind]))
    assert check(path).mistakes == []
