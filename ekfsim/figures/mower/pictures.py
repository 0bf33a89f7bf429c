"""The pictures of document 000:
paths, markers and trace, errors, and a close-up with the time along the path.
"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from ekfsim.figures.album import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    SKY,
    VERMILLION,
    Album,
    labelled,
    square,
)
from ekfsim.figures.track import Track
from ekfsim.geometry import Array
from ekfsim.scene import Scene

PERIOD = 2.0  # s, of the pictures
BLIND = 8.0  # s without a marker from which on a stretch is shaded
# s around the longest blind stretch that the close-up shows, and between labels
BEFORE, AFTER, EVERY = 12.0, 6.0, 2.0
NEAR = 6.0  # m beyond the path up to which the close-up shows markers


def blind_stretches(track: Track) -> Array:
    """When no marker was seen for long : (n, 2) s, from and to"""
    seen = np.unique([track.t[0], *(reading.t for reading in track.readings), track.t[-1]])
    gaps = np.column_stack([seen[:-1], seen[1:]])
    return gaps[np.diff(gaps, axis=-1)[:, 0] >= BLIND]


def paths(scene: Scene, track: Track, album: Album) -> None:
    """Fig. 4: the true and the estimated path, and the markers."""
    figure = album.figure(8.0, 6.4)
    axes = square(figure.add_subplot())
    axes.plot(*track.truth[:, :2].T, color=BLUE, lw=1.6, label="truth")
    axes.plot(*track.pose[:, :2].T, color=ORANGE, lw=0.9, label="estimate")
    axes.plot(*_marks(scene), ls="none", marker="*", ms=9, color=BLACK, label="marker")
    axes.plot(
        *track.truth[:1, :2].T, ls="none", marker="o", ms=7, mfc="white", mec=BLUE, label="start"
    )
    figure.legend(loc="outside upper center", ncols=4, frameon=False)
    album.add(
        figure, "fig4-paths", "Figure 4: true and estimated path, and the markers",
        "Where no marker is in view the estimate wanders off, by dead reckoning alone; with the "
        "next one it jumps back. In the print, too, the reference is darker and the "
        "estimate lighter. "
        + ("The field has its 50 by 75 m and its 28 markers; where they stood it does not say."
           if scene.log is None else ""),
    )  # fmt: skip


def markers_and_trace(track: Track, blind: Array, album: Album) -> None:
    """Fig. 5: how many markers are visible, and the trace of P."""
    figure = album.figure(8.0, 5.2)
    above, below = figure.subplots(2, 1, sharex=True)
    t, seen = _pictures(track)
    labelled(above, "", "visible markers").vlines(t, 0, seen, color=BLUE, lw=1.2)
    above.plot(t, seen, ls="none", marker=".", ms=4, color=BLUE, label="markers in a picture")
    above.set_ylim(0, max(seen.max(initial=0) + 0.6, 1))
    above.yaxis.get_major_locator().set_params(integer=True)
    trace = np.trace(track.covariance, axis1=1, axis2=2)
    labelled(below, "time (s)", "trace of P (m² and rad²)").semilogy(
        track.t, trace, color=VERMILLION, lw=0.9, label="trace of P"
    )
    for axes in (above, below):
        _shade(axes, blind)
    _legend(figure, above, below)
    longest = (
        f" The longest interruption lasts {np.ptp(blind, axis=-1).max():.0f} s."
        if len(blind)
        else ""
    )
    album.add(
        figure, "fig5-markers-and-trace", "Figure 5: number of visible markers, and trace of P",
        "Whenever a marker comes into view the trace falls, and it grows until the next. Without "
        f"markers it grows ever faster, because an unsure heading makes an unsure place.{longest} "
        "The print shows the same saw on a linear scale, where one tooth hides the others; hence "
        "the logarithm here. The trace adds m² and rad², as the document does.",
    )  # fmt: skip


def errors(track: Track, blind: Array, album: Album) -> None:
    """Fig. 6: the position and the heading error, and what the filter thinks of them."""
    figure = album.figure(8.0, 5.6)
    above, below = figure.subplots(2, 1, sharex=True)
    P, t = track.pose_covariance, track.t
    believed = 2 * np.sqrt(P[:, 0, 0] + P[:, 1, 1])
    labelled(above, "", "position error (m)").plot(
        t, track.position_error, color=BLUE, lw=1.0, label="error"
    )
    above.plot(t, believed, color=GREEN, lw=0.7, label=r"$2\sqrt{P_{xx}+P_{yy}}$ of the filter")
    above.set_ylim(bottom=0)
    heading, σ = np.degrees(track.heading_error), np.degrees(np.sqrt(P[:, 2, 2]))
    labelled(below, "time (s)", "heading error (°)")
    first = np.searchsorted(t, np.arange(t[0], t[-1], PERIOD))
    for bound, alpha, when in ((np.maximum, 0.18, "before"), (np.minimum, 0.35, "after")):
        reach = np.repeat(2 * bound.reduceat(σ, first), np.diff(np.append(first, len(t))))
        below.fill_between(
            t, -reach, reach, color=GREEN, alpha=alpha, lw=0, label=f"±2σ just {when} a picture"
        )
    below.plot(t, heading, color=BLUE, lw=0.8)
    for axes in (above, below):
        _shade(axes, blind)
    _legend(figure, above, below)
    album.add(
        figure, "fig6-errors", "Figure 6: position and heading error",
        _told_of_errors(track, blind)
        + " The heading's ±2σ is wider than its errors, and meant to be: the document takes the "
          "noise of the heading "
        "from the wheels as well (eq. 22), although the gyro turns it, and chose Q with room to "
        "spare. The print shows the errors alone, with peaks of the same kind where no marker or a "
        "single one was visible.",
    )  # fmt: skip


def _told_of_errors(track: Track, blind: Array) -> str:
    """The largest error, and what the filter's own measures hold of it."""
    error, P = track.position_error, track.pose_covariance
    if np.isnan(error).all():
        return "The truth is not known."
    worst = float(track.t[np.nanargmax(error)])
    after = [
        *(
            f" during or just after the interruption from {a:.0f} to {b:.0f} s"
            for a, b in blind
            if a <= worst <= b + 4
        ),
        *(
            f" with no more than one marker in a picture since {a:.0f} s"
            for a in _alone_since(track, worst)
        ),
    ]
    inside = np.mean(error <= 2 * np.sqrt(P[:, 0, 0] + P[:, 1, 1]))
    held = np.mean(np.abs(track.heading_error) <= 2 * np.sqrt(P[:, 2, 2]))
    return (
        f"The position error is largest at {worst:.0f} s ({np.nanmax(error):.2f} "
        f"m){''.join(after[:1])}. It stays below 2√(P_xx + P_yy), which should hold 95 to 98 %, "
        f"for {100 * inside:.1f} % of the time, and the heading within ±2σ for {100 * held:.1f} %."
    )


def close_up(scene: Scene, track: Track, blind: Array, album: Album) -> None:
    """Fig. 7: the path around the longest interruption, with ideal angles and the time along it."""
    a, b = blind[np.argmax(np.ptp(blind, axis=-1))] if len(blind) else (track.t[0], track.t[-1])
    here = (track.t >= a - BEFORE) & (track.t <= b + AFTER)
    figure = album.figure(8.0, 6.4)
    axes = square(figure.add_subplot())
    truth, pose, t = track.truth[here, :2], track.pose[here, :2], track.t[here]
    axes.plot(*truth.T, color=BLUE, lw=2.0, label="truth")
    axes.plot(*pose.T, color=ORANGE, lw=1.2, label="estimate, ideal angles")
    instants = np.arange(np.ceil(t[0] / EVERY), np.floor(t[-1] / EVERY) + 1) * EVERY
    rows = np.minimum(np.searchsorted(t, instants), len(t) - 1)
    for i, (true, estimate) in enumerate(zip(truth[rows], pose[rows], strict=True)):
        axes.plot(
            *np.stack([true, estimate]).T,
            color=GREY,
            lw=0.7,
            ls=":",
            label="same instant" if i == 0 else None,
        )
    axes.plot(*truth[rows].T, ls="none", marker="o", ms=5, mfc="white", color=BLUE)
    axes.plot(*pose[rows].T, ls="none", marker="o", ms=5, mfc="white", color=ORANGE)
    for instant, row in zip(instants, rows, strict=True):
        along = truth[min(row + 50, len(t) - 1)] - truth[max(row - 50, 0)]
        aside = np.array([along[1], -along[0]]) / (np.hypot(*along) or 1.0)
        away = aside if aside @ (pose[row] - truth[row]) <= 0 else -aside  # from the estimate
        axes.annotate(f"{instant:.0f}", truth[row].tolist(), (15 * away).tolist(),
        textcoords="offset points",
                      fontsize=8, color=BLUE, ha="center", va="center")  # fmt: skip
    low, high = (
        np.nanmin(np.vstack([truth, pose]), axis=0),
        np.nanmax(np.vstack([truth, pose]), axis=0),
    )
    marks = np.array(_marks(scene)).T
    near = marks[np.all(abs(marks - (low + high) / 2) < (high - low) / 2 + NEAR, axis=-1)]
    axes.plot(*near.T, ls="none", marker="*", ms=10, color=BLACK, label="marker")
    figure.legend(loc="outside upper center", ncols=4, frameon=False)
    apart = track.position_error[here]
    album.add(
        figure, "fig7-close-up", "Figure 7: close-up with the time along the path",
        f"Ideal marker angles, around the longest interruption: from {a:.0f} to {b:.0f} s no "
        "marker is in view. The numbers are seconds from the beginning, beside the true path; "
        "dotted lines join truth and estimate of one instant. The estimate strays by up to "
        f"{np.nanmax(apart, initial=0.0):.2f} m and jumps back when a marker is seen again: "
        "perfect angles cannot help while there are none. In the print the jump is at 285 to 300 "
        "s, in a curve with a single marker or none.",
    )  # fmt: skip


def _marks(scene: Scene) -> tuple[list[float], list[float]]:
    """Where the markers stand : x and y in m"""
    return [mark.x for mark in scene.world.landmarks], [mark.y for mark in scene.world.landmarks]


def _pictures(track: Track) -> tuple[Array, Array]:
    """When markers were seen, and how many : (n,) s, (n,)"""
    t, seen = np.unique([reading.t for reading in track.readings], return_counts=True)
    return t, seen.astype(float)


def _alone_since(track: Track, when: float) -> list[float]:
    """Since when, in s, no picture had two markers,
    where at an instant that is long ago; else nothing.
    """
    t, seen = _pictures(track)
    before = t[(seen > 1) & (t <= when)]
    since = float(before[-1]) if len(before) else float(track.t[0])
    return [since] if when - since >= BLIND else []


def _shade(axes: Axes, blind: Array) -> None:
    for i, (a, b) in enumerate(blind.tolist()):
        axes.axvspan(
            a,
            b,
            color=SKY,
            alpha=0.25,
            lw=0,
            label=f"no marker for {BLIND:.0f} s or more" if i == 0 else None,
        )


def _legend(figure: Figure, *panels: Axes) -> None:
    """One legend for all panels, each word once."""
    named = {
        label: handle
        for axes in panels
        for handle, label in zip(*axes.get_legend_handles_labels(), strict=True)
    }
    figure.legend(
        list(named.values()), list(named), loc="outside upper center", ncols=3, frameon=False
    )
