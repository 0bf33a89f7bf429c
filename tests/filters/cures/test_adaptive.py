import math
import re
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numerics import covariance
from problems import ROOM, classroom, landmark, problem

from ekfsim.files.results.trace import line_of
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.belief import Gaussian, Refused
from ekfsim.filters.cures.adaptive import LEAST, Adaptive
from ekfsim.filters.ekf import EKF
from ekfsim.localization import entries_of, first_belief, localize, play
from ekfsim.models.sensors.laser import Laser
from ekfsim.study.block import run_block
from ekfsim.twins import taking
from ekfsim.views.playback.playback import views
from ekfsim.views.words.narrative.narrating import narrate
from ekfsim.views.words.narrative.opening import UNTAUGHT, opening
from ekfsim.views.words.narrative.trust import believed

seeds = st.integers(0, 2**32 - 1)


def reading_itself(R, walk=0.0):
    """A state of one number that is read itself, and wanders."""
    line = problem(np.random.default_rng(0), 1, 1, 1)
    one, none = np.eye(1), np.zeros((1, 1))
    return replace(
        line, A=one, B=none, C=one, noise=np.array([[R]]), process_noise=np.array([[walk]])
    )


def factor(belief, sensor):
    return belief.factors[sensor.outputs]


def test_by_hand():
    """P = 3, R = 1: S = 4, K = 3/4. An innovation of 8 leaves ε = 2, and P = 3/4: 4 + 3/4 is what
    this reading speaks for, and 0.9 + 0.1 · 4.75 what is learnt."""
    model = reading_itself(1.0)
    prior = Gaussian(np.zeros(1), np.array([[3.0]]))
    after, told = Adaptive(headings=()).update(prior, model, np.array([8.0]))
    assert (after.mean.item(), after.covariance.item()) == pytest.approx((6.0, 0.75), rel=1e-15)
    assert (told.R.item(), told.S.item(), told.nis.item()) == (1.0, 4.0, 16.0)
    assert factor(after, model).item() == told.noise_factor.item() == pytest.approx(1.375)
    # the next reading is weighed by it: P = 0.75, R = 1.375
    last, told = Adaptive(headings=()).update(after, model, np.array([6.0]))
    assert (told.R.item(), told.S.item()) == pytest.approx((1.375, 2.125))
    # ν = 0: nothing is left of it but H P Hᵀ = 0.75 · 1.375 / 2.125
    assert factor(last, model).item() == pytest.approx(0.9 * 1.375 + 0.1 * 0.75 * 1.375 / 2.125)


@settings(max_examples=40)
@given(seeds, st.sampled_from([1, 2, 3]), st.floats(0.1, 0.99))
def test_it_is_the_published_rule(seed, k, forgetting):
    """ε of the state after the reading, and the rule as it is printed, with an inverse of R."""
    random = np.random.default_rng(seed)
    model = problem(random, 3, 2, k)
    filter = Adaptive(headings=(), forgetting=forgetting)
    belief, s = Gaussian(random.normal(size=3), covariance(random, 3)), 1.0
    for _ in range(4):
        u, z = random.normal(size=2), 3 * random.normal(size=k)
        belief, _ = filter.predict(belief, model, u)
        H, R, (x, P) = model.C, model.noise, belief
        S = H @ P @ H.T + s * R
        gain = P @ H.T @ np.linalg.inv(S)
        x, P = x + gain @ (z - H @ x), P - gain @ S @ gain.T
        left = z - H @ x
        seen = np.trace(np.linalg.inv(R) @ (np.outer(left, left) + H @ P @ H.T)) / k
        s = forgetting * s + (1 - forgetting) * seen
        belief, told = filter.update(belief, model, z)
        assert belief.mean == pytest.approx(x, rel=1e-7, abs=1e-8)
        assert belief.covariance == pytest.approx(P, rel=1e-7, abs=1e-8)
        assert told.noise_factor.item() == pytest.approx(s, rel=1e-7)


@pytest.mark.parametrize("way", ["plain", "quick"])
@pytest.mark.parametrize("runs", [None, np.arange(70)])
def test_one_that_forgets_nothing_is_the_ekf_to_the_bit(way, runs):
    scene = load_scene("diverge-11-short-returns")
    first = first_belief(scene, () if runs is None else runs.shape)
    with taking(way):
        entries = list(entries_of(scene, runs))[:25]
        steps = (
            localize(entries, filter, first, scene.guard)
            for filter in (EKF(), Adaptive(forgetting=1.0))
        )
        for plain, learning in zip(*steps, strict=True):
            assert np.array_equal(plain.posterior.mean, learning.posterior.mean)
            assert np.array_equal(plain.posterior.covariance, learning.posterior.covariance)


@pytest.mark.parametrize("told", [0.25, 1.0, 4.0])
def test_it_learns_a_sensors_noise_where_all_else_is_right(told):
    """300 walks in one dimension with a σ of 0.5 a step, read with a σ of 1: where the variance is
    told wrongly, the factor ends with what makes it right, and the estimate is honest."""
    random = np.random.default_rng(3)
    model, filter = reading_itself(told, walk=0.25), Adaptive(headings=(), forgetting=0.97)
    truth, belief = np.zeros((300, 1)), Gaussian(np.zeros((300, 1)), np.zeros((300, 1, 1)))
    for _ in range(250):
        truth = truth + 0.5 * random.normal(size=(300, 1))
        belief, _ = filter.predict(belief, model, np.zeros((300, 1)))
        z = truth + random.normal(size=(300, 1))
        belief, _ = filter.update(belief, model, z)
    learnt = told * factor(belief, model)
    assert 0.9 < np.median(learnt) < 1.1
    assert 0.9 < np.mean((belief.mean - truth)[:, 0] ** 2 / belief.covariance[:, 0, 0]) < 1.3


def test_what_is_not_used_teaches_nothing():
    first, laser, _ = classroom(np.random.default_rng(0), (4,))
    first.covariance[:] = 0.01 * np.eye(3)
    h = laser.h(first.mean)
    filter = Adaptive(gate=0.99)
    before, _ = filter.update(first, laser, 1.1 * h)
    assert np.ptp(factor(before, laser)) > 0
    z = 1.02 * h
    z[0], z[1] = np.nan, 5 * h[1]
    after, told = filter.update(before, laser, z, np.array([False, False, True, False]))
    assert told.refused.tolist() == [Refused.NO_ECHO, Refused.GATE, Refused.GUARD, Refused.NOT]
    same = factor(after, laser) == factor(before, laser)
    assert same.tolist() == [True, True, True, False]
    assert np.array_equal(
        factor(before, laser), filter.update(first, laser, 1.1 * h)[1].noise_factor
    )


def test_it_remembers_for_each_kind_of_reading_and_each_run():
    """Beams share what was learnt of beams; a landmark's range and bearing are another sensor's.
    Runs side by side learn what each would alone."""
    random = np.random.default_rng(5)
    first, _, motion = classroom(random, (6,))
    beams = [Laser(ROOM, bearing, 0.01) for bearing in (0.0, 1.5)]
    mark = landmark()
    filter = Adaptive()
    alone = [Gaussian(first.mean[i], first.covariance[i]) for i in range(6)]
    belief = first
    for sensor in (*beams, mark, beams[0]):
        u = random.uniform(-0.2, 0.2, (6, 2))
        z = sensor.h(belief.mean) * random.uniform(0.9, 1.1, (6, 1))
        belief, _ = filter.predict(belief, motion, u)
        belief, _ = filter.update(belief, sensor, z)
        for i in range(6):
            one, _ = filter.predict(alone[i], motion, u[i])
            alone[i], _ = filter.update(one, sensor, z[i])
    assert set(belief.factors) == {beams[0].outputs, mark.outputs}
    for i in range(6):
        for outputs, s in belief.factors.items():
            assert alone[i].factors[outputs].shape == ()
            assert s[i] == pytest.approx(float(alone[i].factors[outputs]), rel=1e-12)
    only_beams = filter.update(first, beams[0], beams[0].h(first.mean))[0]
    both, told = filter.update(only_beams, mark, mark.h(first.mean))
    assert both.factors[beams[0].outputs] is only_beams.factors[beams[0].outputs]
    assert (mark.R(first.mean) == told.R).all()  # nothing was learnt of landmarks yet


def test_the_innovation_of_zero_certainty_the_seam_and_reverse():
    model, filter = reading_itself(1.0), Adaptive(headings=())
    # readings that always fit: R becomes small, and never nothing
    belief = Gaussian(np.zeros(1), np.array([[1e-9]]))
    for _ in range(200):
        belief, told = filter.update(belief, model, belief.mean)
    assert told.noise_factor == LEAST
    assert told.R.item() == LEAST
    sure, certain = reading_itself(0.0), Gaussian(np.ones(1), np.zeros((1, 1)))
    after, told = filter.update(certain, sure, np.array([9.0]))
    assert (after.mean.item(), told.noise_factor.item()) == (1.0, 1.0)
    # P = 0 alone: all of the innovation is noise
    after, told = filter.update(certain, model, np.array([4.0]))
    assert (after.mean.item(), told.noise_factor.item()) == (1.0, pytest.approx(0.9 + 0.1 * 9))
    angle = replace(model, angles=(0,))
    at_seam = Gaussian(np.array([math.pi - 0.1]), np.array([[3.0]]))
    across, told = Adaptive(headings=(0,)).update(at_seam, angle, np.array([-math.pi + 0.3]))
    assert across.mean.item() == pytest.approx(-math.pi + 0.2)
    assert told.noise_factor.item() == pytest.approx(1 + 0.1 * 0.25 * (0.4**2 / 4 - 1))
    forth, back = (
        filter.update(Gaussian(np.zeros(1), np.eye(1)), model, np.array([sign * 8.0]))
        for sign in (1, -1)
    )
    assert forth[0].mean == -back[0].mean
    assert forth[1].noise_factor == back[1].noise_factor


def test_it_takes_a_wrong_wall_for_noise():
    """What scene 01 loses has learnt a noise that is not there; what it does not lose, none."""
    scene = replace(load_scene("diverge-01-wrong-wall"), filter="adaptive")
    for step in play(scene, np.arange(200)):
        last = step
    lost = last.nees.value > 16.27
    (s,) = last.posterior.factors.values()
    assert 60 < np.count_nonzero(lost) < 130
    assert np.median(s[~lost]) < 1.6
    assert np.median(s[lost]) > 9  # its σ three times and more
    assert np.mean(s[lost] > np.quantile(s[~lost], 0.95)) > 0.9


@pytest.mark.parametrize(
    ("scene", "between"),
    [("02b-laser-overtrusted", (0, 5)), ("09-wrong-start", (60, 110)), ("03c-slip", (197, 200))],
)
def test_what_it_cures_and_what_it_kills(scene, between):
    """Of 200 runs; of 1000 it loses 0.4, 39.7 and 100 %, the EKF 71.2, 0.3 and 47.3 %."""
    ends = run_block(replace(load_scene(f"diverge-{scene}"), filter="adaptive"), 0, 200)
    assert between[0] <= sum(ends.lost_from.values()) <= between[1]


def test_narrative_and_trace_tell_what_was_learnt():
    scene = replace(load_scene("diverge-01-wrong-wall"), filter="adaptive")
    steps = list(play(scene))
    short, long = (
        "".join(narrate(view, scene, explain=explain) for view in views(iter(steps)))
        for explain in (False, True)
    )
    learnt = [line_of(step, scene, 0.954).get("noise_factor") for step in steps if step.correction]
    assert all(isinstance(s, float) for s in learnt)
    told = f"s, the square of that factor, is {learnt[0]:.6g}"
    assert (
        f"such readings have {math.sqrt(learnt[0]):.6g} times the sigma that it is told; {told}\n"
        in short
    )
    assert f"{told}   (s <- a s + (1 - a) seen, a = 0.9; seen = s + s (C_v / S) (NIS - 1), " in long
    assert "C_v is 0.0" in long
    assert "what was learnt so far times (rangeSigmaRatio * predicted range)^2" in long
    assert short.count("such readings have") == sum(
        bool(step.correction.used) for step in steps if step.correction
    )


def test_a_gate_beside_it_is_told_and_keeps_it_from_learning():
    """Of 1000 runs of a laser that is told a quarter of its noise it loses 36 % with a gate, 0.4 %
    without."""
    scene = replace(load_scene("diverge-02b-laser-overtrusted"), filter="adaptive", gate=0.99)
    assert UNTAUGHT in opening(scene)
    assert UNTAUGHT not in opening(replace(scene, gate=None))
    assert UNTAUGHT not in opening(replace(scene, filter="ekf"))
    assert 45 <= sum(run_block(scene, 0, 200).lost_from.values()) <= 100


def test_a_picture_tells_it_in_a_word_or_two():
    scene = replace(load_scene("tour"), filter="adaptive")
    first = next(step for step in play(scene) if step.correction)
    ratio = math.sqrt(float(first.correction.noise_factor))
    assert believed(first.correction) == f"learnt: {ratio:.2g} times the told σ"


def test_the_page_prints_what_it_says(capsys):
    """Its block of Python, of 1000 runs, and the block beneath it."""
    page = (Path(__file__).parents[3] / "docs/judging/cures/adaptive.md").read_text(
        encoding="utf-8"
    )
    code, printed = re.search(r"```python\n(.*?)```\n\n```\n(.*?)```", page, re.DOTALL).groups()
    exec(compile(code, "adaptive.md", "exec"), {})
    assert capsys.readouterr().out == printed
