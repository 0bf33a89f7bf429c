"""The bounds from which on a promise is broken."""

from dataclasses import dataclass

import pytest

from ekfsim.scene import Expect
from ekfsim.study.expectation import findings
from ekfsim.study.results import Share

NONE = Share(0, 100)


@dataclass
class Found:
    """What a study of 100 runs found, as far as a promise asks for it."""

    nis_above: int = 0
    nis_below: int = 0
    nees_above: int = 0
    nees_below: int = 0
    lost: Share = NONE
    ellipse: Share = NONE
    runs: int = 100

    @property
    def tally(self):
        return self

    of = last = tally


def kept(expect, found):
    """Whether the one promise is kept."""
    (finding,) = findings(expect, found)
    return finding.kept


LEVELS = [
    *(
        ("silent", 39, 0, True),
        ("silent", 20, 19, True),
        ("silent", 40, 0, False),
        ("silent", 20, 20, False),
    ),
    *(("high", 40, 60, True), ("high", 39, 0, False), ("high", 0, 40, False)),
    *(("low", 60, 40, True), ("low", 0, 39, False), ("low", 40, 0, False)),
]


@pytest.mark.parametrize(("level", "above", "below", "expected"), LEVELS)
def test_nis_is_silent_below_40_percent_outside_and_high_or_low_from_there_on(
    level, above, below, expected
):
    assert kept(Expect(nis=level), Found(nis_above=above, nis_below=below)) is expected


@pytest.mark.parametrize(
    ("level", "above", "below", "expected"),
    [
        *(
            ("silent", 19, 0, True),
            ("silent", 10, 9, True),
            ("silent", 20, 0, False),
            ("silent", 10, 10, False),
        ),
        *(
            ("high", 20, 80, True),
            ("high", 19, 0, False),
            ("low", 80, 20, True),
            ("low", 0, 19, False),
        ),
    ],
)
def test_nees_is_silent_below_20_percent_outside_and_high_or_low_from_there_on(
    level, above, below, expected
):
    assert kept(Expect(nees=level), Found(nees_above=above, nees_below=below)) is expected


@pytest.mark.parametrize(("runs", "expected"), [(24, False), (25, True), (50, True), (51, False)])
def test_a_share_on_its_bound_is_kept(runs, expected):
    assert kept(Expect(lost=(0.25, 0.5)), Found(lost=Share(runs, 100))) is expected
    assert kept(Expect(coverage=(0.25, 0.5)), Found(ellipse=Share(runs, 100))) is expected


def test_a_share_of_no_runs_keeps_no_promise():
    assert kept(Expect(coverage=(0, 1)), Found(ellipse=Share(0, 0))) is False
