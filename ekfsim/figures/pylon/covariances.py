"""Document 004, figures 5 to 7: what its filters claim to know."""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection

from ekfsim.figures.album import (
    BLACK,
    BLUE,
    Album,
    labelled,
)
from ekfsim.figures.pylon.runs import (
    Runs,
    every_other,
)
from ekfsim.figures.track import Track
from ekfsim.geometry import Array, Integers
from ekfsim.geometry.ellipse import outline
from ekfsim.models.layout import INERTIAL
from ekfsim.systems.document import DocumentReading

LARGER = 100.0  # how many times figure 5 enlarges the authors' covariances
PROBABILITY = 0.954  # of its ellipses
INSIDE, OUTSIDE = 2.0, 0.7  # m, how far figure 5 reaches from the corner
MEETING = 1.2  # times as large is nearly the same
LEAST = 4.0  # how many times its lowest variance a panel of figures 6 and 7 reaches at least
FIRST = 40  # how many steps figures 6 and 7 show
CLAIMS: tuple[tuple[DocumentReading, float, str], ...] = (
    ("coded", LARGER, "R without the yaw error: covariances drawn 100 times larger"),
    ("corrected", 1.0, "R with the yaw error: covariances as they are"),
)
NAMES = {
    "x": "x",
    "y": "y",
    "xdot": "ẋ",
    "ydot": "ẏ",
    "thetadot": "θ̇",
    "theta": "θ",
    "theta_prev": "θ_prev",
}
VARIANCES = (
    (6, "position and velocity", (("x", "m²"), ("y", "m²"), ("xdot", "m²/s²"), ("ydot", "m²/s²"))),
    (7, "angular velocity, angle and previous angle",
     (("thetadot", "rad²/s²"), ("theta", "rad²"), ("theta_prev", "rad²"))),
)  # fmt: skip


def ellipses(runs: Runs, album: Album) -> None:
    """Figure 5."""
    corner = runs.ring[np.argmin(runs.ring.sum(axis=1))]
    if not any(len(_near(runs.tracks[reading], corner)) for reading, _, _ in CLAIMS):
        album.note("Figure 5", "The run does not come near the south-west corner.")
        return
    figure = album.figure(10.0, 5.4)
    widest = dict[str, float]()
    for axes, (reading, larger, title) in zip(
        figure.subplots(1, 2, sharex=True, sharey=True), CLAIMS, strict=True
    ):
        track = runs.tracks[reading]
        near = _near(track, corner)
        labelled(axes, "x (m)", "y (m)")
        expected_path(axes, runs.ring)
        P = track.pose_covariance[near, :2, :2]
        lines = [
            outline(track.pose[k, :2], larger * C, PROBABILITY)
            for k, C in zip(near, P, strict=True)
        ]
        axes.add_collection(
            LineCollection(lines, colors=BLUE, linewidths=0.5, alpha=0.6, label="95.4 % ellipse")
        )
        axes.plot(*track.pose[near, :2].T, ".-", ms=3, lw=0.6, color=BLACK, label="estimate")
        axes.set_aspect("equal", adjustable="box")
        axes.set(
            xlim=(corner[0] - OUTSIDE, corner[0] + INSIDE),
            ylim=(corner[1] - OUTSIDE, corner[1] + INSIDE),
        )
        axes.set_title(title, fontsize=9)
        axes.legend(loc="upper right", fontsize=8)
        widest[reading] = (
            float(np.sqrt(np.linalg.eigvalsh(P)[:, -1].max())) if len(near) else float("nan")
        )
    figure.suptitle("Estimates at the south-west corner")
    album.add(
        figure,
        "fig5-ellipses",
        "Figure 5: ellipses along the path at the south-west corner",
        "Left, as in the printed figure, what the authors' filter claims: its covariances are far "
        f"too small to be seen and are drawn {LARGER:.0f} times larger than they are, which makes "
        f"the ellipses {LARGER**0.5:.0f} times as long and wide (largest standard deviation "
        f"{1000 * widest['coded']:.2g} mm). Right, to scale, what is left of that claim once R "
        "holds the yaw error times the way to the pylon: thin ellipses across the line of sight, "
        f"with a standard deviation of up to {1000 * widest['corrected']:.0f} mm.",
    )


def variances(runs: Runs, album: Album) -> None:
    """Figures 6 and 7."""
    all_, half = (
        runs.track,
        runs.told[runs.reading].but(every_other(runs.told[runs.reading].entries)).track(),
    )
    for number, names, quantities in VARIANCES:
        figure = album.figure(9.0, 6.4 if number == 6 else 3.6)
        panels = figure.subplots(2, 2) if number == 6 else figure.subplots(1, 3)
        for axes, (name, unit) in zip(np.ravel(panels), quantities, strict=True):
            _variance(axes, all_, half, name, unit)
        np.ravel(panels)[0].legend(loc="best", fontsize=8)
        figure.suptitle(f"Variances of {names}: every correction against every other")
        album.add(
            figure,
            f"fig{number}-variances",
            f"Figure {number}: variances of {names}",
            _told_of_variances(number, all_, half),
        )


def _near(track: Track, corner: Array) -> Integers:
    """The instants that figure 5 shows."""
    return np.flatnonzero(np.abs(track.pose[:, :2] - corner).max(axis=1) < INSIDE)


def _variance(axes: Axes, all_: Track, half: Track, name: str, unit: str) -> None:
    """One variance over the first steps."""
    number = INERTIAL.names.index(name)
    steps = np.arange(1, min(FIRST, len(all_.t) - 1) + 1)
    labelled(axes, "time step", f"variance of {NAMES[name]} ({unit})")
    axes.plot(steps, half.covariance[steps, number, number], "o-", ms=5, lw=0.5, mfc="none",
    color="#CC0000",
              label="every other correction")  # fmt: skip
    axes.plot(
        steps,
        all_.covariance[steps, number, number],
        "^-",
        ms=4,
        lw=0.5,
        color=BLUE,
        label="every correction",
    )
    axes.set_yscale("log")
    low, high = axes.get_ylim()
    middle = np.sqrt(low * high)
    if high < LEAST * low:  # constant but for the last digit: there is nothing to magnify
        axes.set_ylim(middle / np.sqrt(LEAST), middle * np.sqrt(LEAST))


def _told_of_variances(number: int, all_: Track, half: Track) -> str:
    i = INERTIAL.names.index("x" if number == 6 else "theta")
    every, other = all_.covariance[1:, i, i], half.covariance[1:, i, i]
    if number == 6:
        without, after = np.median(other[1::2]), np.median(other[2::2])
        meets = after < MEETING * np.median(every)
        return (
            f"The first {FIRST} steps on a logarithmic axis, after a start from P₀ = I. Where a "
            f"correction is left out the variance of x grows to {without:.2g} m², with the next it "
            f"falls back to {after:.2g} m²; with every correction it stays at "
            f"{np.median(every):.2g} m² (medians of the run). In the printed figure the circles "
            "rise at every other step and meet the triangles in between. "
            + ("So they do here." if meets else "Here they do not quite meet them: where R knows "
                                                "of the yaw error, one "
               "reading does not tell all, and each that is left out is missed.")
        )  # fmt: skip
    apart = float(np.max(np.abs(every / other - 1)))
    alike = "to the last digit" if apart == 0 else f"to {100 * apart:.1g} %"
    return (
        f"The pylon tells nothing of the yaw, so triangles and circles coincide, {alike} in the "
        "variance of θ: it and that of θ_prev are the variance of the inertial unit's yaw, "
        f"{np.median(every):.3g} rad², and θ̇ = (θ − θ_prev)/dt has 2σ²/dt². The printed figure "
        "shows these three in the same way."
    )


def expected_path(axes: Axes, ring: Array) -> None:
    """The square that was to be gone round."""
    axes.plot(*np.concatenate([ring, ring[:1]]).T, "--", color=BLACK, lw=1.2, label="expected path")
