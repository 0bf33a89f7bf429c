"""What is said of innovations, whole sentences."""

import numpy as np
import pytest

from ekfsim import load_scene
from ekfsim.diagnostics.innovations import Found
from ekfsim.diagnostics.summary import Summary
from ekfsim.diagnostics.whiteness import whiteness
from ekfsim.localization import play
from ekfsim.views.words.closing import conclude
from ekfsim.views.words.whiteness import sentence


def told(w, targets=1, refused=0):
    names = ["gnss"] if targets == 1 else [f"node {i}" for i in range(targets)]
    read = [names[i % targets] for i in range(len(w))]
    one = whiteness(read[0].split()[0], ("range", "bearing")[: w.shape[1]], read, w)
    return sentence(Found((one,), np.asarray(0), np.asarray(refused), np.asarray(0)))


def noise(n, k=1, seed=0):
    return np.random.default_rng(seed).normal(size=(n, k))


def test_white():
    assert told(noise(50, 2)) == "white around zero (p 0.88; 50 of gnss)"
    said = told(noise(50, seed=6), refused=2)
    assert said.startswith("white around zero (p ")
    assert said.endswith("; 50 of gnss; left out: 2 refused)")


def test_no_evidence():
    assert told(noise(4)) == "no evidence: 4 readings of one sensor, and 10 are wanted"
    nothing = Found((), *[np.asarray(0)] * 3)
    assert sentence(nothing) == "no evidence: 0 readings of one sensor, and 10 are wanted"


def test_a_bias_is_told_as_one():
    said = told(noise(200, 2) + np.array([0.0, -0.5]))
    assert "the bearing of gnss lies 0.4" in said
    assert "σ below its prediction on the average of 200, a bias and no noise" in said
    said = told(noise(200) + 0.8 * (np.arange(200) % 4 == 2)[:, None], targets=4)
    assert "the range of node 2 lies" in said
    assert "average of 50" in said


@pytest.mark.parametrize(("sign", "word"), [(1, "like"), (-1, "against")])
def test_errors_that_last_or_alternate(sign, word):
    w = noise(400)
    for i in range(1, len(w)):
        w[i] += sign * 0.6 * w[i - 1]
    assert f": each of gnss errs {word} the ones before it (lags 1 to 5: " in told(w)
    first = float(told(w).partition("5: ")[2].split()[0])
    assert first == pytest.approx(sign * 0.6, abs=0.08)


def test_the_line_stands_before_the_verdict():
    scene = load_scene("diverge-04a-range-bias-all-round")
    summary = Summary.of(scene)
    for step in play(scene):
        summary.add(step)
    *_, innovations, verdict = conclude(summary).splitlines()
    assert innovations.startswith("Innovations: not white (p 2.7e-26; 64 of laser): ")
    assert "the range of laser behind lies 1.6σ above its prediction" in innovations
    assert "(lags 1 to 5: 0.67 0.56 0.65 " in innovations
    assert verdict.startswith("Verdict: lost")
