"""Document 002: what σ_xθ and σ_yθ mean, and how large an ellipse of 95.4 % is."""

import math

import numpy as np
from matplotlib.axes import Axes

from ekfsim.diagnostics.nees import error, squared_mahalanobis
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
from ekfsim.figures.classroom.proofs import RUNS, shipped
from ekfsim.figures.classroom.room import room
from ekfsim.filters.belief import Gaussian
from ekfsim.geometry import Array
from ekfsim.geometry.ellipse import outline, radius_factor
from ekfsim.localization import play
from ekfsim.provenance import told_in_a_line
from ekfsim.records import Step
from ekfsim.views.notebook.drawing import draw
from ekfsim.views.picture.extent import limits
from ekfsim.views.picture.look import Look
from ekfsim.views.picture.written.legend import HANDLERS
from ekfsim.views.playback.playback import views
from ekfsim.views.playback.view import View

THETA, STARTS, LOOP = "theta", "proof-unsure-start", "proof-coverage"
DOCUMENT = 0.954  # the document's probability
ENLARGED = 1.8  # radii of the ellipse, to each side of an estimate that is drawn enlarged


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
    handles, words = room(whole, beam, scene, Look(conditional=True))
    whole.set_title(f"before the beam: {_told(beam)}", fontsize=10)
    draw(after, scene, close, Look(conditional=True), _about(after), legend=False)
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
        "6°; after 6 m the ellipse is wide to the side. Were the heading known to be at an edge of "
        "its cone, the place would be known much better, and elsewhere: the dashed and the dotted "
        "ellipse. Neither the ellipse nor the cone shows it; both are shadows of P. And it is "
        "useful: the beam to the left measures y alone (∂h/∂θ = 0), yet the cone shrinks, for who "
        "knows y knows the heading, K_θ = P_yθ/S. The assignment asks in words; it has no figure "
        "of it.",
        told_in_a_line(scene),
    )  # fmt: skip


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
        "so much of one number. Of two numbers k standard deviations hold 1 − exp(−k²/2): for 95.4 "
        f"% k = {k:.4f}, and k = 2 holds {100 * _holds(2.0):.1f} %. Measured on {RUNS} runs: "
        f"{shares[0]:.1f} % and {shares[1]:.1f} %. For the heading, one number, ±2σ is right. "
        "Right: the same for every k, at the start and at the end of a loop with beams "
        f"(`{LOOP}`), where the filter has linearised and the ellipse still holds what it says.",
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
