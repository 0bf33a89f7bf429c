"""A student's own commands files: read, never trusted, and told of."""

import os

import pytest

from ekfsim.student.grading.parts.inputs import graded_inputs

GOOD = (
    "world: room.yaml\nexpect: {lost: [0, 0.1], runs: 50}\n"
    "commands: [{move: {distance: 2, angle: 30}}, {sense: {angle: 0}}]\n"
)
ROOM = """\
name: room
boundary: [[0, 0], [10, 0], [10, 8], [0, 8]]
start: {x: 3, y: 3, theta: 0}
noise: {executionDstSigmaRatio: 0.05, executionAngSigmaRatio: 0.05, odometryDstSigmaRatio: 0.05,
        odometryAngSigmaRatio: 0.05, rangeSigmaRatio: 0.01}
"""


@pytest.fixture
def graded(asked, tmp_path):
    """Grades a folder with a room and these files; gives both scores, of promises and mistakes."""

    def grade(files, inputs="{files: 2, exposed: 20, commands: 50}"):
        homework, _, scores = asked(f"inputs: {inputs}")
        folder = tmp_path / "anna"
        folder.mkdir()
        (folder / "room.yaml").write_text(ROOM)
        for name, text in files.items():
            (folder / name).write_text(text)
        keys = homework.keys.parts[0].inputs
        return [graded_inputs(score, keys, folder) for score in scores]

    return grade


def test_kept_promises_and_exposed_mistakes_earn_points(graded):
    promises, mistakes = graded({"a.yaml": GOOD, "b.yaml": GOOD})
    assert promises.cents == promises.check.cents == 500
    assert promises.words == (
        "files that keep what they promise: 2; 2 are worth all points",
        "a.yaml: keeps what it promises, over 50 runs",
        "b.yaml: keeps what it promises, over 50 runs",
    )
    assert mistakes.status == "passed"
    assert mistakes.words[0].startswith("known mistakes exposed: ")
    assert "turn-before-move" not in mistakes.words[2]  # b exposes nothing new


def test_a_broken_promise_is_told_with_its_number(graded):
    broken = GOOD.replace("lost: [0, 0.1]", "lost: [0.5, 0.9]")
    promises, _ = graded({"a.yaml": broken, "b.yaml": GOOD})
    assert promises.cents == 250
    assert promises.words[1] == "a.yaml: lost: 0 % of 50 runs, where 50 to 90 % were promised"


def test_fewer_exposed_mistakes_earn_their_share(graded):
    still = "world: room.yaml\ncommands: [{sense: {angle: 0}}]\n"  # of a certain pose: S is R
    _, mistakes = graded({"a.yaml": still}, "{files: 1, exposed: 100}")
    got = int(mistakes.words[0].partition(": ")[2].partition(";")[0])
    assert 0 <= got < 100
    assert mistakes.cents == 500 * got // 100


def test_who_hands_in_no_input_is_told_so(graded):
    for score, summed in zip(
        graded({}, "{files: 1, exposed: 1}"),
        ("files that keep what they promise", "known mistakes exposed"),
        strict=True,
    ):
        assert score.cents == 0
        assert score.words == (
            f"{summed}: 0; 1 is worth all points", "no commands file (.yaml) was handed in"
        )  # fmt: skip


LEADS_OUT = "which lies outside of the folder; hand it in beside, or name one that comes along"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (GOOD.replace("room.yaml", "/etc/passwd"), f"names the world '/etc/passwd', {LEADS_OUT}"),
        (GOOD.replace("room.yaml", "../homework.yaml"), LEADS_OUT),
        (GOOD.replace("room.yaml", "none.yaml"), "none.yaml: no such file"),
        (GOOD.replace("room.yaml", "pipe"), "names the world 'pipe', which is no file"),
        (GOOD.replace("room.yaml", "link.yaml"), LEADS_OUT),
        ("world: room.yaml\ncommands: [{turm: 3}]\n", "a.yaml:2:13: commands[0]: 'turm' is not"),
        (
            "world: room.yaml\ncommands:\n- repeat: {times: 60, commands: [{sense: {angle: 0}}]}\n",
            "has 60 commands, repetitions written out; 50 at most",
        ),
        ("world: pylon\nrecording: {format: pylon, path: /etc}\n", "has a recording"),
        ("world: mower\ndrive: [{v: 0.5, for: 10}]\n", "has a drive"),
        ("world: room.yaml\ncommands: []\n" + "#" * 300_000, "is larger than 200 kB"),
        ("world: room.yaml\ncommands: [{sense: {angle: 0}}]\n", "promises nothing"),
        ("a: &a [1]\nb: [*a, *b", "a.yaml:2:"),
        ("\0", "cannot stand in a text file"),
    ],
)  # fmt: skip
def test_what_cannot_be_graded_is_told_in_a_line(graded, tmp_path, text, told):
    folder = tmp_path / "anna"
    os.symlink("/etc/passwd", tmp_path / "elsewhere.yaml")
    promises, _ = graded({"a.yaml": text}) if "link" not in text and "pipe" not in text else (
        linked(graded, folder, text)
    )  # fmt: skip
    assert promises.cents == 0
    assert promises.status == "failed"
    (line,) = (word for word in promises.words if told in word)
    assert "\n" not in line
    assert str(tmp_path) not in line
    assert "root:" not in line  # nothing of a file outside is told


def linked(graded, folder, text):
    """The same in a folder that holds a link out of it, and a pipe."""
    original = os.mkdir

    def mkdir(path, *args, **named):
        original(path, *args, **named)
        if str(path) == str(folder):
            os.symlink("/etc/passwd", folder / "link.yaml")
            os.mkfifo(folder / "pipe")

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(os, "mkdir", mkdir)
        return graded({"a.yaml": text})


def test_a_link_in_place_of_a_commands_file_is_not_followed(graded, tmp_path):
    secret = tmp_path / "secret.yaml"
    secret.write_text(GOOD)
    promises, _ = graded({"b.yaml": GOOD})
    os.symlink(secret, tmp_path / "anna/a.yaml")
    assert [line for line in promises.words if "a.yaml" in line] == []


def test_a_single_file_has_nothing_beside_it(asked, tmp_path):
    homework, _, scores = asked("inputs: {files: 1}")
    file = tmp_path / "anna.py"
    file.write_text("")
    score = graded_inputs(scores[0], homework.keys.parts[0].inputs, file)
    assert (score.cents, score.status) == (0, "failed")
    assert score.words == (
        "a file was handed in; commands files are looked for beside it, in a folder",
    )
