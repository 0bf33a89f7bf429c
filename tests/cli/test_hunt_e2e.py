"""`ekfsim hunt` writes files that `check` and `study --expect` confirm."""

import signal
import time

import pytest
import yaml
from program import ekfsim, started

ENOUGH = ("hunt", "furnished-room", "--enough", "0.5", "--lists", "256", "--runs", "300")

FIELD = """
name: field
start: {x: 1, y: 1, theta: 0}
noise: {executionDstSigmaRatio: 0.05, executionAngSigmaRatio: 0.05, odometryDstSigmaRatio: 0.02,
        odometryAngSigmaRatio: 0.02, rangeSigmaRatio: 0.01}
"""
TURN_AND_SENSE = "commands: [move: {distance: 0.5, angle: 90}, sense: {angle: 0}]\n"


def test_what_is_written_keeps_its_word(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = ekfsim(*ENOUGH)
    assert (made.status, made.err) == (0, "")
    assert "Every number that the filter is told is true." in made.out
    assert ekfsim("check", "hunt.yaml", "hunt-world.yaml").status == 0
    held = ekfsim("study", "hunt.yaml", "--expect")
    assert held.status == 0
    assert "lost: kept" in held.out
    again = ekfsim(*ENOUGH)
    assert again.status == 2
    assert "exists already" in again.err
    assert len(yaml.safe_load((tmp_path / "hunt.yaml").read_text())["commands"]) <= 8


def test_the_smallest_wrong_number_keeps_its_word(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "two.yaml").write_text(
        "world: room\ncommands:\n  - say: Hear.\n  - move: {distance: 1, angle: 90}\n"
        "  - sense: {angle: 0}\n"
    )
    made = ekfsim("hunt", "two.yaml", "--change", "told", "--runs", "300")
    assert (made.status, made.err) == (0, "")
    assert "  say: Hear.\n" in made.out
    assert "Not all is as the filter is told:" in made.out
    assert ekfsim("check", "hunt.yaml", "hunt-world.yaml").status == 0
    held = ekfsim("study", "hunt.yaml", "--expect")
    assert held.status == 0
    assert "lost: kept" in held.out
    assert "--lists" not in (tmp_path / "hunt.yaml").read_text()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (["mower"], "mower: only the classroom's robot obeys commands; hunt in a room"),
        (["room", "--goal", "apart"], "name two filters, e.g. --for ekf,iekf"),
        (["room", "--for", "ekf,ukf", "--goal", "lost"], "apart and numbers take two filters"),
        (["room", "-o", "a.txt"], "a.txt: a commands file is written; name it e.g. hunt"),
        (["room", "-o", "/proc/no/hunt.yaml"], "/proc/no/hunt.yaml: cannot be written: No such"),
        (["room", "--change", "told"], "--change told: name COMMANDS that are to be lost"),
        (["room", "--for", "ekf,pf", "--goal", "numbers"], "pf: does not go on from a mean"),
        (["room", "--for", "ekf,ekf-smoothed"], "--for ekf,ekf-smoothed: both believe the same"),
        (["room", "--for", "ekf,ekf"], "--filter ekf,ekf: 'ekf' stands twice; delete one"),
        (["open.yaml", "--change", "start"], "field: no wall says where a start may be"),
        (["told.yaml", "--change", "start"], "room: its `belief` tells the filter a start of its"),
    ],
)
def test_mistakes_are_told_in_a_line(words, told, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "field.yaml").write_text(FIELD)
    (tmp_path / "room.yaml").write_text(
        FIELD.replace("field", "room")
        + "boundary: [[0, 0], [4, 0], [4, 4], [0, 4]]\nbelief: {start: {x: 1.1, y: 1, theta: 0}}\n"
    )
    for name, world in (("open", "field"), ("told", "room")):
        (tmp_path / f"{name}.yaml").write_text(f"world: {world}.yaml\n{TURN_AND_SENSE}")
    made = ekfsim("hunt", *words)
    assert made.status == 2
    assert told in made.err
    assert made.err.count("\n") == 1


def test_ctrl_c_writes_the_best_so_far(tmp_path):
    running = started("hunt", "furnished-room", "--lists", "10000000", "--runs", "50", cwd=tmp_path)
    time.sleep(4)  # a round takes one
    running.send_signal(signal.SIGINT)
    _, err = running.communicate(timeout=60)
    assert running.returncode == 130
    if b"interrupted;" not in err:  # a busy machine: before the first round there is no best
        assert err == b"ekfsim: interrupted\n"
        return
    assert b"lists is kept in hunt.yaml" in err
    assert yaml.safe_load((tmp_path / "hunt.yaml").read_text())["expect"]["runs"] == 50


def test_where_no_fresh_run_does_it_nothing_is_written(tmp_path, monkeypatch):
    """In a field without a wall the best is a run of a thousand."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "field.yaml").write_text(FIELD)
    made = ekfsim("hunt", "field.yaml", "--lists", "40", "--runs", "20")
    assert made.status == 1
    assert made.err.count("\n") == 1
    assert "no run of 40 lists does that" in made.err or "none of 20 fresh ones" in made.err
    assert [one.name for one in tmp_path.iterdir()] == ["field.yaml"]


def test_the_clock_ends_a_comparison_of_numbers(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = ekfsim("hunt", "room", "--for", "huber", "--goal", "numbers", "--budget", "0.001")
    assert made.status == 1
    assert made.err == (
        "ekfsim: huber: has the numbers of ekf in every list that was tried in the 0.001 s of "
        "--budget; --goal apart looks where it is lost more often\n"
    )


def test_every_command_is_told_as_its_file_has_it(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "field.yaml").write_text(FIELD)
    (tmp_path / "all.yaml").write_text(
        "world: field.yaml\ncommands:\n  - move: {distance: 1, angle: 90, slip: 0.5}\n"
        "  - repeat: {times: 3, commands: [sense: {angle: 10}]}\n"
        "  - kidnap: {x: 3, y: 2.5, theta: 30}\n"
    )
    made = ekfsim("hunt", "all.yaml", "--change", "told", "--runs", "20")
    assert made.status == 0
    assert made.out.splitlines()[1:4] == [
        "  move 1 m, turn 90°, slip 0.5",
        "  3 times: sense at 10°",
        "  kidnap to x 3 m, y 2.5 m, 30°",
    ]


OPEN = """
def predict(x, P, u, motion):
    raise ValueError("open")


def update(x, P, z, sensor):
    return x, P
"""


def test_whose_code_fails_is_not_mixed_up(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "other.py").write_text(OPEN)
    (tmp_path / "mine.py").write_text(OPEN.replace('raise ValueError("open")', "return x, P"))
    made = ekfsim("hunt", "room", "--for", "mine.py,other.py", "--goal", "numbers")
    assert (made.status, made.out) == (1, "")
    assert made.err.startswith("other.py:3: step 1 (move ")
    assert made.err.endswith("): ValueError: open; it is what the other is held against\n")


def test_of_a_filter_of_ones_own_a_told_number_is_looked_for_by_its_runs(tmp_path, monkeypatch):
    """Not by its numbers, which is what is usual of a list of commands."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "other.py").write_text(OPEN)
    (tmp_path / "field.yaml").write_text(FIELD)
    (tmp_path / "two.yaml").write_text(f"world: field.yaml\n{TURN_AND_SENSE}")
    made = ekfsim("hunt", "two.yaml", "--for", "other.py", "--change", "told")
    assert made.status == 1
    assert made.err == "other.py:3: run 0, step 1 (move 0.5 m, 90°): ValueError: open\n"
