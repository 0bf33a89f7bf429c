"""`ekfsim hunt` writes files that `check` and `study --expect` confirm."""

import yaml
from program import ekfsim


def test_what_is_written_keeps_its_word(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    made = ekfsim("hunt", "furnished-room", "--enough", "0.5", "--lists", "256", "--runs", "300")
    assert made.status == 0
    assert made.err == ""
    assert "Every number that the filter is told is true." in made.out
    assert ekfsim("check", "hunt.yaml", "hunt-world.yaml").status == 0
    held = ekfsim("study", "hunt.yaml", "--expect")
    assert held.status == 0
    assert "lost: kept" in held.out
    again = ekfsim("hunt", "furnished-room", "--enough", "0.5", "--lists", "256", "--runs", "300")
    assert again.status == 2
    assert "exists already" in again.err
    assert len(yaml.safe_load((tmp_path / "hunt.yaml").read_text())["commands"]) <= 8


def test_mistakes_are_told_in_a_line(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for words, told in {
        ("hunt", "mower"): "mower: only the classroom's robot obeys commands; hunt in a room",
        ("hunt", "room", "--goal", "apart"): "name two filters, e.g. --for ekf,iekf",
        ("hunt", "room", "--for", "ekf,ukf", "--goal", "lost"): "apart and numbers take two filters",
        ("hunt", "room", "-o", "a.txt"): "a.txt: a commands file is written; name it e.g. hunt",
    }.items():
        made = ekfsim(*words)
        assert made.status == 2
        assert told in made.err
        assert made.err.count("\n") == 1
