"""What is shown of a filter that has no idea yet where the robot is: particles, and no place."""

import csv
import io
import math
from dataclasses import replace

import numpy as np
import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure

from ekfsim import load_scene
from ekfsim.files.results.trajectories import Table
from ekfsim.localization import play
from ekfsim.views.page.told import Teller
from ekfsim.views.picture.belief.shape import Shape
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.frames import Picture
from ekfsim.views.picture.look import Look
from ekfsim.views.playback.playback import views
from ekfsim.views.terminal.drawing import draw
from ekfsim.views.words.captions import notes, spread
from ekfsim.views.words.judgement import judgement, standing
from ekfsim.views.words.narrative.narrating import narrate


@pytest.fixture(scope="module")
def scene():
    made = load_scene("unknown-start")
    return replace(made, tuning=replace(made.tuning, particles=2000))


@pytest.fixture(scope="module")
def steps(scene):
    return list(play(scene))


@pytest.fixture(scope="module")
def shown(steps):
    return list(views(steps))


def test_it_has_no_idea_until_its_particles_gather(shown):
    told = [view.unplaced for view in shown]
    assert told[0]
    assert not told[-1]
    assert told == sorted(told, reverse=True)  # once found it stays so
    gathered = told.index(False)
    assert shown[gathered].was_unplaced
    assert shown[gathered].earlier is None  # no grey ellipse larger than the room
    assert "now it has an idea" in notes(shown[gathered], load_scene("unknown-start"), None)[0]


def test_no_words_give_it_a_place(shown, scene):
    first = narrate(shown[0], scene)
    assert "First state estimate: none, its particles lie all over the room\n" in first
    for view in shown:
        told = narrate(view, scene)
        if view.unplaced:
            assert "ellipse is:" not in told
            assert "lies inside" not in told
            assert spread(view, 0.954) == "no idea yet: anywhere in the room"
            assert "no idea yet where it is" in judgement(view, scene, 0.954)
            assert not standing(view, 0.954).outside
        elif not view.beam:
            assert "Uncertainty ellipse is:" in told
            assert spread(view, 0.954).startswith("radii ")


def test_no_picture_gives_it_a_place(shown, scene):
    for view in (shown[0], shown[-1]):
        shape = Shape.of(view, 0.954)
        assert np.isnan(shape.region.rim).all() == view.unplaced
        assert np.isnan(shape.region.pose).all() == view.unplaced
        text = draw(view, scene, 0.954, (100, 30), (-1, 11, -1, 9), colour=False, ascii=True)
        assert ("no idea yet: anywhere in the room" in text) == view.unplaced
        assert ("95.4 % ellipse" in text) != view.unplaced
        assert "particles" in text
    assert len(shown[0].path()) == 0
    assert np.isnan(shown[-1].reckoned.points()).all()


def test_the_legend_names_particles_and_no_place(shown, steps, scene):
    figure = Figure(figsize=(9, 7), dpi=50)
    FigureCanvasAgg(figure)
    picture = Picture(figure, scene, scopes.of_all(scene, [steps]))
    for view in (shown[0], shown[-1]):
        picture.show(view)
        words = [text.get_text() for text in picture.legend.get_texts()]
        assert "particles" in words
        assert ("95.4 % ellipse (2.48 σ)" in words) != view.unplaced
        assert ("estimate" in words) != view.unplaced


def test_a_page_is_told_so(shown, scene):
    teller = Teller(scene, Look(), np.zeros(2), 10.0, 16)
    first, last = teller.tell(shown[0]), teller.tell(shown[-1])
    assert first["by"][0]["unplaced"] == 1
    assert len(first["by"][0]["crowd"]) > 100
    assert "unplaced" not in last["by"][0]
    assert "away" not in first


def test_a_table_has_no_ellipse_of_it(steps, shown, scene):
    file = io.StringIO()
    table = Table(file, scene, 0.954)
    for step in steps:
        table.write(step)
    rows = list(csv.DictReader(io.StringIO(file.getvalue())))
    unplaced = {view.step.entry.index: view.unplaced for view in shown}
    for row in rows:
        assert (row["ellipse_major"] == "") == unplaced[int(row["index"])]
        assert math.isfinite(float(row["nees"]))
