"""Tables and sentences are no wider than the terminal, and as wide as they need where there is
none."""

import pytest

from ekfsim.views.words.text_table import aligned, folded

ROWS = [("filter", "position", "> 50 %", "verdict"), ("ekf", "0.1", "50.2", "consistent")]


def test_without_a_terminal_a_table_is_as_wide_as_it_needs():
    assert aligned(ROWS, 1) == [
        "filter  position  > 50 %     verdict",
        "ekf          0.1    50.2  consistent",
    ]


@pytest.mark.parametrize("width", range(1, 60))
def test_every_cell_stands_in_a_narrow_table_and_its_name_beside_it(width):
    lines = aligned(ROWS, 1, width)
    parts = "\n".join(lines).split("\n\n")
    assert all(part.splitlines()[0].startswith("filter") and "\nekf" in part for part in parts)
    assert [" ".join(lines).count(cell) for cell in (*ROWS[0][1:], *ROWS[1][1:])] == [1] * 6
    if width >= len("filter  consistent"):
        assert max(map(len, lines)) <= width
    assert (len(parts) == 1) == (width >= 36)


def test_a_sentence_goes_on_further_in():
    assert folded("  a long sentence", 12) == ["  a long", "    sentence"]
    assert folded("  a long sentence") == ["  a long sentence"]
    assert folded("a/path/that/cannot/be/broken here", 10) == [
        "a/path/that/cannot/be/broken",
        "  here",
    ]
