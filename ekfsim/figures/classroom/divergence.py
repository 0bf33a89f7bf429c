"""Document 002: an input that makes the filter diverge, and why."""

from dataclasses import replace

import numpy as np

from ekfsim.diagnostics.verdict import LOST
from ekfsim.figures.album import Album
from ekfsim.figures.classroom.proofs import RUNS, shipped
from ekfsim.figures.classroom.room import room
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.localization import play
from ekfsim.provenance import told_in_a_line
from ekfsim.records import Reading, Step
from ekfsim.scene import Scene
from ekfsim.views.curves.bands import ErrorPanel
from ekfsim.views.curves.judged import NeesPanel, NisPanel
from ekfsim.views.curves.marks import tell_lost
from ekfsim.views.curves.panels import Panel, draw_panels
from ekfsim.views.curves.plot import lines, marked
from ekfsim.views.curves.series import Series
from ekfsim.views.picture.look import STANDARD, Look
from ekfsim.views.picture.written.legend import HANDLERS
from ekfsim.views.playback.playback import views

WRONG_WALL = "diverge-01-wrong-wall"
PANELS: dict[str, Panel] = {"x": ErrorPanel(0), "nis": NisPanel(), "nees": NeesPanel()}


def divergence(tour: Scene, album: Album) -> None:
    """A run that diverges, the same without the beam that did it, and that beam."""
    wrong = shipped(WRONG_WALL)
    cured = replace(wrong, guard="skip")
    played = list(play(wrong))
    runs = (
        Series.of(played, "wrong wall"),
        Series.of(play(cured), "the same, --guard skip"),
    )
    guilty = played[int(np.flatnonzero(np.nan_to_num(runs[0].nis) > quantile(LOST, 1))[0])]
    beam = next(
        view
        for view in views(play(wrong))
        if view.beam and view.step.entry.index == guilty.entry.index
    )
    figure = album.figure(12.5, 6.2)
    boxes = figure.subplot_mosaic(
        [["room", "x"], ["room", "nis"], ["room", "nees"]], width_ratios=(1, 1.1)
    )
    handles, words = room(boxes["room"], beam, wrong, Look())
    boxes["room"].legend(handles, words, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=3,
    frameon=False,
                         fontsize=8, handler_map=HANDLERS)  # fmt: skip
    boxes["room"].set_title(
        f"step {guilty.entry.index}: the beam that is taken for another", fontsize=10
    )
    axes = [boxes[name] for name in PANELS]
    draw_panels(list(PANELS.values()), axes, runs)
    tell_lost(axes[0], runs)
    others, meanings = marked(runs, STANDARD.probability)
    boxes["nees"].legend([*lines(runs), *others], [*(run.name for run in runs), *meanings],
                         loc="upper center", bbox_to_anchor=(0.5, -0.3), ncols=3, frameon=False,
                         fontsize=8)  # fmt: skip
    album.add(figure, "divergence", "An input that makes the filter diverge, with the reason",
              _told_of_divergence(guilty, wrong, cured, tour), told_in_a_line(wrong))  # fmt: skip


def _told_of_divergence(guilty: Step, wrong: Scene, cured: Scene, tour: Scene) -> str:
    """What the guilty beam did, and how often it does."""
    correction, given = guilty.correction, guilty.entry.given
    assert correction is not None
    assert isinstance(given, Reading)
    return (
        f"`{WRONG_WALL}`: nothing is at fault, noise, map and start are as the filter was told. At "
        f"step {guilty.entry.index} it expects its beam to meet the desk after "
        f"{correction.predicted[0]:.2f} m; in truth the beam passes the corner and meets the wall "
        f"after {given.z[0]:.2f} m. The filter linearises about the wall that it predicts, takes "
        f"the difference for an error of its pose (NIS {float(correction.nis):.0f}, where 99.9 % "
        f"lie below {quantile(LOST, 1):.1f}), moves away from the truth, and shrinks P. From then "
        f"on NEES stays beyond its 99.9 % bound. Of {RUNS} runs {_lost(wrong):.1f} % end lost; "
        f"with ambiguous beams left out (`--guard skip`) {_lost(cured):.1f} %; of the tour, whose "
        f"beams go to broad walls, {_lost(tour):.1f} %."
    )


def _lost(scene: Scene) -> float:
    """Percent of runs whose last NEES lies beyond its 99.9 % bound."""
    *_, last = play(scene, np.arange(RUNS))
    assert last.nees is not None
    bound = np.array([quantile(LOST, dof) for dof in range(1, 4)])[last.nees.dof - 1]
    return 100 * float(np.mean(last.nees.impossible | (last.nees.value > bound)))
