"""worksheet: a narrative with gaps that can be filled in, and their solution."""

import re
from dataclasses import replace

import pytest
from solver import GAP, Solver

from ekfsim.errors import UsageError
from ekfsim.files.logs import write_log
from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import read_scene
from ekfsim.localization import play
from ekfsim.simulation import simulate
from ekfsim.views.playback.playback import views
from ekfsim.views.words.narrative.narrating import narrate
from ekfsim.views.worksheet.sheets import sheets


def scene(name, **changed):
    return replace(read_scene(packaged("commands")[name]).get(), **changed)


def solution(made):
    rows = re.findall(
        r"^\| (\d+) \| \d+ \| (.*?) \| (\S+) \| (\S+) \|$", made.solution, re.MULTILINE
    )
    return {int(gap): (what, float(value), float(within)) for gap, what, value, within in rows}


@pytest.mark.parametrize("explain", [False, True], ids=["short", "long"])
@pytest.mark.parametrize(
    ("name", "share"),
    [("tour", 0.3), ("tour", 1), ("square", 1), ("proof-corner", 1), ("diverge-01-wrong-wall", 1),
     ("proof-square-twice", 0.5), ("diverge-11-short-returns", 0.4)],
)  # fmt: skip
def test_every_gap_can_be_filled_from_the_sheet_alone(name, share, explain):
    made = sheets(scene(name), share, explain=explain)
    right, answers = solution(made), Solver(made.sheet).solved()
    assert answers.keys() == right.keys() == set(range(1, made.gaps + 1))
    assert {
        gap: (what, answers[gap], value)
        for gap, (what, value, within) in right.items()
        if not abs(answers[gap] - value) <= within
    } == {}
    # and not whatever one answers: a wrong sign is wrong
    passing = [gap for gap, (_, value, within) in right.items() if 2 * abs(value) <= within]
    assert len(passing) <= 0.05 * len(right)


def test_a_recorded_run_has_the_numbers_of_the_run_that_it_is_of(tmp_path):
    played = scene("tour")
    write_log(played, simulate(played), tmp_path / "log", False)
    (tmp_path / "log.yaml").write_text(
        "world: log/world.yaml\nrecording: {format: classroom, path: log}\n"
    )
    made = sheets(read_scene(tmp_path / "log.yaml").get(), 1)
    right, answers = solution(made), Solver(made.sheet).solved()
    assert list(right.values()) == list(solution(sheets(played, 1)).values())
    assert all(abs(answers[gap] - value) <= within for gap, (_, value, within) in right.items())


def test_the_share_is_what_is_asked_for():
    for share in (0.1, 0.3, 0.8):
        made = sheets(scene("tour"), share)
        assert made.gaps == pytest.approx(share * made.numbers, abs=6)
    assert sheets(scene("tour"), 1).gaps == sheets(scene("tour"), 1).numbers


def test_it_is_a_function_of_seed_and_run():
    made = sheets(scene("tour"), 0.3)
    assert made == sheets(scene("tour"), 0.3)
    assert made.sheet != sheets(scene("tour", seed=3), 0.3).sheet
    assert made.sheet != sheets(scene("tour", run=1), 0.3).sheet
    exact = [sheets(scene("proof-square-twice", seed=seed), 0.3) for seed in (1, 2)]
    assert solution(exact[0])
    assert solution(exact[0]) != solution(exact[1])


def narrative(text):
    """What a sheet tells, without the marks of matrices and gaps."""
    blocks = re.findall(r"~~~text\n(.*?)~~~\n", text.partition("## The start")[2], re.DOTALL)
    without_marks = re.sub(r"\(\d+\) ", "", "\n".join(blocks))
    return " ".join(re.sub(r"[\[\]]", " ", without_marks).split())


def test_the_solution_is_the_narrative():
    played = scene("tour")
    told = "".join(narrate(view, played) for view in views(play(played)))
    for share in (0.3, 1):
        assert narrative(sheets(played, share).solution) == " ".join(
            re.sub(r"[\[\]]", " ", told).split()
        )


def test_commands_readings_and_the_truth_are_never_left_out():
    text = sheets(scene("tour"), 1).sheet
    given = r"==>|The odometry|The range is|True state|The true|The robot starts|The noise|First"
    for line in text.splitlines():
        assert not (re.match(given, line) and re.search(GAP, line)), line


def test_what_would_give_a_gap_away_is_a_gap_too():
    """A predicted range is z less the innovation, a standard deviation ν / √NIS."""
    for run in range(5):
        for block in sheets(scene("tour", run=run), 0.3).sheet.split("## Step")[1:]:
            r = re.search(
                r"The innovation is (\S+), its standard deviation (\S+); NIS is (\S+)", block
            )
            if r is None:
                continue
            ν, sd, nis = (re.fullmatch(GAP, each) is not None for each in r.groups())
            assert ν or not re.search(rf"predicted range was {GAP}", block)
            assert nis or not sd


def gone(block, what):
    """Whether each number of a line was left out."""
    found = re.search(rf"^{what}(.*)$", block, re.MULTILINE)
    return [bool(re.search(GAP, part)) for part in found[1].split(", ")] if found else None


def test_the_ellipse_goes_with_what_is_drawn_and_the_state_with_the_gain():
    seen = 0
    for block in sheets(scene("tour"), 0.2).sheet.split("## Step")[1:]:
        matrix = re.search(r"covariance matrix is:\n\[\[(.*)\]\n \[(.*)\]\n", block)
        if matrix and any(re.search(GAP, row.rsplit(maxsplit=1)[0]) for row in matrix.groups()):
            seen += 1
            for radius in re.findall(r"^  m....r radius is (.*)$", block, re.MULTILINE):
                assert radius == "0" or re.fullmatch(GAP, radius)
        gain, state = gone(block, "The Kalman gain is .* = "), gone(block, "Revised state .* = ")
        for left, given in zip(gain or (), state or (), strict=True):
            assert given or not left
    assert seen > 5


def test_an_entry_and_its_mirror_image_are_one_gap():
    rows = re.findall(r"^\[\[(.*)\]\n \[(.*)\]\n \[(.*)\]\]$", sheets(scene("tour"), 1).sheet, re.M)
    assert len(rows) > 20
    for matrix in rows:
        entries = [row.split() for row in matrix]
        assert entries == [list(column) for column in zip(*entries, strict=True)]


def test_a_block_of_fixed_width_ends_where_it_should():
    played = scene("tour", description="Wave.\n~~~~~\nand more")
    sheet = sheets(played, 0.3).sheet
    assert re.search(r"^~{6}text\n(.*\n)+?.*~~~~~\n(.*\n)+?~{6}$", sheet, re.MULTILINE)


@pytest.mark.parametrize(
    ("name", "changed", "line"),
    [
        ("gnss", {}, "the robot obeys no commands: a step of it is of too many numbers"),
        (
            "tour",
            {"filter": "ukf"},
            "the filter is ukf; a worksheet is of ekf, by the assignment's equations",
        ),
        ("tour", {"beside": ("ukf",)}, "is watched by several filters; name one"),
        ("proof-unsure-start", {}, "nothing is calculated in it: it never moves"),
    ],
)
def test_what_no_worksheet_is_made_of(name, changed, line):
    with pytest.raises(UsageError, match=re.escape(f"commands/{name}.yaml: {line}")):
        sheets(scene(name, **changed), 0.3)
