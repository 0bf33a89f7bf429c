"""The pictures of a study, by their artists."""

import numpy as np
import pytest
from matplotlib.collections import PolyCollection
from matplotlib.image import imread

from ekfsim.files.scenes.load_study import read_request
from ekfsim.files.scenes.settings import swept
from ekfsim.study.block import run_block
from ekfsim.study.plan import Plan
from ekfsim.study.results import Result
from ekfsim.views.study.pictures import PICTURES, draw_study, picture

WORLD = """\
name: lab
boundary: [[-5, -5], [5, -5], [5, 5], [-5, 5]]
start: {x: 0, y: 0, theta: 0, sigma: {x: 0.1, y: 0.1, theta: 5}}
noise:
  executionDstSigmaRatio: 0.05
  executionAngSigmaRatio: 0.05
  odometryDstSigmaRatio: 0.05
  odometryAngSigmaRatio: 0.05
  rangeSigmaRatio: 0.01
"""
COMMANDS = """\
world: world.yaml
commands: [move: {distance: 1, angle: 90}, sense: {angle: 0}, move: {distance: 1, angle: 0}]
"""


@pytest.fixture(autouse=True)
def place(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "world.yaml").write_text(WORLD)
    (tmp_path / "commands.yaml").write_text(COMMANDS)
    return tmp_path


def studied(*sweeps, filters=("ekf", "ukf")):
    request = read_request("commands.yaml").overruled((), tuple(map(swept, sweeps)))
    plan = Plan.of(request.__class__(**{**request.__dict__, "filters": filters, "runs": 50}))
    return plan, [Result(case, run_block(case.scene, 0, 50)) for case in plan.cases]


def drawn(name, *sweeps):
    plan, results = studied(*sweeps)
    return results, picture(plan, results, *PICTURES[name])


def test_without_a_sweep_a_line_over_the_steps_with_its_interval():
    results, figure = drawn("nees")
    assert [axes.get_title(loc="left") for axes in figure.axes] == [
        "above the median",
        "above the 95 % quantile",
        "above the 99.9 % quantile",
    ]
    for axes, name, meant in zip(
        figure.axes, ("above_50", "above_95", "above_999"), (0.5, 0.05, 0.001), strict=True
    ):
        for line, band, result in zip(axes.lines, axes.collections, results, strict=False):
            shares = [getattr(at, name) for at in result.steps]
            np.testing.assert_array_equal(line.get_xdata(), [0, 1, 2, 3])
            np.testing.assert_array_equal(line.get_ydata(), [share.value for share in shares])
            assert isinstance(band, PolyCollection)
            heights = band.get_paths()[0].vertices[:, 1]
            assert heights.max() == max(share.high for share in shares)
            assert heights.min() == min(share.low for share in shares)
            assert line.get_label() == result.case.filter
        assert axes.lines[-1].get_ydata() == [meant, meant]
        assert (
            axes.get_title(loc="right")
            == f"grey line: {100 * meant:g} %, where the filter is honest"
        )
    assert [text.get_text() for text in figure.axes[0].get_legend().get_texts()] == ["ekf", "ukf"]
    # hides no line
    assert (
        figure.axes[0].get_legend().get_window_extent().y0 > figure.axes[0].get_window_extent().y1
    )
    assert figure.axes[-1].get_xlabel() == "step"


def test_over_one_key_a_line_with_bars_at_the_last_step():
    results, figure = drawn("coverage", "noise.rangeSigmaRatio=0.5,0.01,0.1")
    ellipse, cone = figure.axes
    assert cone.get_xlabel() == "noise.rangeSigmaRatio"
    for container, name in zip(ellipse.containers, ("ekf", "ukf"), strict=True):
        line, _, (bars,) = container
        shares = {
            float(result.case.values[0].value): result.last.ellipse
            for result in results
            if result.case.filter == name
        }
        np.testing.assert_array_equal(line.get_xdata(), sorted(shares))
        np.testing.assert_array_equal(line.get_ydata(), [shares[x].value for x in sorted(shares)])
        for segment, x in zip(bars.get_segments(), sorted(shares), strict=True):
            np.testing.assert_allclose(segment, [[x, shares[x].low], [x, shares[x].high]])
    assert ellipse.get_xscale() == "log"


def test_words_stand_in_their_order():
    _, figure = drawn("divergence", "guard=warn,off,skip")
    (axes,) = figure.axes
    assert [label.get_text() for label in axes.get_xticklabels()] == ["warn", "off", "skip"]


def test_two_keys_make_a_map_with_its_numbers():
    results, figure = drawn("divergence", "noise.rangeSigmaRatio=0.01,0.1", "guard=warn,off,skip")
    maps = [axes for axes in figure.axes if axes.images]
    assert [axes.get_title() for axes in maps] == ["ekf", "ukf"]
    for axes, name in zip(maps, ("ekf", "ukf"), strict=True):
        shares = [result.last.lost.value for result in results if result.case.filter == name]
        np.testing.assert_array_equal(axes.images[0].get_array(), np.reshape(shares, (2, 3)))
        assert [text.get_text() for text in axes.texts] == [
            f"{100 * share:.1f}" for share in shares
        ]
    assert [label.get_text() for label in maps[0].get_yticklabels()] == ["0.01", "0.1"]
    assert maps[0].get_xlabel() == "guard"
    assert maps[0].get_ylabel() == "noise.\nrangeSigmaRatio"


@pytest.mark.parametrize("name", PICTURES)
def test_headings_lie_inside_the_picture(name):
    plan, results = studied(
        "noise.rangeSigmaRatio=0.01,0.1", "guard=warn,off,skip", filters=("ekf",)
    )
    figure = picture(plan, results, *PICTURES[name])
    figure.draw_without_rendering()
    for text in figure.texts:
        extent = text.get_window_extent()
        assert 0 <= extent.x0 < extent.x1 <= figure.bbox.width


def test_of_very_many_maps_the_rest_is_told():
    plan, results = studied("faults.rangeBias=0,1,2,3,4,5,6,7,8,9,10,11,12", "gate=0.5,0.9",
    "guard=off,skip",
                            filters=("ekf",))  # fmt: skip
    figure = picture(plan, results, *PICTURES["divergence"])
    assert sum(bool(axes.images) for axes in figure.axes) == 12
    assert any(text.get_text() == "12 of 13 maps; summary.csv holds all" for text in figure.texts)


def test_every_picture_tells_what_made_it_and_is_the_same_again(place):
    plan, results = studied("noise.rangeSigmaRatio=0.01,0.1")
    for folder in ("one", "two"):
        (place / folder).mkdir()
        draw_study(plan, results, place / folder)
    for name in PICTURES:
        first, second = ((place / folder / f"{name}.png").read_bytes() for folder in ("one", "two"))
        assert first == second
        assert b"seed 0" in first
        assert b"sweep noise.rangeSigmaRatio=0.01,0.1" in first
        assert imread(place / "one" / f"{name}.png").std() > 0.05
