"""A file with very many mistakes is told of soon and in few lines; no text of a file breaks a line
of a message."""

import difflib

import pytest

from ekfsim.errors import MOST_TOLD, InputError, UsageError, first_of
from ekfsim.files.scenes import check_study
from ekfsim.files.scenes.check_study import check
from ekfsim.files.scenes.checking import polygons
from ekfsim.files.scenes.load import load_scene
from ekfsim.files.scenes.load_study import read_request

MANY = 1500
shapes = polygons._shapes
NOISE = (
    "noise: {executionDstSigmaRatio: 0, executionAngSigmaRatio: 0, odometryDstSigmaRatio: 0, "
    "odometryAngSigmaRatio: 0, rangeSigmaRatio: 0}\n"
)
WORLD = "name: room\nstart: {x: 9, y: 9, theta: 0}\n" + NOISE
DRIVEN = "name: a\nsystem: mower\nstart: {x: 0, y: 0, theta: 0}\n"
TRIANGLE = "points: [[0, 0], [1, 0], [1, 1]]"


def lines(pattern, count=MANY):
    return "".join(pattern.format(n) for n in range(count))


FILES = {  # many mistakes of one kind
    "unknown keys": WORLD + lines("key{0}: 1\n"),
    "unknown keys inside": WORLD + "belief: {{{}}}\n".format(lines("key{0}: 1, ")),
    "one key": WORLD + "name: a\n" * MANY,
    "obstacles of one name": WORLD + "obstacles:\n" + lines(f"  - {{{{name: a, {TRIANGLE}}}}}\n"),
    "names that are missing": WORLD
    + "obstacles:\n"
    + lines(f"  - {{{{name: desk {{0}}, {TRIANGLE}}}}}\n", 60)
    + "belief: {{missing: [{}]}}\n".format(lines("shelf {0}, ")),
    "landmarks of one id": WORLD + "landmarks:\n" + lines("  - {{id: 3, x: {0}, y: 0}}\n"),
    "sensors of one kind": DRIVEN + "sensors:\n" + lines("  - markers: {{rate: 1}}\n"),
    "unknown sensors": DRIVEN + "sensors:\n" + lines("  - marker{0}s: {{rate: 1}}\n"),
    "unknown commands": "world: world.yaml\ncommands:\n"
    + lines("  - moves{0}: {{distance: 1, angle: 0}}\n"),
    "wrong numbers": "world: world.yaml\ncommands:\n" + lines("  - sense: {{angle: a{0}}}\n"),
    "unknown numbers of a study": "study: scene.yaml\nset:\n" + lines("  noise.ratio{0}: 1\n"),
    "polygons": WORLD
    + "obstacles:\n"
    + lines("  - {{name: a{0}, points: [[0, 0], [1, 1], [2, 2]]}}\n"),
}


@pytest.fixture
def place(tmp_path, monkeypatch):
    (tmp_path / "world.yaml").write_text(WORLD)
    (tmp_path / "scene.yaml").write_text("world: world.yaml\ncommands: [{say: a}]\n")
    monkeypatch.chdir(tmp_path)
    return tmp_path


def told_of(text):
    """The lines that are told of a file."""
    with open("f.yaml", "w", encoding="utf-8") as file:
        file.write(text)
    return str(InputError(check("f.yaml").mistakes)).splitlines()


@pytest.mark.parametrize("what", FILES)
def test_of_very_many_mistakes_the_first_are_told_and_the_others_counted(place, what, monkeypatch):
    asked = []
    matches = difflib.get_close_matches
    monkeypatch.setattr(
        difflib, "get_close_matches", lambda *args: asked.append(args) or matches(*args)
    )
    told = told_of(FILES[what])
    assert len(told) == MOST_TOLD
    assert all(line.startswith("f.yaml:") for line in told)
    assert told[-1].endswith("more mistakes from here on")
    assert len(asked) < 5 * MOST_TOLD  # what was meant is looked for where it is told
    assert max(map(len, told)) < 400
    places = [tuple(map(int, line.split(":")[1:3])) for line in told]
    assert places == sorted(places)


def test_of_very_many_swept_values_those_after_the_fiftieth_mistake_are_not_looked_at(
    place, monkeypatch
):
    read = []
    scene = check_study.load.read_scene
    monkeypatch.setattr(
        check_study.load, "read_scene", lambda *args: read.append(args) or scene(*args)
    )
    told = told_of(f"study: scene.yaml\nsweep: {{gate: [0.5, {lines('1{0}, ')}]}}\n")
    assert len(told) == MOST_TOLD
    assert len(read) < 3 * MOST_TOLD
    assert told[-1].endswith(
        "sweep: what stands from here on was not looked at; mend the above first"
    )


def test_a_table_of_too_many_rows_is_told_before_anything_is_read(place, monkeypatch):
    monkeypatch.setattr(check_study.load, "read_scene", lambda *_: pytest.fail("a scene is read"))
    values = ", ".join(map(str, range(5001)))
    told = told_of(
        f"study: scene.yaml\nfilters: [ekf, ukf]\nsweep: {{noise.rangeSigmaRatio: [{values}]}}\n"
    )
    assert told == [
        "f.yaml:3:33: sweep: the table would have 10002 rows, more than 10000; sweep fewer values"
    ]


def test_all_are_counted(place):
    told = told_of(WORLD + lines("key{0}: 1\n", 3049))
    assert told[-1] == f"f.yaml:{3 + MOST_TOLD}:1: and 3 000 more mistakes from here on"
    assert len(told_of(WORLD + lines("key{0}: 1\n", MOST_TOLD))) == MOST_TOLD


def test_many_warnings_are_few_lines():
    assert len(first_of(map(str, range(MANY)))) == MOST_TOLD
    assert first_of(["a", "b"]) == ["a", "b"]
    assert first_of(map(str, range(7)), 3) == ["0", "1", "and 5 more warnings"]
    assert first_of(map(str, range(7)), 0) == []


@pytest.mark.parametrize(
    "text",
    [
        WORLD + "description: *@\n",
        WORLD + "description: &@ [*@]\n",
        WORLD + "@: 1\n@: 2\n",
        WORLD + "description: !@ a\n",
        "world: world.yaml\ncommands: [{sense: {angle: @}}]\n",
        "world: world.yaml\nfilter: @\ncommands: []\n",
        "world: @.yaml\ncommands: [{say: a}]\n",
    ],
)
def test_no_name_makes_a_message_long(place, text):
    told = told_of(text.replace("@", "a" * 300_000))
    assert len(told) <= 2
    assert len(told[0]) < 300 or "cannot be read: File name too long" in told[0]


def test_more_values_than_a_file_may_have_are_refused_before_a_tree_of_them_is_made(
    place, monkeypatch
):
    monkeypatch.setattr("ekfsim.files.yaml.parsing.LONG", 10)
    monkeypatch.setattr("ekfsim.files.yaml.parsing.MAX_VALUES", 1000)
    monkeypatch.setattr(
        "ekfsim.files.yaml.parsing.Tree.take", lambda *_: pytest.fail("a tree is made")
    )
    told = told_of("world: world.yaml\ncommands:\n" + "  - sense: {angle: 0}\n" * 400)
    assert told == [
        "f.yaml:202:5: the file holds more than 1 000 000 values, aliases written out; write fewer"
    ]


def test_a_kidnap_looks_at_what_lies_there_alone(place, monkeypatch):
    made = []
    monkeypatch.setattr(polygons, "_shapes", lambda rings: made.append(len(rings)) or shapes(rings))
    scene = "world: w.yaml\ncommands:\n" + "  - kidnap: {x: 0.5, y: 0.2, theta: 0}\n" * 40
    (place / "w.yaml").write_text(
        WORLD + "obstacles:\n" + lines(f"  - {{{{name: a{{0}}, {TRIANGLE}}}}}\n", 30)
    )
    with open("f.yaml", "w", encoding="utf-8") as file:
        file.write(scene)
    warnings = check("f.yaml").warnings
    assert len(warnings) == 40 * polygons.MOST_IN_THE_WAY
    assert made == [30, 30]  # the start, and all kidnaps together


BREAKS = ["\n", "\r", "\x85", "\u2028", "\x1b[31m", "\u202e"]
NAMES = {  # where a name of a file's comes into a message; @ is a quoted text with a break in it
    "key": WORLD + '"@": 1\n',
    "key twice": WORLD + '"@": 1\n"@": 2\n',
    "key inside": WORLD + 'belief: {"@": 1}\n',
    "number": WORLD + 'belief: {start: {x: "@", y: 0, theta: 0}}\n',
    "obstacle": WORLD
    + 'obstacles: [{name: "@", points: [[0, 0], [1, 1]]}, {name: "@", points: 3}]\n',
    "missing": WORLD + 'belief: {missing: ["@"]}\n',
    "system": WORLD + 'system: "@"\n',
    "sensor": DRIVEN + 'sensors: [{"@": {}}]\n',
    "colour": DRIVEN + 'sensors: [{infrared: {colour: "@"}}]\n',
    "filter": 'world: world.yaml\nfilter: "@"\ncommands: []\n',
    "guard": 'world: world.yaml\nguard: "@"\ncommands: []\n',
    "world": 'world: "@.yaml"\ncommands: [{say: a}]\n',
    "command": 'world: world.yaml\ncommands: [{"@": a}]\n',
    "recording": 'world: world.yaml\nrecording: {format: "@", path: a}\n',
    "path of a recording": 'world: m.yaml\nrecording: {format: mower, path: "@"}\n',
    "study": 'study: "@"\n',
    "filters": 'study: scene.yaml\nfilters: ["@"]\n',
    "filters twice": 'study: scene.yaml\nfilters: [ekf, ekf, "@"]\n',
    "set": 'study: scene.yaml\nset: {"noise.@": 1}\n',
    "sweep": 'study: scene.yaml\nsweep: {"@": [1]}\n',
    "swept value": 'study: scene.yaml\nsweep: {guard: ["@", "@"]}\n',
    "swept number": 'study: scene.yaml\nsweep: {gate: ["@"]}\n',
    "side": 'study: scene.yaml\na: {filter: "@"}\nb: {"@": 1}\n',
}


@pytest.mark.parametrize("what", NAMES)
def test_no_as_written_a_file_breaks_a_line_of_a_message(place, what):
    (place / "m.yaml").write_text(DRIVEN)
    for sign in BREAKS:
        escaped = "".join(f"\\u{ord(char):04x}" for char in f"a{sign}b")
        (place / "f.yaml").write_text(NAMES[what].replace("@", escaped), encoding="utf-8")
        for load in (
            lambda: check("f.yaml").get(),
            lambda: load_scene("f.yaml"),
            lambda: read_request("f.yaml"),
        ):
            try:
                load()
            except UsageError as error:
                told = str(error)
            else:
                continue
            assert not set("\r\x85\u2028\x1b\u202e") & set(told)
            assert all(line.startswith("f.yaml:") for line in told.split("\n")), told


def test_names_of_files_and_logs_break_no_line_either(place):
    for words in ("a\nb: ok", "a\u2028b", "a\x1b[31m"):
        with pytest.raises(UsageError) as refusal:
            load_scene(f"{words}.yaml")
        assert len(str(refusal.value).splitlines()) == 1
        assert "\x1b" not in str(refusal.value)
