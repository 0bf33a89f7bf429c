import math
import re
from collections import Counter
from dataclasses import replace
from itertools import islice, pairwise

import numpy as np
import pytest
from matplotlib.colors import to_hex
from scenes import rich, scene, unbounded
from systems_scenes import landmarks, mower

from ekfsim.commands import Kidnap, Move, Sense
from ekfsim.diagnostics.verdict import LOST
from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.localization import play
from ekfsim.views.curves.bands import NAMES, ErrorPanel
from ekfsim.views.curves.events import Happened
from ekfsim.views.curves.judged import LEAST
from ekfsim.views.curves.marks import MARKS
from ekfsim.views.curves.panels import panels_of, remarks
from ekfsim.views.curves.plot import figure_of, verdict
from ekfsim.views.curves.series import Series, bound
from ekfsim.views.curves.thinning import peaks

WRONG_WALL = load_scene("commands/diverge-01-wrong-wall.yaml")


def drawn(*runs):
    """A figure and its artists by gid; of one that is in several panels, the list."""
    figure = figure_of(runs, "a title", "made by")
    artists = {}
    for axes in figure.axes:
        for artist in axes.get_children():
            if artist.get_gid():
                artists.setdefault(artist.get_gid(), []).append(artist)
    return figure, {gid: found[0] if len(found) == 1 else found for gid, found in artists.items()}


def points(line):
    return np.column_stack(line.get_data(orig=True))


def words(legend):
    return [text.get_text() for text in legend.get_texts()]


@pytest.mark.parametrize("made", [rich(), unbounded(), mower(), landmarks()])
def test_lines_and_bands_are_those_of_the_series(made):
    run = Series.of(play(made))
    _, artists = drawn(run)
    known = ~np.isnan(run.error[:, 0])
    for entry, (name, _, unit) in enumerate(NAMES):
        line = points(artists[f"error-{name}-0"])
        line = line[~np.isnan(line[:, 1])]
        np.testing.assert_array_equal(line[:, 0], run.abscissa[known])
        np.testing.assert_allclose(line[:, 1], unit * run.error[known, entry])
        band = np.vstack([path.vertices for path in artists[f"band-{name}-0"].get_paths()])
        for side in (2, -2):
            edge = np.column_stack([run.abscissa, side * unit * run.sigma[:, entry]])[known]
            for corner in edge[:: max(len(edge) // 50, 1)]:
                assert np.isclose(band, corner, rtol=1e-12, atol=0).all(axis=1).any()
    nees = points(artists["nees-0"])
    np.testing.assert_array_equal(nees[:, 0], run.abscissa)
    log = artists["nees-0"].axes.get_yscale() == "log"
    np.testing.assert_array_equal(nees[:, 1], np.maximum(run.nees, LEAST) if log else run.nees)
    used = run.used & ~np.isnan(run.nis)
    nis = points(artists["nis-0"])
    np.testing.assert_array_equal(nis[:, 0], run.abscissa[used])
    log = artists["nis-0"].axes.get_yscale() == "log"
    np.testing.assert_array_equal(
        nis[:, 1], np.maximum(run.nis[used], LEAST) if log else run.nis[used]
    )


def test_bounds_are_the_quantiles_of_their_freedom():
    run = Series.of(play(rich()))
    _, artists = drawn(run)
    for probability in (0.95, LOST):
        assert set(artists[f"bound-{probability}-1"].get_ydata()) == {quantile(probability, 1)}
        told = points(artists[f"bound-{probability}-0"])
        rows = np.searchsorted(run.abscissa, told[:, 0])
        np.testing.assert_array_equal(told[:, 1], bound(probability, run.nees_dof)[rows])
        # nothing is left out but what lies on the line
        between = np.interp(run.abscissa, told[:, 0], told[:, 1])
        np.testing.assert_allclose(between, bound(probability, run.nees_dof))


@pytest.mark.parametrize("made", [rich(), rich(guard="skip"), unbounded()])
def test_what_happened_and_what_was_not_used_is_marked_at_its_step(made):
    run = Series.of(play(made))
    _, artists = drawn(run)
    found = Counter()
    for happened, mark in MARKS.items():
        name = happened.name.lower()
        places = [f"event-{name}"] if mark.colour else [f"read-{name}-0", f"unread-{name}-0"]
        for place in places:
            if place in artists:
                assert artists[place].get_marker() == mark.marker
                found.update((x, happened) for x in artists[place].get_xdata())
                if place.startswith("read"):
                    rows = np.searchsorted(run.index, artists[place].get_xdata())
                    np.testing.assert_array_equal(
                        artists[place].get_ydata(), np.maximum(run.nis[rows], LEAST)
                    )
        if mark.dashes and f"line-{name}" in artists:
            for line in artists[f"line-{name}"]:
                at = [segment[0, 0] for segment in line.get_segments()]
                assert at == artists[f"event-{name}"].get_xdata().tolist()
    assert found == Counter((run.index[e.row], e.happened) for e in run.events)


def test_the_legend_explains_what_occurs_and_nothing_else():
    for made in (rich(), unbounded(), scene(Move(1, 0), Sense(0.2))):
        run = Series.of(play(made))
        figure, _ = drawn(run)
        told = words(figure.legends[1])
        kinds = {e.happened.value for e in run.events}
        assert set(told) & {h.value for h in Happened} == kinds
        assert ("belief impossible" in told) == bool(run.impossible.any())


def test_where_a_filter_is_lost_is_a_line_through_all_panels():
    run = Series.of(play(WRONG_WALL), "ekf")
    figure, artists = drawn(run)
    assert [set(line.get_xdata()) for line in artists["lost-0"]] == [{13.0}] * 5
    assert artists["lost-words-13"].get_text() == "lost since step 13"
    assert [" ".join(word.split()) for word in words(figure.legends[0])] == [verdict(run)]
    assert verdict(run).startswith("ekf: lost from step 13 on")
    assert re.search(r"; innovations are white \(p \S+\)$", verdict(run))
    _, artists = drawn(Series.of(play(load_scene("commands/tour.yaml")), "ekf"))
    assert not [gid for gid in artists if gid.startswith("lost")]


def test_an_impossible_belief_is_marked():
    made = scene(Move(1.0, 0.0), Kidnap(3.0, 2.0, 0.0), Sense(0.0), start=(1, 1, 0))
    run = Series.of(play(made))
    assert run.impossible.any()
    _, artists = drawn(run)
    assert artists["impossible-0"].get_xdata().tolist() == run.index[run.impossible].tolist()


def test_a_large_nees_flattens_nothing_and_a_small_one_needs_no_decades():
    _, lost = drawn(Series.of(play(WRONG_WALL)))
    assert lost["nees-0"].axes.get_yscale() == lost["nis-0"].axes.get_yscale() == "log"
    _, kept = drawn(Series.of(play(load_scene("commands/tour.yaml"))))
    assert kept["nees-0"].axes.get_yscale() == kept["nis-0"].axes.get_yscale() == "linear"
    assert kept["nees-0"].axes.get_ylim()[1] > quantile(LOST, 3)


def test_errors_far_beyond_their_band_leave_it_to_be_seen():
    """The band of a lost run is a share of its axis that an eye can see."""
    _, lost = drawn(Series.of(play(WRONG_WALL)))
    axes = lost["error-x-0"].axes
    assert axes.get_yscale() == "symlog"
    assert axes.get_ylabel() == "x error (m)\nlog beyond 0.5"
    assert axes.get_yticks().tolist() == [-50, -5, -0.5, 0, 0.5, 5, 50]
    _, kept = drawn(Series.of(play(load_scene("commands/tour.yaml"))))
    assert kept["error-x-0"].axes.get_yscale() == "linear"


def test_a_heading_error_that_goes_past_half_a_turn_breaks_its_line():
    turns = [Kidnap(3, 2, math.radians(a)) for a in (-100, -170, 170, 100)]
    run = Series.of(play(scene(*turns, start=(1, 1, 0), sigma=(0.1, 0.1, 0.1))))
    _, artists = drawn(run)
    line = points(artists["error-theta-0"])[1:, 1]
    np.testing.assert_allclose(line[[0, 1, 3, 4]], np.degrees(run.error[1:, 2]))
    assert np.isnan(line[2])


def test_filters_are_told_apart_by_colour_by_dashes_and_by_dots():
    runs = [Series.of(play(rich()), name) for name in ("ekf", "ukf", "pf", "mine.py")]
    figure, artists = drawn(*runs)
    lines = [artists[f"error-x-{n}"] for n in range(4)]
    assert len({to_hex(line.get_color()) for line in lines}) == 4
    assert len({str(line._unscaled_dash_pattern) for line in lines}) == 4
    assert len({artists[f"nis-{n}"].get_marker() for n in range(4)}) == 4
    assert [line.get_color() for line in figure.legends[0].get_lines()] == [
        line.get_color() for line in lines
    ]
    assert [text.partition(":")[0] for text in words(figure.legends[0])] == [r.name for r in runs]


def test_steps_are_whole_and_a_clock_counts_seconds():
    figure, _ = drawn(Series.of(play(scene(Move(1, 0), Sense(0.1)))))
    assert figure.axes[-1].get_xlabel() == "step"
    assert all(tick == round(tick) for tick in figure.axes[-1].get_xticks())
    figure, _ = drawn(Series.of(play(mower())))
    assert figure.axes[-1].get_xlabel() == "t (s)"


def test_without_a_truth_there_are_innovations_and_nis():
    steps = list(play(landmarks()))
    run = Series.of(replace(s, entry=replace(s.entry, truth=None), nees=None) for s in steps)
    figure, artists = drawn(run)
    assert [quantity.unit for quantity in run.innovations] == ["m", "rad"]
    assert len(figure.axes) == 1 + len(run.innovations) == len(panels_of([run]))
    for quantity, found in run.innovations.items():
        unit = math.degrees(1) if quantity.unit == "rad" else 1
        dots = points(artists[f"innovation-{quantity.name}-0"])
        np.testing.assert_allclose(
            dots, np.column_stack([run.abscissa[found.rows], unit * found.ν])
        )
    assert remarks([run]) == ["no truth is known: innovations and NIS alone"]


def test_what_was_learnt_of_a_noise_has_a_panel():
    """Of each kind of reading its own line: the square root of the factor on the told R."""
    made = scene(Move(1, 0), Sense(0.1), Sense(1.6), Move(0.5, 0.2), Sense(0.3))
    run = Series.of(play(replace(made, filter="adaptive")), "adaptive")
    figure, artists = drawn(Series.of(play(made), "ekf"), run)
    assert "learnt σ / told" in [axes.get_ylabel() for axes in figure.axes]
    steps = [s for s in play(replace(made, filter="adaptive")) if s.correction]
    expected = [(s.entry.index, math.sqrt(s.correction.noise_factor)) for s in steps]
    np.testing.assert_allclose(points(artists["learnt-range-1"]), expected)
    assert "learnt-range-0" not in artists
    plain, _ = drawn(Series.of(play(made)))
    assert len(plain.axes) == len(figure.axes) - 1


def test_a_long_run_keeps_its_peaks_and_says_that_it_is_thinned():
    made = load_scene("commands/gnss.yaml")
    run = Series.of(play(made))
    _, artists = drawn(run)
    for entry, (name, _, unit) in enumerate(NAMES):
        line, e = artists[f"error-{name}-0"].get_ydata(), unit * run.error[:, entry]
        assert len(line) < len(run)
        assert (np.nanmin(line), np.nanmax(line)) == (np.nanmin(e), np.nanmax(e))
    assert np.nanmax(artists["nees-0"].get_ydata()) == np.nanmax(run.nees)
    assert len(artists["nees-0"].get_xdata()) == len(peaks(run.nees[:, None]))
    assert remarks([run]) == [
        "8191 steps are drawn as 1000 stretches, each by its least and its greatest value"
    ]


@pytest.mark.parametrize(
    "name", ["mower", "pioneer", "pylon", "pylon-lidar", "landmarks", "ranges", "theta"]
)
def test_every_system_is_drawn_without_a_warning(name):
    """Each warning is an error here (pyproject.toml)."""
    run = Series.of(islice(play(load_scene(f"commands/{name}.yaml")), 800), "ekf")
    figure, _ = drawn(run)
    figure.canvas.draw()
    assert len(figure.axes) == 5 if run.read.any() else 4


def test_names_are_drawn_as_they_are():
    """A file's name is no mathematics, and one that begins with _ is not left out."""
    names = ["_$x^2$.py", "a\\frac{.py"]
    figure, _ = drawn(*(Series.of(play(scene(Move(1, 0), Sense(0.1))), name) for name in names))
    figure.canvas.draw()
    told = words(figure.legends[0])
    assert told[0].startswith(" _$x^2$.py: ")
    assert told[1].startswith("a\\frac{.py: ")
    assert not any(text.get_parse_math() for text in figure.legends[0].get_texts())


def test_labels_of_panels_lie_beside_each_other():
    """All panels share their steps, and no text lies on another panel."""
    figure, _ = drawn(*(Series.of(play(WRONG_WALL), name) for name in ("ekf", "ukf", "pf")))
    figure.canvas.draw()
    boxes = [axes.get_window_extent() for axes in figure.axes]
    for above, below in pairwise(boxes):
        assert above.y0 > below.y1
    (foot,) = (text for text in figure.texts if text.get_gid() == "source")
    for legend in figure.legends:
        extent = legend.get_window_extent()
        assert not extent.overlaps(foot.get_window_extent())
        assert not any(extent.overlaps(box) for box in boxes)
        assert extent.x1 <= figure.bbox.x1
    heads = [legend.get_window_extent() for legend in figure.legends]
    for text in figure.axes[0].texts:
        assert not any(text.get_window_extent().overlaps(head) for head in heads)
    assert len({axes.get_xlim() for axes in figure.axes}) == 1


def test_only_the_pose_has_errors():
    assert [
        panel.entry
        for panel in panels_of([Series.of(play(mower()))])
        if isinstance(panel, ErrorPanel)
    ] == [0, 1, 2]


def test_filters_that_are_lost_at_one_step_are_told_together():
    runs = [Series.of(play(WRONG_WALL), name) for name in ("ekf", "mine.py")]
    for run, lost in zip(runs, (13, 13), strict=True):
        run.evidence.lost_from = lost
    _, artists = drawn(*runs)
    assert artists["lost-words-13"].get_text() == "ekf, mine.py: lost since step 13"
    runs[1].evidence.lost_from = 20
    _, artists = drawn(*runs)
    told = [artists[f"lost-words-{step}"].get_text() for step in (13, 20)]
    assert told == ["ekf: lost since step 13", "mine.py: lost since step 20"]
