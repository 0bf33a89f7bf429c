"""Document 004, lidar and inertial unit around one pylon:
figures 2 to 7, and what each reading costs.
"""

import numpy as np
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
from ekfsim.figures.pylon.covariances import ellipses, expected_path, variances
from ekfsim.figures.pylon.innovations import innovations
from ekfsim.figures.pylon.readings import cost, table_of_readings
from ekfsim.figures.pylon.runs import (
    Runs,
)
from ekfsim.figures.pylon.yaw import yaw_filter
from ekfsim.figures.track import rmse, running_rmse
from ekfsim.geometry.outline import path_error
from ekfsim.scene import Scene

ENOUGH = 30  # readings


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
    expected_path(axes, runs.ring)
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
        "The square is gone round clockwise from its north-west corner. The estimate follows it to "
        f"{rmse(error):.3g} m (RMSE; {float(np.max(error)):.3g} m at most), corners included.{off} "
        "In the printed figure the GPS is off by about a metre, and the estimate leaves the path "
        f"at the corners, where the cart was turned with difficulty. {cost(runs)}",
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
        "in all, unwrapped. θ is the inertial unit's yaw itself: eq. 5 sets θ = yaw, and no filter "
        "smooths it, as the document's conclusion says.",
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
        " The estimate's own error, against the simulated truth, is "
        f"{rmse(runs.track.position_error):.3g} m (RMSE)."
    )  # fmt: skip
    album.add(
        figure,
        "fig4-tracking",
        "Figure 4: path-tracking error and its RMSE",
        f"RMSE {so_far[-1]:.4f} m, the document says about 0.2 m. The largest error is "
        f"{error[worst]:.3g} m at step {worst + 1}; the printed figure has its largest spikes at "
        "the corners near steps 200 and 400. This is no error of the filter alone: it holds how "
        f"far the cart was led from the square, too.{truth}",
    )
