import math
from dataclasses import replace

import numpy as np
import pytest
from scenes import DESK, scene, told

from ekfsim.commands import Kidnap, Move, Sense
from ekfsim.diagnostics.coverage import inside_cone, inside_ellipse
from ekfsim.diagnostics.nees import nees
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.filters.belief import Gaussian
from ekfsim.localization import play
from ekfsim.views.playback.playback import together, views
from ekfsim.views.playback.view import Judged
from ekfsim.views.words.judgement import fatal, judgement, standing, warns
from ekfsim.views.words.numbers import figure

SIGMA = (0.1, 0.1, 0.05)
WRONG_WALL = load_scene("diverge-01-wrong-wall")


def lines(run, columns=200):
    """Of each view of a run: the view, and how it is judged."""
    return [(view, judgement(view, run, 0.954, columns)) for view in views(play(run))]


def beside(run, *names):
    """The views of a run that several filters watch, and the scene."""
    run = replace(run, filter=names[0], beside=names[1:])
    first, *others = map(play, run.alone())
    return list(together(first, others, run.watching)), run


def test_the_numbers_are_those_of_the_belief_that_is_shown():
    run = scene(Move(1, 0.5), Sense(0.3), Move(1, 0.2), sigma=SIGMA, obstacles=(DESK,))
    for view, line in lines(run)[:-1]:
        measured = nees(view.belief, view.step.entry.truth)
        bound = quantile(0.999, int(measured.dof))
        assert (
            f"NEES {figure(float(measured.value))} "
            f"({int(measured.dof)} dof, 99.9 %: {figure(bound)})" in line
        )
        assert ("NIS" in line) == (view.step.correction is not None)
        if view.step.correction is not None:
            nis = figure(float(view.step.correction.nis))
            assert line.startswith(f"NIS {nis} (99.9 %: {figure(quantile(0.999, 1))})")


@pytest.mark.parametrize(
    ("start", "side"),
    [
        ((1, 1, 0), "inside ellipse and cone"),
        ((1.5, 1, 0), "outside ellipse, inside cone"),
        ((1, 1, 0.2), "inside ellipse, outside cone"),
        ((1.5, 1, 0.2), "outside ellipse and cone"),
    ],
)
def test_which_of_ellipse_and_cone_hold_the_truth_is_said_and_warned_of(start, side):
    run = told(scene(Move(0.1, 0), start=(1, 1, 0), sigma=SIGMA), start=np.array(start, float))
    view, line = lines(run)[0]
    assert f"truth {side}" in line
    stands = standing(view, 0.954)
    pose, truth = Gaussian(*view.belief), view.step.entry.truth
    assert stands.outside_ellipse == (not inside_ellipse(pose, truth, 0.954))
    assert stands.outside_cone == (not inside_cone(pose, truth, 0.954))
    assert stands.warns == warns(view, 0.954) == ("outside" in side)


def test_a_start_that_is_certain_and_right_is_no_alarm():
    view, line = lines(scene(Move(1, 0.5)))[0]
    assert line == "nothing is uncertain, and the estimate is right"
    assert not standing(view, 0.954).warns


def test_a_belief_that_is_certain_of_what_is_not_so_is_impossible():
    run = told(scene(Sense(0.3)), start=np.array([1.5, 1.0, 0.0]))
    view, line = lines(run)[0]
    assert "belief impossible" in line
    assert "lost since step 0" in line
    assert standing(view, 0.954).impossible
    assert standing(view, 0.954).warns


def test_lost_is_said_from_the_reading_on_that_begins_it():
    seen = lines(WRONG_WALL)
    assert [view.number for view, _ in seen if fatal(view)] == [23]
    beam, revised = seen[22], seen[23]
    assert beam[1] == (
        "NIS 81.9 (99.9 %: 10.8) · NEES 5.8 (3 dof, 99.9 %: 16.3) · "
        "truth inside ellipse, outside cone"
    )
    assert revised[1] == (
        "NIS 81.9 (99.9 %: 10.8) · NEES 20341 (3 dof, 99.9 %: 16.3) · "
        "truth outside ellipse and cone · lost since step 13"
    )
    assert all("lost since step 13" in line for _, line in seen[23:])
    assert all("Verdict" not in line for _, line in seen[:-1])
    assert seen[-1][1].startswith("Verdict: lost since step 13 · NEES 31888 (3 dof")


@pytest.mark.parametrize("columns", [118, 80, 40, 20])
def test_a_line_has_no_more_signs_than_its_room(columns):
    for run in (WRONG_WALL, load_scene("tour")):
        for _, line in lines(run, columns):
            assert 0 < len(line) <= columns
    for view, line in lines(WRONG_WALL, columns)[-10:]:
        assert "lost since step 13" in line
        assert warns(view, 0.954)


def test_a_reading_that_is_refused_is_worth_a_number_and_not_used():
    run = scene(Sense(0.3), sigma=SIGMA, gate=0.3)
    run = told(run, start=np.array([1.5, 1.0, math.radians(30)]))
    *_, (view, _) = lines(run)
    assert view.step.correction.refused
    unfinished = replace(view, judged=replace(view.judged, closing=None))
    line = judgement(unfinished, run, 0.954, 200)
    assert line.startswith(
        f"NIS {figure(float(view.step.correction.nis))} (99.9 %: 10.8), not used"
    )


def test_without_an_echo_there_is_no_nis():
    run = scene(Sense(0.3), Move(1, 0), sigma=SIGMA, boundary=None)
    assert all(not line.startswith("NIS") for _, line in lines(run))


def test_where_the_truth_is_unknown_nis_is_told_alone():
    view, _ = lines(scene(Sense(0.3), Move(1, 0), sigma=SIGMA))[2]
    step = replace(view.step, entry=replace(view.step.entry, truth=None), nees=None)
    view = replace(view, step=step, judged=Judged())
    nis = figure(float(step.correction.nis))
    assert judgement(view, WRONG_WALL, 0.954) == f"NIS {nis} (99.9 %: 10.8) · truth unknown"
    assert not warns(view, 0.954)


def test_several_filters_are_judged_each_by_itself():
    seen, run = beside(WRONG_WALL, "ekf", "ukf", "iekf")
    assert judgement(seen[23], run, 0.954, 118) == (
        "ekf: outside, lost since step 13 · ukf: outside, lost since step 13 · "
        "iekf: NEES 10.7, outside"
    )
    two, run_of_two = beside(WRONG_WALL, "ekf", "ukf")
    assert judgement(two[23], run_of_two, 0.954, 118).startswith(
        "ekf: NEES 20341, truth outside both, lost since step 13 · ukf: NEES "
    )
    assert judgement(seen[-1], run, 0.954, 118).startswith(
        "ekf: lost since step 13, outside · ukf: consistent, inside · iekf: "
    )
    assert judgement(seen[-1], run, 0.954, 60).startswith(
        "ekf: lost since 13 · ukf: consistent · iekf: "
    )
    assert warns(seen[-1], 0.954)


def test_one_filter_that_is_lost_is_warned_of_beside_another_that_is_not():
    seen, _ = beside(WRONG_WALL, "ukf", "ekf")
    assert not standing(seen[-1], 0.954).warns
    assert warns(seen[-1], 0.954)


def test_carried_away_the_robot_is_outside():
    run = scene(Kidnap(5, 5, 2), sigma=SIGMA)
    (_, before), (view, after) = lines(run)
    assert "truth inside ellipse and cone" in before
    assert "truth outside ellipse and cone" in after
    assert fatal(view)
