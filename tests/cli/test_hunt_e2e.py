"""`ekfsim hunt` writes files that `check` and `study --expect` confirm."""

import signal
import time

import pytest
import yaml
from program import ekfsim, started

ENOUGH = ("hunt", "furnished-room", "--enough", "0.5", "--lists", "256", "--runs", "300")


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
        (["room", "--change", "told"], "--change told: name COMMANDS that are to be lost"),
        (["room", "--for", "ekf,pf", "--goal", "numbers"], "pf: does not go on from a mean"),
    ],
)
def test_mistakes_are_told_in_a_line(words, told, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
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
