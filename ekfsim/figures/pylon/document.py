"""Document 004, lidar and inertial unit around one pylon:
figures 2 to 7, and what each reading costs.
"""

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection
from matplotlib.ticker import MultipleLocator

from ekfsim.errors import UsageError
from ekfsim.figures.album import (
    BLACK,
    BLUE,
    GREEN,
    GREY,
    ORANGE,
    VERMILLION,
    Album,
    labelled,
    square,
)
from ekfsim.figures.pylon.innovations import innovations
from ekfsim.figures.pylon.runs import (
    Runs,
    by_the_letter,
    every_other,
    in_its_own_frame,
    lidar_alone,
    timed,
)
from ekfsim.figures.pylon.yaw import yaw_filter
from ekfsim.figures.track import Track, rmse, running_rmse
from ekfsim.geometry import Array, Integers
from ekfsim.geometry.ellipse import outline
from ekfsim.geometry.outline import path_error
from ekfsim.models.layout import INERTIAL
from ekfsim.scene import Scene
from ekfsim.systems.document import DocumentReading

OWN_FRAME = "corrected, read in the lidar's own frame: the yaw filtered, too"
COMPARED = (
    "The last column is the path RMSE that the authors' own program has on this log, which "
    "they published. "
)
LARGER = 100.0  # how many times figure 5 enlarges the authors' covariances
PROBABILITY = 0.954  # of its ellipses
INSIDE, OUTSIDE = 2.0, 0.7  # m, how far figure 5 reaches from the corner
ENOUGH = 30  # readings
MEETING = 1.2  # times as large is nearly the same
FIRST = 40  # how many steps figures 6 and 7 show
WHAT: dict[DocumentReading, str] = {
    "corrected": "corrected: the yaw error × the lever arm in R, dt from the stamps",
    "coded": "coded: as the authors' program does",
    "printed": "printed: eq. 5 with its minus",
}
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


def draw_pylon(scene: Scene, album: Album) -> None:
    """Draw them into an album."""
    runs = Runs.of(scene)
    if (seen := len(runs.track.readings)) < ENOUGH:
        source = scene.log_source or scene.commands_source
        raise UsageError(
            f"{source}: {seen} readings of the pylon are too few to draw; {ENOUGH} will do"
        )
    paths(scene, runs, album)
    yaw(runs, album)
    tracking(runs, album)
    ellipses(runs, album)
    variances(runs, album)
    table_of_readings(runs, album)
    yaw_filter(scene, album)
    innovations(runs, album)


def paths(scene: Scene, runs: Runs, album: Album) -> None:
    """Figure 2."""
    track = runs.track
    figure = album.figure(6.8, 6.2)
    axes = square(figure.add_subplot())
    _ring(axes, runs.ring)
    gps = track.fix[~np.isnan(track.fix[:, 0])]
    if len(gps):
        axes.plot(*gps.T, "+-", ms=5, lw=0.6, color=ORANGE, label="GPS, recorded and not used")
    if track.has_truth.any():
        axes.plot(*track.truth[:, :2].T, color=GREEN, lw=1.0, label="truth")
    axes.plot(*track.pose[:, :2].T, color=BLUE, lw=1.4, label="estimate")
    for mark in scene.world.landmarks:
        axes.plot(mark.x, mark.y, "^", ms=9, color=VERMILLION, label="pylon")
    axes.plot(*track.pose[0, :2], "o", ms=6, color=BLACK, label="start")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.09), ncols=3, fontsize=8)
    axes.set_title("Expected path, GPS and estimate")
    error = runs.off_path(track)
    off = (
        f" The GPS is off the path by {rmse(path_error(gps, runs.ring)):.3g} m (RMSE)."
        if len(gps)
        else ""
    )
    album.add(
        figure,
        "fig2-paths",
        "Figure 2: expected path, GPS and estimate",
        f"The square is gone round clockwise from its north-west corner. The estimate follows it "
        f"to {rmse(error):.3g} "
        f"m (RMSE; {float(np.max(error)):.3g} m at most), corners included.{off} In the printed "
        f"figure the GPS is off "
        "by about a metre, and the estimate leaves the path at the corners, where the cart was "
        "turned with "
        f"difficulty. {_cost(runs)}",
    )


def yaw(runs: Runs, album: Album) -> None:
    """Figure 3."""
    track = runs.track
    figure = album.figure(7.5, 4.2)
    axes = labelled(figure.add_subplot(), "time (s)", "yaw θ (degrees, counter-clockwise)")
    heading = np.degrees(np.unwrap(track.pose[:, 2]))
    if track.has_truth.any():
        axes.plot(
            track.t, np.degrees(np.unwrap(track.truth[:, 2])), color=GREEN, lw=2.4, label="truth"
        )
    axes.plot(track.t, heading, color=BLUE, lw=1.1, label="estimate: the yaw as it was measured")
    axes.yaxis.set_major_locator(MultipleLocator(90))
    axes.legend(loc="best", fontsize=8)
    axes.set_title("Yaw over time")
    album.add(
        figure,
        "fig3-yaw",
        "Figure 3: the yaw over time",
        f"A right turn at each corner, as in the printed figure: {heading[-1] - heading[0]:.0f}° "
        f"in all, unwrapped. θ "
        "is the inertial unit's yaw itself: eq. 5 sets θ = yaw, and no filter smooths it, as the "
        "document's "
        "conclusion says.",
    )


def tracking(runs: Runs, album: Album) -> None:
    """Figure 4, eqs 11 and 12."""
    error = runs.off_path(runs.track)
    so_far, steps = running_rmse(error), np.arange(1, len(error) + 1)
    figure = album.figure(7.5, 4.2)
    axes = labelled(figure.add_subplot(), "time step", "distance to the expected path (m)")
    axes.plot(steps, error, color=GREY, lw=0.9, label="error of each step, eq. 11")
    axes.plot(
        steps,
        so_far,
        color=BLUE,
        lw=1.8,
        label=f"RMSE so far, eq. 12: {so_far[-1]:.4g} m in the end",
    )
    axes.set_ylim(bottom=0)
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.14), ncols=2, fontsize=8)
    axes.set_title("Path-tracking error")
    worst = int(np.argmax(error))
    truth = "" if not runs.track.has_truth.any() else (
        f" The estimate's own error, against the simulated truth, is "
        f"{rmse(runs.track.position_error):.3g} m (RMSE)."
    )  # fmt: skip
    album.add(
        figure,
        "fig4-tracking",
        "Figure 4: path-tracking error and its RMSE",
        f"RMSE {so_far[-1]:.4f} m, the document says about 0.2 m. The largest error is "
        f"{error[worst]:.3g} m at step "
        f"{worst + 1}; the printed figure has its largest spikes at the corners near steps 200 "
        f"and 400. This is no "
        f"error of the filter alone: it holds how far the cart was led from the square, "
        f"too.{truth}",
    )


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
        _ring(axes, runs.ring)
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
        "too small to be "
        f"seen and are drawn {LARGER:.0f} times larger than they are, which makes the ellipses "
        f"{LARGER**0.5:.0f} "
        f"times as long and wide (largest standard deviation {1000 * widest['coded']:.2g} mm). "
        f"Right, to scale, what "
        "is left of that claim once R holds the yaw error times the way to the pylon: thin "
        "ellipses across the line "
        f"of sight, with a standard deviation of up to {1000 * widest['corrected']:.0f} mm.",
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


def table_of_readings(runs: Runs, album: Album) -> None:
    """What each reading, and what else was tried, does to the path-tracking error."""
    coded, corrected = runs.told["coded"], runs.told["corrected"]
    fix = runs.track.fix[~np.isnan(runs.track.fix[:, 0])]
    letter = coded.but(by_the_letter(coded.entries)).track()
    apart = rmse(np.linalg.norm(letter.pose[:, :2] - runs.tracks["coded"].pose[:, :2], axis=-1))
    rows = [
        _row(runs, WHAT["corrected"], runs.tracks["corrected"], "-"),
        _row(runs, OWN_FRAME, corrected.but(in_its_own_frame(corrected.entries)).track(), "-"),
        _row(
            runs,
            "corrected, every other correction",
            corrected.but(every_other(corrected.entries)).track(),
            "-",
        ),
        _row(runs, WHAT["coded"], runs.tracks["coded"], "0.230199"),
        _row(
            runs,
            "coded, every other correction",
            coded.but(every_other(coded.entries)).track(),
            "0.233241",
        ),
        _row(
            runs,
            "coded, dt from the stamps",
            coded.but(timed(coded.entries, None)).track(),
            "0.230220",
        ),
        _row(runs, WHAT["printed"], runs.tracks["printed"], "0.231986"),
        _row(runs, "coded, eq. 8 to the letter", letter, "-"),
        [
            "lidar and yaw alone, no filter",
            *_numbers(path_error(lidar_alone(coded), runs.ring)),
            "-",
            "-",
            "0.231313",
        ],
    ]
    if len(fix):
        rows.append(["GPS alone", *_numbers(path_error(fix, runs.ring)), "-", "-", "0.454782"])
    header = ["estimate", "path RMSE (m)", "mean (m)", "largest (m)", "RMSE to the truth (m)",
    "mean NIS per number",
              "the same of the authors' own program (m)"]  # fmt: skip
    published = runs.published
    album.table(
        "readings",
        "What each reading costs",
        header if published else header[:-1],
        rows if published else [row[:-1] for row in rows],
        f"Path RMSE by eqs 11 and 12. {COMPARED if published else ''}A NIS of 1 per number read "
        f"is what a filter that "
        f"knows its own uncertainty has on average. {_cost(runs)} Eq. 8 to the letter, with θ "
        f"where π/2 − θ belongs, "
        f"puts the cart {apart:.2g} m away from where it is (RMS), at another place of the "
        f"square; eq. 11, "
        "which asks for the nearest side, hardly notices.",
    )


def _near(track: Track, corner: Array) -> Integers:
    """The instants that figure 5 shows."""
    return np.flatnonzero(np.abs(track.pose[:, :2] - corner).max(axis=1) < INSIDE)


def _row(runs: Runs, name: str, track: Track, reference: str) -> list[str]:
    truth = f"{rmse(track.position_error):.4f}" if track.has_truth.any() else "-"
    return [name, *_numbers(runs.off_path(track)), truth, f"{track.nis:.2f}", reference]


def _numbers(error: Array) -> list[str]:
    return [f"{rmse(error):.6f}", f"{np.mean(error):.4f}", f"{np.max(error):.4f}"]


def _cost(runs: Runs) -> str:
    """What the difference between the readings costs."""
    path = {reading: rmse(runs.off_path(track)) for reading, track in runs.tracks.items()}
    nis = {reading: track.nis for reading, track in runs.tracks.items()}
    return (
        f"Path RMSE {path['corrected']:.4f} m corrected, {path['coded']:.4f} m coded, "
        f"{path['printed']:.4f} m printed; "
        f"NIS per number on average {nis['corrected']:.1f}, {nis['coded']:.0f} and "
        f"{nis['printed']:.0f}, where 1 is "
        "right: the readings differ more in what they claim than in what they estimate."
    )


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


def _told_of_variances(number: int, all_: Track, half: Track) -> str:
    i = INERTIAL.names.index("x" if number == 6 else "theta")
    every, other = all_.covariance[1:, i, i], half.covariance[1:, i, i]
    if number == 6:
        without, after = np.median(other[1::2]), np.median(other[2::2])
        meets = after < MEETING * np.median(every)
        return (
            f"The first {FIRST} steps on a logarithmic axis, after a start from P₀ = I. Where a "
            f"correction is left "
            f"out the variance of x grows to {without:.2g} m², with the next it falls back to "
            f"{after:.2g} m²; with "
            f"every correction it stays at {np.median(every):.2g} m² (medians of the run). In the "
            f"printed figure the "
            "circles rise at every other step and meet the triangles in between. "
            + ("So they do here." if meets else "Here they do not quite meet them: where R knows "
                                                "of the yaw error, one "
               "reading does not tell all, and each that is left out is missed.")
        )  # fmt: skip
    apart = float(np.max(np.abs(every / other - 1)))
    alike = "to the last digit" if apart == 0 else f"to {100 * apart:.1g} %"
    return (
        f"The pylon tells nothing of the yaw, so triangles and circles coincide, {alike} in the "
        f"variance of θ: it and "
        f"that of θ_prev are the variance of the inertial unit's yaw, {np.median(every):.3g} "
        f"rad², and θ̇ = "
        "(θ − θ_prev)/dt has 2σ²/dt². The printed figure shows these three in the same way."
    )


def _ring(axes: Axes, ring: Array) -> None:
    axes.plot(*np.concatenate([ring, ring[:1]]).T, "--", color=BLACK, lw=1.2, label="expected path")
