"""A filter and the same smoothed, side by side: in commands, and of a run that fails."""

from collections.abc import Iterator, Sequence

import numpy as np
import pytest

from ekfsim import load_scene
from ekfsim.errors import StepError
from ekfsim.filters.place import absolute, label, parts, stem, with_smoothed
from ekfsim.localization import play
from ekfsim.records import Step
from ekfsim.smoothing import smooth, smoothed
from ekfsim.study import block

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


@pytest.mark.parametrize("name", ["ekf-smoothed", "pf-smoothed", "pf"])
def test_what_is_kept_fits_the_memory(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The runs of a block come in portions, whose steps and particles are few enough; none is left
    out.
    """
    monkeypatch.setattr(block, "MOST_KEPT", 31 * 10)  # the tour has 30 steps behind its start
    monkeypatch.setattr(block, "MOST_PARTICLES", 1000 * 12)
    scene = load_scene("tour").with_(filter=name)
    portions = block.at_once(scene, 5, 25)
    most = 12 if name == "pf" else 10
    assert portions == [(5 + k, min(most, 25 - k)) for k in range(0, 25, most)]
