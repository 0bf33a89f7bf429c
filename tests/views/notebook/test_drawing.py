"""A view on Axes of one's own: nothing lies on the picture, and of many runs the world is one."""

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

import ekfsim
from ekfsim.views.notebook.drawing import Naming, Over
from ekfsim.views.picture.artists import empty

TOUR = ekfsim.load_scene("tour")
STEPS = [*ekfsim.play(TOUR)]
VIEWS = [*ekfsim.Playback(STEPS)]
BEAM = VIEWS[6]


def figure(rows=1, columns=1, **told):
    made = Figure(figsize=(9, 7), **told)
    FigureCanvasAgg(made)
    return made, made.subplots(rows, columns, squeeze=False).ravel()


def words(axes):
    return [text.get_text() for text in axes.get_legend().get_texts()]


def with_gid(axes, gid):
    return [child for child in axes.get_children() if child.get_gid() == gid]


@pytest.mark.parametrize(("rows", "columns"), [(1, 1), (2, 2), (3, 1)])
@pytest.mark.parametrize("layout", [None, "constrained"])
def test_no_legend_lies_on_a_picture(rows, columns, layout):
    made, every = figure(rows, columns, layout=layout)
    for axes, number in zip(every, (6, 12, 20, 40), strict=False):
        ekfsim.draw(VIEWS[number], TOUR, axes)
    made.canvas.draw()
    for axes in every:
        legend = axes.get_legend().get_window_extent()
        assert not any(legend.overlaps(other.bbox) for other in every)


def test_the_room_is_the_axes_own():
    made, (axes,) = figure()
    place = axes.get_position()
    ekfsim.draw(BEAM, TOUR, axes)
    made.canvas.draw()
    legend, box = axes.get_legend().get_window_extent(), axes.get_position()
    right = legend.x1 / made.bbox.width
    assert place.x0 - 1e-9 <= box.x0 < box.x1 < right <= place.x1 + 1e-9
    assert place.y0 - 1e-9 <= box.y0 < box.y1 <= place.y1 + 1e-9


def test_the_legend_stands_beneath_a_wide_world_in_a_narrow_place():
    made, (axes,) = figure(layout=None)
    axes.set_position((0.1, 0.4, 0.35, 0.5))
    ekfsim.draw(BEAM, TOUR, axes)
    made.canvas.draw()
    legend, labels = axes.get_legend().get_window_extent(), axes.xaxis.get_tightbbox()
    assert legend.y1 < labels.y0


def test_the_legend_tells_what_is_seen_and_can_be_left_out():
    _, (axes,) = figure()
    ekfsim.draw(BEAM, TOUR, axes)
    assert "beam, as measured" in words(axes)
    _, (axes,) = figure()
    ekfsim.draw(VIEWS[0], TOUR, axes)
    assert "beam, as measured" not in words(axes)
    _, (axes,) = figure()
    ekfsim.draw(BEAM, TOUR, axes, legend=False)
    assert axes.get_legend() is None


def namings(axes):
    return [child for child in axes.get_children() if isinstance(child, Naming)]


@pytest.mark.parametrize("layout", [None, "constrained"])
def test_obstacles_have_their_names_in_the_place_that_the_axes_has_at_last(layout):
    made, (axes,) = figure(layout=layout)
    ekfsim.draw(BEAM, TOUR, axes)
    made.canvas.draw()
    ((naming,),) = [namings(axes)]
    told = {
        name.text: axes.transData.inverted().transform(name.center) for name in naming._names.shown
    }
    assert {"table", "sofa", "piano"} <= set(told)
    (table,) = [one for one in TOUR.world.map.obstacles if one.name == "table"]
    assert told["table"] == pytest.approx(table.points.mean(axis=0), abs=0.2)


def test_of_several_runs_the_world_is_drawn_once_and_each_has_its_own_look():
    _, (axes,) = figure()
    runs = [(TOUR, ""), (TOUR.with_(filter="ukf"), ""), (TOUR.with_(run=3), ""),
            (TOUR.with_(run=4), "run 4")]  # fmt: skip
    pictures = []
    for scene, label in runs:
        last = [*ekfsim.Playback(ekfsim.play(scene))][-1]
        pictures.append(ekfsim.draw(last, scene, axes, label=label))
    assert len(with_gid(axes, "obstacles")) == len(with_gid(axes, "floor")) == 1
    assert len(namings(axes)) == 1
    told = [word.partition(":")[0] for word in words(axes) if "estimate" in word and ":" in word]
    assert told == ["ekf", "ukf", "ekf (2)", "run 4"]
    of_each = {"path": "get_color", "reference": "get_marker"}
    for what, look in of_each.items():
        lines = [line for line in axes.lines if str(line.get_gid()).startswith(what)]
        assert len({getattr(line, look)() for line in lines}) == len(lines) == 4
    assert all(isinstance(picture, Over) for picture in pictures[1:])


def test_what_comes_back_moves_the_same_artists():
    _, (axes,) = figure()
    first = ekfsim.draw(VIEWS[0], TOUR, axes)
    over = ekfsim.draw(VIEWS[0], TOUR, axes, label="again")
    children = len(axes.get_children())
    for picture in (first, over):
        picture.show(VIEWS[-1], None)
    assert len(axes.get_children()) == children
    (path,), (again,) = with_gid(axes, "path"), with_gid(axes, "path-again")
    assert path.get_xydata().tolist() == again.get_xydata().tolist()
    assert not empty(path)


def test_another_world_or_cleared_axes_begin_anew():
    _, (axes,) = figure()
    place = axes.get_position().bounds
    ekfsim.draw(BEAM, TOUR, axes)
    axes.clear()
    ekfsim.draw(BEAM, TOUR, axes, legend=False)
    assert len(with_gid(axes, "obstacles")) == 1
    assert axes.get_position().bounds == pytest.approx(place)
    square = ekfsim.load_scene("square")
    ekfsim.draw(next(iter(ekfsim.Playback(ekfsim.play(square)))), square, axes)
    assert len(with_gid(axes, "obstacles")) == 2


def test_a_run_that_goes_farther_makes_the_picture_larger():
    _, (axes,) = figure()
    ekfsim.draw(STEPS[0], TOUR, axes)
    before = axes.get_xlim()
    far = ekfsim.load_scene("tour").with_("belief.start.x", 30)
    ekfsim.draw([*ekfsim.Playback(ekfsim.play(far))][-1], far, axes, label="astray")
    assert axes.get_xlim()[1] > before[1] + 15
