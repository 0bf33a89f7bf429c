"""Walls that stand free and round obstacles, from the file to what is told, traced and handed
out."""

import json

import numpy as np
import pytest
from program import ekfsim

WORLD = """\
name: hall
boundary: [[0, 0], [10, 0], [10, 8], [0, 8]]
obstacles:
  - {name: pillar, circle: {x: 7, y: 1.2, radius: 0.5}}
walls:
  - [[2, 5], [6, 5]]
  - {name: screen, points: [[0, 3], [4, 3]]}
start: {x: 1, y: 1, theta: 0}
noise: {executionDstSigmaRatio: 0.01, executionAngSigmaRatio: 0.01, odometryDstSigmaRatio: 0.01,
        odometryAngSigmaRatio: 0.01, rangeSigmaRatio: 0.001}
belief: {missing: [screen]}
"""
COMMANDS = """\
world: hall.yaml
commands:
  - sense: {angle: 0}
  - sense: {angle: 90}
  - move: {distance: 4, angle: 90}
  - sense: {angle: 0}
  - move: {distance: 9, angle: 0}
  - kidnap: {x: 1, y: 1, theta: 0}
  - move: {distance: 9, angle: 0}
"""
FILTER = """\
def predict(x, P, u, motion):
    F, G = motion.F(x, u), motion.G(x, u)
    return motion.f(x, u), F @ P @ F.T + G @ motion.M(u) @ G.T

def update(x, P, z, sensor):
    assert sensor.walls.shape == (5, 2, 2) and sensor.circles.tolist() == [[7, 1.2, 0.5]]
    H = sensor.H(x)
    K = P @ H.T / (H @ P @ H.T + sensor.R(x))
    return x + K @ (z - sensor.h(x)), P - K @ H @ P
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    (tmp_path / "hall.yaml").write_text(WORLD)
    (tmp_path / "tour.yaml").write_text(COMMANDS)
    (tmp_path / "mine.py").write_text(FILTER)
    monkeypatch.chdir(tmp_path)
    return tmp_path


def traced(folder, *options):
    ekfsim("run", "tour.yaml", "--trace", "trace.jsonl", "--force", *options)
    return [json.loads(line) for line in (folder / "trace.jsonl").read_text().splitlines()]


def test_a_run_meets_them_and_says_so(folder):
    told = ekfsim("run", "tour.yaml", "--explain").out
    half = np.sqrt(0.5**2 - 0.2**2)
    assert f"The predicted range was {6 - half:.6g} " in told
    assert "It was expected to meet pillar; the angle between beam and wall is 66.4218 deg" in told
    assert "That is a circle about (7, 1.2), with the radius 0.5 m\n" in told
    assert f"dh/dx = -1, dh/dy = {-0.2 / half:.6g}, dh/dth = {-0.2 / half * (6 - half):.6g}" in told
    assert "It bumped into pillar and stopped short of it; the filter was not told\n" in told
    assert "expected to meet edge 1 of wall 1; the angle between beam and wall is " in told
    assert "It bumped into edge 1 of wall 1 and stopped short of it" in told


def test_the_trace_names_them_and_a_robot_stops_1_mm_short(folder):
    lines = traced(folder)
    walls = [line["wall"] for line in lines if line["type"] == "sense"]
    assert walls == [
        {"name": "pillar", "edge": 0},
        {"name": "boundary", "edge": 2},  # the screen is on no map of the filter
        {"name": "wall 1", "edge": 0},
    ]
    assert lines[2]["range"] == pytest.approx(2.0, rel=0.005)  # but it stands
    _, up, across = (line for line in lines if line["type"] == "move")
    assert [move["bump"] for move in (up, across)] == ["wall 1", "pillar"]
    _, y, heading = up["truth"]  # a turn of 0 has no noise
    assert (5 - y) / np.sin(heading) == pytest.approx(0.001, abs=1e-9)
    half = np.sqrt(0.5**2 - 0.2**2)
    assert across["truth"][:2] == pytest.approx([7 - half - 0.001, 1.0], abs=1e-9)


def test_what_is_handed_out_holds_them_and_gives_the_same_numbers(folder):
    ekfsim("record", "tour.yaml", "-o", "log")
    handed = (folder / "log" / "world.yaml").read_text()
    assert '  - {name: "pillar", circle: {x: 7.0, y: 1.2, radius: 0.5}}\n' in handed
    assert 'walls:\n  - {name: "wall 1", points: [[2.0, 5.0], [6.0, 5.0]]}\n' in handed
    assert "screen" not in handed
    recording = "recording: {format: classroom, path: log}\n"
    ends = [traced(folder)[-1]["posterior"]["mean"]]
    (folder / "tour.yaml").write_text(recording)
    ends.append(traced(folder)[-1]["posterior"]["mean"])
    np.testing.assert_allclose(ends[1], ends[0], rtol=1e-12)


def test_a_filter_of_ones_own_is_handed_straight_walls_and_circles(folder):
    ours, theirs = traced(folder), traced(folder, "--filter", "mine.py")
    for one, other in zip(ours, theirs, strict=True):
        if "posterior" in one:
            np.testing.assert_allclose(
                other["posterior"]["mean"], one["posterior"]["mean"], rtol=1e-9, atol=1e-12
            )
