"""The shortest input that exposes a mistake."""

from dataclasses import replace

from ekfsim.files.scenes.load import load_scene
from ekfsim.files.template import template
from ekfsim.hunting.changes.lists import Space
from ekfsim.hunting.exposing import by_length, exposing, exposure
from ekfsim.student.exposing.exposed import exposed, possible
from ekfsim.student.mistakes.known import KNOWN

ROOM = load_scene({"world": "furnished-room", "commands": []})
RIGHT = template("filter-complete")


def always():
    """There is time."""
    return True


def no_ear():
    """Heeds nothing."""


def test_every_known_mistake_is_exposed_by_three_commands_at_most():
    found = exposing(ROOM, 3)
    assert set(found) == possible(ROOM, KNOWN)  # the others need a robot that has a clock
    assert len(found) >= 143
    for mistake, listed in found.items():
        (shown,) = exposed(replace(ROOM, commands=listed), [mistake])
        assert len(listed) <= 3
        assert shown.first is not None, mistake.name


def test_lists_come_the_short_ones_first():
    lengths = [len(listed) for listed in by_length(ROOM, Space(ROOM.world, 3), 20)]
    assert lengths[0] == 1
    assert max(lengths) == 3
    assert lengths.index(2) < lengths.index(3)
    assert sorted(set(lengths[: lengths.index(2)])) == [1]


def of_own(tmp_path, text):
    (tmp_path / "mine.py").write_text(text)
    return replace(ROOM, filter=str(tmp_path / "mine.py"))


def test_a_planted_mistake_is_found_by_the_least_that_shows_it(tmp_path):
    planted = RIGHT.replace("x + K @ r", "x - K @ r")
    assert planted != RIGHT
    found = exposure(of_own(tmp_path, planted), "ekf", 8, [], no_ear, always)
    assert len(found.scene.commands) == 2  # nothing is uncertain before the first move
    assert found.found.first.step.asked.index == 2
    assert "innovation-sign" in [one.name for guess in found.found.guesses for one in guess]
    assert not found.scene.world.map.obstacles


def test_code_that_fails_is_exposed_too(tmp_path):
    planted = RIGHT.replace("    H, r =", "    raise ValueError('open')\n    H, r =")
    found = exposure(of_own(tmp_path, planted), "ekf", 8, [], no_ear, always)
    assert len(found.scene.commands) == 1
    assert "open" in str(found.found.fault)


def test_a_right_filter_is_not_exposed(tmp_path, monkeypatch):
    monkeypatch.setattr("ekfsim.hunting.exposing.MANY", 10)
    assert exposure(of_own(tmp_path, RIGHT), "ekf", 3, [], no_ear, always) is None
