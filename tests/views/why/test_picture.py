"""The picture of why: what is drawn, and that all of it is seen."""

import numpy as np
import pytest
from matplotlib.legend import Legend

from ekfsim.files.scenes.load import load_scene
from ekfsim.views.why.picture import picture
from ekfsim.why import Explanation, explain


@pytest.fixture(scope="module")
def found():
    return explain(load_scene("diverge-01-wrong-wall"), runs=100)


def drawn(figure):
    return {one.get_gid(): one for axes in figure.axes for one in axes.get_children()}


def test_both_runs_are_drawn_from_where_they_part(found):
    parts = drawn(picture(found))
    for name, steps in (("lost", found.lost_steps), ("cured", found.cured_steps)):
        way = np.column_stack(parts[f"{name}-way"].get_data())
        kept = [step for step in steps if step.entry.index >= found.parts_at - 1]
        np.testing.assert_array_equal(way, [step.posterior.mean[:2] for step in kept])
        x, nees = parts[f"{name}-nees"].get_data()
        assert list(x) == [step.entry.index for step in steps]
        assert nees[-1] == pytest.approx(float(steps[-1].nees.value))
    assert parts["step"].get_text() == "step 13"
    assert set(parts["parts"].get_xdata()) == {13}


def test_the_beam_ends_where_it_was_predicted_and_where_it_was_measured(found):
    parts = drawn(picture(found))
    step = found.lost_steps[13]
    x, angle = step.prior.mean, step.prior.mean[2] + step.entry.command.angle
    along = np.array([np.cos(angle), np.sin(angle)])
    predicted = np.array(parts["predicted-end"].get_data()).ravel()
    measured = np.array(parts["measured-end"].get_data()).ravel()
    np.testing.assert_allclose(predicted, x[:2] + step.correction.predicted[0] * along)
    np.testing.assert_allclose(measured, x[:2] + step.entry.given.z[0] * along)


def test_nothing_is_clipped(found):
    figure = picture(found)
    figure.canvas.draw()
    whole = figure.bbox.padded(1)
    for axes in figure.axes:
        legend = next(one for one in axes.get_children() if isinstance(one, Legend))
        for one in (legend, axes.title, axes.xaxis.label, axes.yaxis.label):
            box = one.get_window_extent()
            assert whole.contains(box.x0, box.y0)
            assert whole.contains(box.x1, box.y1)
    map = figure.axes[0]
    way = np.column_stack(drawn(figure)["lost-way"].get_data())
    inside = map.viewLim.padded(1e-9)
    assert all(inside.contains(*place) for place in way.tolist())


def test_of_a_consistent_run_there_is_one(found):
    steps = found.cured_steps
    figure = picture(Explanation(found.scene, "consistent", None, lost_steps=steps))
    parts = drawn(figure)
    assert "lost-way" in parts
    assert "cured-way" not in parts
    assert figure.axes[0].get_title() == "the whole run"
