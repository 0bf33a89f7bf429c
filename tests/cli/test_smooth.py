"""--smooth: a filter and the same smoothed, side by side."""

import pytest
from program import ekfsim


@pytest.mark.parametrize("asked", [["run", "square"], ["study", "square", "--runs", "64"]])
def test_both_have_a_row(asked):
    """A study tells of all steps, too, for both are one at the last."""
    said = ekfsim(*asked, "--smooth")
    assert said.status == 0, said.err
    rows = [line for line in said.out.splitlines() if line.startswith(("ekf  ", "ekf-smoothed "))]
    assert len(rows) == (4 if asked[0] == "study" else 2)
    assert ("Over all steps" in said.out) == (asked[0] == "study")
    assert ("NEES above its χ² median, of all steps" in said.out) == (asked[0] == "run")
    assert "differ from step" not in said.out
