import io

import numpy as np
import pytest
from matplotlib.colors import to_rgb
from PIL import Image
from scenes import rich
from systems_scenes import mower

from ekfsim.localization import play
from ekfsim.views.curves.plot import figure_of
from ekfsim.views.curves.series import Series
from ekfsim.views.curves.strip import COMING, HEIGHT, Strip, Stripped
from ekfsim.views.picture.extent import scope
from ekfsim.views.picture.frames import Frame
from ekfsim.views.playback.playback import views

WIDTH, DPI = 900, 100


def strip_of(made):
    return Strip([Series.of(play(made))], WIDTH, DPI)


def lines(axes):
    return {line.get_gid(): line for own in axes for line in own.get_lines() if line.get_gid()}


@pytest.mark.parametrize(("made", "column"), [(rich(), "index"), (mower(), "t")])
def test_the_cursor_stands_at_the_step_that_is_shown(made, column):
    strip, run = strip_of(made), Series.of(play(made))
    over = getattr(run, column)
    for view in list(views(play(made)))[::7]:
        strip.show(view)
        x = over[run.index.tolist().index(view.step.entry.index)]
        assert {tuple(cursor.get_xdata()) for cursor in strip.cursors} == {(x, x)}
        for veil in strip.veils:
            assert veil.get_x() == x
            assert veil.get_x() + veil.get_width() == pytest.approx(over[-1])


def test_what_is_yet_to_come_is_faint_and_what_was_is_as_it_is_drawn():
    strip, every = strip_of(rich()), list(views(play(rich())))
    whole, middle = strip.rgba(every[-1]).copy(), every[len(every) // 2]
    seen = strip.rgba(middle)
    for axes in strip.axes:
        box = axes.get_window_extent()
        x = round(axes.transData.transform((middle.step.entry.index, 0))[0])
        rows = slice(round(HEIGHT * DPI - box.y1) + 2, round(HEIGHT * DPI - box.y0) - 2)
        assert (seen[rows, round(box.x0) : x - 3] == whole[rows, round(box.x0) : x - 3]).all()
        coming, drawn = (s[rows, x + 3 : round(box.x1) - 3, :3].astype(int) for s in (seen, whole))
        np.testing.assert_allclose(coming, 255 - (1 - COMING) * (255 - drawn), atol=3)
        assert (np.abs(seen[rows, x, :3] - 255 * np.array(to_rgb("black"))) < 80).all()


def test_its_panels_show_what_the_plot_shows():
    run = Series.of(play(rich()))
    plot, strip = lines(figure_of([run]).axes), lines(Strip([run], WIDTH, DPI).axes)
    assert set(strip) - {"cursor"} == set(plot)
    for gid, line in plot.items():
        np.testing.assert_array_equal(strip[gid].get_xdata(), line.get_xdata())
        np.testing.assert_array_equal(strip[gid].get_ydata(), line.get_ydata())


def test_panels_and_their_words_lie_side_by_side():
    strip = strip_of(rich())
    boxes = [axes.get_tightbbox() for axes in strip.axes]
    figure = strip.axes[0].figure.bbox
    for n, box in enumerate(boxes):
        assert figure.contains(box.x0, box.y0)
        assert figure.contains(box.x1, box.y1)
        for other in (axes.get_window_extent() for axes in strip.axes[:n] + strip.axes[n + 1 :]):
            assert not box.overlaps(other)


def test_a_picture_has_the_strip_beneath_it():
    made = rich()
    frame, run = Frame(made, scope.of(made, play(made))), Series.of(play(made))
    stripped, strip = Stripped(Frame(made, scope.of(made, play(made))), [run]), strip_of(made)
    for view in list(views(play(made)))[5:7]:
        above, beneath = frame.rgba(view), strip.rgba(view)
        both = stripped.rgba(view)
        assert (both[: len(above)] == above).all()
        assert (both[len(above) :] == beneath).all()
        assert (stripped.rgb(view) == both[..., :3]).all()
        with Image.open(io.BytesIO(stripped.png(view, {"View": "5"}))) as picture:
            assert picture.text == {"View": "5"}
            assert (np.asarray(picture) == both[..., :3]).all()
