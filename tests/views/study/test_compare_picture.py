"""The picture of a comparison, by its artists."""

import math

import numpy as np
import pytest
from numpy.testing import assert_allclose

from ekfsim.files.scenes.load_study import read_request
from ekfsim.study.comparison import Comparison, with_sides
from ekfsim.study.pairs import run_pairs
from ekfsim.study.results import Share
from ekfsim.views.study.compare_picture import picture, told
from ekfsim.views.study.compare_words import measures, sentence, sentences

RUNS = 400


@pytest.fixture(scope="module")
def made():
    request = with_sides(read_request("diverge-01-wrong-wall"), None, "guard=skip,gate=0.99")
    comparison = Comparison.of(request)
    found = run_pairs(comparison.a.cases[0].scene, comparison.b.cases[0].scene, 0, RUNS)
    return comparison, found, picture(comparison, found)


def test_the_share_that_is_lost_is_drawn_over_the_steps(made):
    _, found, figure = made
    axes = figure.axes[0]
    assert [line.get_label() for line in axes.lines] == [
        "a: as the file stands",
        "b: guard=skip, gate=0.99",
    ]
    for line, tally in zip(axes.lines, (found.a, found.b), strict=True):
        x, y = line.get_data()
        lost = [
            sum(n for first, n in tally.lost_from.items() if first <= step) / RUNS
            for step in range(81)
        ]
        assert_allclose(x, range(81))
        assert_allclose(y, lost)
    assert y[-1] < 0.05 < 0.3 < axes.lines[0].get_ydata()[-1]
    high = axes.collections[0].get_datalim(axes.transData).y1
    assert high == pytest.approx(Share(round(RUNS * axes.lines[0].get_ydata()[-1]), RUNS).high)
    assert axes.get_ylim()[0] == 0
    assert axes.get_ylim()[1] >= high


def test_the_last_errors_are_drawn_by_their_size(made):
    _, found, figure = made
    axes = figure.axes[1]
    assert axes.get_xscale() == "log"
    for step, octaves in zip(axes.patches, (found.a_errors, found.b_errors), strict=True):
        values, edges, _ = step.get_data()
        assert np.sum(values) == pytest.approx(1)
        peak = max(octaves, key=octaves.__getitem__)
        assert values.max() == octaves[peak] / RUNS
        assert math.log2(edges[np.argmax(values)]) * 4 == pytest.approx(peak)


def test_the_sentences_stand_below_and_its_origin_at_its_foot(made):
    comparison, found, figure = made
    (words,) = figure.axes[2].texts
    assert words.get_text().split("\n") == [sentence(measure) for measure in measures(found)]
    assert set(words.get_text().split("\n")) <= set(sentences(found))
    assert "seed 27, a: as the file stands, b: guard=skip, gate=0.99" in told(comparison)
    assert "400 runs" not in told(comparison)  # it tells what was asked for
    assert "10000 runs" in told(comparison)
