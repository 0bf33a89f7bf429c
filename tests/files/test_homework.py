"""A homework file: what it names, and every mistake at its place."""

import pytest
from jsonschema import Draft202012Validator

from ekfsim.errors import InputError
from ekfsim.files.homework import check_homework, read_homework
from ekfsim.files.scenes.check_study import check
from ekfsim.files.template import template
from ekfsim.files.yaml.parsing import parse
from ekfsim.files.yaml.schema import json_schema

PARTS = {
    "steps": "steps: {scenes: [tour]}",
    "jacobians": "jacobians: {functions: [F], scenes: [tour]}",
    "honesty": "honesty: {scenes: [square]}",
    "inputs": "inputs: {exposed: 3}",
}


@pytest.fixture
def homework(tmp_path):
    """Writes a file of these lines, and gives its path."""

    def write(*lines, head="homework: EKF\ntotal: 10\n"):
        path = tmp_path / "homework.yaml"
        path.write_text(head + "\n".join(lines) + "\n")
        return path

    return write


def part(name, points, *kinds):
    told = ", ".join(PARTS.get(kind, kind) for kind in kinds)
    return f"  - {{name: {name}, points: {points}, {told}}}" if told else (
        f"  - {{name: {name}, points: {points}}}"
    )  # fmt: skip


def told(path):
    return [
        str(mistake).replace(str(path.parent) + "/", "")
        for mistake in check_homework(path).mistakes
    ]


def test_the_file_to_start_from_names_its_scenes_and_their_files(tmp_path):
    path = tmp_path / "homework.yaml"
    path.write_text(template("homework"))
    found = read_homework(path)
    assert list(found.scenes) == ["tour", "square"]
    assert found.files[0] == path
    assert [file.name for file in found.files[1:]] == [
        *("tour.yaml", "furnished-room.yaml"),
        *("square.yaml", "room.yaml"),
    ]
    assert found.scenes["tour"].seed == 2
    path.write_text(template("homework").replace("# seed: 2027", "seed: 2027"))
    assert read_homework(path).scenes["tour"].seed == 2027
    assert read_homework(path).digest != found.digest


def test_the_part_that_stands_there_in_comments_can_be_switched_on(tmp_path):
    path, lines = tmp_path / "homework.yaml", template("homework").split("\n")
    first = lines.index("  # - name: Derivatives")
    lines[first : first + 5] = [line.replace("# ", "", 1) for line in lines[first : first + 5]]
    path.write_text("\n".join(lines).replace("total: 100", "total: 130"))
    assert "is handed out" in told(path)[0]
    path.write_text(path.read_text().replace("# provided", "provided"))
    assert told(path) == []
    assert read_homework(path).keys.parts[1].jacobians.functions == ["F", "G", "H"]


def test_a_scene_beside_the_file_is_found_and_counts(homework, tmp_path):
    scene, world = tmp_path / "mine/lesson.yaml", tmp_path / "mine/room.yaml"
    scene.parent.mkdir()
    world.write_text(template("world"))
    scene.write_text(template("commands").replace("world.yaml", "room.yaml"))
    path = homework("parts:", part("a", 10, "steps: {scenes: [mine/lesson.yaml]}"))
    before = read_homework(path)
    assert before.files == (path, scene, world)
    world.write_text(template("world") + "# another\n")
    assert read_homework(path).digest != before.digest


@pytest.mark.parametrize(
    ("parts", "mistake"),
    [
        (
            [part("a", 4, "steps"), part("b", 5, "honesty")],
            "2:8: total: the points of the parts add up to 9, not to 10; "
            "write total: 9, or mend a part",
        ),
        (
            [part("Steps", 4, "steps"), part("steps", 6, "honesty")],
            "5:12: parts[1].name: 'steps' is the name of two parts; rename one",
        ),
        (
            [part("a", 10, "steps", "inputs")],
            "4:5: parts[0]: a part has one of steps, jacobians, honesty, inputs; this has steps "
            "and inputs; make two parts of it",
        ),
        (
            [part("a", 10)],
            "4:5: parts[0]: a part has one of steps, jacobians, honesty, inputs; this has none; "
            "write e.g. steps: {scenes: [tour]}",
        ),
        (
            [part("a", 10, "inputs: {}")],
            "4:35: parts[0].inputs: asks for nothing; write files: 3, or exposed: 100",
        ),
        (
            [part("a", 10, "jacobians")],
            "4:51: parts[0].jacobians.functions[0]: F is to be written, and is handed out: motion "
            "and sensor provide everything; write provided: [f, h, …] without F",
        ),
        (
            [part("a", 10, "steps: {scenes: [tuor]}")],
            "4:44: parts[0].steps.scenes[0]: 'tuor' is neither a file nor one of the packaged "
            "commands; did you mean 'tour'?",
        ),
        (
            [part("a", 10, "steps: {scenes: [none.yaml]}")],
            "4:44: parts[0].steps.scenes[0]: none.yaml: no such file; write its path relative to "
            "this file, or a name that `ekfsim list` shows",
        ),
        (
            [part("a", 9.995, "steps")],
            "4:23: parts[0].points: 9.995 is finer than hundredths; write 9.99",
        ),
        (
            [part("a", 10, "steps: {scenes: [tour, tour]}")],
            "4:43: parts[0].steps.scenes: 'tour' stands twice; delete one",
        ),
        (
            [part("a", ".nan", "steps")],
            "4:23: parts[0].points: .nan is not a finite number; write e.g. 40",
        ),
        (
            [part("a", "true", "steps")],
            "4:23: parts[0].points: true is a yes-or-no value where a number belongs; "
            "write e.g. 40",
        ),
    ],
)
def test_a_mistake_is_told_at_its_place(homework, parts, mistake):
    path = homework("parts:", *parts)
    assert told(path) == [f"homework.yaml:{mistake}"]
    with pytest.raises(InputError):
        read_homework(path)


@pytest.mark.parametrize(
    ("kind", "right"),
    [
        ("inputs: {}", False),
        ("inputs: {files: 1}", True),
        ("steps: {scenes: [tour, tour]}", False),
        ("honesty: {scenes: [square]}", True),
    ],
)
@pytest.mark.parametrize(
    ("more", "right_too"),
    [
        ("", True),
        ("filter: mine.py", True),
        ("filter: mine.txt", False),
        ("filter: /mine.py", False),
        ("provided: [f, f]", False),
        ("provided: []", True),
    ],
)
def test_the_schema_refuses_what_is_refused(homework, kind, right, more, right_too):
    path = homework(more, "parts:", part("a", 10, kind))
    root, _ = parse(path.read_text(), str(path))
    verdict = Draft202012Validator(json_schema("homework")).is_valid(root.plain())
    assert verdict == (told(path) == []) == (right and right_too)


def test_a_scene_s_own_mistakes_are_told_in_its_file_once(homework, tmp_path):
    (tmp_path / "bad.yaml").write_text("world: room\ncommands: [{turm: 3}]\n")
    scenes = "{scenes: [bad.yaml]}"
    path = homework("parts:", part("a", 5, f"steps: {scenes}"), part("b", 5, f"honesty: {scenes}"))
    mistakes = told(path)
    assert len(mistakes) == 1
    assert mistakes[0].startswith("bad.yaml:2:13: commands[0]: 'turm' is not a command;")


def test_points_of_hundredths_add_up(homework):
    """0.1 + 0.2 is not 0.3, but ten and twenty hundredths are thirty."""
    lines = ["parts:", part("a", 0.1, "steps"), part("b", 0.2, "honesty")]
    path = homework(*lines, head="homework: EKF\ntotal: 0.3\n")
    assert told(path) == []


def test_other_kinds_of_files_are_told_apart(homework, tmp_path):
    other = tmp_path / "world.yaml"
    other.write_text(template("world"))
    assert told(other)[0].endswith(
        "this is no homework file; its first key is homework: TITLE; see `ekfsim new homework.yaml`"
    )


def test_a_homework_without_its_title_is_told_as_one(homework):
    path = homework("parts:", part("a", 10, "steps"), head="name: EKF\ntotal: 10\n")
    first, second = (str(mistake) for mistake in check(path).mistakes)
    assert "homework: the key is missing" in first
    assert "unknown key 'name'; known keys here: homework" in second
