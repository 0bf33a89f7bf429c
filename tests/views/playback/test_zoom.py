"""The close-up's scale: of a step one, steady from step to step, the same by whichever way."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from scenes import DESK, rich, scene, told

from ekfsim.commands import Move, Sense
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry.ellipse import ellipse
from ekfsim.localization import play
from ekfsim.views.picture.panels import close_width
from ekfsim.views.playback.playback import Playback, views
from ekfsim.views.playback.view import View
from ekfsim.views.playback.zoom import Zoom, one_two_five

RUN = rich()


def widths(*sigmas):
    """Of readings that each leave the position with such a σ, in m, in both directions."""
    (start,) = play(told(scene(), sigma=np.array([1.0, 1.0, 0.1])))
    zoom, chosen, before = Zoom(), [], start.posterior
    for sigma in sigmas:
        after = Gaussian(before.mean, np.diag([sigma**2, sigma**2, 0.01]))
        entry = replace(start.entry, truth=None)
        chosen.append(zoom.take(before, replace(start, entry=entry, posterior=after)))
        before = after
    return chosen


def test_a_prediction_and_its_update_have_one_scale_that_holds_both():
    shown = list(views(play(RUN)))
    for before, after in pairwise(shown):
        if before.beam:
            assert before.across == after.across
    for view in shown:
        larger = max(
            float(ellipse(P[:2, :2], 0.954).major) for _, P in (view.step.prior, view.pose)
        )
        assert view.across >= 2.6 * larger
        assert view.across == one_two_five(view.across)
        assert close_width(view, 0.954, 1.0) == view.across


def test_it_is_steady():
    assert widths(1, 0.3, 0.25, 0.29, 0.3) == [10, 10, 5, 5, 5]
    # just beneath 2 m / (2.6 k), just above, and back: without slack it would change each time
    edge = 2 / (2.6 * 2.4816)
    assert widths(1, 0.99 * edge, 1.01 * edge, 0.99 * edge, 0.99 * edge)[2:] == [5, 5, 5]
    assert widths(1, 0.09, 0.09)[2] == 1  # and becomes narrower where there is much room
    assert widths(1, 0, 0)[2] == 0


def test_whichever_way_a_view_is_reached_its_scale_is_the_same():
    expected = [view.across for view in views(play(RUN))]
    there_and_back = Playback(play(RUN))
    assert [there_and_back.view(n).across for n in (9, 3, 12, 0)] == [
        expected[n] for n in (9, 3, 12, 0)
    ]
    assert len(set(expected)) > 1


def test_the_truth_is_held_where_it_is_near():
    (start,) = play(told(scene(), sigma=np.array([0.1, 0.1, 0.1])))
    radius = 0.1 * 2.4816
    for error, across in ((0.5, 1.0), (2.9, 2.0), (3.1, 1.0)):
        truth = start.posterior.mean + np.array([error * radius, 0, 0])
        step = replace(start, entry=replace(start.entry, truth=truth))
        assert Zoom().take(start.prior, step) == across


def test_a_view_of_no_run_has_a_scale_of_its_own():
    *_, step = play(scene(Move(1.0, 0.2), Sense(0.3), sigma=(0.1, 0.1, 0.1), obstacles=(DESK,)))
    view = View(0, step)
    assert view.across is None
    assert close_width(view, 0.954, 1.0) == Zoom().take(step.prior, step) > 0
    # a larger ellipse asks for more
    assert close_width(view, 0.9999, 1.0) > close_width(view, 0.954, 1.0)


def test_a_belief_that_is_no_number_asks_for_nothing():
    (start,) = play(scene(sigma=(0.1, 0.1, 0.1)))
    P = np.full((3, 3), np.nan)
    step = replace(start, posterior=Gaussian(start.posterior.mean, P))
    assert Zoom().take(start.prior, step) == pytest.approx(1.0)
