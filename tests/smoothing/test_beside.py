"""A filter and the same smoothed, side by side: in commands, and of a run that fails."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

import numpy as np
import pytest

from ekfsim import load_scene
from ekfsim.errors import StepError, UsageError
from ekfsim.filters.place import absolute, label, parts, stem, with_smoothed
from ekfsim.localization import play
from ekfsim.records import Nees, Step
from ekfsim.smoothing import smooth, smoothed
from ekfsim.smoothing.shares import Shares
from ekfsim.study.block import at_once
from ekfsim.views.driving.course import Course
from ekfsim.views.playback.playback import together

MEDIAN = 2.366  # of χ² with three degrees of freedom


def test_a_place_keeps_what_stands_behind_it() -> None:
    """Of a filter of one's own as of a built-in one."""
    assert with_smoothed(["ekf", "mine.py"]) == (
        *("ekf", "ekf-smoothed", "mine.py", "mine.py-smoothed"),
    )
    place = absolute("mine.py:Mine-smoothed")
    assert label(place) == "mine.py:Mine-smoothed"
    assert stem(place) == "mine-Mine-smoothed"
    assert parts(place)[1] == "Mine"


@pytest.mark.parametrize("name", ["ekf", "ukf", "huber"])
def test_an_honest_filter_is_an_honest_smoother(name: str) -> None:
    """Over all steps half of the NEES lie above the median, and no error grows."""
    scene, runs = load_scene("diverge-00-control").with_(filter=name), np.arange(64)
    filtered = list(play(scene, runs))
    after = list(play(scene.with_(filter=f"{name}-smoothed"), runs))
    judged = [step.nees for step in after if step.nees and step.entry.index]
    assert 0.45 < np.mean([nees.value > MEDIAN for nees in judged]) < 0.57
    assert squares(after) < 0.6 * squares(filtered)


def squares(steps: Sequence[Step]) -> float:
    """The squared errors of position over all steps and runs."""
    known = [(step.posterior.mean, step.entry.truth) for step in steps]
    off = [x[:, :2] - truth[:, :2] for x, truth in known if truth is not None]
    return float(np.sum(np.square(off)))


def test_a_run_that_fails_is_smoothed_up_to_there() -> None:
    """And then fails as it does without."""
    steps = list(play(load_scene("tour")))[:9]

    def failing() -> Iterator[Step]:
        yield from steps
        raise StepError("step 9: what the filter returns is no number")

    coming = smoothed(failing())
    before = [next(coming) for _ in steps]
    assert [one.posterior.mean.tolist() for one in before] == [
        one.posterior.mean.tolist() for one in smooth(steps)
    ]
    with pytest.raises(StepError, match="step 9"):
        next(coming)


def test_runs_that_are_kept_or_of_particles_are_watched_in_portions() -> None:
    """As many at once as the memory holds: of a filter that keeps nothing, all."""
    scene = load_scene("tour")
    assert at_once(scene, 0, 1024) == [(0, 1024)]
    many = scene.with_("filter.particles", 10_000, filter="pf-smoothed")
    assert at_once(many, 5, 1000)[:2] == [(5, 200), (205, 200)]
    drive = load_scene("gnss").with_(filter="ekf-smoothed")
    portions = at_once(drive, 0, 1024)
    assert portions == [(first, 128) for first in range(0, 1024, 128)]
    kept = 128 * 7801 * 4**2  # entries of covariances of so many runs, 7800 motions and the start
    assert kept <= 16_000_000 < kept * 129 / 128


def test_shares_count_what_is_judged() -> None:
    """A certain belief says nothing; an impossible one is beyond every bound."""
    shares, start = Shares(), next(play(load_scene("tour")))
    for value, dof, impossible in ((0.0, 0, False), (2.3, 3, False), (2.4, 3, False),
                                   (17.0, 3, False), (np.nan, 3, True)):  # fmt: skip
        nees = Nees(np.array(value), np.array(dof), np.array(impossible))
        shares.take(replace(start, nees=nees))
    assert (shares.judged, shares.above, shares.lost) == (4, 3, 2)


def test_nobody_drives_what_is_known_at_the_end() -> None:
    """A filter that is smoothed waits for the last reading."""
    with pytest.raises(UsageError, match="ekf-smoothed knows what it believes when"):
        Course(load_scene("tour").with_(filter="ekf-smoothed"))


def test_where_a_smoothed_filter_parts_is_not_told() -> None:
    """It is meant to; between two filters it still is."""
    scene = load_scene("tour")
    names = "ekf", "ekf-smoothed", "iekf"
    runs = [play(scene.with_(filter=name)) for name in names]
    view = next(iter(together(runs[0], runs[1:], names)))
    assert [apart.names for apart in view.apart] == [("ekf", "iekf")]
