"""Whether a filter that weighs its readings believes them no more, held against brute force."""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.stats import binom, norm

from ekfsim.diagnostics.shutting_out import MOST, SURE, Weighing, shut_out, shut_out_of
from ekfsim.diagnostics.summary import Summary
from ekfsim.files.scenes.load import load_scene
from ekfsim.localization import play
from ekfsim.views.playback.playback import views
from ekfsim.views.words.closing import conclude, conclude_all
from ekfsim.views.words.verdict import meaning

PDAF = Weighing("pdaf", 0.1, 0.1)


def of(doubted):
    return [(10 + i, 0.0 if one else 1.0) for i, one in enumerate(doubted)]


def test_it_is_the_likeliest_beginning_of_shutting_out():
    """While its sum is not cut off, it is that of the suffix whose likelihood ratio is largest."""
    rng = np.random.default_rng(5)
    found = 0
    for _ in range(200):
        doubted = rng.random(14) < 0.4
        ratios = [
            binom.logpmf(k := int(doubted[i:].sum()), n := len(doubted) - i, 0.55)
            - binom.logpmf(k, n, 0.1)
            for i in range(len(doubted))
        ]
        if max(ratios) > MOST - 1:
            continue
        told = shut_out(of(doubted), PDAF)
        assert (told is None) == (max(ratios) < SURE)
        if told is not None:
            found += 1
            first = int(np.argmax(ratios))
            assert told[1:] == (10 + first, int(doubted[first:].sum()), len(doubted) - first)
    assert found > 20


def test_a_filter_that_found_its_way_since_does_not_shut_out():
    assert shut_out(of([True] * 60), PDAF) == (PDAF, 10, 60, 60)
    assert shut_out(of([True] * 60 + [False] * 14), PDAF) is None
    assert shut_out([], PDAF) is None


def test_it_is_called_seldom_where_readings_are_doubted_as_often_as_is_expected():
    rng = np.random.default_rng(6)
    wrong = sum(shut_out(of(rng.random(64) < 0.1), PDAF) is not None for _ in range(2000))
    assert wrong <= 2  # of 2000; 0.003 % each would be about exp(-SURE) of 64 beginnings


def test_what_is_expected_is_what_the_filter_is_told():
    scene = load_scene("tour")
    assert Weighing.of(scene) is None
    huber = Weighing.of(replace(scene, filter="huber"))
    assert huber.little == 1
    assert huber.rare == pytest.approx(2 * norm.sf(2), rel=1e-12)
    assert Weighing.of(replace(scene, filter="pdaf-smoothed")) == PDAF


@pytest.mark.parametrize(
    ("name", "filter", "told"),
    [
        ("diverge-09-wrong-start", "pdaf",
         "How it was lost: beta was below 0.1 in {d} of the {n} readings since step {s}: pdaf took "
         "them for clutter, for its own ellipse was too small, and so they could not call it back"),
        ("diverge-03c-slip", "pdaf",
         "How it was lost: beta was below 0.1 in {d} of the {n} readings since step {s}: pdaf took "
         "them for clutter, for its own ellipse was too small, and so they could not call it back"),
        ("diverge-03c-slip", "huber",
         "How it was lost: {d} of the {n} readings since step {s} lay beyond 2 sigma of what huber "
         "expected, where 1 in 22 would; each pulled no harder than one at 2 sigma, and together "
         "they could not call it back"),
    ],
)  # fmt: skip
def test_a_filter_that_dies_of_it_says_so(name, filter, told):
    scene = replace(load_scene(name), filter=filter, gate=None)
    summary = Summary.of(scene)
    steps = list(summary.following(play(scene)))
    since = 2 if "09" in name else 33  # the first beam, and the first after the wheels slipped
    trusts = [
        float(step.correction.trust)
        for step in steps
        if step.correction is not None and step.entry.index >= since
    ]
    doubted = sum(trust < (1 if filter == "huber" else 0.1) for trust in trusts)
    line = told.format(d=doubted, n=len(trusts), s=since)
    assert conclude(summary).splitlines()[-1] == line
    assert shut_out_of(steps, scene)[1:] == (since, doubted, len(trusts))
    beside = conclude_all(replace(scene, beside=("ekf",)), [summary, Summary.of(scene)])
    assert beside.splitlines()[-1] == f"{filter}: h{line[1:]}"
    *_, last = views(steps)
    assert f"{doubted} of {len(trusts)} readings since step {since}" in meaning(last, scene)


@pytest.mark.parametrize("name", ["tour", "diverge-11-short-returns"])
def test_one_that_is_in_order_is_not_told_of(name):
    scene = replace(load_scene(name), filter="pdaf")
    summary = Summary.of(scene)
    trusts = [step.correction.trust for step in summary.following(play(scene)) if step.correction]
    assert min(map(float, trusts)) < (0.1 if "11" in name else 1)
    assert summary.shut_out is None
    assert not math.isnan(sum(map(float, trusts)))
    assert "lost" not in conclude(summary)
