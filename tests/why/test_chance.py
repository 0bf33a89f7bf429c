"""A few runs in a thousand of an honest filter are beyond its own bound, and no change is why."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import binomtest, chi2

from ekfsim import load_scene
from ekfsim.localization import play
from ekfsim.study.block import watched
from ekfsim.views.why.answer import answer, sentence
from ekfsim.why import Explanation, Mechanism, explain
from ekfsim.why.trying.chance import by_chance
from ekfsim.why.trying.crowd import Crowd, badly

CONTROL = load_scene("diverge-00-control")
WATCHED = watched(CONTROL, 0, 1000)
LOST = badly(WATCHED, "lost")
NEES = np.asarray(WATCHED.ends.nees.value)
LIKELY = chi2.isf(1e-5, 3)  # of three numbers


def chosen(which):
    """The control with the first of some runs."""
    return replace(CONTROL, run=int(np.flatnonzero(which)[0]))


def test_bad_luck_is_called_so_with_the_share_of_runs_that_have_it():
    found = explain(chosen(LOST & (NEES < LIKELY)))
    assert (found.outcome, found.mechanism, found.causes) == ("lost", Mechanism.CHANCE, ())
    assert found.shares is not None
    assert found.shares.lost == LOST.mean() < 0.005
    interval = binomtest(int(LOST.sum()), 1000).proportion_ci(method="wilson")
    assert (found.shares.low, found.shares.high) == pytest.approx(tuple(interval))
    told = " ".join(answer(found).split())
    assert "Cause: chance" in told
    assert "one run in 1000 ends beyond the 99.9 % bound of its NEES" in told
    assert f"Of 1000 runs {100 * LOST.mean():.1f} % are lost [" in told


def test_bad_luck_has_its_limits():
    """A NEES that no luck brings about; more runs than luck has; too few to know how many."""
    far = chosen(LOST & (NEES > LIKELY))
    assert by_chance(list(play(far)), Crowd(far, 1000, "lost"), "lost") is None
    near = chosen(LOST & (NEES < LIKELY))
    steps = list(play(near))
    assert by_chance(steps, Crowd(near, 1000, "lost"), "lost") is not None
    assert by_chance(steps, Crowd(near, 400, "lost"), "lost") is None
    often = Crowd(load_scene("diverge-12-close-to-the-wall"), 500, "lost")
    assert by_chance(steps, often, "lost") is None


@pytest.mark.parametrize(
    ("outcome", "side"), [("over-confident", "above"), ("over-cautious", "below")]
)
def test_a_sum_outside_its_band_may_be_luck_as_well(outcome, side):
    low, high = chi2.isf([0.995, 0.005], int(WATCHED.readings.dof[0]))
    nis = WATCHED.readings.nis
    outside = (nis > high) & (nis < chi2.isf(1e-5, 64)) if side == "above" else nis < low
    scene = chosen(outside & ~LOST)
    found = by_chance(list(play(scene)), Crowd(scene, 1000, outcome), outcome)
    assert found is not None
    explained = Explanation(scene, outcome, None, mechanism=Mechanism.CHANCE, shares=found)
    assert f"one run in 200 ends {side} the 99 % band of its NIS" in sentence(explained)
