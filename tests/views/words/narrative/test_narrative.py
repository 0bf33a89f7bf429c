import math
import re
from dataclasses import replace

import numpy as np
import pytest
from scenes import DESK, NOISE, ROOM, SILENT, rich, scene, told, unbounded

from ekfsim.commands import Kidnap, Move, Say, Sense
from ekfsim.diagnostics.ambiguity import Sighting
from ekfsim.filters import FILTERS
from ekfsim.filters.belief import Correction, Gaussian, Prediction, Refused
from ekfsim.filters.tuning import Tuning
from ekfsim.localization import play
from ekfsim.models.motions.move_turn import MoveTurn
from ekfsim.models.sensors.laser import Laser
from ekfsim.provenance import VERSION
from ekfsim.records import Control, Entry, Nees, Reading, Step
from ekfsim.views.playback.playback import views
from ekfsim.views.playback.view import View
from ekfsim.views.words.narrative.narrating import narrate
from ekfsim.views.words.narrative.origins import BY_FILTER
from ekfsim.views.words.numbers import heading
from ekfsim.world import Noise

TURN = math.pi / 2
PLACE = scene(obstacles=(DESK,))
BEFORE = Gaussian(np.array([1.0, -1.25, math.radians(86.5)]), np.zeros((3, 3)))
P = np.array([[0.04, 0.0, -0.001], [0.0, 0.01, 0.0005], [-0.001, 0.0005, 0.0025]])
AFTER = Gaussian(np.array([1.25, 0.5, math.radians(-178.25)]), P)
ASKED = np.array(
    [[0, 0.25, 0], [0.5, 0, 0], [0, 0, 0.1], [0, -0.25, 0], [-0.5, 0, 0], [0, 0.001, -0.1]]
)
TRUTH = np.array([1.15, 0.5, math.pi])
WALLS = PLACE.world.map.walls


def nees(value=0.279, dof=3, impossible=False):
    return Nees(np.array(value), np.array(dof), np.array(impossible))


def said(step, beam=False, place=PLACE, **settings):
    return narrate(View(1, step, beam), place, **settings)


def moved(command=Move(1.75, TURN), bump=-1, measured=nees(), truth=TRUTH):  # noqa: B008
    control = Control(MoveTurn(0.02, 0.03), np.array([1.75991, math.radians(95.8725)]))
    entry = Entry(1, control, truth, command, np.array(bump))
    return Step(entry, BEFORE, AFTER, prediction=Prediction(np.eye(3), np.eye(3, 2)), nees=measured)


def sensed(
    z=2.00572, h=2.00698, wall=2, incidence=80.0, probes=(2,) * 6, nis=0.000359, refused=Refused.NOT
):
    """A reading whose numbers are those of no filter."""
    number = np.array([[0.0665**2]])
    correction = Correction(
        np.array([h]), np.array([z - h]), number, number, np.array([[0, 1.00059, 0.0689879]]),
        np.array([[0.5], [-0.25], [0.125]]), np.array(nis), np.array(int(refused)),
    )  # fmt: skip
    seen = Sighting(
        np.array(wall), np.radians(incidence), BEFORE.mean + ASKED, np.ones(6), np.array(probes),
        np.array(probes) != wall,
    )  # fmt: skip
    entry = Entry(2, Reading(Laser(WALLS, TURN, 0.01), np.array([z])), TRUTH, Sense(TURN))
    return Step(entry, BEFORE, AFTER, correction=correction, remark=seen, nees=nees())


MOVED = """\
==>The robot moved: distance=1.75, angle=90
The odometry measured: distance=1.75991, angle=95.8725
Current state estimate is (x, y, th) = (1, -1.25, 86.5)
New state estimate is (x, y, theta) = (1.25, 0.5, -178.25)
New state covariance matrix is:
[[0.04 0 -0.001]
[0 0.01 0.0005]
[-0.001 0.0005 0.0025]]

True state is (x, y, th) = (1.15, 0.5, 180)
Uncertainty ellipse is:
  minor radius is 0.248158
  major radius is 0.496316
  orientation is 0 degrees
  2*sigma_theta is 5.72958 degrees
The true position lies inside the ellipse, the true heading inside the cone; NEES is 0.279 (3 \
degrees of freedom)

"""
BEAM = """\
==>Commanding the robot to sense at an angle of 90
The range is 2.00572

"""
REVISED = """\
The predicted range was 2.00698
It was expected to meet edge 3 of boundary; the angle between beam and wall is 80 degrees
The derivatives are:
  dh/dx = 0, dh/dy = 1.00059, dh/dth = 0.0689879
The innovation is -0.00126, its standard deviation 0.0665; NIS is 0.000359
The Kalman gain is (x, y, th) = (0.5, -0.25, 0.125)
Revised state estimate: (x, y, theta) = (1.25, 0.5, -178.25)
Revised covariance matrix is:
[[0.04 0 -0.001]
[0 0.01 0.0005]
[-0.001 0.0005 0.0025]]
Uncertainty ellipse is:
  minor radius is 0.248158
  major radius is 0.496316
  orientation is 0 degrees
  2*sigma_theta is 5.72958 degrees
The true position lies inside the ellipse, the true heading inside the cone; NEES is 0.279 (3 \
degrees of freedom)

"""


def test_a_move():
    assert said(moved()) == MOVED


def test_a_sense_is_told_in_two_views():
    assert said(sensed(), beam=True) == BEAM
    assert said(sensed()) == REVISED


def test_a_kidnapping_and_a_word():
    carried = Step(Entry(3, None, TRUTH, Kidnap(3.0, 2.0, -math.pi)), AFTER, AFTER, nees=nees(50.0))
    told = said(carried)
    assert told.startswith(
        "==>The robot was carried away to (x, y, th) = (3, 2, 180); the filter was not told\n"
    )
    assert "NEES is 50 (3 degrees of freedom)\nNEES lies above its 99 % quantile, 11.3449\n" in told
    assert (
        said(Step(Entry(4, None, TRUTH, Say("Now watch.\n")), AFTER, AFTER, nees=nees()))
        == "==>Now watch.\n\n"
    )


def test_the_start_says_what_made_it():
    step = next(iter(play(PLACE)))
    told = narrate(View(0, step), PLACE)
    assert told.startswith(f"ekfsim {VERSION}, ")
    assert "seed 0, run 0" in told.splitlines()[0]
    assert "First state estimate is (x, y, theta) = (1, 1, 30)\n" in told
    assert "[[0 0 0]\n[0 0 0]\n[0 0 0]]\n\nTrue state is (x, y, th) = (1, 1, 30)\n" in told
    assert "NEES is 0 (0 degrees of freedom)\n" in told
    assert "==>" not in told


def lines(text):
    return text.splitlines()


@pytest.mark.parametrize(
    ("step", "beam", "line"),
    [
        (moved(bump=4), False, "It bumped into edge 1 of desk and stopped short of it; the filter "
                               "was not told"),
        (moved(Move(1.0, 0.0, slip=0.25)), False,
         "==>The robot moved: distance=1, angle=0, slip=0.25"),
        (moved(Move(-1.0, -4 * math.pi)), False, "==>The robot moved: distance=-1, angle=-720"),
        (sensed(z=math.nan, refused=Refused.NO_ECHO), True,
         "There is no echo: the beam met no wall"),
        (sensed(z=math.nan, nis=math.nan, refused=Refused.NO_ECHO), False,
         "No echo: the reading is not used"),
        (sensed(h=math.nan, nis=math.nan, wall=-1, refused=Refused.NO_WALL), False,
         "No wall: the reading is not used"),
        (sensed(h=math.nan, nis=math.nan, wall=-1, refused=Refused.NO_WALL), False,
         "No range was predicted: no wall of the filter's map lies that way"),
        (sensed(refused=Refused.GUARD), False, "Guard: this ambiguous reading is left out"),
        (sensed(nis=50.0, refused=Refused.GATE), False,
         "Gate: this reading is refused, its NIS is too large to be believed"),
        (sensed(nis=50.0), False, "NIS lies above its 99 % quantile, 6.6349"),
        (sensed(nis=math.nan), False,
         "The innovation is -0.00126; nothing is uncertain, so NIS is undefined and the gain is 0"),
        (sensed(probes=(2, 2, 1, -1, 1, 2)), True,
         "This beam is ambiguous: expected to meet edge 3 of boundary, but from a pose within 3 "
         "sigma "
         "(turned 5.7 degrees to the left) it would meet edge 2 of boundary, and from another "
         "(0.25 m behind) it would meet no wall"),
        (sensed(h=math.nan, wall=-1, probes=(-1, 4, -1, -1, 7, 4)), True,
         "This beam is ambiguous: expected to meet no wall, but from a pose within 3 sigma "
         "(0.5 m to the right) it would meet edge 1 of desk, and from another "
         "(0.5 m to the left) it would meet edge 4 of desk"),
        (sensed(incidence=7.5), True,
         "This beam grazes its wall: the angle between beam and wall is 7.5 degrees (below 15), "
         "and a small turn would "
         "move its end far"),
        (moved(measured=nees(math.nan, 2, True)), False,
         "The true position lies inside the ellipse, the true heading inside the cone; the belief "
         "is impossible: "
         "the error has a part where the covariance claims certainty"),
        (moved(measured=nees(1.0, 1)), False,
         "The true position lies inside the ellipse, the true heading inside the cone; "
         "NEES is 1 (1 degree of freedom)"),
        (moved(truth=np.array([1.25 - 0.5, 0.5, 0.0])), False,
         "The true position lies outside the ellipse, the true heading outside the cone; "
         "NEES is 0.279 (3 degrees of freedom)"),
    ],
)  # fmt: skip
def test_every_line_of_its_own(step, beam, line):
    assert line in lines(said(step, beam))
    assert line not in MOVED + BEAM + REVISED


def test_what_was_not_used_has_no_gain():
    for refused in set(Refused) - {Refused.NOT}:
        assert "Kalman gain" not in said(sensed(refused=refused))


def test_without_a_guard_an_ambiguous_beam_is_not_told_and_a_grazing_one_is():
    unguarded = replace(PLACE, guard="off")
    assert said(sensed(probes=(1,) * 6), beam=True, place=unguarded) == BEAM
    assert "grazes" in said(sensed(incidence=3.0, probes=(1,) * 6), beam=True, place=unguarded)


def test_the_truth_is_told_only_where_it_is_known():
    told = said(moved(truth=None, measured=None))
    assert "true" not in told.lower()
    assert "NEES" not in told


def test_another_confidence_has_another_ellipse_and_cone():
    told = said(moved(), probability=0.5)
    assert "  minor radius is 0.117741\n  major radius is 0.235482\n" in told
    assert "  0.6745*sigma_theta is 1.93227 degrees\n" in told


@pytest.mark.parametrize("name", ["100 % oak", "50%d", "{desk}", "a ==> b", "%(x)s"])
def test_any_name_of_an_obstacle_can_be_told(name):
    place = scene(
        Move(9.0, 0.0),
        Sense(0.0),
        Sense(0.7),
        start=(2, 3.5, 0),
        obstacles=(replace(DESK, name=name),),
    )
    story = "".join(narrate(view, place) for view in views(play(place)))
    assert f" of {name} and stopped short" in story
    assert (
        f"It was expected to meet edge 4 of {name}; the angle between beam and wall is 90 degrees"
        in story
    )


FLOAT = r"-?[\d.]+(?:e[-+]\d+)?"


def numbers(pattern, text):
    found = re.search(pattern, text)
    assert found, (pattern, text)
    return [float(n) for n in re.findall(FLOAT, found[0].split("=", 1)[-1])]


def near(told, values):
    return told == pytest.approx(np.asarray(values, float).ravel(), rel=5.1e-6, abs=1.1e-15)


def pose(x):
    return [x[0], x[1], math.degrees(x[2])]


def turned_alike(told, x):
    return (
        near(told[:2], x[:2])
        and math.cos(math.radians(told[2]) - x[2]) == pytest.approx(1)
        and -180 < told[2] <= 180
    )


@pytest.mark.parametrize("made", [rich(), rich(seed=5, gate=None, guard="skip"), unbounded()])
def test_every_number_told_is_that_of_the_step(made):
    for view in views(play(made)):
        text, step = narrate(view, made), view.step
        for printed in re.findall(rf"(?<![\w.]){FLOAT}(?![\w.])", text):
            assert not re.fullmatch(r"-0(\.0*)?", printed)
        assert "nan" not in text.split()
        assert text.endswith("\n\n")
        if step.entry.command is not None:
            assert text.startswith("==>") == (
                view.beam or not isinstance(step.entry.command, Sense)
            )
        if isinstance(step.entry.command, Move):
            assert turned_alike(numbers(r"New state estimate is .*", text), step.posterior.mean)
            assert turned_alike(numbers(r"Current state estimate is .*", text), step.prior.mean)
            assert turned_alike(numbers(r"True state is .*", text), step.entry.truth)
            d, a = step.entry.given.u
            assert near(numbers(r"odometry measured: distance=.*,", text), [d])
            assert near(numbers(r"measured: distance=.*, angle(=.*)", text)[-1:], [math.degrees(a)])
            assert near(
                numbers(r"covariance matrix is:(?s:.*?)\]\]", text), step.posterior.covariance
            )
        if step.correction is not None and not view.beam:
            assert turned_alike(numbers(r"Revised state estimate: .*", text), step.posterior.mean)
            assert near(
                numbers(r"covariance matrix is:(?s:.*?)\]\]", text), step.posterior.covariance
            )
            if step.correction.refused == Refused.NOT:
                assert near(numbers(r"gain is .*", text), step.correction.K)
                h, ν = step.correction.predicted[0], step.correction.innovation[0]
                assert near(numbers(r"predicted range was .*", text), [h])
                assert near(numbers(r"innovation is .*?,", text), [ν])
                assert near(
                    numbers(r"standard deviation .*?;", text), [math.sqrt(step.correction.S[0, 0])]
                )


def test_no_rounding_error_and_no_minus_zero_is_printed():
    tiny = Gaussian(
        np.array([-0.0, 1e-17, -0.0]),
        np.array([[1e-17, -1e-18, -0.0], [-1e-18, 0, 0], [-0.0, 0, 0]]),
    )
    entry = Entry(
        1,
        Control(MoveTurn(0, 0), np.array([-0.0, -1e-17])),
        np.zeros(3),
        Move(-0.0, -0.0),
        np.array(-1),
    )
    told = said(Step(entry, tiny, tiny, nees=nees(0.0, 0)))
    assert re.findall(r"(?<![\w*])-?0(?![\w.*])", told).count("-0") == 0
    assert "e-1" not in told
    assert "[[0 0 0]\n[0 0 0]\n[0 0 0]]" in told


@pytest.mark.parametrize("filter", ["ekf", "ukf", "ukf-augmented"])
def test_derivatives_that_are_rounding_are_told_as_none(filter):
    made = scene(Sense(math.radians(180)), start=(1, 1, math.pi), sigma=(0.1, 0.1, 0.1),
    boundary=None, filter=filter,
                 obstacles=(replace(DESK, points=np.array([[9, -90], [9, 90], [9.5, 0]])),
                 ))  # fmt: skip
    text = "".join(narrate(view, made, explain=True) for view in views(play(made)))
    assert re.search(r"  dh/dx = -1(\.\d+)?, dh/dy = 0, dh/dth = 0\n", text)
    assert re.search(r"\(x, y, th\) = \(-[\d.]+, 0, 0\)", text)
    assert "e-1" not in text


def test_a_small_variance_beside_a_large_one_is_told_in_the_long_form():
    made = told(scene(Move(1.0, 0.5), noise=SILENT), sigma=np.array([1e6, 1e6, 1e-3]))
    text = "".join(narrate(view, made, explain=True) for view in views(play(made)))
    carried = re.search(r"J_x P J_x' is:\n(.*?\]\])", text, re.DOTALL).group(1)
    assert carried == "[[1e+12 0 -5e-07]\n[0 1e+12 8.66025e-07]\n[-5e-07 8.66025e-07 1e-06]]"


def test_a_covariance_that_is_rounding_is_told_as_none():
    """A wide belief leaves it: after the beam σ_x = 1 cm and σ_θ = 720°, and σ_xθ = 2e-12."""
    made = told(scene(Sense(0.0), start=(1, 1, math.pi), noise=replace(SILENT, range=0.01)),
                sigma=np.array([1e6, 1e-6, 4 * math.pi]))  # fmt: skip
    *_, view = views(play(made))
    assert view.pose.covariance[0, 2] != 0
    assert "Revised covariance matrix is:\n[[0.0001 0 0]\n[0 1e-12 0]\n[0 0 157.914]]\n" in narrate(
        view, made
    )


def test_a_pose_at_map_coordinates_is_not_drawn_back_by_rounding():
    here = np.array([5e6, 9.9e7, 0.0])
    desk = replace(DESK, points=np.array([[9, 3.9], [9.5, 3.9], [9.5, 4.1], [9, 4.1]]) + here[:2])
    for σ in (0.2, 0.23, 0.26, 0.29, 0.32):
        made = scene(
            Sense(0.0),
            start=np.add(here, (5, 4, 0)),
            boundary=ROOM + here[:2],
            sigma=(0.1, σ, 0),
            obstacles=(desk,),
        )
        text = "".join(narrate(view, made, explain=True) for view in views(play(made)))
        assert "it would meet edge" in text
        assert "drawn back" not in text


def test_at_map_coordinates_tenths_of_a_millimetre_are_told():
    """Northing 5 000 000 m: estimate and truth are told apart, and so are two headings."""
    here = np.array([4e5, 5e6, 0.0])
    desk = replace(DESK, points=DESK.points + here[:2])
    made = scene(
        Move(0.01, 0.0), Sense(0.0), start=np.add(here, (1, 3.5, 0)), boundary=ROOM + here[:2],
        obstacles=(desk,),
        sigma=(1e-3, 1e-3, 1e-5),
    )  # fmt: skip
    for view in views(play(made)):
        text = narrate(view, made, explain=True)
        for name, x in (
            ("True state is .*", view.step.entry.truth),
            ("state estimate(?: is|:) .*", view.pose.mean),
        ):
            for found in re.findall(rf"(?:{name}) = \((.*?)\)", text)[-1:]:
                told = [float(number) for number in found.split(", ")]
                assert told == pytest.approx([*x[:2], math.degrees(x[2])], rel=0, abs=0.51e-4)
        if "That edge" in text:
            assert "goes from (400004, 5000004) to (400004, 5000003)\n" in text
    assert heading(math.radians(123.45678)) == "123.4568"


def test_the_head_tells_the_ratios_and_the_start_and_what_the_filter_is_told_otherwise():
    plain = narrate(next(views(play(PLACE))), PLACE)
    assert "\n\n\n" not in plain
    ratios = (
        "executionDstSigmaRatio=0.05, executionAngSigmaRatio=0.04, odometryDstSigmaRatio=0.02, "
    )
    assert (
        f"\nThe noise ratios: {ratios}odometryAngSigmaRatio=0.03, rangeSigmaRatio=0.01\n" in plain
    )
    assert "\nThe robot starts at (x, y, th) = (1, 1, 30)\n" in plain
    assert "as the filter is told" not in plain
    wrong = told(
        scene(sigma=(0.1, 0.2, math.radians(5))),
        noise=replace(NOISE, range=0.5, odometry_angle=0.0),
    )
    text = narrate(next(views(play(wrong))), wrong)
    assert (
        "\nThe noise ratios, as the filter is told: odometryAngSigmaRatio=0, rangeSigmaRatio=0.5\n"
        in text
    )
    assert "(1, 1, 30), each run about it with the standard deviations (0.1, 0.2, 5)\n" in text


LONG_MOVE = """\
P_u is:   (eq 1: (odometryDstSigmaRatio * distance)^2 and (odometryAngSigmaRatio * angle)^2, \
uncorrelated)
[[0.00123891 0]
[0 0.00251991]]
J_x is:   (eqs 5, 6)
[[1 0 0]
[0 1 0]
[0 0 1]]
"""


def test_the_long_form_has_the_assignments_names_and_numbers():
    text = said(moved(), explain=True)
    assert LONG_MOVE in text
    assert (
        "\nNew state estimate is (x, y, theta) = (1.25, 0.5, -178.25)   (eq 4: f(x, u))\n" in text
    )
    assert "\nNew state covariance matrix is:   (eq 7: J_x P J_x' + J_u P_u J_u')\n" in text
    text = said(sensed(), explain=True)
    for line in ("That edge, counted from 1 in the file's order, goes from (10, 8) to (0, 8)",
                 "C_v is 0.00442225   ((rangeSigmaRatio * predicted range)^2)",
                 "S is 0.00442225   (eq 11: J_H P J_H' + C_v)",
                 "Revised covariance matrix is:   (eq 12: (I - K J_H) P)"):  # fmt: skip
        assert line in lines(text)
    ambiguous = said(sensed(probes=(1, 2, 2, 2, 2, 2)), beam=True, explain=True)
    assert "it would meet edge 2 of boundary, from (10, 0) to (10, 8), after 1\n" in ambiguous
    assert "eq 12" not in said(sensed(refused=Refused.GATE), explain=True)


@pytest.mark.parametrize("filter", FILTERS)
def test_no_filter_is_given_the_equations_of_another(filter):
    made = replace(rich(), filter=filter)
    text = "".join(narrate(view, made, explain=True) for view in views(play(made)))
    tangents, at_estimate = (
        filter in ("kf", "kf-nominal"),
        filter in ("ekf", "iekf", "huber", "pdaf", "adaptive", "invariant"),
    )
    weighing = filter in ("huber", "pdaf")
    assert filter in BY_FILTER
    assert (
        ("J_x P J_x' is:" in text)
        == ("(eq 12: (I - K J_H) P" in text or weighing)
        == (tangents or at_estimate)
    )
    assert ("(eq 4: f(x, u))" in text) == ("(eq 8: h(x))" in text) == at_estimate
    assert ("(eq 10: x + K r)" in text) == (
        filter not in ("iekf", "pf", "amcl", "huber", "pdaf", "mhekf", "invariant")
    )
    assert ("J_u P_u J_u' is:" in text) == (filter not in ("pf", "amcl", "ukf-augmented"))
    assert ("x0 the first state estimate" in text) == (filter == "kf")
    assert ("x0 on the nominal trajectory" in text) == (filter == "kf-nominal")
    assert ("sigma points" in text) == filter.startswith("ukf")
    assert ("which hold the noise" in text) == (filter == "ukf-augmented")
    assert ("the mean of the particles" in text) == (filter in ("pf", "amcl"))


def test_the_noise_of_a_range_is_told_as_each_filter_has_it():
    sure = scene(Sense(0.0), sigma=(0.3, 0.3, 0.1), start=(2.0, 2.0, 0.3))
    for name, of in (
        ("ekf", lambda view: view.step.correction.predicted[0]),
        ("kf", lambda view: view.step.entry.given.sensor.h(np.array([2.0, 2.0, 0.3]))[0]),
        ("ukf", lambda view: view.step.entry.given.sensor.h(view.step.prior.mean)[0]),
    ):
        made = replace(sure, filter=name)
        view = list(views(play(made)))[-1]
        told = re.search(r"\nC_v is (\S+)   \((.*)\)\n", narrate(view, made, explain=True))
        assert float(told[1]) == pytest.approx((NOISE.range * of(view)) ** 2, rel=1e-5)
        assert told[2].startswith("(rangeSigmaRatio * ")
    assert "(rangeSigmaRatio * range from the state before)^2" in told[2]


def test_counterexamples_are_told_as_what_they_are():
    made = replace(scene(Move(1.0, 0.5), Sense(0.0), sigma=(0.3, 0.3, 0.1)), tuning=Tuning(
        range_variance="reading", cross_covariances="dropped"))  # fmt: skip
    text = "".join(narrate(view, made, explain=True) for view in views(play(made)))
    assert "((rangeSigmaRatio * range)^2)\n" in text
    assert (
        "(eq 7: J_x P J_x' + J_u P_u J_u'; then sigma_xtheta and sigma_ytheta are set to 0)\n"
        in text
    )
    assert "(eq 12: (I - K J_H) P; then sigma_xtheta and sigma_ytheta are set to 0)\n" in text


def test_a_pose_that_was_drawn_back_is_told_so():
    made = scene(Sense(0.0), start=(3.0, 7.5, 0.0), sigma=(0.01, 0.4, 0.01), obstacles=(replace(
        DESK, points=np.array([[5, 7.8], [6, 7.8], [6, 8], [5, 8.0]])),))  # fmt: skip
    view = list(views(play(made)))[1]
    text = narrate(view, made, explain=True)
    share, y = re.search(
        r"\(3, (\S+), 0\), drawn back to (\S+) of its arm, where the robot can stand", text
    ).group(2, 1)
    assert float(y) == pytest.approx(7.999)
    assert float(share) == pytest.approx(0.499 / 1.2, rel=1e-5)


@pytest.mark.parametrize(
    "degrees", [-180, -179.9999, -179.9996, -179.99951, -179.9995, -179.99949, 180, 179.99999]
)
def test_headings_are_printed_above_minus_180(degrees):
    x = Gaussian(np.array([0, 0, math.radians(degrees)]), P)
    told = said(Step(moved().entry, x, x, nees=nees()))
    (shown,) = set(re.findall(r"estimate is \(.*\) = \(0, 0, (.*)\)", told))
    assert shown != "-180"
    assert float(shown) == pytest.approx(degrees, abs=1e-3) or shown == "180"


def test_a_perfect_laser_is_told_too():
    """Nothing is uncertain along the second beam."""
    made = scene(*[Sense(0.3)] * 3, Sense(1.0), Sense(1.0), Sense(0.3), sigma=(0.1, 0.1, 0.1))
    for seed in range(20):
        perfect = replace(told(made, noise=replace(made.world.noise, range=0.0)), seed=seed)
        assert "==>" in "".join(narrate(view, perfect) for view in views(play(perfect)))


def test_a_small_nis_or_nees_is_no_surprise():
    """0 is the likeliest value of χ²₁; an exact start has NEES 0."""
    for step in (sensed(nis=1e-9), sensed(nis=0.0), sensed(nis=6.63)):
        assert "NIS lies" not in said(step)
    assert "NEES lies" not in said(
        Step(Entry(4, None, TRUTH, Kidnap(1.0, 1.0, 0.0)), AFTER, AFTER, nees=nees(0.0))
    )


def test_a_search_that_was_cut_off_is_told():
    step = sensed()
    assert "did not settle" not in said(step)
    cut_off = replace(step, correction=replace(step.correction, settled=np.array(False)))
    assert "The search for the most probable state did not settle: " in said(cut_off)


def test_the_certainty_of_a_perfect_beam_is_told():
    perfect = replace(PLACE.world.told.noise, range=0.0)
    for noise, sigma, filter, expected in (
        (perfect, 0.1, "ekf", True), (perfect, 0.1, "ukf", False), (PLACE.world.told.noise, 0.1,
        "ekf", False),
        (Noise(0, 0, 0, 0, 0), 0.0, "ekf", False), (perfect, 0.1, "kf", True),
    ):  # fmt: skip
        world = replace(
            PLACE.world, told=replace(PLACE.world.told, noise=noise, sigma=np.full(3, sigma))
        )
        scene = replace(PLACE, world=world, filter=filter)
        text = narrate(View(0, next(iter(play(scene))), False), scene)
        assert ("is told that the range has no noise" in text) == expected
