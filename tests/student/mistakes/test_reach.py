"""On one scene that comes along the first wrong number of every known mistake is named."""

from dataclasses import replace

import pytest
from textbook import MISTAKES, written

from ekfsim import load_scene
from ekfsim.student.comparing.found import found
from ekfsim.student.comparing.sides import caller_of, runs_of

SCENE = load_scene("proof-every-mistake")
# a student's code is not told the command, which it may know from the file alone
WRITABLE = [name for name, changes in MISTAKES.items() if "motion.command" not in "".join(changes)]


@pytest.mark.parametrize("name", WRITABLE)
def test_the_first_wrong_number_is_found_and_named(name, tmp_path):
    place = tmp_path / "mine.py"
    place.write_text(written(*MISTAKES[name]), encoding="utf-8")
    scene = replace(SCENE, filter=str(place))
    result = found(runs_of(scene, caller_of(scene), "ekf"))
    assert result.fault is None
    assert result.first is not None
    assert [mistake.name for mistake in result.guesses[0]] == [name]
    assert name in {mistake.name for mistake in result.named}


def test_the_right_file_is_found_equal(tmp_path):
    place = tmp_path / "mine.py"
    place.write_text(written(), encoding="utf-8")
    scene = replace(SCENE, filter=str(place))
    result = found(runs_of(scene, caller_of(scene), "ekf", runs=5))
    assert result.equal
    assert result.steps == 40
    assert len(WRITABLE) > 130
