"""worksheet, as its user meets it."""

from pathlib import Path

import pytest
from program import ekfsim, left_in


@pytest.fixture
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    return tmp_path


def test_two_sheets_are_written_whole_or_not_at_all(place):
    told = ekfsim("worksheet", "square", "-o", "week1/sheet.md", "--blanks", "1")
    assert (told.status, told.err) == (0, "")
    gaps = Path("week1/sheet.md").read_text(encoding="utf-8").count(")_________")
    assert told.out.startswith("week1/sheet.md: ")
    assert told.out.endswith(" gaps; week1/sheet-solution.md: what belongs in them\n")
    assert 0 < int(told.out.split()[1]) <= gaps
    Path("week1/sheet.md").unlink()
    again = ekfsim("worksheet", "square", "-o", "week1/sheet.md")
    assert (again.status, again.out) == (2, "")
    assert again.err.startswith("ekfsim: week1/sheet-solution.md: exists already; ")
    assert left_in(place) == ["week1", "week1/sheet-solution.md"]


def test_seed_and_long_form_are_taken(place):
    for name, *args in (("a",), ("b", "--seed", "9"), ("c", "--explain")):
        assert ekfsim("worksheet", "square", "-o", f"{name}.md", *args).status == 0
    a, b, c = (Path(f"{name}.md").read_text(encoding="utf-8") for name in "abc")
    assert a != b
    assert "J_x is:" in c
    assert "J_x is:" not in a


@pytest.mark.parametrize("share", ["0", "1.1", "nan", "half"])
def test_a_share_is_more_than_nothing_and_at_most_all(place, share):
    told = ekfsim("worksheet", "square", "-o", "sheet.md", "--blanks", share)
    assert told.status == 2
    assert "--blanks" in told.err
    assert left_in(place) == []
