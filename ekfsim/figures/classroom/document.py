"""Document 002, the teaching assignment:
the display, inputs that prove the program, a divergence, and σ_xθ.
"""

import math
from dataclasses import replace
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from ekfsim.commands import Move
from ekfsim.diagnostics.nees import error, squared_mahalanobis
from ekfsim.diagnostics.verdict import LOST
from ekfsim.figures.album import (
    BLACK,
    GREEN,
    GREY,
    ORANGE,
    PURPLE,
    SKY,
    VERMILLION,
    Album,
    labelled,
    square,
)
from ekfsim.figures.classroom.proofs import proof_rows, shipped
from ekfsim.filters.belief import Gaussian
from ekfsim.filters.chi_square import quantile
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import outline, radius_factor
from ekfsim.localization import play
from ekfsim.provenance import told_in_a_line
from ekfsim.records import Reading, Step
from ekfsim.scene import Scene
from ekfsim.views.picture import limits
from ekfsim.views.picture.frames import HANDLERS, Frame, draw
from ekfsim.views.picture.look import Look
from ekfsim.views.terminal.playback import View, views

DOCUMENT = 0.954  # the document's probability
RUNS = 1000
MARGIN = 0.4  # m around a room
ENLARGED = 1.8  # radii of the ellipse, to each side of an estimate that is drawn enlarged
NEVER_IN_THESE = ("… is refused",)
WRONG_WALL, THETA, STARTS, LOOP = (
    "diverge-01-wrong-wall",
    "theta",
    "proof-unsure-start",
    "proof-coverage",
)


def draw_classroom(scene: Scene, album: Album) -> None:
    """Draw them into an album. scene : the tour"""
    contact_sheet(scene, album)
    album.table(
        "proofs", "Inputs that show the program is right", ["input", "what is looked at",
        "expected", "measured"],
        list(proof_rows()),
        "Each is a commands file that comes along (`ekfsim run proof-corner`), and says in its "
        "description what to "
        "expect and why. Expected values are worked out by hand from the assignment's equations, "
        "not by the program.",
    )  # fmt: skip
    divergence(scene, album)
    theta_question(album)
    ellipse_size(album)
    album.note(
        "The sample output",
        "The numbers of the assignment's sample output are made up, as its text says: they do not "
        "hang together, "
        "and no program can reproduce them. Its layout is kept; `ekfsim run tour` shows it with "
        "numbers that fit.",
    )


def contact_sheet(scene: Scene, album: Album) -> None:
    """The display after some of the commands, the first with the legend of all."""
    shown, extent = list(views(play(scene))), limits.of(scene, play(scene))
    first, others = Frame(scene, extent), Frame(scene, extent, legend=False)
    figure = album.figure(15.0, 17.7)
    for axes, view in zip(figure.subplots(3, 2).flat, _chosen(shown), strict=True):
        axes.imshow((others if view.number else first).rgb(view), interpolation="antialiased")
        axes.set_axis_off()
    album.add(
        figure, "display", "The display after every command",
        f"Six of the {len(shown)} views (a beam has two) of `ekfsim play {_name(scene)}`; "
        f"`ekfsim render {_name(scene)} -o DIR` makes them all. The start; the ellipse after a "
        f"straight move, a line; "
        "the ellipse after the turn and more of the "
        "way; a beam, drawn from the estimate as long as it was measured; the revised estimate, "
        "thinner along the "
        "beam; and the end. The assignment asks for walls, path, ellipse, cone and beam; beyond "
        "it the picture shows "
        "the truth, where the filter expected the beam to end, and a close-up.",
    )  # fmt: skip


def _chosen(shown: list[View]) -> list[View]:
    """Start, first move, before the first beam, the first beam, its update, end."""
    moves = [view for view in shown if isinstance(view.step.entry.command, Move)]
    beams = [view for view in shown if view.beam]
    beam = beams[0].number
    before = [view for view in moves if view.number < beam][-1]
    return [shown[0], moves[0], before, shown[beam], shown[beam + 1], shown[-1]]


def _name(scene: Scene) -> str:
    return scene.commands_source.rpartition("/")[2].removesuffix(".yaml")


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
    handles, words = _room(boxes["room"], beam, wrong, Look())
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
        f"`{WRONG_WALL}`: nothing is at fault, noise, map and start are as the filter was told. "
        f"At step "
        f"{guilty.entry.index} it expects its beam to meet the desk after "
        f"{correction.predicted[0]:.2f} m; in truth "
        f"the beam passes the corner and meets the wall after {given.z[0]:.2f} m. The filter "
        f"linearises about the wall "
        f"that it predicts, takes the difference for an error of its pose (NIS "
        f"{float(correction.nis):.0f}, where "
        f"99.9 % lie below {quantile(LOST, 1):.1f}), moves away from the truth, and shrinks P. "
        f"From then on NEES stays "
        f"beyond its 99.9 % bound. Of {RUNS} runs {_lost(wrong):.1f} % end lost; with ambiguous "
        f"beams left out "
        f"(`--guard skip`) {_lost(cured):.1f} %; of the tour, whose beams go to broad walls, "
        f"{_lost(tour):.1f} %."
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


def theta_question(album: Album) -> None:
    """What σ_xθ and σ_yθ are good for:
    ellipses on the condition of a heading, before and after a beam.
    """
    scene = shipped(THETA)
    shown = list(views(play(scene)))
    beam = next(view for view in shown if view.beam)
    figure = album.figure(12.5, 4.9)
    after = shown[beam.number + 1]
    whole, close = figure.subplots(1, 2)
    handles, words = _room(whole, beam, scene, Look(conditional=True))
    whole.set_title(f"before the beam: {_told(beam)}", fontsize=10)
    draw(after, scene, close, Look(conditional=True), _about(after))
    _without_legend(close)
    close.set_title(f"after it, enlarged: {_told(after)}", fontsize=10)
    figure.legend(
        handles,
        words,
        loc="outside lower center",
        ncols=5,
        frameon=False,
        fontsize=8,
        handler_map=HANDLERS,
    )
    album.add(
        figure, "theta", "What do σ_xθ and σ_yθ mean?",
        "They tell that place and heading err together. The start is known, the heading only to "
        "6°; after 6 m the "
        "ellipse is wide to the side. Were the heading known to be at an edge of its cone, the "
        "place would be known "
        "much better, and elsewhere: the dashed and the dotted ellipse. Neither the ellipse nor "
        "the cone shows it; "
        "both are shadows of P. And it is useful: the beam to the left measures y alone (∂h/∂θ = "
        "0), yet the cone "
        "shrinks, for who knows y knows the heading, K_θ = P_yθ/S. The assignment asks in words; "
        "it has no figure of "
        "it.",
        told_in_a_line(scene),
    )  # fmt: skip


def _room(axes: Axes, view: View, scene: Scene, look: Look) -> tuple[list[Any], list[str]]:
    """Draw a view no wider than its room,
    and the legend's handles and words of what can be in it.
    """
    picture = draw(view, scene, axes, look)
    _without_legend(axes)
    assert scene.world.map.boundary is not None
    (left, bottom), (right, top) = (
        scene.world.map.boundary.min(axis=0),
        scene.world.map.boundary.max(axis=0),
    )
    axes.set(xlim=(left - MARGIN, right + MARGIN), ylim=(bottom - MARGIN, top + MARGIN))
    axes.set_aspect("equal", adjustable="box")
    named = {
        str((handle[0] if isinstance(handle, tuple) else handle).get_label()): handle
        for handle in picture.handles()
    }
    kept = {word: handle for word, handle in named.items() if word not in NEVER_IN_THESE}
    return list(kept.values()), list(kept)


def _without_legend(axes: Axes) -> None:
    legend = axes.get_legend()
    assert legend is not None
    legend.remove()


def _about(view: View) -> limits.Limits:
    """The surroundings of the estimate, wide enough for its ellipse and small enough for those
    within to be seen.
    """
    x, P = view.pose
    reach = ENLARGED * outline(np.zeros(2), P[:2, :2], DOCUMENT).max()
    return limits.Limits(x[0] - reach, x[1] - reach, x[0] + reach, x[1] + reach)


def _told(view: View) -> str:
    """σ of the heading, and its correlation with y."""
    P = view.pose.covariance
    correlation = P[1, 2] / np.sqrt(P[1, 1] * P[2, 2])
    return f"σ_θ = {np.degrees(np.sqrt(P[2, 2])):.1f}°, correlation of y and θ {correlation:.2f}"


def ellipse_size(album: Album) -> None:
    """How many standard deviations hold 95.4 % of an ellipse: 2.4816, not 2."""
    scene, k = shipped(STARTS), radius_factor(DOCUMENT)
    start = next(iter(play(scene, np.arange(RUNS))))
    assert start.entry.truth is not None
    belief = Gaussian(start.posterior.mean[0], start.posterior.covariance[0])
    figure = album.figure(11.5, 5.0)
    left, right = figure.subplots(1, 2)
    square(left).plot(
        *start.entry.truth[:, :2].T,
        ls="none",
        marker=".",
        ms=3,
        color=GREY,
        label="true start of a run",
    )
    for factor, color, style in ((k, GREEN, "-"), (2.0, VERMILLION, "--")):
        inside = np.mean(_deviations(start) <= factor)
        left.plot(*outline(belief.mean, belief.covariance[:2, :2], _holds(factor)).T, color=color,
        ls=style,
                  label=f"k = {factor:.4g}: {100 * inside:.1f} % inside")  # fmt: skip
        right.axvline(factor, color=color, ls=style, lw=1)
    _shares(right, start)
    left.legend(fontsize=8, loc="upper right")
    shares = [100 * float(np.mean(_deviations(start) <= factor)) for factor in (k, 2.0)]
    album.add(
        figure, "ellipse", "The 95.4 % ellipse is 2.4816 standard deviations wide",
        "The assignment draws an ellipse of 95.4 %, and takes the 2 standard deviations that hold "
        "so much of one "
        f"number. Of two numbers k standard deviations hold 1 − exp(−k²/2): for 95.4 % k = "
        f"{k:.4f}, and k = 2 holds "
        f"{100 * _holds(2.0):.1f} %. Measured on {RUNS} runs: {shares[0]:.1f} % and "
        f"{shares[1]:.1f} %. For the "
        "heading, one number, ±2σ is right. Right: the same for every k, at the start and at the "
        "end of a loop with "
        f"beams (`{LOOP}`), where the filter has linearised and the ellipse still holds what it "
        f"says.",
        told_in_a_line(scene),
    )  # fmt: skip


def _shares(axes: Axes, start: Step) -> None:
    """The share of runs inside the ellipse of k, measured and by the formula."""
    *_, end = play(shipped(LOOP), np.arange(RUNS))
    ks = np.linspace(0, 3.5, 200)
    labelled(axes, "k, standard deviations", "truth inside the ellipse (%)")
    axes.plot(ks, [100 * _holds(k) for k in ks], color=BLACK, lw=1.2, label="1 − exp(−k²/2)")
    for step, color, style, label in ((start, SKY, "-", STARTS), (end, PURPLE, "--", LOOP)):
        measured = np.sort(_deviations(step))
        axes.plot(
            ks,
            100 * np.searchsorted(measured, ks) / len(measured),
            color=color,
            ls=style,
            label=label,
        )
    axes.axhline(100 * DOCUMENT, color=ORANGE, lw=0.8, ls=":", label=f"{100 * DOCUMENT:.1f} %")
    axes.legend(fontsize=8, loc="lower right")


def _holds(k: float) -> float:
    """The probability inside k standard deviations in the plane."""
    return 1 - math.exp(-(k**2) / 2)


def _deviations(step: Step) -> Array:
    """How many standard deviations each run's true position lies from its estimate : (N,)"""
    assert step.entry.truth is not None
    square, _, _ = squared_mahalanobis(
        error(step.posterior, step.entry.truth)[:, :2], step.posterior.covariance[:, :2, :2]
    )
    deviations: Array = np.sqrt(square)
    return deviations
