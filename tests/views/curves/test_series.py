import io
import json
import math
from collections import Counter
from itertools import pairwise

import numpy as np
import pytest
from recordings import recording
from scenes import rich, scene, unbounded
from systems_scenes import landmarks, mower

from ekfsim.commands import Kidnap, Move, Say, Sense
from ekfsim.diagnostics.summary import Summary
from ekfsim.diagnostics.verdict import LOST
from ekfsim.files.results.trace import Trace
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.belief import Refused
from ekfsim.localization import play
from ekfsim.views.curves.events import REFUSALS, Happened
from ekfsim.views.curves.series import BOUNDS, NONE, Series, bound
from ekfsim.views.curves.thinning import peaks

SCENES = {
    "rich": rich(),
    "guarded": rich(guard="skip"),
    "unbounded": unbounded(),
    "recording": recording(),
    "mower": mower(),
    "landmarks": landmarks(),
}


def traced(scene):
    """The lines of the trace: other code than that of the curves."""
    file = io.StringIO()
    trace = Trace(file, scene, 0.954)
    for step in play(scene):
        trace.write(step)
    return [json.loads(line) for line in file.getvalue().splitlines()]


def numbers(lines, key):
    return np.array([math.nan if line.get(key) is None else line[key] for line in lines], float)


@pytest.mark.parametrize("made", SCENES.values(), ids=SCENES)
def test_errors_and_sigmas_are_those_of_the_trace(made):
    series, lines = Series.of(play(made)), traced(made)
    places = list(made.world.layout.places)
    told = [line.get("posterior", line) for line in lines]
    for row, (line, belief) in enumerate(zip(lines, told, strict=True)):
        if "mean" not in belief:  # a say or a kidnap: the belief is the one before
            continue
        P = np.array(belief["covariance"])[np.ix_(places, places)]
        np.testing.assert_allclose(series.sigma[row], np.sqrt(np.diag(P)), rtol=1e-12)
        if line["truth"] is None:
            assert np.isnan(series.error[row]).all()
            continue
        e = np.array(belief["mean"])[places] - line["truth"]
        e[2] = math.remainder(e[2], 2 * math.pi)
        np.testing.assert_allclose(series.error[row], e, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize("made", SCENES.values(), ids=SCENES)
def test_nis_and_nees_are_those_of_the_trace(made):
    series, lines = Series.of(play(made)), traced(made)
    assert series.index.tolist() == [line.get("index", 0) for line in lines]
    np.testing.assert_array_equal(series.nis, numbers(lines, "nis"))
    judged = np.array(["nees" in line for line in lines])
    np.testing.assert_array_equal(series.nees[judged], numbers(lines, "nees")[judged])
    told = [line for line in lines if "nees" in line]
    assert series.nees_dof[judged].tolist() == [line["nees_dof"] or 0 for line in told]
    assert series.impossible[judged].tolist() == [bool(line["impossible"]) for line in told]
    words = [None if r == NONE else Refused(r).word for r in series.refused]
    assert words == [line.get("refused") for line in lines]
    assert series.read.tolist() == [line.get("type") in ("sense", "update") for line in lines]
    assert series.used.tolist() == [
        line["type"] in ("sense", "update") and line["updated"] for line in lines
    ]


@pytest.mark.parametrize("made", SCENES.values(), ids=SCENES)
def test_what_is_said_of_the_whole_run_is_what_the_summary_says(made):
    series, summary = Series.of(play(made)), Summary.of(made)
    for step in play(made):
        summary.add(step)
    told = summary.table()
    assert series.lost_from == told["lost_from"]
    assert series.evidence.verdict.value == told["verdict"]
    assert float(np.nansum(series.nis)) == pytest.approx(told["nis"]["sum"], rel=1e-12)
    assert int(series.nis_dof[~np.isnan(series.nis)].sum()) == told["nis"]["dof"]
    assert int(series.used.sum()) == told["updates"]
    assert int((series.read & ~series.used).sum()) == told["refused"]


def test_a_lost_run_is_beyond_its_bound_from_that_step_to_the_end():
    series = Series.of(play(load_scene("commands/diverge-01-wrong-wall.yaml")))
    beyond = (series.nees > bound(LOST, series.nees_dof)) | series.impossible
    assert series.lost_from == 13
    assert beyond[13:].all()
    assert not beyond[12]


def test_without_readings_sigma_and_error_are_those_of_a_straight_line():
    """A straight way along x: σ_x grows as the root of the sum of the squares of the ways."""
    made = scene(*(Move(d, 0.0) for d in (1.0, 2.0, 0.5)), start=(1, 1, 0))
    series, (_, *steps) = Series.of(play(made)), play(made)
    measured = np.array([step.entry.given.u[0] for step in steps])
    true = [step.entry.truth[0] for step in steps]
    np.testing.assert_allclose(series.sigma[1:, 0], np.sqrt(np.cumsum((0.02 * measured) ** 2)))
    np.testing.assert_allclose(series.error[1:, 0], 1 + np.cumsum(measured) - true, atol=1e-15)
    assert (series.sigma[0] == 0).all()
    np.testing.assert_allclose(series.nees[1:], (series.error[1:, 0] / series.sigma[1:, 0]) ** 2)
    assert series.nees_dof.tolist() == [0, 1, 1, 1]


def test_a_heading_error_is_wrapped():
    half = math.radians(179.0)
    made = scene(Kidnap(5.0, 5.0, -half), start=(1, 1, half))
    error = Series.of(play(made)).error[-1, 2]
    assert error == pytest.approx(-math.radians(2))


@pytest.mark.parametrize("made", SCENES.values(), ids=SCENES)
def test_innovations_are_those_of_the_steps(made):
    series = Series.of(play(made))
    expected = {}
    for row, step in enumerate(play(made)):
        if step.correction is None:
            continue
        for i, quantity in enumerate(step.entry.given.sensor.outputs):
            told = (row, step.correction.innovation[i], math.sqrt(step.correction.S[i, i]))
            expected.setdefault(quantity, []).append(told)
    assert list(series.innovations) == list(expected)
    for quantity, rows in expected.items():
        found = series.innovations[quantity]
        got = np.column_stack([found.rows, found.ν, found.σ])
        np.testing.assert_allclose(got, np.array(rows, float), rtol=1e-15)


def test_a_run_without_a_truth_has_no_errors_and_no_nees():
    series = Series.of(play(recording()))
    unknown = [step.entry.truth is None for step in play(recording())]
    np.testing.assert_array_equal(np.isnan(series.error).all(axis=1), unknown)
    np.testing.assert_array_equal(np.isnan(series.nees) & ~series.impossible, unknown)
    assert series.clocked
    assert series.t[0] == 0
    np.testing.assert_allclose(series.t, [s.entry.t - 10.0 for s in play(recording())])


@pytest.mark.parametrize("made", [rich(), rich(guard="skip"), unbounded()])
def test_what_happens_is_marked_at_its_step(made):
    steps = list(play(made))
    series = Series.of(steps)
    found = Counter((event.row, event.happened) for event in series.events)
    expected = Counter()
    for row, step in enumerate(steps):
        command, c = step.entry.command, step.correction
        expected[row, Happened.KIDNAP] += isinstance(command, Kidnap)
        expected[row, Happened.SAY] += isinstance(command, Say)
        expected[row, Happened.BUMP] += step.entry.bump is not None and step.entry.bump >= 0
        for refused, happened in REFUSALS.items():
            expected[row, happened] += c is not None and c.refused == refused
        used = c is not None and c.refused == Refused.NOT
        expected[row, Happened.AMBIGUOUS] += bool(used and step.remark.ambiguous)
    assert found == +expected
    texts = {event.row: event.text for event in series.events if event.text}
    said = {row: s.entry.command for row, s in enumerate(steps) if isinstance(s.entry.command, Say)}
    assert texts == {row: say.text for row, say in said.items()}


def test_all_that_can_happen_does_in_these_scenes():
    kinds = {e.happened for made in SCENES.values() for e in Series.of(play(made)).events}
    assert kinds == set(Happened)


def test_labels_name_the_step():
    series = Series.of(play(scene(Move(1.5, math.radians(90)), Sense(0.0))))
    assert series.labels == ["step 0", "step 1 (move 1.5 m, 90°)", "step 2 (sense 0°)"]


def test_bounds_are_the_quantiles_of_each_steps_freedom():
    """χ²: 2 degrees of freedom have the closed form −2 ln(1 − p)."""
    dof = np.array([0, 2, 1, 2])
    for p, one in zip(BOUNDS, (3.841459, 6.634897, 10.827566), strict=True):
        two = -2 * math.log(1 - p)
        np.testing.assert_allclose(bound(p, dof), [math.nan, two, one, two], rtol=1e-6)


def test_thinning_keeps_the_peaks_of_each_stretch():
    rng = np.random.default_rng(5)
    columns = rng.standard_normal((10_007, 3))
    columns[4321, 1], columns[77, 0], columns[2000:2100, 2] = 1e6, -1e6, math.nan
    kept = peaks(columns, 100)
    assert len(kept) <= 100 * (2 + 2 * 3)
    assert (np.diff(kept) > 0).all()
    assert {0, 77, 4321, 10_006} <= set(kept.tolist())
    edges = np.linspace(0, 10_007, 101).astype(int)
    for first, end in pairwise(edges):
        inside = kept[(kept >= first) & (kept < end)]
        for whole, left in zip(columns[first:end].T, columns[inside].T, strict=True):
            if not np.isnan(whole).all():
                assert np.nanmin(left) == np.nanmin(whole)
                assert np.nanmax(left) == np.nanmax(whole)


def test_a_short_run_is_not_thinned():
    assert peaks(np.zeros((400, 2)), 100).tolist() == list(range(400))
    assert len(peaks(np.zeros((401, 2)), 100)) == 200
    assert peaks(np.zeros((0, 2))).tolist() == []
