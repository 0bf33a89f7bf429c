import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from recordings import BEAM, FIRST, MARKER, entry, recording, speeds, wheels

from ekfsim.files.scenes.load import load_scene
from ekfsim.filters import FILTERS
from ekfsim.filters.belief import Correction, Refused
from ekfsim.filters.pf import PF
from ekfsim.localization import play
from ekfsim.models.sensors.echo import Echo
from ekfsim.records import Entry, Reading, Step
from ekfsim.version import VERSION
from ekfsim.views.playback.playback import views
from ekfsim.views.playback.view import View
from ekfsim.views.words.narrative.narrating import narrate
from ekfsim.views.words.numbers import matrix, pose, state

GOLDEN = Path(__file__).with_name("recorded_narrative.txt")


def told(scene):
    return [narrate(view, scene) for view in views(play(scene))]


def test_a_recorded_run_is_told_whole():
    assert "".join(told(recording(description="Nine rows."))) == GOLDEN.read_text().replace(
        "0.1.0", VERSION
    )


@pytest.mark.parametrize("made", [recording(), recording(gate=None), speeds(45, 7)])
# for which no recording has a plan
@pytest.mark.parametrize("filter", sorted(FILTERS.keys() - {"kf-nominal"}))
def test_every_filter_can_be_told(made, filter):
    for text in told(replace(made, filter=filter))[1:]:
        assert text.startswith(("==>", "The predicted reading was ", "No reading was predicted"))
        assert text.endswith("\n\n")
        assert "nan" not in text
        assert not re.search(r"(?<![\w.])-0(?![\w.])", text)


def test_the_start_says_what_should_be_known_of_the_filter():
    remark = "The filter kf: linearised once, at the first belief\n"
    assert remark in told(recording(filter="kf"))[0]
    assert f"The filter pf: {PF.count} particles\n" in told(recording(filter="pf"))[0]
    assert "The filter" not in told(recording())[0]


def test_the_start_says_which_reading_of_the_document_is_followed():
    assert (
        "those of the document as printed, not the corrected ones\n"
        in told(recording(reading="printed"))[0]
    )
    pioneer = replace(load_scene("pioneer"), reading="printed")
    first = narrate(next(views(play(pioneer))), pioneer)
    assert (
        "Of the equations that this run uses none is printed otherwise: they are the corrected "
        "ones\n" in first
    )
    assert "document" not in told(recording())[0]


def test_particles_are_weighed_in_place_of_a_gain():
    story = "".join(told(recording(filter="pf")))
    assert "Kalman gain" not in story
    weighed = re.findall(r"The particles were weighed by the reading(.*)\n", story)
    assert len(weighed) > 1
    for how in weighed:
        assert how == f", and {PF.count} alike ones drawn anew by their weights" or re.fullmatch(
            rf"; the {PF.count} say as much as \d+ alike", how
        )


def test_a_larger_state_is_told_by_its_names():
    first, moved, beam, revised, *_ = told(speeds(9, 3))
    assert (
        "The state is (v, phi, x, y): phi in degrees, all else and the matrices in m, s and rad\n"
        in first
    )
    assert "First state estimate is (v, phi, x, y) = (0, 5.72958, 1, 2)\n" in first
    assert moved.startswith(
        "==>From t = 0.1 s to 0.3 s: 3 motion inputs; the last: left = 0.9 m/s, right = 1.1 m/s, "
        "dt = 0.1 s\n"
    )
    assert beam == "==>At t = 0.3 s gnss was read: x = 1.3 m, y = 2.03 m\n\n"
    assert (
        "The derivatives are (rows x, y; columns v, phi, x, y):\n[[0 0 1 0]\n[0 0 0 1]]\n"
        in revised
    )
    assert "True" not in first + moved + revised
    assert "NEES" not in first + moved + revised


def standing(*instants):
    """Wheels that hardly turn, at these instants."""
    first, *others = [(k, t) for k, t in enumerate(instants)]
    inputs = (entry(k, t, wheels(0.1, 0.1, 0, 0.01), (1, 2, 10)) for k, t in others)
    return recording((entry(*first, None, (1, 2, 10)), *inputs))


def test_an_entry_without_a_clock():
    assert told(standing(None, None, None))[1].startswith(
        "==>2 motion inputs; the last: left = 0.1 m, "
    )
    assert told(standing(None, None))[1].startswith("==>The motion input was: left = 0.1 m, ")


def test_instants_of_a_clock_that_began_long_ago_are_told_since_the_start():
    t = 1248272272.841
    start, text = told(standing(t, t + 0.01, t + 0.02))
    assert "Times are told in s since the start, which the log stamps 1248272272.841\n" in start
    assert text.startswith("==>From t = 0.01 s to 0.02 s: 2 motion inputs;")
    assert "Times" not in told(standing(0.0, 0.01))[0]


def test_zeros_that_are_sums_of_many_steps_are_told_as_zeros():
    numbers = np.array([[0.5, 3e-15], [-3e-15, 0.0]])
    assert matrix(numbers) == "[[0.5 0]\n[0 0]]\n"
    assert matrix(np.array([[2e-13, 0.0], [0.0, 1e-13]])) == "[[2e-13 0]\n[0 1e-13]]\n"
    assert pose([1e-13, -1e-13, -1e-14]) == "(0, 0, 0)"


def test_a_direction_is_told_above_minus_180_and_a_difference_as_it_is():
    reading = Reading(MARKER, np.array([-math.pi, -0.05]), "marker 3")
    c = Correction(
        np.array([-math.pi, -0.05]), np.array([-math.pi, 0.0]), np.eye(2), np.eye(2), np.eye(2, 3),
        np.eye(3, 2),
        np.array(1.0), np.array(0),
    )  # fmt: skip
    step = Step(Entry(1, reading, t=1.0), FIRST, FIRST, correction=c)
    before, after = (narrate(View(1, step, beam), recording()) for beam in (True, False))
    assert "azimuth = 180 degrees" in before
    assert "The predicted reading was azimuth = 180 degrees" in after
    assert "The innovation is azimuth = -180 degrees" in after


def sighted(z, h, refused, K=0.5, S=0.04, nis=1.0):
    c = Correction(
        np.array([h]), np.array([z - h]), np.array([[S]]), np.array([[S]]), np.array([[0.0, 1.0,
        0.0]]),
        np.array([[0.0], [K], [0.0]]), np.array(nis), np.array(int(refused)),
    )  # fmt: skip
    step = Step(
        Entry(3, Reading(BEAM, np.array([z]), "ultrasonic 2"), t=2.5), FIRST, FIRST, correction=c
    )
    return [narrate(View(1, step, beam), recording()) for beam in (True, False)]


@pytest.mark.parametrize(
    ("refused", "line"),
    [
        (Refused.GUARD, "Guard: this ambiguous reading is left out\n"),
        (Refused.GATE, "Gate: this reading is refused, its NIS is too large to be believed\n"),
    ],
)
def test_a_refused_reading_has_no_gain(refused, line):
    _, after = sighted(1.5, 1.4, refused)
    assert line in after
    assert "gain" not in after


def test_one_number_has_a_standard_deviation():
    before, after = sighted(1.5, 1.4, Refused.NOT)
    assert before == "==>At t = 2.5 s ultrasonic 2 was read: range = 1.5 m\n\n"
    assert "The innovation is range = 0.1 m, its standard deviation 0.2 m; NIS is 1\n" in after
    assert "The Kalman gain is (rows x, y, theta; columns range):\n[[0]\n[0.5]\n[0]]\n" in after


def test_nothing_read_and_nothing_predicted():
    before, after = sighted(math.nan, 1.4, Refused.NO_ECHO, nis=math.nan)
    assert before == "==>At t = 2.5 s ultrasonic 2 was read: nothing came back\n\n"
    assert "The predicted reading was range = 1.4 m\n" in after
    assert "No echo: the reading is not used\n" in after
    _, after = sighted(1.5, math.nan, Refused.NO_WALL, nis=math.nan)
    assert after.startswith(
        "No reading was predicted: nothing of the filter's map is within reach there\nNo wall: "
    )


def test_without_any_uncertainty_there_is_no_nis():
    _, after = sighted(1.5, 1.4, Refused.NOT, K=0.0, S=0.0, nis=math.nan)
    assert "range = 0.1 m; nothing is uncertain, so NIS is undefined and the gain is 0\n" in after


def test_a_reading_of_very_many_numbers_is_shortened():
    k = 12
    reading = Reading(Echo(np.arange(float(k)), 0.1), np.arange(float(k)), "echo")
    c = Correction(
        np.arange(float(k)), np.zeros(k), np.eye(k), np.eye(k), np.ones((k, 3)), np.ones((3, k)),
        np.array(12.0),
        np.array(0),
    )  # fmt: skip
    step = Step(Entry(1, reading, t=1.0), FIRST, FIRST, correction=c)
    before, after = (narrate(View(1, step, beam), recording()) for beam in (True, False))
    shown = ", ".join(f"amplitude = {n} V" for n in range(8))
    assert before == f"==>At t = 1 s echo was read: {shown}, … (12 numbers)\n\n"
    assert "[1 1 1]\n…]\nThe innovation is" in after
    assert "its covariance is:\n[[1 0 0 0 0 0 0 0 …]\n" in after
    assert "[[1 1 1 1 1 1 1 1 …]\n[1 1 1 1 1 1 1 1 …]\n[1 1 1 1 1 1 1 1 …]]\nRevised" in after
    assert "NIS is 12 (12 degrees of freedom)" in after


@pytest.mark.parametrize("made", [recording(), speeds(9, 3)])
@pytest.mark.parametrize("filter", sorted(FILTERS.keys() - {"kf-nominal"}))
def test_the_long_form_adds_lines_and_changes_none(made, filter):
    made = replace(made, filter=filter)
    for view in views(play(made)):
        short, long = narrate(view, made), narrate(view, made, explain=True)
        kept = iter(re.sub(r"   \(.*\)$", "", long, flags=re.MULTILINE).splitlines())
        assert all(line in kept for line in short.splitlines())  # in the same order
        assert "nan" not in long
        assert "eq " not in long  # no document of theirs has the assignment's numbers


def test_the_long_form_of_a_drive_has_every_matrix():
    made = recording()
    for view in views(play(made)):
        told, step = narrate(view, made, explain=True), view.step
        if step.prediction is not None:
            F, G, M = (
                step.prediction.F,
                step.prediction.G,
                step.entry.given.motion.M(step.entry.given.u),
            )
            P = step.prior.covariance
            for name, A in (
                ("F", F),
                ("G", G),
                ("M", M),
                ("F P F'", F @ P @ F.T),
                ("G M G'", G @ M @ G.T),
            ):
                assert re.search(
                    rf"^{re.escape(name)} is:.*\n{re.escape(matrix(A))}", told, re.MULTILINE
                ), name
        elif (
            step.correction is not None and not view.beam and not np.isnan(step.correction.S).any()
        ):
            for name in ("R", "S"):
                found = re.escape(matrix(getattr(step.correction, name)))
                assert re.search(rf"^{name} is:.*\n{found}", told, re.MULTILINE), name


def test_the_listing_that_looks_back_is_told_so():
    for reading, before in (("coded", True), ("corrected", False)):
        made = recording(reading=reading)
        text = "".join(narrate(view, made, explain=True) for view in views(play(made)))
        assert ("(h(x), x where the robot stood before the last motion)" in text) == before


def test_the_last_of_many_inputs_is_told_with_what_it_found():
    made = speeds(9, 3)
    view = next(view for view in views(play(made)) if view.inputs > 1)
    x, P = view.step.prior
    assert f"The last input found {state(x, view.layout)} and P:\n{matrix(P)}" in narrate(
        view, made, explain=True
    )


def test_the_head_tells_the_numbers_of_robot_and_sensors_and_what_the_filter_is_told_otherwise():
    mower = load_scene("mower")
    first = narrate(next(views(play(mower))), mower)
    assert "\nThe robot (mower): rate=100, width=" in first
    assert "\nSensor markers: rate=0.5, height=0.226, azimuth_sigma=0.048" in first
    told = replace(mower.world.told, robot=replace(mower.world.robot, width=1.5))
    wrong = replace(mower, world=replace(mower.world, told=told))
    assert "\nThe robot (mower), as the filter is told: width=1.5\n" in narrate(
        next(views(play(wrong))), wrong
    )
    recorded = narrate(next(views(play(recording()))), recording())
    assert "\nThe robot (mower), as the filter is told: rate=100, " in recorded
    assert "\nThe robot (mower): " not in recorded
    assert "starts at" not in recorded  # no one knows where
