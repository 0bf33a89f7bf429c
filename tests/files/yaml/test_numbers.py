"""Long lists of points: read in one go, and the same as value by value."""

import json
import math

import pytest

from ekfsim.files.scenes.load import read_world
from ekfsim.files.yaml import numbers
from ekfsim.files.yaml.numbers import LONG, Numbers
from ekfsim.files.yaml.parsing import LOADER, Tree, _parsed, parse, quickly

POINTS = [[i / 8, -(i % 7) * 1e-3] for i in range(1500)]
FLOW = f"[{', '.join(f'[{x!r}, {y!r}]' for x, y in POINTS)}]"
ROWS = "".join(f"    - [{x!r},{y!r}]\n" for x, y in POINTS)
DASHES = "".join(f"  - - {x!r}\n    - {y!r}\n" for x, y in POINTS)
OVER_LINES = FLOW.replace("], [", "],\n     [")
FILES = {
    "in a line": f"name: a\nobstacles:\n  - {{name: b, points: {FLOW}}}\nz: 1\n",
    "over lines": f"name: a\nobstacles:\n  - {{name: b, points: {OVER_LINES}, z: 1}}\nend: 2\n",
    "rows": f"obstacles:\n  - name: b\n    points:\n{ROWS}    z: 1\nend: 2\n",
    "dashes": f"obstacles:\n  points:\n{DASHES}  z: 1\nend: 2\n",
    "rows at the margin": "points:\n" + ROWS.replace("    -", "-") + "end: 2\n",
    "two of them": f"a: {FLOW}\nb:\n{ROWS}c: {FLOW}\n",
    "at the top": FLOW,
    "named": f"a: &one {FLOW}\nb: *one\n",
    "named rows": f"a: &one\n{ROWS}b: *one\n",
    "lists of them": f"walls: [{FLOW}, {FLOW}]\n",
}
# what looks like a list, and is none, or is a part of one
NONE = {
    "a comment": f"# {FLOW}\nend: 2\n",
    "a text": f"text: on {FLOW}\nend: 2\n",
    "a quoted text": f"text: 'on {FLOW}'\nend: 2\n",
    "a text in lines": f"text: |\n{ROWS}end: 2\n",
    "a folded text": f"text: >\n{ROWS}end: 2\n",
    "below a text": f"text: word\n{ROWS}end: 2\n",
    "after another value": f"points:\n    - a\n{ROWS}end: 2\n",
    "before another value": f"points:\n{ROWS}    - [a, b]\nend: 2\n",
    "a comment within": f"points:\n{ROWS}    # half\n{ROWS}end: 2\n",
    "octal": f"points: {FLOW[:-1]}, [010, 1]]\n",
    "a tag": f"points: !!seq {FLOW}\n",
}


def told(node, path=()):
    """Every value with its path, its place, and what it is."""
    yield path, node.mark, node.values, node.levels, node.plain(), node.keys
    if isinstance(node.value, dict | list):
        inner = node.value.items() if isinstance(node.value, dict) else enumerate(node.value)
        for part, one in inner:
            yield from told(one, (*path, part))


def value_by_value(text):
    tree = Tree("f")
    tree.grow(text, LOADER)
    return tree


@pytest.mark.parametrize("text", FILES.values(), ids=FILES)
def test_the_tree_is_the_same_as_value_by_value(text):
    assert len(text) > LONG
    quick = quickly(text, "f")
    assert list(told(quick)) == list(told(value_by_value(text).root))
    assert any(isinstance(node, Numbers) for node in lists(quick))


def lists(node):
    """The lists in a tree that were not yet looked into, and all values around them."""
    yield node
    if not isinstance(node, Numbers) and isinstance(node.value, dict | list):
        for one in node.value.values() if isinstance(node.value, dict) else node.value:
            yield from lists(one)


@pytest.mark.parametrize("text", NONE.values(), ids=NONE)
def test_what_only_looks_like_a_list_is_read_as_it_stands(text):
    tree = value_by_value(text)
    root, mistakes = parse(text, "f")
    assert list(told(root)) == list(told(tree.root))
    assert mistakes == tree.mistakes


CIRCLE = [[round(20 * math.cos(i / 200), 6), round(20 * math.sin(i / 200), 6)] for i in range(1256)]
ONE = f"[{CIRCLE[700][0]}, "
WORLD = f"""name: round
boundary: {json.dumps(CIRCLE)}
start: {{x: 0, y: 0, theta: 90}}
noise: {{executionDstSigmaRatio: 0, executionAngSigmaRatio: 0, odometryDstSigmaRatio: 0,
  odometryAngSigmaRatio: 0, rangeSigmaRatio: 0}}
"""


@pytest.mark.parametrize("as_rows", [False, True])
@pytest.mark.parametrize(
    ("number", "written"),
    [
        (ONE, "1e999"),
        (ONE, "true"),
        (ONE, "19.9"),
        ("[20.0, 0.0]", "[20.0]"),
        (ONE, ONE),
    ],
)
def test_a_mistake_in_a_long_list_is_told_as_in_any_other(
    tmp_path, monkeypatch, number, written, as_rows
):
    text = WORLD.replace("], [", "]\n- [").replace("[[", "\n- [")
    text = (text.replace("]]", "]") if as_rows else WORLD).replace(number, written)
    (tmp_path / "world.yaml").write_text(text)
    quick = read_world(tmp_path / "world.yaml").mistakes
    monkeypatch.setattr(numbers, "LONG", len(text) + 1)
    _parsed.cache_clear()
    assert bool(quick) == (number != written)
    assert quick == read_world(tmp_path / "world.yaml").mistakes
