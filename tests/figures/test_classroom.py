"""The figures of document 002: the display, the proofs, a divergence, σ_xθ, and the size of an
ellipse."""

import csv
import re

import numpy as np
import pytest

from ekfsim.figures.album import Album
from ekfsim.figures.classroom.document import draw_classroom
from ekfsim.figures.classroom.proofs import shipped
from ekfsim.localization import play
from ekfsim.views.picture.extent import scope as scopes
from ekfsim.views.picture.frames import Frame
from ekfsim.views.playback.playback import views


class Kept(Album):
    """An album that keeps its figures, and writes none."""

    def add(self, figure, name, title, caption, source=None):
        self.drawn = {**getattr(self, "drawn", {}), name: figure}
        self.captions = {**getattr(self, "captions", {}), name: caption}


@pytest.fixture(scope="module")
def album(tmp_path_factory):
    kept = Kept("classroom", "test", tmp_path_factory.mktemp("classroom"))
    draw_classroom(shipped("tour"), kept)
    return kept


def test_every_figure_is_there(album):
    assert list(album.drawn) == ["display", "divergence", "theta", "ellipse"]
    assert [path.name for path in album.folder.iterdir()] == ["proofs.csv"]
    assert any("made up" in page for page in album.pages)


def test_the_display_is_six_pictures_as_they_are_rendered(album):
    images = [axes.images[0].get_array() for axes in album.drawn["display"].axes]
    scene = shipped("tour")
    shown, frame = list(views(play(scene))), Frame(scene, scopes.of(scene, play(scene)))
    for image, number in zip(images, [0, 2, 4, 6, 7, 45], strict=True):
        np.testing.assert_array_equal(image, frame.rgb(shown[number]))
    assert not any(axes.get_title(loc="left") for axes in album.drawn["display"].axes)


def test_every_proof_gives_what_was_expected(album):
    with (album.folder / "proofs.csv").open(encoding="utf-8") as file:
        rows = list(csv.reader(file))[1:]
    assert {row[0] for row in rows} == {
        f"proof-{name}" for name in (
            "no-noise", "turn-noise", "distance-noise", "heading-bends", "square-twice",
            "across-wall", "corner",
            "nearest-wall", "expected-wall", "one-after-another",
            "two-beams", "dead-reckoning", "unsure-start", "coverage", "every-mistake",
        )
    }  # fmt: skip
    for _, what, expected, measured, _ in rows:
        if "runs" in what:
            shares = [float(share) for share in re.findall(r"[\d.]+", measured)]
            assert shares == pytest.approx([95.4, 95.4], abs=2)
        else:
            assert measured == expected
    # it would end a cell of the captions
    assert not any("|" in cell for row in rows for cell in row)


def line(axes, gid):
    return next(one for one in axes.get_lines() if one.get_gid() == gid)


def test_the_divergence_begins_with_the_beam_that_is_shown(album):
    room, error, nis, nees = album.drawn["divergence"].axes
    step = int(re.search(r"step (\d+)", room.get_title()).group(1))
    told = [text.get_text() for text in nees.get_legend().get_texts()]
    assert told[:2] == ["wrong wall", "the same, --guard skip"]
    assert "tour" not in told  # another world's run is no third setting of this one
    wrong, cured = (np.abs(line(error, f"error-x-{n}").get_ydata()) for n in (0, 1))
    assert wrong[-1] > 1 > 0.2 > cured[-1]
    over = np.flatnonzero(np.nan_to_num(line(nees, "nees-0").get_ydata()) > 16.27)
    assert over.tolist() == list(range(step, len(wrong)))
    assert line(nis, "nis-0").get_ydata()[line(nis, "nis-0").get_xdata() == step] > 10.83
    assert not (line(nees, "nees-1").get_ydata() > 16.27).any()
    assert line(nees, "lost-0").get_xdata()[0] == step
    bounds = [line(nees, f"bound-{p}-0").get_ydata()[-1] for p in (0.95, 0.999)]
    assert bounds == pytest.approx([7.815, 16.266], abs=1e-3)
    assert re.search(r"1000 runs 3\d\.\d % end lost", album.captions["divergence"])


def test_theta_shows_the_conditional_ellipses_far_apart_before_the_beam_and_together_after(album):
    apart = []
    for axes in album.drawn["theta"].axes:
        plus, minus = (
            next(line for line in axes.get_lines() if line.get_gid() == gid)
            for gid in ("ellipse-plus", "ellipse-minus")
        )
        apart.append(np.mean(plus.get_ydata()) - np.mean(minus.get_ydata()))
    assert apart[0] == pytest.approx(2 * 1.272, abs=0.005)
    assert apart[1] == pytest.approx(2 * 0.061, abs=0.005)
    close = album.drawn["theta"].axes[1]  # where the robot's own symbol covered them all
    body, ellipse = (
        next(patch for patch in close.patches if patch.get_gid() == gid)
        for gid in ("body", "ellipse")
    )
    assert np.ptp(body.get_xy(), axis=0).max() < 0.5 * np.ptp(ellipse.get_xy(), axis=0).min()
    assert "the dashed and the dotted ellipse" in " ".join(album.captions["theta"].split())


def test_two_standard_deviations_hold_86_percent_of_an_ellipse(album):
    left, right = album.drawn["ellipse"].axes
    labels = [str(line.get_label()) for line in left.get_lines()]
    assert labels[1:] == ["k = 2.482: 95.1 % inside", "k = 2: 86.5 % inside"]
    formula = next(line for line in right.get_lines() if "exp" in str(line.get_label()))
    k, share = formula.get_data()
    assert np.interp(2.4816, k, share) == pytest.approx(95.4, abs=0.02)
    for line in right.get_lines():
        if str(line.get_label()).startswith("proof-"):
            assert np.abs(line.get_ydata() - share).max() < 4
    assert "2.4816" in album.captions["ellipse"]
