"""Document 002: an input that makes the filter diverge, and why."""

from dataclasses import replace

import numpy as np

from ekfsim.diagnostics.nees import error
from ekfsim.diagnostics.verdict import LOST
from ekfsim.figures.album import (
    BLACK,
    GREEN,
    GREY,
    VERMILLION,
    Album,
    labelled,
)
from ekfsim.figures.classroom.proofs import RUNS, shipped
from ekfsim.figures.classroom.room import room
from ekfsim.filters.arithmetic.chi_square import quantile
from ekfsim.localization import play
from ekfsim.provenance import told_in_a_line
from ekfsim.records import Reading, Step
from ekfsim.scene import Scene
from ekfsim.views.picture.legend import HANDLERS
from ekfsim.views.picture.look import Look
from ekfsim.views.playback.playback import views

WRONG_WALL = "diverge-01-wrong-wall"


def divergence(tour: Scene, album: Album) -> None:
    """A run that diverges, the same without the beam that did it, and that beam."""
    wrong = shipped(WRONG_WALL)
    cured = replace(wrong, guard="skip")
    lines = (("wrong wall", wrong, VERMILLION, "-"), ("the same, --guard skip", cured, GREEN, "--"))
    figure = album.figure(12.5, 6.2)
    boxes = figure.subplot_mosaic([["room", "error"], ["room", "nees"]], width_ratios=(1, 1.1))
    played = list(play(wrong))
    guilty = next(step for step in played if _nis(step) > quantile(LOST, 1))
    beam = next(
        view
        for view in views(play(wrong))
        if view.beam and view.step.entry.index == guilty.entry.index
    )
    boxes["nees"].sharex(boxes["error"])
    handles, words = room(boxes["room"], beam, wrong, Look())
    boxes["room"].legend(handles, words, loc="upper center", bbox_to_anchor=(0.5, -0.16), ncols=3,
    frameon=False,
                         fontsize=8, handler_map=HANDLERS)  # fmt: skip
    boxes["room"].set_title(
        f"step {guilty.entry.index}: the beam that is taken for another", fontsize=10
    )
    for label, scene, color, style in lines:
        steps = played if scene is wrong else list(play(scene))
        index = [step.entry.index for step in steps]
        boxes["error"].plot(
            index, [_position_error(step) for step in steps], color=color, ls=style, label=label
        )
        boxes["nees"].plot(index, [_nees(step) for step in steps], color=color, ls=style)
    labelled(boxes["error"], "", "position error (m)").set_yscale("log")
    labelled(boxes["nees"], "step", "NEES (3 degrees of freedom)").set_yscale("log")
    for probability, style in ((0.95, ":"), (LOST, "-.")):
        boxes["nees"].axhline(quantile(probability, 3), color=BLACK, lw=0.9, ls=style,
                              label=f"χ² {100 * probability:g} %")  # fmt: skip
    for axes in (boxes["error"], boxes["nees"]):
        axes.axvline(guilty.entry.index, color=GREY, lw=0.9, ls=(0, (1, 1)))
        axes.legend(fontsize=8, loc="upper right", ncols=3)
    boxes["error"].set_ylim(top=200)
    boxes["nees"].set_ylim(top=3e6)
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


def _nis(step: Step) -> float:
    """−1 where there is none"""
    return (
        -1.0
        if step.correction is None or np.isnan(step.correction.nis)
        else float(step.correction.nis)
    )


def _position_error(step: Step) -> float:
    """m, nan where there is none to draw on a logarithmic scale"""
    assert step.entry.truth is not None
    return float(np.hypot(*error(step.posterior, step.entry.truth)[:2])) or float("nan")


def _nees(step: Step) -> float:
    """nan where P is not of full rank"""
    return (
        float(step.nees.value)
        if step.nees is not None and int(step.nees.dof) == 3
        else float("nan")
    )


def _lost(scene: Scene) -> float:
    """Percent of runs whose last NEES lies beyond its 99.9 % bound."""
    *_, last = play(scene, np.arange(RUNS))
    assert last.nees is not None
    bound = np.array([quantile(LOST, dof) for dof in range(1, 4)])[last.nees.dof - 1]
    return 100 * float(np.mean(last.nees.impossible | (last.nees.value > bound)))
