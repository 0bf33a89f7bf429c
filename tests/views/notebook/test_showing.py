"""What a cell shows of scenes, steps, views and summaries, and what their repr says in a line."""

import dataclasses
import pickle
import struct

import numpy as np
import pytest

import ekfsim
from ekfsim import localization
from ekfsim.records import Step
from ekfsim.views.notebook import showing

TOUR = ekfsim.load_scene("tour")
STEPS = [*ekfsim.play(TOUR)]
VIEWS = [*ekfsim.Playback(STEPS)]


def summed():
    summary = ekfsim.Summary.of(TOUR)
    for step in STEPS:
        summary.add(step)
    return summary


@pytest.mark.parametrize(
    ("one", "told"),
    [
        (TOUR, "Scene(commands/tour.yaml in worlds/furnished-room.yaml, 30 commands, ekf, seed 2, "
               "run 0)"),
        (TOUR.with_("gate", 0.9, "noise.rangeSigmaRatio", 0.1, guard="off"),
         "Scene(commands/tour.yaml in worlds/furnished-room.yaml, 30 commands, ekf, seed 2, run 0, "
         "gate 0.9, guard off, noise.rangeSigmaRatio=0.1)"),
        (TOUR.world, "World(furnished room: classroom, 7 obstacles, 0 landmarks, "
                     "start 1.2, 1.4, 0°)"),
        (STEPS[0], "Step(step 0: x 1.2, y 1.4, theta 0)"),
        (next(ekfsim.play(TOUR, np.arange(5))), "Step(step 0, 5 runs)"),
        (summed(), "Summary(30 steps, 15 of 15 readings used: consistent)"),
    ],
)  # fmt: skip
def test_a_repr_is_a_line(one, told):
    assert repr(one) == told


def test_a_step_and_a_view_say_where_the_estimate_is():
    x = STEPS[6].posterior.mean
    told = f"Step(step 6 (sense -86°): x {x[0]:.6g}, y {x[1]:.6g}, theta {x[2]:.6g})"
    assert repr(STEPS[6]) == told
    assert repr(VIEWS[6]) == f"View(6: the beam, of {told})"
    assert repr(VIEWS[7]) == f"View(7: as it ended, of {told})"


def size(png):
    assert png.startswith(b"\x89PNG")
    return struct.unpack(">II", png[16:24])


def test_scene_step_and_view_show_their_picture_and_their_words():
    told = {
        "guard     warn": TOUR,
        ekfsim.narrate(VIEWS[6], TOUR).splitlines()[0].replace(">", "&gt;"): VIEWS[6],
        "The innovation is ": STEPS[6],
    }
    for words, one in told.items():
        page = one._repr_html_()
        assert words in page
        assert page.count('src="data:image/png;base64,iVBOR') == 1
        assert size(one._repr_png_())[0] == 900


def test_the_picture_is_the_frame_of_the_view(monkeypatch):
    drawn = []
    frame = showing.Frame

    class Noted(frame):
        def png(self, view, *more):
            drawn.append(view)
            return super().png(view, *more)

    monkeypatch.setattr(showing, "Frame", Noted)
    VIEWS[12]._repr_html_()
    VIEWS[12]._repr_png_()
    assert drawn == [VIEWS[12]]  # once for both
    STEPS[6]._repr_png_()
    assert drawn[1].judged.nees == STEPS[6].nees  # judged as the run judges it


def test_a_summary_concludes():
    page = summed()._repr_html_()
    assert "Verdict: consistent" in page
    assert "<img" not in page
    assert summed()._repr_png_() is None


def test_a_step_of_no_scene_shows_its_numbers():
    step = [*localization.play(TOUR)][6]
    assert step.scene is None
    assert step._repr_png_() is None
    page = step._repr_html_()
    assert "covariance:" in page
    assert f"NIS {float(step.correction.nis):.6g}" in page


def test_texts_of_files_are_inert_in_a_page():
    scene = dataclasses.replace(TOUR, description="<script>alert(1)</script>")
    page = scene._repr_html_()
    assert "<script>" not in page
    assert "&lt;script&gt;" in page


def test_records_stay_what_they_were():
    step = STEPS[3]
    assert not hasattr(step, "__dict__")
    assert not hasattr(VIEWS[3], "__dict__")
    assert step == dataclasses.replace(step, scene=None)
    assert pickle.loads(pickle.dumps(step)).entry.index == 3
    assert [field.name for field in dataclasses.fields(Step)][-1] == "scene"


def test_an_explanation_shows_its_words_and_its_picture():
    found = ekfsim.why("diverge-02c-laser-distrusted", runs=100)
    assert "Over-cautious, not lost: told four times" in found._repr_html_()
    assert found._repr_png_().startswith(b"\x89PNG")
