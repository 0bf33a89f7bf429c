from itertools import pairwise

import numpy as np
import pytest
from matplotlib.figure import Figure
from scenes import rich, scene

from ekfsim import plot_errors
from ekfsim.commands import Move
from ekfsim.errors import UsageError
from ekfsim.localization import play
from ekfsim.views.curves.series import Series


def lines(curves, gid):
    return [line for axes in curves.axes for line in axes.get_lines() if line.get_gid() == gid]


def test_a_notebook_sees_a_figure_of_its_own():
    curves = plot_errors(play(rich()))
    assert len(curves.axes) == 5
    assert curves._repr_png_().startswith(b"\x89PNG")
    run = Series.of(play(rich()))
    np.testing.assert_array_equal(curves.series[0].error, run.error)
    (line,) = lines(curves, "error-y-0")
    np.testing.assert_array_equal(line.get_ydata(), run.error[:, 1])


def test_the_panels_share_the_place_of_one_axes():
    figure = Figure()
    left, right = figure.subplots(1, 2)
    right.plot([0, 1], [0, 1])
    curves = plot_errors(play(rich()), left)
    figure.canvas.draw()
    assert curves.figure is figure
    assert curves._repr_png_() is None  # whoever made the figure shows it
    outer = left.get_window_extent()
    boxes = [axes.get_window_extent() for axes in curves.axes]
    assert all(outer.padded(1).contains(*corner) for b in boxes for corner in (b.min, b.max))
    assert all(above.y0 > below.y1 for above, below in pairwise(boxes))
    assert len(right.get_lines()) == 1


def test_axes_of_ones_own_are_filled_from_the_top():
    axes = Figure().subplots(5, 1)
    curves = plot_errors({"a": play(rich()), "b": play(rich())}, axes)
    assert curves.axes == tuple(axes)
    assert [line.axes for line in lines(curves, "nees-1")] == [axes[4]]
    assert [run.name for run in curves.series] == ["a", "b"]


def test_what_cannot_be_plotted_is_told_in_a_sentence():
    steps = play(rich())
    list(steps)
    with pytest.raises(UsageError, match="no steps to plot; a generator gives its steps once"):
        plot_errors(steps)
    for given in (rich(), "tour", 3, {"a": rich()}):
        with pytest.raises(UsageError, match="holds no steps; give those of a run"):
            plot_errors(given)
    with pytest.raises(UsageError, match="not as many steps"):
        plot_errors({"a": play(rich()), "b": play(scene(Move(1, 0)))})
    with pytest.raises(UsageError, match="there are 5 panels for 2 Axes; give one, or each"):
        plot_errors(play(rich()), Figure().subplots(2, 1))
