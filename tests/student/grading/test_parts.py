"""What is looked at in a submission: right filters earn all, wrong ones what is right of them."""

import numpy as np
import pupils
import pytest

from ekfsim.errors import InputError
from ekfsim.records import Control
from ekfsim.student.fault import FaultError
from ekfsim.student.grading.parts.honesty import graded_honesty, of_reference, tally_of
from ekfsim.student.grading.parts.jacobians import graded_jacobian, numerical_derivative
from ekfsim.student.grading.parts.steps import graded_steps
from ekfsim.student.grading.sound import refuse_unsound
from ekfsim.study.plan import Case
from ekfsim.study.results import Result
from ekfsim.study.verdict import Verdict

PROVIDED = "provided: [f, h, M, R, H]"


def steps(asked, folder, text, partial="halves", scene="square", runs=2):
    homework, bench, scores = asked(
        f"steps: {{scenes: [{scene}], runs: {runs}, partial: {partial}}}"
    )
    keys = homework.keys.parts[0].steps
    return graded_steps(scores[0], keys, bench, pupils.pupil(folder, text))


@pytest.mark.parametrize("partial", ["halves", "steps", "none"])
def test_a_right_filter_earns_everything(asked, tmp_path, partial):
    score = steps(asked, tmp_path, pupils.RIGHT, partial)
    assert (score.cents, score.status, score.first_wrong, score.fault) == (1000, "passed", "", "")
    assert score.words[0].startswith("all 16 steps are right, to ")


def test_a_wrong_reading_costs_the_half_that_readings_are_worth(asked, tmp_path):
    """Of the square's two runs, four moves and four readings each, no reading is right."""
    found = {
        partial: steps(asked, tmp_path, pupils.MINUS, partial)
        for partial in ("halves", "steps", "none")
    }
    assert {partial: score.cents for partial, score in found.items()} == {
        "halves": 500, "steps": 500, "none": 0,
    }  # fmt: skip
    for score in found.values():
        assert score.status == "failed"
        assert score.first_wrong == "square run 0: step 2 (sense -90°)"
        assert score.words[0].startswith(
            "first wrong number: run 0, step 2 (sense -90°): x is 5.52256328, where 5.55246823 is "
            "right: 1.16 σ; "
        )
        assert score.words[1].startswith("innovation-sign: ")
        assert score.words[-1] == "0 of 8 readings are right"
        assert [(one.mistake, one.scene, one.steps) for one in score.shown] == [
            ("innovation-sign", "square", 8)
        ]


def test_moves_that_are_right_by_chance_count_as_right(asked, tmp_path):
    """The first move of a run begins in certainty, where J_x means nothing: one of four."""
    score = steps(asked, tmp_path, pupils.AFTER)
    assert score.cents == 500 + 125
    assert score.first_wrong == "square run 0: step 3 (move 3 m, 90°)"
    assert score.words[-2:] == ("2 of 8 moves are right", "8 of 8 readings are right")
    assert [one.mistake for one in score.shown] == ["J_x-after-move"]


@pytest.mark.parametrize("partial", ["halves", "steps"])
def test_who_does_nothing_earns_nothing(asked, tmp_path, partial):
    """Its P stays 0, for which no reading would change anything: right by chance is not right."""
    lazy = "def predict(x, P, u, motion):\n    return motion.f(x, u), P\n\n\n"
    lazy += "def update(x, P, z, sensor):\n    return x, P\n"
    score = steps(asked, tmp_path, lazy, partial)
    assert score.cents == 0
    nothing = "for 8 of them its own belief left nothing to do"
    assert score.words[-2:] == ("0 of 8 moves are right", f"0 of 8 readings are right; {nothing}")


def test_who_fails_at_readings_has_half_for_the_moves(asked, tmp_path, monkeypatch):
    """After each failure it goes on from what the reference believes."""
    monkeypatch.chdir(tmp_path)
    score = steps(asked, tmp_path, pupils.FAILS)
    assert (score.cents, score.status) == (500, "failed")
    assert score.fault == "mine.py:25: step 2 (sense -90°): ZeroDivisionError: division by zero"
    assert score.words == (
        f"the code failed: run 0: {score.fault}", "it fails at 7 more steps",
        "8 of 8 moves are right", "0 of 8 readings are right",
    )  # fmt: skip


def test_who_fails_once_loses_that_step_alone(asked, tmp_path):
    lines = "    if not hasattr(update, 'asked'):\n        update.asked = True\n        1 / 0\n"
    score = steps(asked, tmp_path, pupils.RIGHT.replace("    J = s", lines + "    J = s"))
    assert score.words[1:] == ("8 of 8 moves are right", "7 of 8 readings are right")
    assert score.cents == 500 + 500 * 7 // 8


def test_after_an_answer_that_is_no_belief_it_goes_on_too(asked, tmp_path):
    text = pupils.RIGHT.replace("(np.eye(3) - K @ J) @ P", "P - 3 * K @ J @ P")
    score = steps(asked, tmp_path, text)
    assert score.words[-2:] == ("8 of 8 moves are right", "0 of 8 readings are right")
    assert score.cents == 500


def test_an_object_that_failed_half_way_goes_on_from_the_right_belief(asked, tmp_path):
    text = """\
import numpy as np


class Mine:
    def __init__(self, x, P):
        self.x, self.P = x, P

    def predict(self, u, motion):
        F, G = motion.F(self.x, u), motion.G(self.x, u)
        self.x, self.P = motion.f(self.x, u), F @ self.P @ F.T + G @ motion.M(u) @ G.T

    def update(self, z, sensor):
        self.x, self.P = self.x + 1, 2 * self.P
        raise ValueError
"""
    score = steps(asked, tmp_path, text)
    assert score.words[-2:] == ("8 of 8 moves are right", "0 of 8 readings are right")


def test_who_ends_its_process_fails_at_all_that_is_left(asked, tmp_path):
    """As it is told by a process that has gone: again and again."""
    homework, bench, scores = asked("steps: {scenes: [square], runs: 2}")
    mine, calls = pupils.pupil(tmp_path, pupils.RIGHT), iter(range(10**3))

    def call(asked):
        if next(calls) > 2:
            raise FaultError("mine.py", "ended its process with status 0")
        return alive(asked)

    alive, mine.call = mine.call, call
    score = graded_steps(scores[0], homework.keys.parts[0].steps, bench, mine)
    assert score.words[-2:] == ("2 of 8 moves are right", "1 of 8 readings are right")


def test_what_is_handed_out_is_all_that_there_is(asked, tmp_path):
    homework, bench, scores = asked("steps: {scenes: [square]}")
    text = pupils.RIGHT.replace("F(x, u, motion)), np", "motion.F(x, u)), np")
    score = graded_steps(
        scores[0], homework.keys.parts[0].steps, bench, pupils.pupil(tmp_path, text, ["f", "h"])
    )
    assert score.fault.endswith("motion.F is not provided; write this one yourself")


def test_of_another_robot_mistakes_are_told_in_its_own_names(asked, tmp_path):
    score = steps(asked, tmp_path, pupils.MINUS, scene="proof-marker-behind", runs=1)
    told = next(words for words in score.words if words.startswith("innovation-sign: "))
    assert "h − z" in told
    assert "J_H" not in told
    assert "eq" not in told


def test_other_systems_are_graded_too(asked):
    """Their reference in the place of a student's filter."""
    _, bench, _ = asked("steps: {scenes: [pioneer]}")
    reached = bench.reached("pioneer", 0, "ekf")
    assert min(reached) > 10


# derivatives


def jacobian(asked, folder, text, name="F", scenes="tour"):
    homework, bench, scores = asked(
        f"jacobians: {{functions: [{name}], scenes: [{scenes}]}}", head=PROVIDED.replace(", H", "")
    )
    keys = homework.keys.parts[0].jacobians
    return graded_jacobian(scores[0], keys, bench, pupils.pupil(folder, text, ["f", "h", "H"]))


@pytest.mark.parametrize("name", "FGH")
def test_right_derivatives_earn_everything(asked, tmp_path, name):
    score = jacobian(asked, tmp_path, pupils.RIGHT, name)
    assert (score.cents, score.status) == (1000, "passed")
    number = 15 if name == "H" else 8
    assert score.words == (f"all {number} are right",)


def test_a_wrong_derivative_is_told_with_both_numbers(asked, tmp_path):
    score = jacobian(asked, tmp_path, pupils.SIGN)
    assert score.status == "failed"
    assert score.first_wrong.startswith("tour: step 1 (move 3 m, 90°): F[0, 2] is ") or (
        "the numerical derivative is" in score.first_wrong
    )
    assert "; the numerical derivative is " in score.words[0]
    assert score.words[1].endswith(" of 8 are right")


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (pupils.RIGHT.replace("def F(", "def J("), "there is no function F(x, u, motion)"),
        (pupils.RIGHT.replace("return [[1, 0", "return None and [[1, 0"), "F returns nothing"),
        (pupils.RIGHT.replace("[0, 0, 1]]", "]"), "F has the shape (2, 3), not (3, 3)"),
        (pupils.RIGHT.replace("[0, 0, 1]]", "[0, 0, np.nan]]"), "F[2, 2]"),
        (pupils.RIGHT.replace("def F(x, u, motion):", "def F(x, u, motion):\n    motion.F(x, u)"),
         "motion.F is not provided; write this one yourself"),
    ],
)  # fmt: skip
def test_a_derivative_that_is_none_earns_nothing(asked, tmp_path, text, told):
    score = jacobian(asked, tmp_path, text)
    assert (score.cents, score.status) == (0, "failed")
    assert told in score.fault or told in score.words[0]


def test_numerical_derivatives_are_those_of_the_models(asked):
    """Held against ours, which other tests hold against others."""
    _, bench, _ = asked("steps: {scenes: [tour]}")
    seen = set()
    for step in bench.by_itself("tour", 0, "ekf"):
        given, x = step.asked.given, step.asked.x
        names = "FG" if isinstance(given, Control) else "H"
        for name in names:
            ours = getattr(given.motion, name)(x, given.u) if name in "FG" else given.sensor.H(x)
            found = numerical_derivative(name, step.asked)
            if found is not None:
                seen.add(name)
                np.testing.assert_allclose(found, ours, atol=1e-6)
    assert seen == set("FGH")


# honesty


def honesty(asked, folder, text, runs=60):
    homework, bench, scores = asked(f"honesty: {{scenes: [tour], runs: {runs}}}")
    keys = homework.keys.parts[0].honesty
    return graded_honesty(scores[0], keys, bench, pupils.pupil(folder, text))


def test_a_right_filter_is_not_condemned(asked, tmp_path):
    score = honesty(asked, tmp_path, pupils.RIGHT)
    assert (score.cents, score.status) == (1000, "passed")
    assert score.words[0].startswith("at the end of 60 runs: ")
    assert score.words[1].startswith("on the way: nothing against it: NIS 0.9")


def test_a_filter_that_is_too_sure_or_not_sure_enough_is(asked, tmp_path):
    sure = honesty(asked, tmp_path, pupils.AFTER)
    assert sure.cents == 0
    assert "over-confident: " in sure.words[0]
    unsure = honesty(asked, tmp_path, pupils.CAUTIOUS)
    assert unsure.cents == 0
    assert "over-cautious: " in unsure.words[0]


def test_a_right_filter_s_runs_are_those_of_a_study(asked, tmp_path):
    """The same verdict to the last count, though each run is called for by itself."""
    _, bench, _ = asked("honesty: {scenes: [tour], runs: 20}")
    scene = bench.scene("tour")
    theirs = Verdict(
        Result(Case((), scene), tally_of(scene, 20, pupils.pupil(tmp_path, pupils.RIGHT)))
    )
    ours = of_reference(scene, 20)
    for one, other in zip(theirs.at_end.measures, ours.at_end.measures, strict=True):
        assert one.share == other.share
    assert theirs.on_the_way.nis.value == pytest.approx(ours.on_the_way.nis.value, rel=1e-9)


def test_a_fault_in_one_of_many_runs_is_told(asked, tmp_path):
    score = honesty(asked, tmp_path, pupils.FAILS)
    assert score.cents == 0
    assert "ZeroDivisionError" in score.fault


def test_a_scene_in_which_the_reference_itself_fails_is_refused(asked):
    homework, _, _ = asked("honesty: {scenes: [tour, diverge-08-grazing], runs: 100}")
    with pytest.raises(InputError) as refused:
        refuse_unsound(homework)
    (mistake,) = refused.value.mistakes
    assert mistake.field == "parts[0].honesty.scenes[1]"
    assert "the reference itself is not honest there" in mistake.wrong


def test_a_derivative_that_no_scene_asks_for_is_refused(asked, tmp_path):
    (tmp_path / "still.yaml").write_text(
        "world: furnished-room\ncommands: [{move: {distance: 1, angle: 0}}]\n"
    )
    homework, _, _ = asked(
        "jacobians: {functions: [H], scenes: [still.yaml]}", head="provided: [h]"
    )
    with pytest.raises(InputError, match="none of the scenes asks for H"):
        refuse_unsound(homework)
