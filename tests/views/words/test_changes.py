import math
import re
from dataclasses import replace

import numpy as np
import pytest
from recordings import recording
from scenes import DESK, rich, scene, told

from ekfsim.commands import Kidnap, Move, Sense
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry.ellipse import ellipse
from ekfsim.localization import play
from ekfsim.views.picture.panels import reading
from ekfsim.views.playback.playback import together, views
from ekfsim.views.words.captions import notes
from ekfsim.views.words.changes import carried, moved, revised
from ekfsim.views.words.numbers import length

SIGMA = (0.1, 0.1, 0.05)


def captions(run, number=None):
    """What is said of each view, a paragraph each, or of one."""
    every = list(views(play(run)))
    said = [notes(view, run, reading(view, run), 0.954) for view in every]
    return said if number is None else said[number]


def radius(belief):
    return length(float(ellipse(belief.covariance, 0.954).major))


@pytest.mark.parametrize(
    ("to", "said"),
    [
        ((1.3, 1.0, 0.5), "moved 30 cm →"),
        ((1.0, 0.7, 0.5), "moved 30 cm ↓"),
        ((0.8, 1.2, 0.6), "moved 28.3 cm ↖ and turned 5.73° left"),
        ((1.0, 1.0, 0.5 - 0.1), "turned 5.73° right"),
        ((1.0, 1.0, 0.5 + 2 * math.pi), "stays where it is"),
    ],
)
def test_how_far_and_whereto_the_estimate_moved(to, said):
    P = np.eye(3)
    before, after = (Gaussian(np.array(x), P) for x in ((1.0, 1.0, 0.5), to))
    assert moved(before, after) == f"the estimate {said}"


def test_what_shrank_most_is_told_of_a_reading():
    """A beam straight at a wall tells the distance along it and nothing else."""
    run = scene(Sense(-math.pi / 2), start=(3, 1, 0), sigma=(0.2, 0.2, 0))
    view = list(views(play(run)))[2]
    along = math.sqrt(view.belief.covariance[1, 1])
    assert f"; σ along the beam shrank from 20 cm to {length(along)}; " in revised(view, 0.954)


def test_a_beam_along_a_wall_tells_the_heading():
    """From afar a small turn moves a grazing beam's end more than any step aside does."""
    run = scene(Sense(-0.12), start=(0.5, 0.5, 0), sigma=(0.001, 0.001, 0.1))
    view = list(views(play(run)))[2]
    after = math.degrees(2 * math.sqrt(view.belief.covariance[2, 2]))
    assert f"the heading's cone shrank from ± 11.5° to ± {after:.3g}°" in revised(view, 0.954)


@pytest.mark.parametrize(
    ("off", "word"), [(0.0, "as expected"), (0.2, "surprising"), (3.0, "very surprising")]
)
def test_what_a_reading_was_worth_is_told_in_standard_deviations(off, word):
    run = told(
        scene(Sense(0), start=(3, 1, 0), sigma=SIGMA),
        start=np.array([3 + off, 1, 0]),
        sigma=np.array([0.001, 0.1, 0.001]),
    )
    view = list(views(play(run)))[2]
    σ = math.sqrt(float(view.step.correction.nis))
    assert f"the reading was {word} ({σ:.2g}σ)" in revised(view, 0.954)


def test_a_reading_of_several_numbers_is_worth_its_nis():
    said = [note for view in captions(recording(gate=None)) for note in view]
    assert any(re.search(r"the reading was .* \(NIS .* of 2\)$", note) for note in said)


def test_a_move_tells_by_how_much_it_grew():
    run = scene(Move(1, 0.5), Move(1, 0.5), sigma=SIGMA)
    start, first, second = views(play(run))
    assert carried(start, 0.954) == ""
    assert carried(second, 0.954).startswith(
        f"the major radius grew from {radius(first.belief)} to {radius(second.belief)}, "
        "the heading's cone grew from ± "
    )


def test_the_motion_inputs_of_one_view_are_told_together():
    gathered = [view for view in views(play(recording())) if view.inputs > 1]
    assert gathered
    for view in gathered:
        assert f"from {radius(view.before)} to {radius(view.belief)}" in carried(view, 0.954)


def test_the_reading_that_loses_the_run_says_so():
    said = captions(load_scene("diverge-01-wrong-wall"))
    losing = [
        n for n, view in enumerate(said) if any(note.startswith("lost with") for note in view)
    ]
    assert losing == [23]
    assert said[23][0] == (
        "lost with this reading: off by 28.4 cm and 11.3°, before by 11 cm and 3.78°"
    )
    assert "the reading was very surprising (9.1σ)" in said[23][1]


def test_a_start_and_a_step_that_lose_the_run_say_so():
    wrong = told(scene(Move(0.1, 0), sigma=SIGMA), start=np.array([3.0, 1.0, 0.5]))
    assert captions(wrong, 0)[0].startswith("lost from the start: off by 1.99 m")
    carried_away = captions(scene(Kidnap(5, 5, 2), Move(0.1, 0), sigma=SIGMA), 1)
    assert carried_away[0].startswith("lost with this step: off by")
    assert carried_away[1].startswith("the robot was carried away")


def test_a_refused_reading_keeps_its_reason():
    said = [note for view in captions(rich(gate=0.5)) for note in view]
    assert any(
        note.endswith("too far from what was predicted; the estimate stays") for note in said
    )


def test_an_estimate_that_is_no_number_is_said_to_be_none():
    view = list(views(play(scene(Sense(0.3), sigma=SIGMA))))[2]
    x = np.full(3, np.nan)
    view = replace(view, step=replace(view.step, posterior=Gaussian(x, view.belief.covariance)))
    assert revised(view, 0.954) == "the estimate is no number"


def test_the_other_walls_of_an_ambiguous_beam_are_named_and_told_from_corner_to_corner():
    run = scene(Sense(0), start=(4.1, 6, -math.pi / 2), sigma=(0.1, 0.01, 0.01), obstacles=(DESK,))
    range_told, doubt = captions(run, 1)
    assert range_told.startswith("measured 2")
    assert doubt == (
        "ambiguous: from 30 cm to the right it would meet edge 1 of the room's wall, "
        "not edge 3 of desk"
    )
    view = list(views(play(run)))[1]
    assert reading(view, run).walls == pytest.approx(np.array([[[0, 0], [10, 0]]]))


def test_of_several_filters_each_that_a_reading_loses_is_named():
    run = replace(load_scene("diverge-01-wrong-wall"), beside=("ukf", "iekf"))
    first, *others = map(play, run.alone())
    view = list(together(first, others, run.watching))[23]
    said = notes(view, run, None, 0.954)
    assert re.match(r"lost with this reading: ekf \(off by 28.4 cm and 11.3°\), ukf \(", said[0])
    assert "iekf" not in said[0]
    assert said[-1].startswith("ekf: the estimate moved")


def test_where_nothing_was_uncertain_a_reading_teaches_nothing():
    run = told(scene(Sense(0.3)), start=np.array([1.5, 1.0, 0.5]))
    view = list(views(play(run)))[2]
    assert revised(view, 0.954).startswith("nothing was uncertain, so the estimate stays; ")
