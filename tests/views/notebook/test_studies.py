"""A study and a comparison in a notebook have the numbers of the command line, and its words."""

import re

import numpy as np
import pytest

import ekfsim
from ekfsim.errors import UsageError
from ekfsim.files.scenes import load_study
from ekfsim.study.comparison import Comparison, with_sides
from ekfsim.study.plan import Plan
from ekfsim.study.running.doing import total, unkept
from ekfsim.study.running.engines import serial
from ekfsim.views.study import compare_words, words

RUNS = 40
SQUARE = ekfsim.load_scene("square")


def asked(runs=RUNS, filters=None, sweeps=(), settings=(), seed=None):
    return load_study.asked(
        "square", None, runs, seed, filters, sweeps, settings, None, None, None, False
    )


def numbers(result):
    """All that is said of every step, nan as itself."""
    return repr(result.steps)


def nobody(*_):
    """Hears of nothing."""


def without_replays(told, name):
    """What is said without how its runs are played again, which differs."""
    kept = (line for line in told.splitlines() if " run: " not in line)
    return [line.replace(name, "square") for line in kept]


def test_the_numbers_and_the_words_are_those_of_the_command_line():
    ours = ekfsim.study(SQUARE.with_("noise.rangeSigmaRatio", 0.1), RUNS, seed=9, filters="ekf,ukf")
    plan = Plan.of(asked(filters="ekf,ukf", settings=["noise.rangeSigmaRatio=0.1"], seed=9))
    theirs = unkept(plan, serial, nobody)
    assert list(map(numbers, ours.results)) == list(map(numbers, theirs))
    told = words.conclude(plan, theirs)
    assert without_replays(repr(ours), "commands/square.yaml") == without_replays(told, "square")


def test_a_sweep_is_that_of_the_command_line():
    swept = {"noise.rangeSigmaRatio": [0.01, np.float64(0.1)], "gate": ["off", 0.9]}
    ours = ekfsim.study("square", RUNS, swept)
    plan = Plan.of(asked(sweeps=["noise.rangeSigmaRatio=0.01,0.1", "gate=off,0.9"]))
    theirs = unkept(plan, serial, nobody)
    assert list(map(numbers, ours.results)) == list(map(numbers, theirs))
    table = ours.table()
    assert list(table["noise.rangeSigmaRatio"]) == [0.01, 0.01, 0.1, 0.1]
    assert list(table["gate"]) == ["off", 0.9, "off", 0.9]
    assert list(table["lost"]) == pytest.approx([one.last.lost.value for one in theirs])


def test_a_comparison_is_that_of_the_command_line():
    ours = ekfsim.compare(SQUARE, {"filter": "ukf"}, {"noise.rangeSigmaRatio": 0.1}, RUNS)
    comparison = Comparison.of(with_sides(asked(), "filter=ukf", "noise.rangeSigmaRatio=0.1"))
    theirs = total(comparison, comparison.tasks(), serial, nobody)
    assert (
        repr(ours).splitlines()[1:] == compare_words.conclude(comparison, theirs).splitlines()[1:]
    )


@pytest.mark.parametrize("many", [{"filters": ["ekf", "ukf"]}, {}])
def test_the_line_that_plays_a_run_again_plays_it(many):
    scene = SQUARE.with_("noise.odometryDstSigmaRatio", 0.2)
    study = ekfsim.study(scene, RUNS, {"noise.rangeSigmaRatio": [0.01, 0.1]}, **many)
    lines = [line for line in repr(study).splitlines() if "the worst run" in line]
    assert len(lines) == len(study.results)
    for line, result in zip(lines, study.results, strict=True):
        played = eval(line.partition(": ")[2], {"ekfsim": ekfsim, "scene": scene})
        nees = [*played][-1].nees.value
        assert float(nees) == pytest.approx(result.tally.worst.nees, rel=1e-9)


def test_a_filter_of_a_cell_is_studied():
    def predict(x, P, u, motion):
        F, G = motion.F(x, u), motion.G(x, u)
        return motion.f(x, u), F @ P @ F.T + G @ motion.M(u) @ G.T

    ekfsim.bring(predict, lambda x, P, z, sensor: (x, P), name="blind")
    told = ekfsim.study(SQUARE, 5, filters=["ekf", "blind"])
    assert [result.case.filter for result in told.results] == ["ekf", "blind"]


def test_pictures_are_those_of_the_folder():
    study = ekfsim.study(SQUARE, 5)
    assert list(study.figures()) == ["nees", "coverage", "divergence"]
    compared = ekfsim.compare(SQUARE, {"guard": "off"}, {"guard": "skip"}, 5)
    for shown in (study, compared):
        page = shown._repr_html_()
        assert page.count("<img ") == 1
        assert re.search("runs of seed", page)
        assert "data:image/png;base64,iVBOR" in page


@pytest.mark.parametrize(
    ("told", "what"),
    [
        ("runs=0: write a whole number from 1 to", {"runs": 0}),
        ("workers=1.5: write a whole number from 1 to", {"workers": 1.5}),
        ("filter EKF: there is no such filter; did you mean 'ekf'?", {"filters": "EKF"}),
        ("sweep: gate has no values", {"sweep": {"gate": []}}),
        ("sweep: gate needs a list of values", {"sweep": {"gate": 0.9}}),
        ("gate=0.9: the value stands twice; delete one", {"sweep": {"gate": [0.9, 0.9]}}),
        ("sweep: filter is no number of a file; name several by filters=",
         {"sweep": {"filter": ["ekf"]}}),
        ("noise.range=1: unknown key 'range'", {"sweep": {"noise.range": [1]}}),
        ("filter.alpha=1: no filter here (ekf) reads it", {"sweep": {"filter.alpha": [1]}}),
        ("the table would have 10001 rows, more than 10000",
         {"sweep": {"noise.rangeSigmaRatio": range(1, 10002)}}),
    ],
)  # fmt: skip
def test_a_mistake_in_a_study_is_told(told, what):
    with pytest.raises(UsageError) as refused:
        ekfsim.study(SQUARE, **what)
    assert str(refused.value).startswith(told)


@pytest.mark.parametrize(
    ("told", "what"),
    [
        ("nothing is compared; write e.g. a=", {}),
        ("compare: a and b are what either side sets", {"a": SQUARE}),
        ("compare: a and b are the same; let them differ", {"a": {"guard": "warn"}}),
        ("seed: both sides have the same draws; give seed to both", {"a": {"seed": 3}}),
        ("compare: two filters are compared as a=", {"a": {"gate": 0.9}, "filter": "ekf,ukf"}),
        ("gate=5: 5 is not strictly between 0 and 1", {"b": {"gate": 5}}),
    ],
)
def test_a_mistake_in_a_comparison_is_told(told, what):
    with pytest.raises(UsageError) as refused:
        ekfsim.compare(SQUARE, **what)
    assert str(refused.value).startswith(told)


def test_a_number_that_the_filter_is_not_told_is_warned_of_once():
    with pytest.warns(UserWarning, match="only the truth changes") as told:
        ekfsim.study(
            "diverge-02a-odometry-overtrusted", 2, {"noise.odometryDstSigmaRatio": [0.1, 0.2]}
        )
    assert [warning.filename for warning in told] == [__file__]
