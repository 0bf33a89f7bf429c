"""A tally says of many runs what one says of each of them alone."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from scenes import rich, scene
from scipy import stats
from systems_scenes import gnss, mower

from ekfsim.commands import Move, Sense
from ekfsim.diagnostics.coverage import inside_cone, inside_ellipse
from ekfsim.diagnostics.nees import squared_mahalanobis
from ekfsim.diagnostics.verdict import Evidence
from ekfsim.filters.belief import posed
from ekfsim.localization import play
from ekfsim.study import block
from ekfsim.study.block import run_block, steps_told
from ekfsim.study.counting import IMPOSSIBLE, WIDEST
from ekfsim.study.tally import Tally
from ekfsim.systems.drives import Stretch, Stretches

RUNS = 24
SHORT = Stretches((Stretch(1.0, 0.2, 1.0),))
SCENES = {
    "rich": rich(),
    "certain": scene(Move(1.0, 0.5), Sense(0.3), Move(2.0, 0.0), sigma=(0.1, 0.1, 0)),
    "gnss": replace(gnss(), drive=SHORT),
    "mower": replace(mower(seed=4), drive=SHORT),
}


def alone(made, run):
    """The last step of each instant of one run, and its evidence."""
    evidence, ends = Evidence(), {}
    for step in play(replace(made, run=run)):
        evidence.add(step)
        ends[step.entry.index if step.entry.t is None else step.entry.t] = step
    return list(ends.values()), evidence


def above(step, probability):
    if step.nees.impossible:
        return True
    dof = int(step.nees.dof)
    return dof > 0 and float(step.nees.value) > stats.chi2.ppf(probability, dof)


@pytest.mark.parametrize("name", SCENES)
def test_a_tally_counts_what_each_run_alone_says(name):
    made = SCENES[name]
    runs = [alone(made, run) for run in range(RUNS)]
    tally = run_block(made, 0, RUNS)
    layout = made.world.layout
    assert tally.runs == RUNS
    assert len(tally.steps) == len(runs[0][0])
    for k in range(len(tally.steps)):
        steps = [ends[k] for ends, _ in runs]
        poses = [posed(step.posterior, layout) for step in steps]
        truths = [step.entry.truth for step in steps]
        at = {field: column[k] for field, column in tally.at._asdict().items()}
        known = [step for step in steps if step.nees.dof > 0 and not step.nees.impossible]
        assert at["impossible"] == sum(bool(step.nees.impossible) for step in steps)
        assert at["judged"] == len(known) + at["impossible"]
        for field, probability in (("above_50", 0.5), ("above_95", 0.95), ("above_999", 0.999)):
            assert at[field] == sum(above(step, probability) for step in steps)
        held = [
            inside_ellipse(pose, truth, 0.954) for pose, truth in zip(poses, truths, strict=True)
        ]
        blocks = [
            squared_mahalanobis(pose.mean[:2] - truth[:2], pose.covariance[:2, :2])
            for pose, truth in zip(poses, truths, strict=True)
        ]
        drawn = [rank == 2 or impossible for _, rank, impossible in blocks]
        assert at["ellipse_runs"] == sum(drawn)
        assert at["in_ellipse"] == sum(bool(h) for h, d in zip(held, drawn, strict=True) if d)
        unsure = [pose.covariance[2, 2] > 1e-24 for pose in poses]
        cones = [
            bool(inside_cone(pose, truth, 0.954)) for pose, truth in zip(poses, truths, strict=True)
        ]
        assert at["cone_runs"] == sum(u or not c for u, c in zip(unsure, cones, strict=True))
        assert at["in_cone"] == sum(c for u, c in zip(unsure, cones, strict=True) if u)
        assert at["nees_runs"] == len(known)
        assert at["nees_dof"] == sum(int(step.nees.dof) for step in known)
        assert at["nees_sum"] == pytest.approx(
            sum(float(step.nees.value) for step in known), rel=1e-6
        )
        square = sum(math.dist(p.mean[:2], t[:2]) ** 2 for p, t in zip(poses, truths, strict=True))
        assert at["position_square"] == pytest.approx(square, rel=1e-9, abs=1e-15)
    lost = [index_of(ends, evidence) for ends, evidence in runs if evidence.lost_from is not None]
    assert tally.lost_from == {step: lost.count(step) for step in set(lost)}
    check_sums(tally, [evidence for _, evidence in runs])


def index_of(ends, evidence):
    """The instant from which on a run is lost: with a clock, whatever a reading in the middle of
    one says."""
    since = None
    for n, step in enumerate(ends):
        since = (n if since is None else since) if above(step, 0.999) else None
    assert since is not None
    return since


def check_sums(tally, evidences):
    of = tally.of
    assert of.nis_readings == sum(evidence.nis_readings for evidence in evidences)
    assert of.nis_dof == sum(evidence.nis_dof for evidence in evidences)
    assert of.nis_sum == pytest.approx(sum(evidence.nis_sum for evidence in evidences), rel=1e-6)
    bands = [stats.chi2.ppf([0.025, 0.975], max(evidence.nis_dof, 1)) for evidence in evidences]
    judged = [evidence.nis_dof > 0 for evidence in evidences]
    assert of.nis_runs == sum(judged)
    sums = [
        (e.nis_sum, low, high)
        for e, (low, high), j in zip(evidences, bands, judged, strict=True)
        if j
    ]
    assert of.nis_above == sum(total > high for total, _, high in sums)
    assert of.nis_below == sum(total < low for total, low, _ in sums)
    last = [evidence.last_nees for evidence in evidences]
    assert of.nees_above == sum(
        bool(nees.impossible)
        or (nees.dof > 0 and float(nees.value) > stats.chi2.ppf(0.975, nees.dof))
        for nees in last
    )
    assert of.nees_below == sum(
        not nees.impossible and nees.dof > 0 and float(nees.value) < stats.chi2.ppf(0.025, nees.dof)
        for nees in last
    )
    ranked = [
        (bool(nees.impossible), 0.0 if nees.impossible else float(nees.value)) for nees in last
    ]
    assert tally.worst.run == ranked.index(max(ranked))
    assert sum(held.runs for held in tally.spread.values()) == tally.runs
    for key, held in tally.spread.items():
        bins = [bin_of(*rank) for rank in ranked]
        assert (held.runs, held.lowest) == (bins.count(key), bins.index(key))


def bin_of(impossible, value):
    if impossible:
        return IMPOSSIBLE
    return max(math.floor(32 * math.log2(value)), -WIDEST) if value > 0 else -WIDEST


def test_blocks_put_together_are_all_their_runs():
    made = SCENES["rich"]
    whole, halves = run_block(made, 0, 20), run_block(made, 0, 9) + run_block(made, 9, 11)
    ours, theirs = whole.plain(), halves.plain()
    for name in ours.keys() - {"at", "of"}:
        assert repr(ours[name]) == repr(theirs[name])
    for one, other in zip(whole.at, halves.at, strict=True):
        np.testing.assert_allclose(one, other, rtol=1e-12)
    np.testing.assert_allclose(whole.of, halves.of, rtol=1e-12)


def test_a_tally_survives_a_text_to_the_last_bit():
    tally = run_block(SCENES["rich"], 1020, 8)
    text = json.dumps(tally.plain())
    again = Tally.of_plain(json.loads(text))
    assert json.dumps(again.plain()) == text
    assert [column.dtype for column in again.at] == [column.dtype for column in tally.at]
    assert json.dumps((again + again).plain()) == json.dumps((tally + tally).plain())


def test_the_tally_of_no_runs_adds_nothing():
    tally = run_block(SCENES["mower"], 0, 3)
    empty = Tally.empty(tally.steps)
    for both in (empty + tally, tally + empty):
        assert json.dumps(both.plain()) == json.dumps(tally.plain())
    assert (empty + empty).runs == 0


def test_the_size_of_a_tally_does_not_grow_with_the_runs():
    sizes = [len(json.dumps(run_block(SCENES["certain"], 0, runs).plain())) for runs in (64, 1024)]
    tally = run_block(SCENES["certain"], 0, 1024)
    assert sizes[1] < 6 * sizes[0]
    assert len(json.dumps((tally + tally).plain())) < 1.1 * sizes[1]


def test_of_long_runs_a_thousand_steps_are_told_and_the_last(monkeypatch):
    assert steps_told(1000).tolist() == list(range(1001))
    told = steps_told(54_321)
    assert len(told) == 1001
    assert (told[0], told[-1]) == (0, 54_321)
    assert set(np.diff(told)) == {54, 55}
    monkeypatch.setattr(block, "MOST_STEPS", 7)
    long = replace(gnss(), drive=Stretches((Stretch(1.0, 0.2, 2.0),)))
    tally, whole = run_block(long, 0, 4), None
    monkeypatch.undo()
    whole = run_block(long, 0, 4)
    assert len(tally.steps) == 8
    chosen = np.isin(whole.steps, tally.steps)
    assert tally.at.position_square.tolist() == whole.at.position_square[chosen].tolist()
    assert tally.times.tolist() == whole.times[chosen].tolist()
    assert tally.lost_from == whole.lost_from


def test_an_impossible_run_is_the_worst_and_the_lowest_of_equals(monkeypatch):
    made = scene(Move(1.0, 0.0), Move(2.0, 0.0), sigma=(0.1, 0.1, 0.1))
    wrong = replace(
        made, world=replace(made.world, told=replace(made.world.told, sigma=np.zeros(3)))
    )
    tally = run_block(wrong, 5, 10)
    assert tally.worst == (True, 0.0, 5)
    assert set(tally.spread) == {IMPOSSIBLE}
    assert tally.at.impossible.tolist() == [10, 10, 10]
    assert tally.at.above_999.tolist() == [10, 10, 10]
    assert tally.lost_from == {0: 10}
