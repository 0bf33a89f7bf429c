"""The ellipses of several hypotheses and their weights, which do not cover each other."""

from dataclasses import replace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from ekfsim.files.scenes.load import load_scene
from ekfsim.filters.belief import Gaussian, parts
from ekfsim.geometry.ellipse import outline
from ekfsim.localization import play
from ekfsim.views.picture.belief.hypotheses import HypothesisArtists


def drawn(several, width=10.0):
    figure = Figure(figsize=(5, 5), dpi=100)
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, width), ylim=(0, width))
    artists = HypothesisArtists(axes)
    artists.show(several, 0.954)
    return figure, artists


def test_of_eight_at_once_the_weights_do_not_cover_each_other():
    """Wherever they lie: heaps of eight in a room, and all on one spot."""
    rng = np.random.default_rng(3)
    for spread in (3.0, 1.0, 0.3, 0.0):
        w = np.sort(rng.dirichlet(np.ones(8)))
        means = np.column_stack([5 + spread * rng.uniform(-1, 1, (8, 2)), np.zeros(8)])
        P = np.diag([0.04, 0.02, 0.01])
        several = [(float(one), Gaussian(mean, P)) for one, mean in zip(w, means, strict=True)]
        figure, artists = drawn(several)
        renderer = FigureCanvasAgg(figure).get_renderer()
        shown = [label for label in artists.labels if label.get_visible()]
        assert len(artists.ellipses.get_paths()) == 8
        assert shown[0].get_text() == f"{w[-1]:.2f}"  # the heaviest always
        boxes = [label.get_window_extent(renderer) for label in shown]
        for i, box in enumerate(boxes):
            assert not any(box.overlaps(other) for other in boxes[:i])
        assert len(shown) >= (3 if spread < 1 else 6)


def test_each_ellipse_is_that_of_its_hypothesis():
    steps = play(replace(load_scene("kidnap"), filter="mhekf"))
    step = max(steps, key=lambda step: len(parts(step.posterior, step.layout)))
    several = parts(step.posterior, step.layout)
    assert len(several) > 4
    _, artists = drawn(several)
    paths, colours = artists.ellipses.get_paths(), artists.ellipses.get_colors()
    for (w, (x, P)), path, colour in zip(several[::-1], paths, colours, strict=True):
        np.testing.assert_allclose(path.vertices, outline(x[:2], P[:2, :2], 0.954))
        assert colour[3] == pytest.approx(0.35 + 0.65 * w)
    artists.show([], 0.954)
    assert not artists.ellipses.get_paths()
    assert not any(label.get_visible() for label in artists.labels)
