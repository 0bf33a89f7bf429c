"""The verdict of a study: a word for the end, decided or leaning, and a word for the way there."""

from dataclasses import replace

import pytest
from counted import counted

from ekfsim.files.packaged import packaged
from ekfsim.files.scenes.load import read_scene
from ekfsim.study.block import run_block
from ekfsim.study.plan import Case
from ekfsim.study.results import Result, Share
from ekfsim.study.verdict import AtEnd, OnTheWay, Verdict, Word
from ekfsim.systems.drives import Square
from ekfsim.views.study.words import evidence, sentence

RIGHT, CONFIDENT, CAUTIOUS = Word.CONSISTENT, Word.OVER_CONFIDENT, Word.OVER_CAUTIOUS
MANY = {"runs": 100_000, "above": (50_000,), "ellipse": (95_400,)}


def at_end(**made):
    end = AtEnd.of(counted(**made).last)
    return end.word, end.decided


@pytest.mark.parametrize(
    ("made", "word", "decided"),
    [
        ({}, RIGHT, True),
        ({"above": (450,)}, RIGHT, False),
        ({"above": (550,)}, RIGHT, False),
        ({"above": (551,)}, CONFIDENT, False),
        ({"above": (449,)}, CAUTIOUS, False),
        ({"above": (600,)}, CONFIDENT, True),
        ({"above": (400,)}, CAUTIOUS, True),
        ({"ellipse": (934,)}, RIGHT, False),
        ({"ellipse": (933,)}, CONFIDENT, False),
        ({"ellipse": (915,)}, CONFIDENT, True),
        ({"ellipse": (974,)}, RIGHT, False),
        ({"ellipse": (975,)}, CAUTIOUS, False),
        ({"ellipse": (990,)}, CAUTIOUS, True),
        ({"lost_from": {0: 19}}, RIGHT, False),
        ({"lost_from": {0: 20}}, CONFIDENT, False),
        ({"lost_from": {0: 40}}, CONFIDENT, True),
        # most too cautious, and yet 4 % lost
        ({"above": (300,), "lost_from": {0: 40}}, CONFIDENT, True),
        # few lost, but the NEES is too small
        ({"above": (300,), "lost_from": {0: 2}}, CAUTIOUS, True),
        ({"above": (600,), "ellipse": (990,)}, CONFIDENT, True),  # of two faults the dangerous one
        # an ellipse that is a line covers nothing
        ({"ellipse": (0,), "ellipse_runs": (0,)}, RIGHT, True),
        ({"ellipse": (19,), "ellipse_runs": (20,)}, RIGHT, False),  # 20 runs alone have one
        (
            {"judged": (0,), "above": (0,), "ellipse": (0,), "ellipse_runs": (0,)},
            Word.NO_EVIDENCE,
            False,
        ),
        ({"judged": (20,), "above": (10,)}, RIGHT, False),  # of the others nothing is uncertain
        ({**MANY, "ellipse": (93_300,)}, CONFIDENT, False),
        ({**MANY, "ellipse": (93_200,)}, CONFIDENT, True),
        ({**MANY, "ellipse": (93_600,)}, RIGHT, True),
    ],
)
def test_the_word_at_the_end_is_decided_where_no_interval_reaches_over_its_edge(
    made, word, decided
):
    assert at_end(**made) == (word, decided)


@pytest.mark.parametrize(
    ("runs", "above", "ellipse", "word"),
    [
        (20, 12, 19, CONFIDENT),
        (20, 10, 19, RIGHT),
        (20, 8, 19, CAUTIOUS),
        (1, 1, 1, CONFIDENT),
        (300, 150, 286, RIGHT),
    ],
)
def test_few_runs_decide_nothing(runs, above, ellipse, word):
    assert at_end(runs=runs, above=(above,), ellipse=(ellipse,)) == (word, False)


@pytest.mark.parametrize(
    ("above", "inside", "lost"),
    [
        (0.50, 0.954, 0.0),
        (0.56, 0.954, 0.0),
        (0.50, 0.928, 0.0),
        (0.50, 0.954, 0.023),
        (0.53, 0.96, 0.015),
    ],
)
def test_as_many_runs_as_are_told_would_decide(above, inside, lost):
    """Were the shares the same, their intervals would then end at the edge that is in doubt."""

    def end(runs):
        shares = (Share(share * runs, runs) for share in (above, inside, lost))
        above_50, ellipse, gone = shares
        return AtEnd.of(
            counted().last._replace(runs=runs, above_50=above_50, ellipse=ellipse, lost=gone)
        )

    wanted = end(100).runs_to_tell
    assert wanted > 100
    assert [end(times * wanted).decided for times in (0.98, 1.02)] == [False, True]


def on_the_way(**made):
    way = OnTheWay.of(counted(**made))
    return way.word, way.decided, [at.step for at in way.steps]


STEPS = {"above": (500,) * 5, "ellipse": (954,) * 5}


@pytest.mark.parametrize(
    ("made", "word", "decided", "steps"),
    [
        ({"nis": (1.25, 10_000)}, None, False, []),
        ({"nis": (1.251, 10_000)}, CONFIDENT, True, []),
        ({"nis": (0.8, 10_000)}, None, False, []),
        ({"nis": (0.799, 10_000)}, CAUTIOUS, True, []),
        ({"nis": (1.4, 10)}, CONFIDENT, False, []),  # ten readings have a mean of 1.4 by chance
        ({"nis": (0.7, 10)}, CAUTIOUS, False, []),
        ({"nis": (0.0, 0)}, None, False, []),  # no reading at all
        ({"beyond": (0, 28, 0, 0, 0)}, None, False, []),  # its interval begins at 1.95 %
        # at 2.03 %, but five steps were looked at
        ({"beyond": (0, 29, 0, 0, 0)}, CONFIDENT, False, [1]),
        ({"beyond": (0, 100, 900, 50, 0)}, CONFIDENT, True, [1, 2, 3]),
        ({"beyond": (1000, 0, 0, 100, 0)}, CONFIDENT, True, [0, 3]),
        ({"beyond": (0, 0, 0, 0, 100), "nis": (0.5, 10_000)}, CONFIDENT, True, [4]),
        ({"beyond": (0, 0, 0, 0, 0), "judged": (0,) * 5, "nis": (0.0, 0)}, None, False, []),
    ],
)
def test_the_word_on_the_way(made, word, decided, steps):
    assert on_the_way(**STEPS, **made) == (word, decided, steps)


@pytest.mark.parametrize(
    ("made", "told"),
    [
        ({}, "consistent at the end"),
        (
            {"runs": 200, "above": (100,), "ellipse": (191,)},
            "leans consistent at the end; about 600 runs would tell",
        ),
        (
            {"runs": 20, "above": (12,), "ellipse": (19,)},
            "leans over-confident at the end; about 400 runs would tell",
        ),
        ({"above": (550,)}, "leans consistent at the end; more runs may tell"),
        (
            {**STEPS, "beyond": (0, 100, 900, 50, 0), "nis": (18.34, 10_000)},
            "consistent at the end, over-confident from step 1 to 3: NIS 18.3",
        ),
        (
            {**STEPS, "beyond": (0, 100, 900, 50, 0)},
            "consistent at the end, over-confident from step 1 to 3: up to 90.0 % beyond 99.9 %",
        ),
        (
            {
                **STEPS,
                "beyond": (0, 100, 900, 50, 0),
                "nis": (0.5, 10_000),
                "times": (0, 0.5, 1.0, 1.5, 2.0),
            },
            "consistent at the end, over-confident from t = 0.5 s to 1.5 s: up to 90.0 % beyond "
            "99.9 %",
        ),
        (
            {**STEPS, "above": (600,) * 5, "beyond": (0, 0, 0, 0, 100)},
            "over-confident at the end, and at step 4: up to 10.0 % beyond 99.9 %",
        ),
        (
            {**STEPS, "above": (600,) * 5, "beyond": (0, 0, 0, 100, 100), "nis": (2.0, 10_000)},
            "over-confident at the end, and from step 3 on: NIS 2",
        ),
        (
            {"above": (400,), "nis": (0.5, 10_000)},
            "over-cautious at the end, and on the way: NIS 0.5",
        ),
        (
            {"above": (400,), "nis": (1.3, 10_000)},
            "over-cautious at the end, over-confident on the way: NIS 1.3",
        ),
        (
            {"runs": 20, "above": (12,), "ellipse": (19,), "nis": (1.4, 10)},
            "leans over-confident at the end; about 400 runs would tell; leans over-confident on "
            "the way: NIS 1.4",
        ),
        (
            {"judged": (0,), "above": (0,), "ellipse": (0,), "ellipse_runs": (0,), "nis": (0.0, 0)},
            "no evidence at the end: no run is uncertain of anything",
        ),
    ],
)
def test_the_sentence_names_both_parts(made, told):
    assert sentence(Verdict(counted(**made))) == told


def test_the_evidence_says_which_way_each_measure_points():
    made = counted(
        runs=20, above=(12, 12), ellipse=(20, 20), beyond=(9, 0), nis=(1.4, 100), outside=(3, 1)
    )
    assert evidence(Verdict(made)) == [
        "60.0 % [38.7, 78.1] end with a NEES above the χ² median, not 45 to 55 %: over-confident",
        "100 % [83.9, 100] end inside the 95.4 % ellipse, not 93.4 to 97.4 %: over-cautious",
        "0 % [0, 16.1] are lost (fewer than 2 % is right)",
        "NIS is 1.4 per number read, where 0.742 to 1.3 is chance, not 0.8 to 1.25: over-confident",
        "15.0 % of the runs have a sum of NIS above its 95 % band, 5.0 % below (2.5 % each is "
        "chance)",
        "45.0 % [25.8, 65.8] lie beyond the χ² 99.9 % quantile at step 0",
    ]
    assert evidence(Verdict(counted(ellipse=(0,), ellipse_runs=(0,), lost_from={0: 30})))[1:3] == [
        "no run ends with an ellipse that has an area: nothing is said of its coverage",
        "3.0 % [2.1, 4.3] are lost, not fewer than 2 %: over-confident",
    ]


def studied(name, runs, filter="ekf", **settings):
    made = replace(read_scene(packaged("commands")[name]).get(), filter=filter, **settings)
    return Verdict(Result(Case((), made), run_block(made, 0, runs)))


def test_a_start_that_is_believed_wrongly_is_no_clean_bill_though_every_run_recovers():
    found = studied("diverge-09-wrong-start", 400)
    assert found.at_end.word is RIGHT
    assert (found.on_the_way.word, found.on_the_way.decided) == (CONFIDENT, True)
    assert found.on_the_way.steps[0].step == 0
    assert found.on_the_way.steps[-1].step < found.result.last.step
    assert found.on_the_way.nis.value > 10


def test_a_filter_that_was_linearised_where_the_tour_ends_is_over_confident_on_the_way():
    tour = Square(2.0, 0.5)
    linear, extended = (studied("pylon", 60, filter, drive=tour) for filter in ("kf", "ekf"))
    assert not (linear.at_end.word is CONFIDENT and linear.at_end.decided)
    assert (linear.on_the_way.word, linear.on_the_way.decided) == (CONFIDENT, True)
    assert not extended.on_the_way.decided


def test_where_nothing_errs_there_is_no_evidence():
    found = studied("proof-no-noise", 20)
    assert (found.at_end.word, found.on_the_way.word) == (Word.NO_EVIDENCE, None)
